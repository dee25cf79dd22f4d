//! Units: what each is in SI, what hosts show it in, and magnitudes that are usual.

use fmi_unit::{DataType, Variable};
use model_description::Unit;
use rocking::structure::parameters::PARAMETERS;
use rocking::{State, Structure};

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
    let definition = |(name, base)| Unit { name, base: Some(base), display: shown_in(name, structure) };
    UNITS.map(definition).into()
}

/// The unit that hosts can show a unit in, and the factor of a value in that unit. The g of an acceleration is the structure's own,
/// as in a record.
fn shown_in(unit: &str, structure: &Structure) -> Option<(&'static str, f64)> {
    match unit {
        "rad" => Some(("deg", 1f64.to_degrees())),
        "m" => Some(("mm", 1e3)),
        "s" => Some(("ms", 1e3)),
        "m/s2" => Some(("g", 1.0 / structure.parameters().g)),
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

/// The magnitude that is usual for `variable`, of what moves: at the rotation α_cg, at which the structure is about to fall,
/// at u_cr, at which its base lifts off, and under the acceleration g tan α_cg, which lifts it statically (Eqs 2 to 4). To
/// three digits.
pub fn nominal(variable: &Variable, structure: &Structure) -> Option<f64> {
    let parameters = structure.parameters();
    let usual = State::usual(structure);
    let (m, height, alpha) = (parameters.m, parameters.H, usual.theta);
    let acceleration = parameters.g * structure.tan_alpha_cg;
    let name = ["_max", "_0"].iter().find_map(|ending| variable.name.strip_suffix(ending)).unwrap_or(&variable.name);
    let magnitude = match name {
        "theta" => Some(alpha),
        "theta_dot" | "der(theta)" => Some(usual.theta_dot),
        "u" => Some(usual.u),
        "u_dot" | "der(u)" => Some(usual.u_dot),
        "uplift" => Some(2.0 * parameters.B * alpha.sin()),
        "delta_t" => Some(height * alpha.sin()),
        "v_t" => Some(height * usual.theta_dot),
        "a_g" | "a_ground" | "a_v" | "a_v_ground" | "a_t" | "der(u_dot)" => Some(acceleration),
        "der(theta_dot)" => Some(structure.p_l * usual.theta_dot),
        "F_t" | "V_t" | "R_h" => Some(m * acceleration),
        "M_t" | "R_m" => Some(m * height * acceleration),
        "R_v" | "P_t" | "F_d1" | "F_d2" => Some((m + parameters.m0) * parameters.g),
        _ => None, // impulses add up over a motion
    };
    magnitude.map(|magnitude| format!("{magnitude:.2e}").parse().expect("a number in Rust's own notation"))
}
