//! Which structure a command works on: one of the paper's specimens, or parameters from a file, with single numbers in
//! the place of theirs, or numbers that are all of it.
use crate::options::{on_command_line, one_of, option_name};
use crate::talk::{say, warning};
use anyhow::{Context, bail};
use clap::{Arg, ArgMatches, Command, FromArgMatches, parser::ValueSource};
use rocking::digits::short;
use rocking::structure::derived::Derived;
use rocking::structure::description::Description;
use rocking::structure::doubts::{all_doubted, doubted};
use rocking::structure::ground;
use rocking::structure::natural_quantities::{NATURAL, Numbers, names};
use rocking::structure::parameters::{PARAMETERS, PRESETS};
use rocking::structure::quantity::Quantity;
use rocking::{Parameters, Structure};
use rocking_report::{input, structure_file};
use std::path::{Path, PathBuf};

#[derive(clap::Args, Debug)]
pub struct StructureArgs {
    /// Specimen of the paper: a bridge pier (Table 2) or a shear wall (Table 1) [default: mcmanus, if no
    /// structure is given]
    #[arg(long, value_parser = one_of(PRESETS), conflicts_with = "parameters")]
    preset: Option<Parameters>,
    /// TOML file of parameters, as `describe --template` writes it, `-` for standard input
    #[arg(long, value_name = "FILE.toml")]
    parameters: Option<PathBuf>,
    #[command(flatten)]
    numbers: NumberOptions,
    /// Names of numbers; their warnings are left out
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = one_of(all_doubted().map(|name| (name, name))))]
    allow: Vec<&'static str>,
}

/// Numbers in the place of the specimen's or the file's, or alone: an option for every parameter and natural quantity.
#[derive(Debug)]
struct NumberOptions(Numbers);

impl StructureArgs {
    pub fn input(&self) -> Option<&Path> {
        self.parameters.as_deref()
    }

    /// Reads the structure, and warns of doubtful numbers; a refusal names the file, the line and the key.
    pub fn load_any(&self) -> anyhow::Result<Structure> {
        let structure = self.read()?;
        for doubt in structure.doubts() {
            let name = doubted(&doubt);
            if !self.allow.contains(&name) {
                warning!("{doubt} (--allow {name} silences this warning)");
            }
        }
        Ok(structure)
    }

    fn read(&self) -> anyhow::Result<Structure> {
        let numbers = &self.numbers.0;
        Ok(match (&self.parameters, self.preset) {
            (Some(path), _) => {
                let read = || structure_file::read(&input::text(path)?);
                let structure = read().with_context(|| format!("parameters in {}", input::name(path)))?;
                match structure.description() {
                    _ if numbers.is_empty() => structure,
                    Some(Description { parameters, many: None, ground }) => {
                        let changed = numbers.clone().on(ground.clone()).structure(Some(parameters))?;
                        changed.measured_in(structure.units())
                    }
                    _ => bail!(
                        "{} replaces a number of one mass, and {} describes many masses: change it in the file",
                        numbers.names().map(on_command_line).collect::<Vec<_>>().join(", "),
                        input::name(path)
                    ),
                }
            }
            (None, Some(preset)) => numbers.structure(Some(&preset))?,
            (None, None) if numbers.is_empty() => {
                say!("structure      mcmanus, the default: choose another with --preset or --parameters");
                Structure::new(Parameters::MCMANUS)?
            }
            (None, None) => numbers.parameters(on_command_line).and_then(|_| numbers.structure(None))?,
        })
    }
}

fn option(name: &'static str, unit: &'static str, help: String) -> Arg {
    let needed = match unit {
        "1" => "a number is needed".to_owned(),
        unit => format!("a number in {unit} is needed, without the unit"),
    };
    let number = move |text: &str| text.parse::<f64>().map_err(|_| needed.clone());
    Arg::new(name)
        .long(option_name(name))
        .value_name(if unit == "1" { "NUMBER".into() } else { unit.to_uppercase() })
        .help(help)
        .help_heading("Numbers that replace those of the preset or the file, or stand alone")
        .hide_short_help(true)
        .allow_hyphen_values(true)
        .value_parser(number)
}

impl clap::Args for NumberOptions {
    fn augment_args(command: Command) -> Command {
        let parameters = PARAMETERS.iter().map(|&Quantity { name, unit, description, min, max, .. }| {
            option(name, unit, format!("{description}, {} to {}", short(min), short(max)))
        });
        let natural = NATURAL.iter().map(|natural| {
            let &Derived { name, unit, description, .. } = natural.derived();
            option(name, unit, format!("{description}; replaces {}", natural.in_place_of))
        });
        let of_ground = ground::NAMES.into_iter().filter(|name| name.contains('_')).map(|name| {
            let refuse = |_: &str| Err::<f64, _>("ground that gives stands in [ground] of the file of --parameters");
            Arg::new(name).long(option_name(name)).hide(true).allow_hyphen_values(true).value_parser(refuse)
        });
        command.args(parameters.chain(natural).chain(of_ground))
    }

    fn augment_args_for_update(command: Command) -> Command {
        NumberOptions::augment_args(command)
    }
}

impl FromArgMatches for NumberOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<NumberOptions, clap::Error> {
        let mut given = Numbers::default();
        for name in names().filter(|name| matches.value_source(name) == Some(ValueSource::CommandLine)) {
            let value = matches.get_one(name).copied().expect("it is there");
            given.give(name, value).expect("clap knows these names, and each once");
        }
        Ok(NumberOptions(given))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = NumberOptions::from_arg_matches(matches)?;
        Ok(())
    }
}
