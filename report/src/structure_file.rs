//! The file of a structure, in TOML: read and written.

use anyhow::{Context, anyhow};
use rocking::digits::short;
use rocking::structure::derived::Derived;
use rocking::structure::description::{Damping, Described, Description};
use rocking::structure::natural_quantities::{NATURAL, Natural, Numbers};
use rocking::structure::parameters::Parameters;
use rocking::{OneMass, Quantity, Structure};
use serde::{Deserialize, Deserializer};
use std::fmt::Write;
use toml::{Deserializer as OfText, Table, Value};

/// What only the file of a structure of many masses has.
pub const OF_MANY: [&str; 5] = ["base", "storeys", "floors", "K", "modes"];

/// The structure that the TOML `text` describes, of many masses if there are tables of them. An error names the line and the key.
pub fn read(text: &str) -> anyhow::Result<Structure> {
    of(is_of_many(&toml::from_str(text)?), OfText::parse(text)?, None)
}

/// The structure that the tables of a file describe, of one mass in the place of the numbers of `base` if there is one.
pub fn of_table(table: Table, base: Option<&Parameters>) -> anyhow::Result<Structure> {
    let structure = of(base.is_none() && is_of_many(&table), table, base);
    structure.map_err(|error| match error.downcast::<toml::de::Error>() {
        Ok(error) => anyhow!("{}", error.to_string().trim_end().replace('\n', "; ")),
        Err(error) => error,
    })
}

fn is_of_many(table: &Table) -> bool {
    OF_MANY.iter().any(|key| table.contains_key(*key))
}

fn of<'de, D>(is_of_many: bool, file: D, base: Option<&Parameters>) -> anyhow::Result<Structure>
where
    D: Deserializer<'de, Error = toml::de::Error>,
{
    Ok(if is_of_many {
        Described::deserialize(file)?.structure()?
    } else {
        Numbers::deserialize(file)?.structure(base)?
    })
}

/// The names at the top of the file of a structure of many masses, as serde lists them of what has none of them.
pub fn names_of_many() -> Vec<String> {
    let nameless = Table::from_iter([(String::new(), Value::Boolean(true))]);
    let refused = Described::deserialize(nameless).map(drop).map_or_else(|error| error.to_string(), |()| String::new());
    refused.split('`').skip(1).step_by(2).filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

/// The tables of the file of `structure`, from which [`of_table`] makes it again to the same bits.
pub fn table(structure: &Structure) -> anyhow::Result<Table> {
    let of_body = "the structure was made of a body and modes: make it of numbers that a file has";
    let description @ Description { many, ground, .. } = structure.description().context(of_body)?;
    let numbers = description.own_parameters().map(|(of, value)| (of.name.to_owned(), value.into()));
    let numbers = Table::from_iter(numbers);
    let mut table = match many {
        None => numbers,
        Some(many) => {
            let mut table = Table::try_from(many)?;
            let zeta = match &many.zeta {
                Damping::All(zeta) => Value::from(*zeta),
                Damping::Each(zetas) => zetas.clone().into(),
                Damping::Rayleigh { f, zeta } => {
                    Table::from_iter([("f".to_owned(), f.to_vec().into()), ("zeta".into(), (*zeta).into())]).into()
                }
            };
            table.insert("zeta".into(), zeta);
            table.insert("base".into(), numbers.into());
            table
        }
    };
    let has_content = |value: &Value| *value != Value::Boolean(false) && *value != Value::Array(Vec::new());
    if let Some(ground) = ground {
        let mut ground = Table::try_from(ground)?;
        ground.retain(|_, value| has_content(value));
        table.insert("ground".into(), ground.into());
    }
    table.retain(|_, value| has_content(value));
    Ok(table)
}

/// The file of `structure`, from which [`read`] makes it again to the same bits: each number with its unit and its range, and the numbers
/// that may take its place.
pub fn write(structure: &Structure) -> anyhow::Result<String> {
    let mut table = table(structure)?;
    let is_many = is_of_many(&table);
    let mut out =
        "# A structure, for rocking-fmu ... --parameters FILE.toml. SI units; # begins a comment.\n".to_owned();
    let [zeta, keep, p_delta] = ["zeta", "keep", "p_delta"].map(|key| table.remove(key));
    zeta.iter().try_for_each(|zeta| writeln!(out, "\nzeta = {zeta} # damping ratio in full contact"))?;
    keep.iter().try_for_each(|keep| writeln!(out, "keep = {keep} # modes that are kept"))?;
    p_delta.iter().try_for_each(|_| writeln!(out, "p_delta = true # the weights above soften each storey"))?;
    if let Some(Value::Array(K)) = table.remove("K") {
        let rows = K.iter().map(|row| format!("\n    {row},")).collect::<String>();
        writeln!(out, "# stiffness matrix, N/m\nK = [{rows}\n]")?;
    }
    out += if is_many {
        "\n[base]"
    } else {
        "# A line that begins with # may replace the line above it. You may leave out what has a default.\n"
    };
    structure.description().into_iter().try_for_each(|of| parameters_of(&mut out, of, structure.one()))?;
    let is_table = |value: &Value| value.is_table() || value.is_array();
    table.retain(|key, value| key != "base" && is_table(value));
    if !is_many && table.is_empty() {
        out += "\n# Without their #, these lines put the structure on ground that gives (Winkler springs), which needs J0 and no r.\n# [ground]\n\
                # f_v = 10 # frequency of the bounce on the ground, Hz: or k_v, the vertical stiffness, N/m\n\
                # zeta_v = 0.2 # damping ratio of the bounce\n# n_points = 2 # contact points from edge to edge\n";
    }
    if !table.is_empty() {
        out += &format!("\n{}", toml::to_string(&table)?);
    }
    Ok(out)
}

/// A line for each parameter of the description `of` a structure, with its unit, its range and what may be given in its place.
fn parameters_of(out: &mut String, of: &Description, one: Option<&OneMass>) -> anyhow::Result<()> {
    for (&Quantity { name, unit, description, min, max, get, .. }, value) in of.own_parameters() {
        let of = if unit == "1" { String::new() } else { format!(" {unit},") };
        let default = Some(get(&Parameters::DEFAULTS)).filter(|default| !default.is_nan());
        let default = default.map_or(String::new(), |default| format!(", default {}", short(default)));
        writeln!(out, "\n# {description},{of} {} to {}{default}\n{name} = {value:?}", short(min), short(max))?;
        for (one, natural) in one.iter().flat_map(|one| NATURAL.iter().map(move |natural| (one, natural))) {
            let &Natural { min, max, in_place_of, stands_for, .. } = natural;
            let &Derived { name: own, unit, description, value, .. } = natural.derived();
            if stands_for == name {
                let (value, [min, max]) = (shortest(value(one)), [min, max].map(short));
                writeln!(out, "# {own} = {value} # {description}, {unit}, {min} to {max}: instead of {in_place_of}")?;
            }
        }
    }
    Ok(())
}

/// `value` without the last rounding of what it was computed from, in as many digits as every decimal number keeps.
fn shortest(value: f64) -> f64 {
    format!("{value:.*e}", f64::DIGITS as usize - 1).parse().expect("a number in Rust's own notation")
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: &str = "[base]\nm0 = 20\nJ0 = 30.1\nwidth = 3\nk_d = 1e4\nF_y = 100\nxi_d = 1\n";
    const STOREYS: &str = "[[storeys]]\nm = 40.3\nh = 3.5\nk = 6e4\n[[storeys]]\nm = 30\nh = 7\nk = 4e4\n";
    const FLOORS: &str = "[[floors]]\nm = 4e4\nh = 3.5\n[[floors]]\nm = 3e4\nh = 7\n";
    const BED: &str = "[ground]\nk_v = 1e6\nn_points = 5\n";
    const POINTS: &str = "[ground]\nxi = [-1.5, 0, 1.5]\nk = [1e6, 1.1e6, 1e6]\nc = [0, 0, 0]\n";

    #[test]
    fn a_file_that_is_written_makes_the_same_structure_again() {
        let pier = "m = 401.3\nm0 = 65.4\nalpha_cg = 0.22\nB = 0.285\nJ0 = 10.7\nperiod_fc = 0.2\nzeta_fc = 0.02\n";
        let units = "units = \"kN, m, t\"\n";
        let kN = |rest: &str| format!("{units}{rest}");
        let files = [
            format!("{pier}r = 0.93\nP_0 = 1e3\n"),
            format!("{pier}[ground]\nf_v = 11.7\n"),
            format!("{pier}r = 0.9\n[ground]\nk_v = 1e7\nc_v = 1e4\nn_points = 5\nkr_ratio = 0.4\n"),
            kN(&format!("zeta = 0.02\np_delta = true\n{BASE}{STOREYS}")),
            kN(&format!("zeta = [0.01, 0.02]\nkeep = 1\n{BASE}r = 0.9\n{STOREYS}{BED}")),
            kN(&format!("zeta = {{ f = [2, 9], zeta = 0.05 }}\n{BASE}{STOREYS}{POINTS}")),
            format!("zeta = 0.02\nK = [[1e8, -4e7], [-4e7, 4e7]]\n{BASE}{FLOORS}"),
            format!("zeta = 0.02\n{BASE}{FLOORS}[[modes]]\nf = 4\nmass = 6.5e4\nheight = 5.4\nshape = [0.5, 1]\n"),
            format!(
                "zeta = 0.02\n{BASE}[total]\nm_s = 7e4\nS_1 = 3.5e5\nI_2 = 2e6\n[[modes]]\nperiod = 0.3\nmass = 6e4\nmoment = 3.1e5\n"
            ),
        ];
        for file in files {
            let structure = read(&file).unwrap_or_else(|error| panic!("{error:#}\n{file}"));
            let written = write(&structure).unwrap();
            assert!(of_table(table(&structure).unwrap(), None).unwrap() == structure, "{file}");
            let again = read(&written).unwrap_or_else(|error| panic!("{error:#}\n{written}"));
            assert!(again == structure && write(&again).unwrap() == written, "{file}\n{written}");
        }
    }
}
