//! Named values for people and for programs: columns of text, or CSV.
use crate::significant::significant;
use serde::Serialize;
use std::io::{self, Write, stdout};

/// One value.
#[derive(Serialize)]
pub struct Line {
    /// Its symbol.
    pub name: String,
    /// The value.
    pub value: f64,
    /// Its unit; `1` for a ratio.
    pub unit: &'static str,
    /// Where the paper defines it.
    pub equation: &'static str,
    /// What it is.
    pub description: String,
}

impl Line {
    /// A value of a fixed name.
    pub fn new(name: &str, value: f64, unit: &'static str, equation: &'static str, description: &str) -> Line {
        Line { name: name.into(), value, unit, equation, description: description.into() }
    }
}

/// Prints `lines` in columns; accelerations also in multiples of `g` (m/s²).
pub fn print_columns(out: &mut impl Write, lines: &[Line], g: f64) -> io::Result<()> {
    for Line { name, value, unit, equation, description } in lines {
        let in_g = if *unit == "m/s2" { format!("{:.4} g", value / g) } else { String::new() };
        let unit = if *unit == "1" { "-" } else { unit };
        let value = significant(*value);
        writeln!(out, "  {name:<20} {value:>12} {unit:<6} {in_g:>10}  {equation:<13} {description}")?;
    }
    Ok(())
}

/// Prints `lines` as CSV; a number reads back to the same bits.
pub fn print_csv(lines: impl IntoIterator<Item = Line>) -> anyhow::Result<()> {
    let mut writer = csv::Writer::from_writer(stdout().lock());
    for line in lines {
        writer.serialize(line)?;
    }
    Ok(writer.flush()?)
}
