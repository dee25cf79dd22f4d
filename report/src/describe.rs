//! A structure's parameters and what follows from them.

use crate::quantities::NamedValue;
use rocking::digits::{short, significant};
use rocking::run::validity;
use rocking::structure::any::{ModeOf, OF_FRAME, OF_MODE};
use rocking::structure::frame::Body;
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::quantity::Quantity;
use rocking::structure::{DERIVED, Derived};
use rocking::{Detail, Frame, Structure};
use std::fmt::{self, Write};

/// The parameters and the derived quantities, for people.
pub fn text(structure: &Structure) -> Result<String, fmt::Error> {
    let mut out = String::new();
    let unit = |unit| if unit == "1" { "-" } else { unit };
    writeln!(out, "Parameters")?;
    for Quantity { name, unit: of, description, get, .. } in &PARAMETERS {
        let value = short(get(structure.parameters()));
        writeln!(out, "  {name:<10} {value:>12} {:<6} {description}", unit(of))?;
    }
    writeln!(out, "\nDerived quantities")?;
    for Derived { name, unit: of, description, equation, value } in &DERIVED {
        let value = significant(value(structure));
        writeln!(out, "  {name:<10} {value:>12} {:<6} {equation:<13} {description}", unit(of))?;
    }
    Ok(out)
}

/// A structure of many masses, for people: its numbers, and a row for each mode.
pub fn frame(frame: &Frame) -> Result<String, fmt::Error> {
    let mut out = String::from("Structure of many masses\n");
    let unit = |unit| if unit == "1" { "-" } else { unit };
    for Derived { name, unit: of, description, value, .. } in &OF_FRAME {
        let value = value(frame);
        if value != 0.0 {
            writeln!(out, "  {name:<10} {:>12} {:<6} {description}", significant(value), unit(of))?;
        }
    }
    if frame.base().r.is_none() {
        writeln!(out, "  r is not given: momentum with the shape frozen gives it for each impact")?;
    }
    for warning in validity::of_frame(frame, Detail::Auto) {
        writeln!(out, "  {warning}")?;
    }
    let &Body { m_s, S_1, I_2, .. } = frame.body();
    let [mass, first, second] = frame.rest();
    let part = |rest: f64, whole: f64| format!("{:.2} %", 100.0 * (1.0 - rest / whole));
    let [mass, first, second] = [part(mass, m_s), part(first, S_1), part(second, I_2)];
    let modes = match (frame.modes().len(), frame.floors().len()) {
        (modes, floors) if floors > modes => format!("{modes} modes of {floors} floors"),
        (1, _) => "1 mode".to_owned(),
        (modes, _) => format!("{modes} modes"),
    };
    writeln!(
        out,
        "  carried by {modes}: {mass} of m_s, {first} of S_1, {second} of I_2; the rest turns rigidly with the base"
    )?;
    writeln!(out, "\nModes of vibration: f_u is the frequency while the structure rocks, share a part of m_s")?;
    write!(out, "  mode")?;
    for Derived { name, unit, .. } in &OF_MODE {
        let heading = if *unit == "1" { (*name).to_owned() } else { format!("{name} ({unit})") };
        write!(out, " {heading:>12}")?;
    }
    for (number, mode) in (1..).zip(frame.mode_table()) {
        write!(out, "\n  {number:<4}")?;
        OF_MODE.iter().try_for_each(|of| write!(out, " {:>12}", significant((of.value)(&mode))))?;
    }
    writeln!(out)?;
    Ok(out)
}

/// A structure of many masses, for programs: its numbers, and the numbers of each mode as `f[1]`.
pub fn numbers(frame: &Frame) -> Vec<NamedValue> {
    let own = OF_FRAME.iter().map(|&Derived { name, unit, description, value, .. }| {
        NamedValue::new(name, value(frame), unit, "", description)
    });
    let of_mode = |(number, mode): (usize, ModeOf)| {
        OF_MODE.iter().map(move |&Derived { name, unit, description, value, .. }| {
            NamedValue::new(&format!("{name}[{number}]"), value(&mode), unit, "", description)
        })
    };
    own.chain((1..).zip(frame.mode_table()).flat_map(of_mode)).collect()
}
