//! Units that hosts show, and magnitudes that are usual.

use fmi_unit::{DataType, Variable};
use rocking::structure::parameters::PARAMETERS;
use rocking::{Base, Body, Modes, Structure, Ties};

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

/// The magnitude that is usual for `variable` in a motion, to three digits.
///
/// The structure is about to fall at the rotation α_cg. Its base lifts off at u_cr, and statically under the acceleration
/// g tan α_cg without a tendon (Eqs 2 to 4).
pub fn nominal(variable: &Variable, structure: &Structure) -> Option<f64> {
    let &Base { m_t, B, g, p_l, tan_alpha_cg, ties: Ties { P_0, .. }, .. } = structure.base();
    let acceleration = g * tan_alpha_cg;
    let &Body { m_s: m, S_1, .. } = structure.body();
    let (height, lowest, lifting) = (S_1 / m, structure.vibration().contact, acceleration + P_0 * B / S_1);
    let (u, u_dot) = (lifting / (lowest * lowest), lifting / lowest);
    let (alpha, name) = (tan_alpha_cg.atan(), &*variable.name);
    let (name, number) = symbol_and_number(name);
    let coordinates = || number.map(|number| (number, structure.usual::<Modes>()));
    let name = ["_max", "_0"].iter().find_map(|ending| name.strip_suffix(ending)).unwrap_or(&name);
    let magnitude = match name {
        "theta" => Some(alpha),
        "theta_dot" | "der(theta)" => Some(p_l * alpha),
        "q" => coordinates().map(|(j, usual)| usual.u.numbers()[j]),
        "q_dot" | "der(q)" => coordinates().map(|(j, usual)| usual.u_dot.numbers()[j]),
        "u" | "drift" => Some(u),
        "u_dot" | "der(u)" => Some(u_dot),
        "uplift" => Some(2.0 * B * alpha.sin()),
        "delta_t" => Some(height * alpha.sin()),
        "v_t" => Some(height * p_l * alpha),
        "a_g" | "a_ground" | "a_v" | "a_v_ground" | "a_t" | "der(u_dot)" => Some(acceleration),
        "der(theta_dot)" => Some(p_l * p_l * alpha),
        "F_t" | "V_t" | "V" | "R_h" => Some(m * acceleration),
        "M_t" | "M" | "R_m" => Some(m * height * acceleration),
        "R_v" | "P_t" | "F_d1" | "F_d2" => Some(m_t * g),
        _ => None, // impulses add up over a motion
    };
    magnitude.map(|magnitude| format!("{magnitude:.2e}").parse().expect("a number in Rust's own notation"))
}

/// A name without the number of a floor, storey or mode, and the number from 0.
fn symbol_and_number(name: &str) -> (String, Option<usize>) {
    let Some((symbol, rest)) = name.split_once('[') else { return (name.to_owned(), None) };
    let Some((number, ending)) = rest.split_once(']') else { return (name.to_owned(), None) };
    (format!("{symbol}{ending}"), number.parse::<usize>().ok().and_then(|number| number.checked_sub(1)))
}
