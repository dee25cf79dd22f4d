//! The scene for use outside the page: commands for a shell, a script in Python, and values to set in its FMU.

use crate::scene::{EL_CENTRO, Fields, RUN, number_of, unit_of};
use rocking::structure::natural_quantities::names;
use rocking::structure::parameters::PRESETS;
use rocking_records::Column;
use rocking_report::structure_file;
use serde_json::{Number, Value};
use std::path::Path;

/// Name of the file in which the page saves a ground motion.
pub const TABLE: &str = "ground.csv";

/// Name of the file of its vertical component in an FMU.
pub const VERTICAL: &str = "ground_v.csv";

/// Options of one call, by the names that the command line and Python share.
type Options = Vec<(&'static str, Value)>;

/// Commands of a POSIX shell, a script in Python, and start and method of the run, which an FMU does not hold. All three are of
/// the scene `fields` with the record at `path`. Commands and script contain every key of the scene.
pub fn taken_along(fields: &Fields, path: Option<&Path>) -> Result<[String; 3], String> {
    let usual = |name: &str| match name {
        "preset" => Some(PRESETS[0].0.to_owned()),
        "amplitude" | "frequency" | "duration" => fields.number(name).ok().map(|usual| usual.to_string()),
        _ => None, // the command line and Python have the usual values of the page
    };
    let after_first = |options: &Options| arguments(options).trim_start_matches(", ").to_owned();
    let options = |names: &mut dyn Iterator<Item = &'static str>| -> Result<Options, String> {
        let given =
            names.filter_map(|name| Some((name, fields.text(name).map(str::to_owned).or_else(|| usual(name))?)));
        given.map(|(name, text)| Ok((name, literal(name, &text)?))).collect()
    };
    let (written, structure, called) = if fields.has_file() {
        let toml = if fields.is_frame() { "building.toml" } else { "pier.toml" };
        let text = structure_file::write(&fields.structure()?).map_err(|error| rocking_report::message(&error))?;
        let written = format!("cat >{toml} <<'END'\n{text}END\n");
        (written, vec![("parameters", toml.into())], format!(".read(\"{toml}\")"))
    } else {
        let numbers = options(&mut ["preset"].into_iter().filter(|_| fields.has_preset()).chain(names()))?;
        let called = format!("({})", after_first(&numbers));
        (String::new(), numbers, called)
    };
    let (of_file, run) = (options(&mut fields.of_file())?, options(&mut RUN.into_iter())?);
    let file = path.filter(|_| fields.kind() == "record").map_or(TABLE.into(), |path| path.display().to_string());
    let file = if file == "-" { "./-".into() } else { file }; // `-` alone is standard input
    let simulate = |motion, of_file| command("simulate", &[&structure, &vec![motion], of_file, &run]);
    let (command, record, motion) = match fields.kind() {
        "free" => {
            let motion = options(&mut ["duration"].into_iter())?;
            (simulate(motion[0].clone(), &of_file)?, String::new(), arguments(&motion))
        }
        EL_CENTRO | "record" | "synthetic" => {
            let record = format!("record = fr.Record.read({}{})\n", Value::from(file.as_str()), arguments(&of_file));
            (simulate(("record", file.into()), &of_file)?, record, ", record".into())
        }
        shape => {
            let pulse = options(&mut ["amplitude", "frequency", "cycles", "phase"].into_iter())?;
            let of_pulse = [&pulse, &structure, &vec![("output", TABLE.into())]]; // the structure for its g
            let pulse_written = command(&format!("pulse {shape}"), &of_pulse)?;
            let scaled = if of_file.is_empty() { "".into() } else { format!(".scaled({})", after_first(&of_file)) };
            let record = format!("record = fr.pulse(\"{shape}\"{}, g=structure.g){scaled}\n", arguments(&pulse));
            (format!("{pulse_written}\n{}", simulate(("record", file.into()), &of_file)?), record, ", record".into())
        }
    };
    let values_of_fmu = |(name, value): &(&str, Value)| match value.as_array() {
        Some(floors) => (1..).zip(floors).map(|(i, value)| format!("{name}[{i}]={value}")).collect(),
        None if *name == "u_0" && fields.is_frame() => vec![format!("u_0[1]={value}")],
        None => vec![format!("{name}={value}")],
    };
    let in_host = run.iter().flat_map(values_of_fmu).collect::<Vec<_>>().join(", ");
    let (command, run) = (format!("{written}{command}"), arguments(&run));
    let script = format!(
        "import flexible_rocking as fr\n\nstructure = fr.Structure{called}\n{record}run = fr.simulate(structure{motion}{run})"
    );
    Ok([command, script, in_host])
}

/// The value of the key `name`, given as `text`.
fn literal(name: &str, text: &str) -> Result<Value, String> {
    let given = || number_of(name, unit_of(name), text).ok();
    let number = || text.parse::<i64>().map(Number::from).ok().or_else(|| Number::from_f64(given()?));
    match name {
        "preset" | "unit" | "detail" => Ok(text.into()),
        "ignore_npts" => Ok(true.into()),
        "column" | "column_v" => Ok(match Column::from(text) {
            Column::Number(number) => number.into(),
            _ => text.into(),
        }),
        "u_0" if text.contains(',') => text.split(',').map(|text| literal(name, text.trim())).collect(),
        _ => number().map(Value::Number).ok_or_else(|| format!("{name} = {text:?} is no finite number")),
    }
}

/// One command with `options`, each quoted for a POSIX shell.
fn command(name: &str, options: &[&Options]) -> Result<String, String> {
    let mut words = vec![format!("rocking-fmu {name}")];
    for (name, value) in options.iter().copied().flatten() {
        let text = value.as_str().map_or_else(|| value.to_string().replace(['[', ']'], ""), str::to_owned);
        let quoted = shlex::try_quote(&text).map_err(|error| format!("{name} = {text:?}: {error}"))?;
        let name = name.replace('_', "-");
        words.push(if value.is_boolean() { format!("--{name}") } else { format!("--{name}={quoted}") });
    }
    Ok(words.join(" "))
}

/// The `options` as keyword arguments of Python, each behind a comma. Strings and numbers of JSON are literals of Python.
fn arguments(options: &Options) -> String {
    let literal = |value: &Value| if value.is_boolean() { "True".into() } else { value.to_string() };
    options.iter().map(|(name, value)| format!(", {name}={}", literal(value))).collect()
}
