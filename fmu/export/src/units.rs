//! Units that hosts show, and magnitudes that are usual.

use FlexibleRocking::source::Source;
use fmi_unit::{DataType, Variable};
use rocking::mechanics::shown::{Reader, UNITS};
use rocking::structure::parameters::PARAMETERS;
use rocking::{Base, Body, Modes, Output, Structure};

/// Units, what hosts can show in the place of each, and the factor of a value then. The g of an acceleration is the structure's own, as in
/// a record.
pub fn display_units(structure: &Structure) -> Vec<(&'static str, &'static str, f64)> {
    let shown = UNITS.iter().filter(|(.., reader)| matches!(reader, Reader::All | Reader::Hosts));
    shown.map(|(name, of, size, _)| (*of, *name, 1.0 / size.unwrap_or(structure.base().g))).collect()
}

/// The unit that `variable` is shown in, if that is another than its own. The structure's own parameters are in SI, as in its file, and
/// instants in seconds: they are looked up in a record.
pub fn display_unit(variable: &Variable, structure: &Structure) -> Option<&'static str> {
    let DataType::Real { unit, .. } = variable.data_type else { return None };
    let is_parameter = PARAMETERS.iter().any(|parameter| parameter.name == variable.name);
    let shown = display_units(structure).into_iter().find(|(of, ..)| *of == unit).map(|(_, shown, _)| shown);
    shown.filter(|_| unit != "s" && !is_parameter)
}

/// The magnitude that is usual for `variable` from `source` in a motion, to three digits: under the acceleration g tan α_cg, which lifts the
/// base off statically without a tendon (Eqs 2 to 4), and at the [usual magnitudes](Structure::usual) of the state. Impulses have none: they
/// add up over a motion.
pub fn nominal(variable: &Variable, source: Source, structure: &Structure) -> Option<f64> {
    let (&Base { m_t, g, p_l, tan_alpha_cg, .. }, &Body { m_s, S_1, .. }) = (structure.base(), structure.body());
    let (usual, a_g) = (structure.usual::<Modes>(), g * tan_alpha_cg);
    let (name, number) = symbol_and_number(&variable.name);
    let settled = structure.foundation().map_or(f64::NAN, |ground| ground.y_s.abs());
    let magnitude = match source {
        _ if matches!(&*name, "y" | "x" | "x_max" | "s" | "settled") => settled,
        _ if matches!(&*name, "y_dot" | "x_dot" | "der(y)" | "der(x)") => (g * settled).sqrt(),
        Source::Output(of) | Source::Peak(of) => of.usual(structure)?,
        Source::InitialValue(which, floor) => {
            [Output::theta, Output::theta_dot, Output::u(floor), Output::u_dot(floor)][which].usual(structure)?
        }
        Source::Restraint(_) => m_t * g,
        _ => match &*name {
            "q" => usual.u.numbers()[number],
            "q_dot" | "der(q)" => usual.u_dot.numbers()[number],
            "der(u)" => Output::u_dot(0).usual(structure)?,
            "der(theta)" => usual.theta_dot,
            "der(theta_dot)" => p_l * usual.theta_dot,
            "a_g" | "a_ground" | "a_v" | "a_v_ground" | "der(u_dot)" => a_g,
            "F_t" | "R_h" => m_s * a_g,
            "R_m" => S_1 * a_g,
            "R_v" => m_t * g,
            _ => return None,
        },
    };
    Some(format!("{magnitude:.2e}").parse().expect("a number in Rust's own notation"))
}

/// A name without the number of a floor or mode, and the number from 0.
fn symbol_and_number(name: &str) -> (String, usize) {
    let numbered = name.split_once('[').and_then(|(symbol, rest)| Some((symbol, rest.split_once(']')?)));
    let Some((symbol, (number, ending))) = numbered else { return (name.to_owned(), 0) };
    (format!("{symbol}{ending}"), number.parse::<usize>().map_or(0, |number| number - 1))
}
