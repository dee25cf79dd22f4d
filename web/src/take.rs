//! A scene as what computes it elsewhere: commands for a shell, a script in Python, and values to set in its FMU.

use crate::scene::{Fields, RUN};
use rocking::structure::natural_quantities::names;
use rocking::structure::parameters::PRESETS;
use rocking_records::Column;
use serde_json::{Number, Value};
use std::path::Path;

/// Name of the file in which the page saves a ground motion.
pub const GROUND: &str = "ground.csv";

/// Options of one call, by the names that the command line and Python share.
type Options = Vec<(&'static str, Value)>;

/// The calls that compute one scene, and the options of each.
pub struct Calls<'a> {
    ground: &'a str,
    structure: Options,
    /// Numbers of a pulse, or the duration of free vibration.
    motion: Options,
    /// Name of the record's file.
    file: String,
    of_file: Options,
    run: Options,
}

impl Calls<'_> {
    /// The calls that compute the scene `fields` with the record at `path`. Every key of the scene is in one of them.
    pub fn of<'a>(fields: &'a Fields, path: Option<&Path>) -> Result<Calls<'a>, String> {
        let ground = fields.kind();
        let file = path.filter(|_| ground == "record").unwrap_or(Path::new(GROUND));
        let given = |names: &mut dyn Iterator<Item = &'static str>| -> Result<Options, String> {
            let given = names.filter_map(|name| Some((name, fields.text(name)?)));
            given.map(|(name, text)| Ok((name, literal(name, text)?))).collect()
        };
        // a command has no usual value of these
        let needed = |names: &[&'static str]| -> Result<Options, String> {
            names.iter().map(|name| Ok((*name, literal(name, &fields.number(name)?.to_string())?))).collect()
        };
        let motion = match ground {
            "record" | "synthetic" => Vec::new(),
            "free" => needed(&["duration"])?,
            _ => [needed(&["amplitude", "frequency"])?, given(&mut ["cycles", "phase"].into_iter())?].concat(),
        };
        let preset = fields.text("preset").unwrap_or(PRESETS[0].0);
        Ok(Calls {
            ground,
            structure: [vec![("preset", preset.into())], given(&mut names())?].concat(),
            motion,
            file: if file == Path::new("-") { "./-".into() } else { file.display().to_string() }, // no standard input
            of_file: given(&mut fields.of_file())?,
            run: given(&mut RUN.into_iter())?,
        })
    }

    fn is_pulse(&self) -> bool {
        !["record", "synthetic", "free"].contains(&self.ground)
    }

    /// The commands of a POSIX shell, a line each.
    pub fn command(&self) -> Result<String, String> {
        let motion = match self.ground {
            "free" => vec![("free", self.motion[0].1.clone())],
            _ => vec![("record", self.file.as_str().into())],
        };
        let simulate = command("simulate", &[&self.structure, &motion, &self.of_file, &self.run])?;
        if !self.is_pulse() {
            return Ok(simulate);
        }
        let output = vec![("output", GROUND.into())];
        let pulse = command(&format!("pulse {}", self.ground), &[&self.motion, &self.structure, &output])?;
        Ok(format!("{pulse}\n{simulate}"))
    }

    /// The script in Python.
    pub fn script(&self) -> String {
        let [structure, of_file, run] = [&self.structure, &self.of_file, &self.run].map(|options| arguments(options));
        let record = match self.ground {
            "free" => String::new(),
            _ if !self.is_pulse() => {
                format!("record = fr.Record.read({}{of_file})\n", Value::from(self.file.as_str()))
            }
            shape => {
                let scaled = if of_file.is_empty() { String::new() } else { format!(".scaled({})", &of_file[2..]) };
                format!("record = fr.pulse(\"{shape}\"{}, g=structure.g){scaled}\n", arguments(&self.motion))
            }
        };
        let motion = if record.is_empty() { arguments(&self.motion) } else { ", record".into() };
        format!(
            "import flexible_rocking as fr\n\nstructure = fr.Structure({})\n{record}run = fr.simulate(structure{motion}{run})",
            &structure[2..]
        )
    }

    /// The values of the run, which an FMU does not hold.
    pub fn to_set(&self) -> String {
        arguments(&self.run).trim_start_matches(", ").to_owned()
    }
}

/// The value of the key `name`, given as `text`.
fn literal(name: &str, text: &str) -> Result<Value, String> {
    let number = || text.parse::<i64>().map(Number::from).ok().or_else(|| Number::from_f64(text.parse().ok()?));
    match name {
        "preset" | "unit" | "detail" => Ok(text.into()),
        "ignore_npts" => Ok(true.into()),
        "column" => Ok(match Column::from(text) {
            Column::Number(number) => number.into(),
            _ => text.into(),
        }),
        _ => number().map(Value::Number).ok_or_else(|| format!("{name} = {text:?} is no finite number")),
    }
}

/// One command with `options`, each quoted for a POSIX shell.
fn command(name: &str, options: &[&Options]) -> Result<String, String> {
    let mut words = vec![format!("rocking-fmu {name}")];
    for (name, value) in options.iter().copied().flatten() {
        let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
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
