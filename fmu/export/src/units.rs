//! Units that hosts show, and magnitudes that are usual.

use fmi_unit::{DataType, Variable};
use rocking::structure::parameters::PARAMETERS;
use rocking::{Base, Body, Modes, Output, Structure};

/// Units, what hosts can show in the place of each, and the factor of a value then. The g of an acceleration is the structure's own, as in
/// a record.
pub fn display_units(structure: &Structure) -> Vec<(&'static str, &'static str, f64)> {
    let g = 1.0 / structure.base().g;
    let angle = ("rad", "deg", 1f64.to_degrees());
    vec![angle, ("m", "mm", 1e3), ("s", "ms", 1e3), ("m/s2", "g", g), ("N", "kN", 1e-3), ("N.m", "kN.m", 1e-3)]
}

/// The unit that `variable` is shown in, if that is another than its own. The structure's own parameters are in SI, as in its file, and
/// instants in seconds: they are looked up in a record.
pub fn display_unit(variable: &Variable, structure: &Structure) -> Option<&'static str> {
    let DataType::Real { unit, .. } = variable.data_type else { return None };
    let is_parameter = PARAMETERS.iter().any(|parameter| parameter.name == variable.name);
    let shown = display_units(structure).into_iter().find(|(of, ..)| *of == unit).map(|(_, shown, _)| shown);
    shown.filter(|_| unit != "s" && !is_parameter)
}

/// The magnitude that is usual for `variable` in a motion, to three digits: under the acceleration g tan α_cg, which lifts the base off
/// statically without a tendon (Eqs 2 to 4), and at the [usual magnitudes](Structure::usual) of the state.
pub fn nominal(variable: &Variable, structure: &Structure) -> Option<f64> {
    let (&Base { m_t, g, tan_alpha_cg, .. }, &Body { m_s, S_1, .. }) = (structure.base(), structure.body());
    let (usual, a_g, (name, number)) =
        (structure.usual::<Modes>(), g * tan_alpha_cg, symbol_and_number(&variable.name));
    let number = number.unwrap_or(0);
    let magnitude = match ["_max", "_0"].iter().find_map(|ending| name.strip_suffix(ending)).unwrap_or(&name) {
        "q" => Some(usual.u.numbers()[number]),
        "q_dot" | "der(q)" => Some(usual.u_dot.numbers()[number]),
        "der(theta)" => Some(usual.theta_dot),
        "der(theta_dot)" => Some(structure.base().p_l * usual.theta_dot),
        "a_g" | "a_ground" | "a_v" | "a_v_ground" | "der(u_dot)" => Some(a_g),
        "F_t" | "R_h" => Some(m_s * a_g),
        "R_m" => Some(S_1 * a_g),
        "R_v" | "P_t" | "F_d1" | "F_d2" => Some(m_t * g),
        symbol => {
            let symbol = if symbol == "der(u)" { "u_dot" } else { symbol };
            let mut all = Output::all(structure).into_iter().filter(|of| of.symbol() == symbol);
            all.nth(number)?.usual(structure) // impulses add up over a motion
        }
    };
    magnitude.map(|magnitude| format!("{magnitude:.2e}").parse().expect("a number in Rust's own notation"))
}

/// A name without the number of a floor, storey or mode, and the number from 0.
fn symbol_and_number(name: &str) -> (String, Option<usize>) {
    let Some((symbol, rest)) = name.split_once('[') else { return (name.to_owned(), None) };
    let Some((number, ending)) = rest.split_once(']') else { return (name.to_owned(), None) };
    (format!("{symbol}{ending}"), number.parse::<usize>().ok().and_then(|number| number.checked_sub(1)))
}
