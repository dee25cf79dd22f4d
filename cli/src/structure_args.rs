//! Which structure a command works on: one of the paper's specimens, or parameters from a file, with single numbers in
//! the place of theirs.
use crate::input;
use anyhow::Context;
use clap::{Arg, ArgMatches, Command, FromArgMatches, parser::ValueSource, value_parser};
use rocking::natural_quantities::{Given, NATURAL, names};
use rocking::parameters::PARAMETERS;
use rocking::quantity::Quantity;
use rocking::structure::Derived;
use rocking::{Parameters, Structure};
use std::path::{Path, PathBuf};

/// The structure asked for.
#[derive(clap::Args, Debug)]
pub struct StructureArgs {
    /// Specimen of the paper
    #[arg(long, value_enum, default_value_t = Preset::Mcmanus, conflicts_with = "parameters")]
    preset: Preset,
    /// TOML file of parameters, as `describe --template` writes it, `-` for standard input
    #[arg(long, value_name = "FILE.toml")]
    parameters: Option<PathBuf>,
    #[command(flatten)]
    numbers: Numbers,
}

/// Numbers in the place of the specimen's or the file's: an option for every parameter and natural quantity.
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
}

/// The structure's parameters in one line.
pub fn in_one_line(structure: &Structure) -> String {
    let values = PARAMETERS.iter().map(|parameter| {
        let value = (parameter.get)(structure.parameters());
        let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
        format!("{} = {value}{unit}", parameter.name)
    });
    values.collect::<Vec<_>>().join(", ")
}

impl StructureArgs {
    /// The file that is read, if any.
    pub fn input(&self) -> Option<&Path> {
        self.parameters.as_deref()
    }

    /// Reads the parameters and derives the structure; a refusal names the file, the line and the key.
    pub fn load(&self) -> anyhow::Result<Structure> {
        let Some(path) = &self.parameters else {
            return Ok(Structure::new(self.numbers.0.over(&self.preset.parameters())?)?);
        };
        let read = || -> anyhow::Result<Structure> {
            let given: Given = toml::from_str(&input::text(path)?)?;
            Ok(Structure::new(given.parameters()?)?)
        };
        let structure = read().with_context(|| format!("parameters in {}", input::name(path)))?;
        Ok(Structure::new(self.numbers.0.over(structure.parameters())?)?)
    }
}

/// A limit of a range, which may be far from 1.
pub fn short(limit: f64) -> String {
    if limit == 0.0 || (1e-3..1e5).contains(&limit) { limit.to_string() } else { format!("{limit:e}") }
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
        .help_heading("Numbers in the place of the preset's or the file's")
        .hide_short_help(true)
        .allow_negative_numbers(true)
        .value_parser(value_parser!(f64))
}

impl clap::Args for Numbers {
    fn augment_args(command: Command) -> Command {
        let parameters = PARAMETERS.iter().map(|&Quantity { name, unit, description, min, max, .. }| {
            option(name, unit, format!("{description}, {} to {}", short(min), short(max)))
        });
        let natural = NATURAL.iter().map(|natural| {
            let &Derived { name, unit, description, .. } = natural.derived();
            option(name, unit, format!("{description}: in the place of {}", natural.in_place_of))
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
