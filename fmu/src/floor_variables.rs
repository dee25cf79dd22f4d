//! The variables of many masses: of each floor, storey and mode; the others are those of one mass.

use crate::variables::{ACCELERATION, Row, Source};
use fmi_unit::variables::Text;
use fmi_unit::{Causality, Variable};
use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::structure::derived::{OF_MODE, OF_STRUCTURE};
use rocking::{Output, Structure};
use std::collections::HashSet;

/// The rows of `frame`, made with the rows of `one_mass`.
pub(crate) fn rows(frame: &Structure, one_mass: impl Iterator<Item = Row>) -> Vec<Row> {
    let (inputs, others): (Vec<_>, Vec<_>) = one_mass.partition(|(_, source)| matches!(source, Source::Input(_)));
    let is_peak = |(_, source): &Row| matches!(source, Source::Peak(_) | Source::PeakInstant(_));
    let (peaks, others): (Vec<_>, Vec<_>) = others.into_iter().partition(is_peak);
    let rows: Vec<_> = loads(frame, &inputs)
        .into_iter()
        .chain(Output::all(frame).into_iter().filter(|of| *of != Output::y).map(|of| output(of, frame)))
        .chain(states(frame))
        .chain(peaks)
        .chain(numbers(frame))
        .chain(others.into_iter().filter(is_of_many))
        .collect();
    // one mass has the names u, u_dot and F_t, and parameters where many masses have fixed numbers
    let names: HashSet<Text> = rows.iter().map(|(variable, _)| variable.name.clone()).collect();
    let (modes, floors) = (frame.modes().len(), frame.floors().len());
    let known = |name: &Text| -> Vec<Text> {
        let all = |of: &str, count| Vec::from_iter((1..=count).map(|at| Text::from(format!("{of}[{at}]"))));
        match &**name {
            // on ground that gives all accelerations depend on y
            "u" => all("q", modes).into_iter().chain(names.get("y").cloned()).collect(),
            "u_dot" => all("q_dot", modes).into_iter().chain(names.get("y_dot").cloned()).collect(),
            "F_t" => all("F_t", floors),
            _ => names.get(name).cloned().into_iter().collect(),
        }
    };
    let adapt = |(variable, source): Row| {
        let depends_on = variable.depends_on.iter().flat_map(known).collect();
        (Variable { depends_on, ..variable }, source)
    };
    rows.into_iter().map(adapt).collect()
}

/// Whether many masses have the row of one mass, too.
fn is_of_many((variable, source): &Row) -> bool {
    match source {
        Source::InitialValue(_) => variable.name.starts_with("theta"),
        Source::Output(_) | Source::StateRate(_) | Source::Parameter(_) | Source::Derived(_) => false,
        _ => true,
    }
}

/// a_g and a_v, and a force on each floor, from the `inputs` of one mass.
fn loads(frame: &Structure, inputs: &[Row]) -> Vec<Row> {
    let load = |which: usize| inputs[which].0.clone();
    let force = |floor: usize| {
        let description = format!("external horizontal force on floor {}, positive to the right", floor + 1);
        let name = format!("{}[{}]", LOADS[1].name, floor + 1).into();
        Variable { name, description: description.into(), ..load(1) }
    };
    let all = [load(0), load(VERTICAL)].into_iter().chain((0..frame.floors().len()).map(force));
    all.enumerate().map(|(which, variable)| (variable, Source::Input(which))).collect()
}

fn output(of: Output, frame: &Structure) -> Row {
    let depends_on: &[&'static str] = match of {
        Output::theta => &["theta_0"],
        Output::theta_dot => &["theta_dot_0"],
        Output::uplift => &["theta", "y"],
        Output::V_t | Output::M_t => ACCELERATION,
        Output::a_t(_) | Output::V(_) | Output::M(_) => ACCELERATION,
        Output::u(_) | Output::drift(_) | Output::drift_ratio(_) => &["u"],
        Output::u_dot(_) => &["u_dot"],
        Output::delta_t(_) => &["u", "theta"],
        Output::v_t(_) => &["u", "u_dot", "theta", "theta_dot"],
        Output::y | Output::P_t | Output::settlement | Output::settled(_) | Output::lifted(_) => &["y", "theta"],
        Output::N_left | Output::N_right | Output::N(_) | Output::pressure => &["y", "y_dot", "theta", "theta_dot"],
        _ => &[],
    };
    let is_local = matches!(of, Output::theta_dot | Output::u_dot(_));
    let causality = if is_local { Causality::Local } else { Causality::Output };
    let variable =
        Variable::real(causality, of.name(frame), of.unit(), of.description()).from(depends_on.iter().copied());
    let is_state = matches!(of, Output::theta | Output::theta_dot);
    (if is_state { variable.state() } else { variable }, Source::Output(of))
}

/// Number of lateral coordinates that are states: of the modes, and on ground that gives y.
pub(crate) fn lateral_states(frame: &Structure) -> usize {
    frame.modes().len() + usize::from(frame.foundation().is_some())
}

/// The coordinates of the modes, and the derivatives of all states.
fn states(frame: &Structure) -> Vec<Row> {
    let n = lateral_states(frame);
    let is_y = |place: usize| place % n == frame.modes().len() && place < 2 * n;
    let name = |place: usize| match place {
        place if is_y(place) => ["y", "y_dot"][place / n].to_owned(),
        place if place < n => format!("q[{}]", place + 1),
        place if place < 2 * n => format!("q_dot[{}]", place - n + 1),
        place => ["theta", "theta_dot"][place - 2 * n].to_owned(),
    };
    let coordinate = |place: usize| {
        let (unit, description) = if is_y(place) {
            let of_base =
                ["height of the middle of the base above the unloaded ground", "velocity of the middle of the base"];
            (["m", "m/s"][place / n], of_base[place / n].into())
        } else if place < n {
            ("m", format!("coordinate of mode {}, scaled to a modal mass of 1 kg", place + 1))
        } else {
            ("m/s", format!("velocity of mode {}", place - n + 1))
        };
        (Variable::real(Causality::Local, name(place), unit, description).state(), Source::Coordinate(place))
    };
    let rate = |place: usize| {
        let (unit, of): (_, &[&'static str]) = match place {
            place if place < n => ("m/s", &[]),
            place if place < 2 * n => ("m/s2", ACCELERATION),
            place if place == 2 * n => ("rad/s", &["theta_dot"]),
            _ => ("rad/s2", ACCELERATION),
        };
        let own = (place < n).then(|| name(place + n));
        let name = name(place);
        let description = format!("rate of {name}, by the equations of the level of detail");
        let variable = Variable::real(Causality::Local, format!("der({name})"), unit, description);
        (variable.from(of.iter().copied()).from(own).rate_of(name), Source::StateRate(place))
    };
    (0..2 * n).map(coordinate).chain((0..2 * n + 2).map(rate)).collect()
}

/// Fixed numbers of the base, the modes and the floors.
fn numbers(frame: &Structure) -> Vec<Row> {
    let known = |name: String, unit, description: String, value| {
        (Variable::real(Causality::CalculatedParameter, name, unit, description), Source::Known(value))
    };
    let of_base =
        OF_STRUCTURE.iter().map(|of| known(of.name.into(), of.unit, of.description.into(), (of.value)(frame)));
    let of_modes = OF_MODE.iter().flat_map(|of| {
        (1..).zip(frame.mode_table()).map(move |(j, mode)| {
            known(format!("{}[{j}]", of.name), of.unit, format!("mode {j}: {}", of.description), (of.value)(&mode))
        })
    });
    let of_floors = (1..).zip(frame.floors()).flat_map(|(i, floor): (usize, _)| {
        [
            known(format!("m[{i}]"), "kg", format!("mass of floor {i}"), floor.mass),
            known(format!("h[{i}]"), "m", format!("height of floor {i} above the base"), floor.height),
        ]
    });
    of_base.chain(of_modes).chain(of_floors).collect()
}
