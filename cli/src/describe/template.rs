//! A structure as a commented file of parameters.
use rocking::digits::short;
use rocking::structure::derived::Derived;
use rocking::structure::natural_quantities::{NATURAL, Natural};
use rocking::structure::parameters::PARAMETERS;
use rocking::{OneMass, Quantity};
use std::fmt::{self, Write};

/// Writes `structure` as a TOML file: every parameter with its unit and range, and what may be given in its place.
pub fn write(out: &mut impl Write, structure: &OneMass) -> fmt::Result {
    writeln!(out, "# A structure, for rocking-fmu ... --parameters FILE.toml. SI units; # begins a comment.")?;
    writeln!(
        out,
        "# A line that begins with # may replace the line above it. You may leave out J0 (default 0), c_ratio (1), g (9.81 m/s2),"
    )?;
    writeln!(out, "# and the numbers of tendon and dissipators (0).")?;
    for &Quantity { name, unit, description, min, max, get, .. } in &PARAMETERS {
        let of = if unit == "1" { String::new() } else { format!(" {unit},") };
        writeln!(out, "\n# {description},{of} {} to {}", short(min), short(max))?;
        writeln!(out, "{name} = {}", shortest(get(structure.parameters())))?;
        for natural in NATURAL.iter().filter(|natural| natural.stands_for == name) {
            let &Natural { min, max, in_place_of, .. } = natural;
            let &Derived { name, unit, description, value, .. } = natural.derived();
            let value = shortest(value(structure));
            writeln!(
                out,
                "# {name} = {value} # {description}, {unit}, {} to {}: instead of {in_place_of}",
                short(min),
                short(max)
            )?;
        }
    }
    Ok(())
}

/// `value` without the last rounding of what it was computed from, in as many digits as every decimal number keeps.
fn shortest(value: f64) -> f64 {
    format!("{value:.*e}", f64::DIGITS as usize - 1).parse().expect("a number in Rust's own notation")
}
