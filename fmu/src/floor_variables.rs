//! The variables of modes and floors, and the derivatives of all states.

use crate::source::{Source, VariableRow};
use fmi_unit::variables::Text;
use fmi_unit::{Causality, Variable};
use rocking::Structure;
use rocking::mechanics::outputs::ACCELERATION;
use rocking::mechanics::state::COMPONENTS;
use rocking::structure::derived::OF_MODE;
use rocking::structure::description::Description;
use std::collections::HashSet;

/// The names among the `knowns` that a structure has for `of`, a name of one mass. On ground that gives y moves like a mode.
pub(crate) fn all_of(of: &str, knowns: &HashSet<Text>) -> Vec<Text> {
    let named: &[&str] = match of {
        "u" => &["q", "y"],
        "u_dot" => &["q_dot", "y_dot"],
        "H" => &["h"],
        "f_fc" => &["k"],
        "zeta_fc" => &["zeta"],
        "f_v" => &["f_v", "k_v", "zeta_v", "c_v", "kr_ratio", "k_r"],
        of => &[of],
    };
    let is_meant = |name: &str| name == of || name.split('[').next().is_some_and(|symbol| named.contains(&symbol));
    knowns.iter().filter(|name| is_meant(name)).cloned().collect()
}

/// Number of lateral coordinates that are states: of the modes, and on ground that gives y.
pub(crate) fn lateral_states(frame: &Structure) -> usize {
    frame.modes().len() + usize::from(frame.foundation().is_some())
}

/// The place in [`COMPONENTS`] of what the state at a place is, its number from 1, and whether it is y of ground that gives.
fn kind(structure: &Structure, place: usize) -> (usize, usize, bool) {
    let n = lateral_states(structure);
    let kind = if place < 2 * n { place / n } else { place - 2 * n + 2 };
    (kind, place % n + 1, kind < 2 && place % n == structure.modes().len())
}

/// The name of the state at a place.
fn name(structure: &Structure, place: usize) -> String {
    match kind(structure, place) {
        (kind, _, true) => ["y", "y_dot"][kind].to_owned(),
        (kind @ 0..2, number, _) if !structure.is_one_mass() => format!("{}[{number}]", ["q", "q_dot"][kind]),
        (kind, ..) => COMPONENTS[kind].to_owned(),
    }
}

/// The states that are no outputs: the coordinates of the modes of many masses, and y on ground that gives.
pub(crate) fn coordinates(frame: &Structure) -> Vec<VariableRow> {
    let is_one = frame.is_one_mass();
    let coordinate = |place: usize| {
        let (unit, description) = match kind(frame, place) {
            (0, _, true) => ("m", "height of the middle of the base above the unloaded ground".into()),
            (_, _, true) => ("m/s", "velocity of the middle of the base".into()),
            (0, mode, _) => ("m", format!("coordinate of mode {mode}, scaled to a modal mass of 1 kg")),
            (_, mode, _) => ("m/s", format!("velocity of mode {mode}")),
        };
        let from = match kind(frame, place) {
            (.., true) => None,
            (kind, ..) => Some(["u_0", "u_dot_0"][kind]),
        };
        let variable = Variable::real(Causality::Local, name(frame, place), unit, description).from(from);
        (variable.state(), Source::Coordinate(place))
    };
    (0..2 * lateral_states(frame)).filter(|place| !is_one || kind(frame, *place).2).map(coordinate).collect()
}

/// The derivatives of all states.
pub(crate) fn state_rates(structure: &Structure) -> Vec<VariableRow> {
    let (n, is_one) = (lateral_states(structure), structure.is_one_mass());
    let rate = |place: usize| {
        let (unit, is_velocity) =
            [("m/s", true), ("m/s2", false), ("rad/s", true), ("rad/s2", false)][kind(structure, place).0];
        let of = if is_velocity { &[][..] } else { ACCELERATION };
        let own = is_velocity.then(|| name(structure, if place < n { place + n } else { place + 1 }));
        let (name, by) = (name(structure, place), ", by the equations of the level of detail");
        let description = format!("rate of {name}{}", if is_one && is_velocity { "" } else { by });
        let variable = Variable::real(Causality::Local, format!("der({name})"), unit, description);
        (variable.from(of.iter().copied()).from(own).rate_of(name), Source::StateRate(place))
    };
    (0..2 * n + 2).map(rate).collect()
}

/// The numbers of the base, the modes and the floors that follow from those that the host sets, and their values.
pub(crate) fn numbers(structure: &Structure) -> Vec<(Variable, f64)> {
    let calculated = |name: String, unit, description: String, value| {
        (Variable::real(Causality::CalculatedParameter, name, unit, description), value)
    };
    let number = |([name, unit, description], value): ([&'static str; 3], f64)| {
        calculated(name.into(), unit, description.into(), value)
    };
    let of_modes = OF_MODE.iter().flat_map(|of| {
        (1..).zip(structure.mode_table()).map(move |(j, mode)| {
            calculated(format!("{}[{j}]", of.name), of.unit, format!("mode {j}: {}", of.description), (of.value)(&mode))
        })
    });
    let of_floors = (1..).zip(structure.floors()).flat_map(|(i, floor): (usize, _)| {
        [
            calculated(format!("m[{i}]"), "kg", format!("mass of floor {i}"), floor.mass),
            calculated(format!("h[{i}]"), "m", format!("height of floor {i} above the base"), floor.height),
        ]
    });
    let of_many = of_modes.chain(of_floors).filter(|_| !structure.is_one_mass());
    let given = structure.description().map_or(Vec::new(), Description::numbers);
    let all = structure.derived().map(number).chain(of_many);
    all.filter(|(variable, _)| given.iter().all(|of| of.name != variable.name)).collect()
}
