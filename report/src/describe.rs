//! A structure's parameters and what follows from them.

use crate::quantities::NamedValue;
use anyhow::ensure;
use rocking::Body;
use rocking::digits::{short, significant, with_unit};
use rocking::estimates::restoring::{FlagPoint, flag};
use rocking::run::validity;
use rocking::structure::derived::{DERIVED, Derived, OF_MODE};
use rocking::structure::description::Description;
use rocking::{Detail, Structure};
use std::f64::consts::FRAC_PI_2;
use std::fmt::{self, Write};

pub fn given(structure: &Structure) -> Vec<NamedValue> {
    let given =
        structure.description().filter(|of| of.many.is_none()).into_iter().flat_map(Description::own_parameters);
    given.map(|(of, value)| NamedValue::new(of.name, value, of.unit, "", of.description)).collect()
}

/// The derived quantities of one mass; the numbers of a structure of many masses.
pub fn derived(structure: &Structure) -> Vec<NamedValue> {
    let equation = |name: &str| DERIVED.iter().find(|of| structure.is_one_mass() && of.name == name);
    let number = |([name, unit, description], value): ([&'static str; 3], f64)| {
        NamedValue::new(name, value, unit, equation(name).map_or("", |of| of.equation), description)
    };
    let given = given(structure);
    let is_given = |name: &str| given.iter().any(|of| of.name == name);
    let of_any = || structure.derived().filter(|([name, ..], _)| !is_given(name)).map(number).collect();
    structure.one().map_or_else(of_any, |one| named(&DERIVED, one))
}

/// The numbers of each mode of a structure of many masses, lowest frequency first.
pub fn modes(structure: &Structure) -> Vec<Vec<NamedValue>> {
    let modes = [structure].into_iter().filter(|of| !of.is_one_mass()).flat_map(Structure::mode_table);
    modes.map(|mode| named(&OF_MODE, &mode)).collect()
}

/// Steps of each way of [`restoring`].
const STEPS: u32 = 20;

/// The moment that turns the base back, while it is turned slowly to the rotation `theta` (rad, 0 to π/2) and back.
pub fn restoring(structure: &Structure, theta: f64) -> anyhow::Result<Vec<FlagPoint>> {
    let is_in_range = theta > 0.0 && theta < FRAC_PI_2;
    ensure!(is_in_range, "restoring = {theta} rad is out of range: a rotation above 0 and below pi/2 is needed");
    Ok(flag(structure, theta, STEPS)?)
}

fn named<'a, T: 'a>(all: impl IntoIterator<Item = &'a Derived<T>>, of: &T) -> Vec<NamedValue> {
    let all = all.into_iter();
    all.map(|line| NamedValue::new(line.name, (line.value)(of), line.unit, line.equation, line.description)).collect()
}

/// All numbers of a structure, for programs; the numbers of each mode as `f[1]`.
pub fn numbers(structure: &Structure) -> Vec<NamedValue> {
    let of_mode = |(number, mode): (usize, Vec<NamedValue>)| {
        mode.into_iter().map(move |of| NamedValue { name: format!("{}[{number}]", of.name), ..of })
    };
    let modes = (1..).zip(modes(structure)).flat_map(of_mode);
    given(structure).into_iter().chain(derived(structure)).chain(modes).collect()
}

/// A number of things by their name in the singular.
fn counted((name, count): (&str, usize)) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

/// The parameters of one mass in one line; how many floors and modes many masses have.
pub fn in_one_line(structure: &Structure) -> String {
    if !structure.is_one_mass() {
        let [floors, modes] = [("floor", structure.floors().len()), ("mode", structure.modes().len())].map(counted);
        return format!("{floors}, {modes}");
    }
    let value = |of: &NamedValue| format!("{} = {}", of.name, with_unit(of.value, of.unit));
    given(structure).iter().map(value).collect::<Vec<_>>().join(", ")
}

/// The structure, for people: parameters and derived quantities of one mass; of many masses their numbers, and a row for each mode.
pub fn text(structure: &Structure) -> Result<String, fmt::Error> {
    let mut out = String::new();
    let unit = |unit| if unit == "1" { "-" } else { unit };
    let derived = derived(structure);
    if !structure.is_one_mass() {
        let masses = if structure.floors().len() == 1 { "one mass" } else { "many masses" };
        let ground = if structure.foundation().is_some() { " on ground that gives" } else { "" };
        writeln!(out, "Structure of {masses}{ground}")?;
        for NamedValue { name, value, unit: of, description, .. } in derived.iter().filter(|of| of.value != 0.0) {
            writeln!(out, "  {name:<10} {:>12} {:<6} {description}", significant(*value), unit(of))?;
        }
        print_modes(&mut out, structure, &modes(structure))?;
        return Ok(out);
    }
    writeln!(out, "Parameters")?;
    for NamedValue { name, value, unit: of, description, .. } in given(structure) {
        writeln!(out, "  {name:<10} {:>12} {:<6} {description}", short(value), unit(of))?;
    }
    print_rule_of_impact(&mut out, structure)?;
    writeln!(out, "\nDerived quantities")?;
    for NamedValue { name, value, unit: of, equation, description } in derived {
        writeln!(out, "  {name:<10} {:>12} {:<6} {equation:<13} {description}", significant(value), unit(of))?;
    }
    Ok(out)
}

fn print_rule_of_impact(out: &mut String, structure: &Structure) -> fmt::Result {
    if structure.base().r.is_none() && structure.foundation().is_none() {
        writeln!(out, "  r is not given: momentum with the shape frozen gives it for each impact")?;
    }
    Ok(())
}

fn print_modes(out: &mut String, frame: &Structure, table: &[Vec<NamedValue>]) -> fmt::Result {
    print_rule_of_impact(out, frame)?;
    for warning in validity::of_structure(frame, Detail::Auto) {
        writeln!(out, "  {warning}")?;
    }
    let &Body { m_s, S_1, I_2, .. } = frame.body();
    let [mass, first, second] = frame.rest();
    let part = |rest: f64, whole: f64| format!("{:.2} %", 100.0 * (1.0 - rest / whole));
    let [mass, first, second] = [part(mass, m_s), part(first, S_1), part(second, I_2)];
    let modes = match (frame.modes().len(), frame.floors().len()) {
        (modes, floors) if floors > modes => format!("{} of {floors} floors", counted(("mode", modes))),
        (modes, _) => counted(("mode", modes)),
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
    for (number, mode) in (1..).zip(table) {
        write!(out, "\n  {number:<4}")?;
        mode.iter().try_for_each(|of| write!(out, " {:>12}", significant(of.value)))?;
    }
    writeln!(out)
}
