//! The variables of modes and floors, and the derivatives of all states.

use crate::source::{Source, VariableRow};
use fmi_unit::variables::Text;
use fmi_unit::{Causality, Variable};
use rocking::mechanics::outputs::{ACCELERATION, CONTACT};
use rocking::mechanics::state::COMPONENTS;
use rocking::structure::derived::OF_MODE;
use rocking::structure::description::Description;
use rocking::{Output, Structure};
use std::collections::HashSet;

/// The names among the `knowns` that a structure has for `of`, a name of one mass. On ground that gives y moves like a mode.
pub(crate) fn all_of(of: &str, knowns: &HashSet<Text>) -> Vec<Text> {
    let named: &[&str] = match of {
        "u" => &["q", "y"],
        "u_dot" => &["q_dot", "y_dot"],
        "H" => &["h"],
        "f_fc" => &["k"],
        "zeta_fc" => &["zeta"],
        "f_v" => &["f_v", "k_v", "zeta_v", "c_v", "kr_ratio", "k_r", "mu_c", "fs"],
        of => &[of],
    };
    let is_meant = |name: &str| name == of || name.split('[').next().is_some_and(|symbol| named.contains(&symbol));
    knowns.iter().filter(|name| is_meant(name)).cloned().collect()
}

/// Number of lateral coordinates that are states: of the modes, and on ground that gives y, and x of a base that may slide.
pub(crate) fn lateral_states(frame: &Structure) -> usize {
    let of_ground = frame.foundation().map_or(0, |ground| 1 + usize::from(ground.mu_c.is_some()));
    frame.modes().len() + of_ground
}

/// Number of the settlements for good, which are states without a velocity.
pub(crate) fn settlements(frame: &Structure) -> usize {
    frame.foundation().filter(|ground| ground.yields).map_or(0, |ground| ground.points.len())
}

/// The place in [`COMPONENTS`] of what the state at a place is, after them settlements, and its number from 0.
fn kind(structure: &Structure, place: usize) -> (usize, usize) {
    let n = lateral_states(structure);
    match place.checked_sub(2 * n) {
        None => (place / n, place % n),
        Some(turn @ 0..2) => (2 + turn, 0),
        Some(after) => (4, after - 2),
    }
}

/// The output that the state at a place is, of those of ground that gives, or the velocity of y.
fn of_ground(structure: &Structure, place: usize) -> Option<Result<Output, [&'static str; 3]>> {
    let modes = structure.modes().len();
    Some(match kind(structure, place) {
        (0, n) if n == modes => Ok(Output::y),
        (1, n) if n == modes => Err(["y_dot", "m/s", "velocity of the middle of the base"]),
        (0, n) if n > modes => Ok(Output::x),
        (1, n) if n > modes => Ok(Output::x_dot),
        (4, point) => Ok(Output::s(point)),
        _ => return None,
    })
}

/// The name of the state at a place.
fn name(structure: &Structure, place: usize) -> String {
    match (of_ground(structure, place), kind(structure, place)) {
        (Some(Ok(of)), _) => of.name(structure),
        (Some(Err([name, ..])), _) => name.to_owned(),
        (_, (kind @ 0..2, mode)) if !structure.is_one_mass() => format!("{}[{}]", ["q", "q_dot"][kind], mode + 1),
        (_, (kind, _)) => COMPONENTS[kind].to_owned(),
    }
}

/// The states beside u and θ of one mass: the coordinates of the modes of many masses, and those of ground that gives. All but y are shown
/// as outputs.
pub(crate) fn coordinates(frame: &Structure) -> Vec<VariableRow> {
    const START: [&str; 10] = ["theta_0", "theta_dot_0", "m", "m0", "g", "B", "P_0", "k_t", "f_v", "fs"];
    let coordinate = |place: usize| {
        let real = |causality, unit, description: String| {
            Variable::real(causality, name(frame, place), unit, description).state()
        };
        let variable = match (of_ground(frame, place), kind(frame, place)) {
            (Some(Ok(of)), (kind, _)) => {
                let is_output = of != Output::y;
                let causality = if is_output { Causality::Output } else { Causality::Local };
                let start = if is_output && kind < 2 { &[][..] } else { &START };
                real(causality, of.unit(), of.description(frame)).from(start.iter().copied())
            }
            (Some(Err([_, unit, description])), _) => real(Causality::Local, unit, description.into()).from(START),
            (None, (kind @ 0..2, mode)) if !frame.is_one_mass() => {
                let description = match kind {
                    0 => format!("coordinate of mode {}, scaled to a modal mass of 1 kg", mode + 1),
                    _ => format!("velocity of mode {}", mode + 1),
                };
                real(Causality::Local, ["m", "m/s"][kind], description).from([["u_0", "u_dot_0"][kind]])
            }
            _ => return None,
        };
        Some((variable, Source::Coordinate(place)))
    };
    (0..2 * lateral_states(frame) + 2 + settlements(frame)).filter_map(coordinate).collect()
}

pub(crate) fn state_rates(structure: &Structure) -> Vec<VariableRow> {
    let (n, is_one) = (lateral_states(structure), structure.is_one_mass());
    let rate = |place: usize| {
        let (unit, of): (_, &[&str]) =
            [("m/s", &[][..]), ("m/s2", ACCELERATION), ("rad/s", &[]), ("rad/s2", ACCELERATION), ("m/s", CONTACT)]
                [kind(structure, place).0];
        let is_velocity = of.is_empty();
        let own = is_velocity.then(|| name(structure, if place < n { place + n } else { place + 1 }));
        let (name, by) = (name(structure, place), ", by the equations of the level of detail");
        let description = format!("rate of {name}{}", if is_one && is_velocity { "" } else { by });
        let variable = Variable::real(Causality::Local, format!("der({name})"), unit, description);
        (variable.from(of.iter().copied()).from(own).rate_of(name), Source::StateRate(place))
    };
    (0..2 * n + 2 + settlements(structure)).map(rate).collect()
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
