//! The file of a structure, in TOML: read and written.

use anyhow::Context;
use rocking::digits::short;
use rocking::structure::derived::Derived;
use rocking::structure::description::{Damping, Described, Description, ManyMasses};
use rocking::structure::natural_quantities::{NATURAL, Natural, Numbers};
use rocking::structure::parameters::{OF_ONE_MASS, PARAMETERS, Parameters};
use rocking::{OneMass, Quantity, Structure};
use serde::Serialize;
use std::fmt::Write;
use toml::{Table, Value};

/// The structure that the TOML `text` describes, of many masses if there are tables of them. An error names the line and the key.
pub fn read(text: &str) -> anyhow::Result<Structure> {
    let keys: Table = toml::from_str(text)?;
    if ["base", "storeys", "floors", "modes"].iter().any(|key| keys.contains_key(*key)) {
        return Ok(toml::from_str::<Described>(text)?.structure()?);
    }
    Ok(toml::from_str::<Numbers>(text)?.structure(None)?)
}

/// The file of `structure`, from which [`read`] makes it again to the same bits: each number with its unit and its range, and the numbers
/// that may take its place.
pub fn write(structure: &Structure) -> anyhow::Result<String> {
    let of_body = "the structure was made of a body and modes: make it of numbers that a file has";
    let Description { parameters, many, ground } = structure.description().context(of_body)?;
    let mut out =
        "# A structure, for rocking-fmu ... --parameters FILE.toml. SI units; # begins a comment.\n".to_owned();
    if let Some(ManyMasses { zeta, p_delta, keep, K, .. }) = many {
        let zeta = match zeta {
            Damping::All(zeta) => format!("{zeta:?}"),
            Damping::Each(zetas) => format!("{zetas:?}"),
            Damping::Rayleigh { f, zeta } => format!("{{ f = {f:?}, zeta = {zeta:?} }}"),
        };
        writeln!(out, "\nzeta = {zeta} # damping ratio in full contact")?;
        keep.iter().try_for_each(|keep| writeln!(out, "keep = {keep} # modes that are kept"))?;
        Some("p_delta = true # the weights above soften each storey\n")
            .filter(|_| *p_delta)
            .iter()
            .for_each(|line| out += line);
        if !K.is_empty() {
            let rows = K.iter().map(|row| format!("\n    {row:?},")).collect::<String>();
            writeln!(out, "# stiffness matrix, N/m\nK = [{rows}\n]")?;
        }
        out += "\n[base]";
    } else {
        out += "# A line that begins with # may replace the line above it. You may leave out what has a default.\n";
    }
    parameters_of(&mut out, parameters, structure.one(), many.is_some())?;
    match ground {
        Some(ground) => out += &tables("ground", ground)?,
        None if many.is_none() => {
            out += "\n# Without their #, these lines put the structure on ground that gives (Winkler springs), which needs J0 and no r.\n# [ground]\n\
                    # f_v = 10 # frequency of the bounce on the ground, Hz: or k_v, the vertical stiffness, N/m\n\
                    # zeta_v = 0.2 # damping ratio of the bounce\n# n_points = 2 # contact points from edge to edge\n";
        }
        None => (),
    }
    if let Some(ManyMasses { storeys, floors, modes, total, .. }) = many {
        total.iter().try_for_each(|total| anyhow::Ok(out += &tables("total", total)?))?;
        out += &[tables("storeys", storeys)?, tables("floors", floors)?, tables("modes", modes)?].concat();
    }
    Ok(out)
}

/// A line for each parameter that `parameters` have, with its unit, its range and what may be given in its place.
fn parameters_of(
    out: &mut String,
    parameters: &Parameters,
    one: Option<&OneMass>,
    is_base: bool,
) -> anyhow::Result<()> {
    for &Quantity { name, unit, description, min, max, get, .. } in PARAMETERS {
        let value = get(parameters);
        if value.is_nan() || is_base && OF_ONE_MASS.contains(&name) {
            continue;
        }
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

/// The TOML of the table, or of the tables, called `name`, without empty lists.
fn tables(name: &str, of: impl Serialize) -> anyhow::Result<String> {
    let mut value = Value::try_from(of)?;
    let has_content = |value: &Value| value.as_array().is_none_or(|list| !list.is_empty());
    value.as_table_mut().into_iter().for_each(|table| table.retain(|_, value| has_content(value)));
    let named = Table::from_iter([(name.to_owned(), value)]);
    Ok(if has_content(&named[name]) { format!("\n{}", toml::to_string(&named)?) } else { String::new() })
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
            let again = read(&written).unwrap_or_else(|error| panic!("{error:#}\n{written}"));
            assert!(again == structure && write(&again).unwrap() == written, "{file}\n{written}");
        }
    }
}
