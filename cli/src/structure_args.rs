//! Which structure a command works on: one of the paper's specimens, or parameters from a file, with single numbers in
//! the place of theirs, or numbers that are all of it. What is assumed is said.
use crate::{input, significant::in_full, talk::say};
use anyhow::{Context, anyhow};
use clap::{Arg, ArgMatches, Command, FromArgMatches, ValueEnum, parser::ValueSource, value_parser};
use rocking::structure::Derived;
use rocking::structure::natural_quantities::{DEFAULTS, Given, GivenError, NATURAL, names};
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::quantity::Quantity;
use rocking::{Parameters, Structure};
use std::path::{Path, PathBuf};

/// The structure asked for.
#[derive(clap::Args, Debug)]
pub struct StructureArgs {
    /// Specimen of the paper [default: mcmanus, where nothing of a structure is given]
    #[arg(long, value_enum, conflicts_with = "parameters")]
    preset: Option<Preset>,
    /// TOML file of parameters, as `describe --template` writes it, `-` for standard input
    #[arg(long, value_name = "FILE.toml")]
    parameters: Option<PathBuf>,
    #[command(flatten)]
    numbers: Numbers,
}

/// Numbers in the place of the specimen's or the file's, or alone: an option for every parameter and natural quantity.
#[derive(Debug)]
struct Numbers(Given);

/// A specimen of the paper.
#[derive(Clone, Copy, Debug, clap::ValueEnum, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Preset {
    /// Shear wall (Table 1)
    Evison,
    /// Bridge pier (Table 2)
    Mcmanus,
}

impl Preset {
    /// Its parameters.
    pub fn parameters(self) -> Parameters {
        match self {
            Preset::Evison => Parameters::EVISON,
            Preset::Mcmanus => Parameters::MCMANUS,
        }
    }

    /// What it is called.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().into())
    }
}

/// The structure's parameters in one line.
pub fn in_one_line(structure: &Structure) -> String {
    listed(structure.parameters(), |_| true)
}

/// The `parameters` whose names are `meant`, in one line.
fn listed(parameters: &Parameters, meant: impl Fn(&str) -> bool) -> String {
    let value = |parameter: &Quantity<Parameters>| {
        let value = (parameter.get)(parameters);
        let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
        format!("{} = {value}{unit}", parameter.name)
    };
    PARAMETERS.iter().filter(|parameter| meant(parameter.name)).map(value).collect::<Vec<_>>().join(", ")
}

/// Where what is not `given` by name of `parameters` comes from: from a specimen, or by default. None if all is given.
pub fn left_open(preset: Option<&str>, parameters: &Parameters, given: impl Fn(&str) -> bool) -> Option<String> {
    let Some(preset) = preset else {
        let is_default = |name: &str| DEFAULTS.iter().any(|(default, _)| *default == name);
        let open = listed(parameters, |name| !given(name) && is_default(name));
        return (!open.is_empty()).then(|| format!("by default: {open}"));
    };
    let open = listed(parameters, |name| !given(name));
    let is_all = PARAMETERS.iter().all(|parameter| !given(parameter.name));
    (!open.is_empty()).then(|| if is_all { preset.to_owned() } else { format!("from {preset}: {open}") })
}

impl StructureArgs {
    /// The file that is read, if any.
    pub fn input(&self) -> Option<&Path> {
        self.parameters.as_deref()
    }

    /// Reads the parameters and derives the structure, and says what of it was not given; a refusal names the file, the line
    /// and the key.
    pub fn load(&self) -> anyhow::Result<Structure> {
        let numbers = &self.numbers.0;
        let mut of_file = Given::default();
        let parameters = match (&self.parameters, self.preset) {
            (Some(path), _) => {
                let mut read = || -> anyhow::Result<Structure> {
                    of_file = toml::from_str(&input::text(path)?)?;
                    Ok(Structure::new(of_file.parameters()?)?)
                };
                let structure = read().with_context(|| format!("parameters in {}", input::name(path)))?;
                numbers.over(structure.parameters())?
            }
            (None, Some(preset)) => numbers.over(&preset.parameters())?,
            (None, None) if numbers.is_empty() => Preset::Mcmanus.parameters(),
            (None, None) => numbers.parameters().map_err(with_options)?,
        };
        let structure = Structure::new(parameters)?;
        let preset = match self.preset {
            Some(preset) => Some(preset.name()),
            None if self.parameters.is_some() || !numbers.is_empty() => None,
            None => Some(format!("{}, for none is given: see --preset, --parameters", Preset::Mcmanus.name())),
        };
        let given = |name: &str| numbers.determine(name) || of_file.determine(name);
        if let Some(open) = left_open(preset.as_deref(), &parameters, given) {
            say!("structure      {open}");
        }
        Ok(structure)
    }
}

/// The error with the options that help.
fn with_options(error: GivenError) -> anyhow::Error {
    let GivenError::Missing(missing) = &error else { return error.into() };
    let advice = missing.iter().map(|missing| missing.advice(|name| format!("--{}", option_name(name))));
    let presets = Preset::value_variants().iter().map(|preset| format!("--preset {}", preset.name()));
    anyhow!(
        "{}; or take what is missing from a specimen of the paper: {}",
        advice.collect::<Vec<_>>().join("; "),
        presets.collect::<Vec<_>>().join(" or ")
    )
}

/// The option of the number called `name`: `--f-fc` of f_fc.
fn option_name(name: &str) -> String {
    name.replace('_', "-")
}

fn option(name: &'static str, unit: &'static str, help: String) -> Arg {
    Arg::new(name)
        .long(option_name(name))
        .value_name(if unit == "1" { "NUMBER".into() } else { unit.to_uppercase() })
        .help(help)
        .help_heading("Numbers that replace those of the preset or the file, or stand alone")
        .hide_short_help(true)
        .allow_negative_numbers(true)
        .value_parser(value_parser!(f64))
}

impl clap::Args for Numbers {
    fn augment_args(command: Command) -> Command {
        let parameters = PARAMETERS.iter().map(|&Quantity { name, unit, description, min, max, .. }| {
            option(name, unit, format!("{description}, {} to {}", in_full(min), in_full(max)))
        });
        let natural = NATURAL.iter().map(|natural| {
            let &Derived { name, unit, description, .. } = natural.derived();
            option(name, unit, format!("{description}; replaces {}", natural.in_place_of))
        });
        command.args(parameters.chain(natural))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Numbers::augment_args(command)
    }
}

impl FromArgMatches for Numbers {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Numbers, clap::Error> {
        let mut given = Given::default();
        for name in names().filter(|name| matches.value_source(name) == Some(ValueSource::CommandLine)) {
            let value = matches.get_one(name).copied().expect("it is there");
            given.give(name, value).expect("clap knows these names, and each once");
        }
        Ok(Numbers(given))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Numbers::from_arg_matches(matches)?;
        Ok(())
    }
}
