//! The scene for use outside the page: commands for a shell, a script in Python, and values to set in its FMU.

use crate::scene::{EL_CENTRO, Fields, RUN, number_of, storey, unit_of};
use rocking::structure::description::Storey;
use rocking::structure::ground::Ground;
use rocking::structure::natural_quantities::names;
use rocking::structure::parameters::PRESETS;
use rocking_records::Column;
use serde_json::{Number, Value, json};
use std::path::Path;

/// Name of the file in which the page saves a ground motion.
pub const TABLE: &str = "ground.csv";

/// Name of the file of its vertical component in an FMU.
pub const VERTICAL: &str = "ground_v.csv";

/// Name of the file of a structure of many masses or on ground that gives.
fn file_of(fields: &Fields) -> &'static str {
    if fields.is_frame() { "building.toml" } else { "pier.toml" }
}

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
    let options = |names: &mut dyn Iterator<Item = &'static str>| -> Result<Options, String> {
        let given =
            names.filter_map(|name| Some((name, fields.text(name).map(str::to_owned).or_else(|| usual(name))?)));
        given.map(|(name, text)| Ok((name, literal(name, &text)?))).collect()
    };
    let numbers = if fields.is_many() && fields.has_preset() {
        fields.numbers()?.into_iter().map(|(name, value)| (name, value.into())).collect()
    } else {
        options(&mut ["preset"].into_iter().chain(names()).filter(|name| *name != "preset" || fields.has_preset()))?
    };
    let structure = if fields.is_many() { vec![("parameters", file_of(fields).into())] } else { numbers.clone() };
    let (of_file, run) = (options(&mut fields.of_file())?, options(&mut RUN.into_iter())?);
    let file = path.filter(|_| fields.kind() == "record").map_or(TABLE.into(), |path| path.display().to_string());
    let file = if file == "-" { "./-".into() } else { file }; // `-` alone is standard input
    let simulate = |motion, of_file| command("simulate", &[&structure, &vec![motion], of_file, &run]);
    let after_first = |options: &Options| arguments(options)[", ".len()..].to_owned();
    let (command, record, motion) = match fields.kind() {
        "free" => {
            let motion = options(&mut ["duration"].into_iter())?;
            (simulate(("free", motion[0].1.clone()), &of_file)?, String::new(), arguments(&motion))
        }
        EL_CENTRO | "record" | "synthetic" => {
            let record = format!("record = fr.Record.read({}{})\n", Value::from(file.as_str()), arguments(&of_file));
            (simulate(("record", file.into()), &of_file)?, record, ", record".into())
        }
        shape => {
            let pulse = options(&mut ["amplitude", "frequency", "cycles", "phase"].into_iter())?;
            let preset = vec![("preset", PRESETS[0].0.into())]; // for its g
            let of_g = numbers.iter().filter(|(name, _)| *name == "g").cloned();
            let of_g = if fields.is_many() { preset.into_iter().chain(of_g).collect() } else { structure.clone() };
            let written = command(&format!("pulse {shape}"), &[&pulse, &of_g, &vec![("output", TABLE.into())]])?;
            let scaled = if of_file.is_empty() { "".into() } else { format!(".scaled({})", after_first(&of_file)) };
            let record = format!("record = fr.pulse(\"{shape}\"{}, g=structure.g){scaled}\n", arguments(&pulse));
            (format!("{written}\n{}", simulate(("record", file.into()), &of_file)?), record, ", record".into())
        }
    };
    let (building, structure) =
        if fields.is_many() { building(fields, &numbers)? } else { (String::new(), arguments(&numbers)) };
    let structure = structure.trim_start_matches(", ");
    let values_of_fmu = |(name, value): &(&str, Value)| match value.as_array() {
        Some(floors) => (1..).zip(floors).map(|(i, value)| format!("{name}[{i}]={value}")).collect(),
        None if *name == "u_0" && fields.is_many() => vec![format!("u_0[1]={value}")],
        None => vec![format!("{name}={value}")],
    };
    let in_host = run.iter().flat_map(values_of_fmu).collect::<Vec<_>>().join(", ");
    let (command, run) = (format!("{building}{command}"), arguments(&run));
    let script = format!(
        "import flexible_rocking as fr\n\nstructure = fr.Structure({structure})\n{record}run = fr.simulate(structure{motion}{run})"
    );
    Ok([command, script, in_host])
}

/// A command that writes the file of one mass of these `numbers`, or of storeys on their base, and of ground that gives, and the
/// arguments of the same structure in Python.
fn building(fields: &Fields, numbers: &Options) -> Result<(String, String), String> {
    let lines = |of: &Options| of.iter().map(|(name, value)| format!("{name} = {value}\n")).collect::<String>();
    let (mut file, mut structure) = match fields.text("storeys") {
        Some(storeys) => of_storeys(fields, storeys, lines(numbers))?,
        None => (lines(numbers), String::new()),
    };
    structure += &arguments(numbers);
    if let Some(Ground { f_v, k_v, zeta_v, n_points, .. }) = fields.ground()? {
        let all = [("f_v", json!(f_v)), ("k_v", json!(k_v)), ("zeta_v", json!(zeta_v)), ("n_points", json!(n_points))];
        let ground = all.into_iter().filter(|(_, value)| !value.is_null()).collect();
        file += &format!("\n[ground]\n{}", lines(&ground));
        structure += &format!(", ground=fr.Ground({})", arguments(&ground).trim_start_matches(", "));
    }
    Ok((format!("cat >{} <<'END'\n{file}END\n", file_of(fields)), structure))
}

/// Storeys as a file with these lines of the `base`, and as arguments of Python.
fn of_storeys(fields: &Fields, storeys: &str, base: String) -> Result<(String, String), String> {
    let zeta = literal("zeta", &fields.number("zeta")?.to_string())?;
    let keep = fields.modes()?;
    let kept = keep.map_or(String::new(), |count| format!("keep = {count}\n"));
    let mut file = format!("zeta = {zeta}\n{kept}\n[base]\n{base}");
    let mut rows = Vec::new();
    for row in storeys.split_whitespace() {
        let Storey { m, h, k } = storey(rows.len() + 1, row)?;
        let named = || ["m", "h", "k"].iter().zip([m, h, k]).map(|(name, number)| (name, Value::from(number)));
        file += &format!(
            "\n[[storeys]]\n{}",
            named().map(|(name, value)| format!("{name} = {value}\n")).collect::<String>()
        );
        rows.push(named().map(|(name, value)| format!("\"{name}\": {value}")).collect::<Vec<_>>().join(", "));
    }
    let rows: String = rows.iter().map(|row| format!("    {{{row}}},\n")).collect();
    let kept = keep.map_or(String::new(), |count| format!(", keep={count}"));
    Ok((file, format!("storeys=[\n{rows}], zeta={zeta}{kept}")))
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
    let called = |name| if name == "column_v" { "vertical_column" } else { name };
    options.iter().map(|(name, value)| format!(", {}={}", called(*name), literal(value))).collect()
}
