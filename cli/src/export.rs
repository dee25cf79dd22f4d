//! `export`: packs the shared libraries, with all that describes them, into an FMU.

use crate::options::{on_command_line, one_of};
use crate::record_args::{RecordOptions, VerticalArgs, say_understood};
use crate::structure_args::StructureArgs;
use crate::talk::{say, warning};
use FlexibleRocking::{guid, resources::Contents};
use anyhow::{Context, bail};
use fmu_export::{Library, LibraryError, ModelName, Platform, Version};
use rocking::run::record::SamplesError;
use rocking_records::LAYOUTS;
use rocking_report::{describe::in_one_line, input, output_files::OutputFiles, record::no_pair};
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};

/// Path of the archive with the libraries for every platform, in the folder `share` of an installation.
const INSTALLED: &str = "flexible-rocking/FlexibleRocking.fmu";

#[derive(clap::Args)]
pub struct ExportArgs {
    #[command(flatten)]
    structure: StructureArgs,
    #[arg(long, value_name = "FILE", num_args = 1.., help_heading = "Ground motion", help = format!(
        "Ground motion records to pack: {LAYOUTS}; the FMU follows the first, and each other one by its name. A record \
         read with options, or from standard input, `-`, is packed as a CSV file"
    ))]
    record: Vec<PathBuf>,
    #[command(flatten)]
    vertical: VerticalArgs,
    #[command(flatten, next_help_heading = "Ground motion")]
    options: RecordOptions,
    /// Version of FMI, for co-simulation and model exchange: 2 (2.0), 3 (3.0)
    #[arg(long, value_name = "VERSION", default_value = "2", value_parser = one_of([("2", Version::Fmi2), ("3", Version::Fmi3)]))]
    fmi: Version,
    /// Leave out the parameters `record` and `record_v`, which are strings: CasADi loads no FMI 3.0 with strings
    #[arg(long)]
    no_strings: bool,
    /// Name of the model and of its libraries' files, for hosts that hold several exports
    #[arg(long, value_name = "NAME", default_value = "FlexibleRocking")]
    name: ModelName,
    /// Archive to write, `-` for standard output; an existing file is replaced [default: NAME.fmu]
    #[arg(short, long, value_name = "FILE.fmu")]
    output: Option<PathBuf>,
    /// Shared libraries to pack, or an FMU of this build to take them from [default: those built with this
    /// program]
    #[arg(long, value_name = "PATH", num_args = 1..)]
    library: Vec<PathBuf>,
}

/// Writes the FMU and reports its content; the libraries are beside `program`.
pub fn run(args: &ExportArgs, program: &Path) -> anyhow::Result<()> {
    let structure = args.structure.load_any()?;
    let mut libraries = if args.library.is_empty() { libraries_of(program)? } else { Vec::new() };
    for path in &args.library {
        libraries.extend(Library::read(path)?);
    }
    let output = args.output.clone().unwrap_or_else(|| format!("{}.fmu", args.name.as_str()).into());
    let inputs = args.record.iter().chain(&args.vertical.record_v).chain(&args.library);
    let inputs = args.structure.input().into_iter().chain(inputs.map(PathBuf::as_path));
    let file = OutputFiles::of_inputs(inputs).create(&output)?;
    if !input::is_stream(&output) {
        fmu_export::check_target(&output)?;
    }
    let g = structure.base().g;
    let records = args.record.iter().map(|path| record(&args.options, path, g)).collect::<Result<Vec<_>, _>>()?;
    let of_vertical = args.options.with_column(&args.vertical.column_v);
    let vertical = args.vertical.file(args.record.first()).map(|path| record(&of_vertical, path, g)).transpose()?;
    let vertical = match (vertical, records.first()) {
        (Some((_, bytes)), Some((name, along))) if bytes == *along => {
            return Err(no_pair(SamplesError::Twice { title: name.display().to_string() }, "--column-v"));
        }
        (Some((name, bytes)), _) if records.iter().any(|(of_record, _)| *of_record == name) => {
            Some(((input::stem(&name) + "_v.csv").into(), bytes))
        }
        (vertical, _) => vertical,
    };
    let contents = Contents { fixed: args.no_strings, ..structure.clone().into() };
    let (contents, archive) = fmu_export::export(args.fmi, &args.name, contents, records, vertical, &libraries)?;
    file.write(&archive)?;
    say!("{}: {} kB", output.display(), archive.len().div_ceil(1000));
    say!("  GUID       {}", guid(&contents));
    say!("  structure  {}", in_one_line(&structure));
    let platforms: Vec<_> = libraries.iter().map(|library| library.platform.folder(args.fmi)).collect();
    say!("  platforms  {}", platforms.join(", "));
    for packed in &contents.records {
        say!("  record     {}", packed.file);
    }
    if let Some(packed) = &contents.vertical {
        say!("  record_v   {}", packed.file);
    }
    Ok(())
}

/// The file to pack for the record at `path`, and its content: itself, or what is understood of it.
fn record(options: &RecordOptions, path: &Path, g: f64) -> anyhow::Result<(PathBuf, Vec<u8>)> {
    let understood = options.understand(path, g, on_command_line)?;
    say_understood("", &understood);
    if *options == RecordOptions::default() && !input::is_stream(path) {
        return Ok((path.into(), rocking_records::read_file(path)?));
    }
    Ok(((input::stem(path) + ".csv").into(), understood.tables()?.0.into_bytes()))
}

/// The shared libraries that were built with `program`, at most one for each platform.
///
/// If the program is in cargo's target folder, the libraries of `make dist` are in the folders of their targets, beside
/// the folder of the program's profile. These libraries come first because they need no newer system than they say. The
/// library of the program's own platform is in the folder `deps` beside the program. Cargo links this library into the
/// program's folder only if the package of the FMU is built as well, as `cargo build` does in the root and
/// `-p rocking-cli` does not.
///
/// An installed program is in `bin`; the folder `share` beside `bin` has an archive with the libraries. If pip installs
/// for one user of Windows, a folder of Python's version is between the two.
fn libraries_of(program: &Path) -> anyhow::Result<Vec<Library>> {
    let own = format!("{DLL_PREFIX}FlexibleRocking{DLL_SUFFIX}");
    let beside = program.with_file_name(&own);
    let in_deps = program.with_file_name("deps").join(&own);
    let folder = program.parent().unwrap_or(Path::new(""));
    let [installed, for_one_user] = [1, 2].map(|up| {
        let above = folder.ancestors().nth(up).unwrap_or(Path::new(""));
        above.join("share").join(INSTALLED)
    });
    let mut libraries: Vec<Library> = Vec::new();
    for platform in Platform::ALL {
        let path = folder.with_file_name(platform.target()).join("dist").join(platform.file());
        match Library::read(&path) {
            Ok(found) => libraries.extend(found),
            Err(LibraryError::OtherBuild(_)) => warning!("{} is left out: it is of another build", path.display()),
            Err(_) if !path.exists() => (),
            Err(error) => return Err(error.into()),
        }
    }
    if let Some(path) = [&in_deps, &beside, &installed, &for_one_user].into_iter().find(|path| path.exists()) {
        let found =
            Library::read(path).with_context(|| format!("`cargo build --release` builds {}", beside.display()))?;
        let is_new = |library: &Library| libraries.iter().all(|other| other.platform != library.platform);
        let new: Vec<_> = found.into_iter().filter(is_new).collect();
        libraries.extend(new);
    }
    if libraries.is_empty() {
        bail!(
            "there is no shared library to pack, neither {} nor {} nor {}: build it with `cargo build --release`, or \
             say with --library PATH where it is, or where an FMU of this build is",
            beside.display(),
            in_deps.display(),
            installed.display()
        );
    }
    libraries.sort_by_key(|library| library.platform);
    Ok(libraries)
}
