//! Units: what each is in SI, what hosts show it in, and magnitudes that are usual.

use fmi_unit::{DataType, Variable};
use model_description::Unit;
use rocking::structure::parameters::PARAMETERS;
use rocking::{Base, Body, Modes, Structure, Ties};

/// The units of the variables, as exponents of kg, m, s, rad.
pub const UNITS: [(&str, [i32; 4]); 17] = [
    ("kg", [1, 0, 0, 0]),
    ("m", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("Hz", [0, 0, -1, 0]),
    ("rad", [0, 0, 0, 1]),
    ("rad/s", [0, 0, -1, 1]),
    ("rad/s2", [0, 0, -2, 1]),
    ("m/s", [0, 1, -1, 0]),
    ("m/s2", [0, 1, -2, 0]),
    ("N", [1, 1, -2, 0]),
    ("N/m", [1, 0, -2, 0]),
    ("N.s/m", [1, 0, -1, 0]),
    ("N.m", [1, 2, -2, 0]),
    ("J", [1, 2, -2, 0]),
    ("N.s", [1, 1, -1, 0]),
    ("N.m.s", [1, 2, -1, 0]),
    ("kg.m2", [1, 2, 0, 0]),
];

/// Definitions of the units; the display unit g is that of `structure`.
pub fn definitions(structure: &Structure) -> Vec<Unit> {
    let of_many = structure.one().is_none().then_some(("kg.m", [1, 1, 0, 0]));
    let definition = |(name, base)| Unit { name, base: Some(base), display: shown_in(name, structure) };
    UNITS.into_iter().chain(of_many).map(definition).collect()
}

/// The unit that hosts can show a unit in, and the factor of a value in that unit. The g of an acceleration is the structure's own,
/// as in a record.
fn shown_in(unit: &str, structure: &Structure) -> Option<(&'static str, f64)> {
    match unit {
        "rad" => Some(("deg", 1f64.to_degrees())),
        "m" => Some(("mm", 1e3)),
        "s" => Some(("ms", 1e3)),
        "m/s2" => Some(("g", 1.0 / structure.base().g)),
        "N" => Some(("kN", 1e-3)),
        "N.m" => Some(("kN.m", 1e-3)),
        _ => None,
    }
}

/// The unit that `variable` is shown in, if that is another than its own. The structure's own parameters are in SI, as in its file, and
/// instants in seconds: they are looked up in a record.
pub fn display_unit(variable: &Variable, structure: &Structure) -> Option<&'static str> {
    let DataType::Real { unit, .. } = variable.data_type else { return None };
    let is_parameter = PARAMETERS.iter().any(|parameter| parameter.name == variable.name);
    let shown = shown_in(unit, structure).map(|(name, _)| name);
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
