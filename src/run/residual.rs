//! What is left at the end of a run on ground that slips and yields: the way of the base, and the rest on the settled ground.

use crate::engine::motion::Motion;
use crate::mechanics::lateral::Coordinates;
use crate::structure::ground::Foundation;
use crate::{Output, Structure};

/// A number of the end of a run.
#[derive(Debug)]
#[allow(missing_docs)]
pub struct Residual {
    pub name: &'static str,
    pub unit: &'static str,
    pub description: &'static str,
    is_of: fn(&Foundation) -> bool,
    value: ResidualValue,
}

/// How a number follows from the end of a run.
#[derive(Debug)]
enum ResidualValue {
    /// An output that adds up.
    Output(Output),
    /// x, m.
    Way,
    /// Of y (m) and sin θ at rest on the settled ground.
    AtRest(fn(&Foundation, [f64; 2]) -> f64),
}

const SLIDES: fn(&Foundation) -> bool = |of| of.mu_c.is_some();
const YIELDS: fn(&Foundation) -> bool = |of| of.yields;

const fn residual(
    [name, unit, description]: [&'static str; 3],
    is_of: fn(&Foundation) -> bool,
    value: ResidualValue,
) -> Residual {
    Residual { name, unit, description, is_of, value }
}

const fn of_output(of: Output, is_of: fn(&Foundation) -> bool) -> Residual {
    residual([of.symbol(), of.unit(), of.text()], is_of, ResidualValue::Output(of))
}

/// The numbers, in the order in which they are shown.
pub const RESIDUALS: [Residual; 8] = [
    residual(["x_end", "m", "way of the base at the end"], SLIDES, ResidualValue::Way),
    of_output(Output::slip_path, SLIDES),
    of_output(Output::E_friction, SLIDES),
    residual(
        ["theta_res", "rad", "rotation at rest on the settled ground"],
        YIELDS,
        ResidualValue::AtRest(|_, [_, sin]| libm::asin(sin)),
    ),
    residual(
        ["settlement_res", "m", "settlement at rest of the lower outer point"],
        YIELDS,
        ResidualValue::AtRest(|ground, [y, sin]| {
            let outer = [0, ground.points.len() - 1].map(|i| y - ground.points[i].xi * sin);
            -outer[0].min(outer[1])
        }),
    ),
    of_output(Output::tilt, YIELDS),
    of_output(Output::settled, YIELDS),
    of_output(Output::E_plastic, YIELDS),
];

impl Residual {
    /// The numbers that a run of `structure` leaves.
    pub fn all(structure: &Structure) -> impl Iterator<Item = &'static Residual> {
        let foundation = structure.foundation().cloned();
        RESIDUALS.iter().filter(move |of| foundation.as_ref().is_some_and(of.is_of))
    }

    /// Its value after `motion` of `structure`. The rest of a structure that has overturned, or falls over without inertia from where it is,
    /// is infinite.
    pub fn of<Q: Coordinates>(&self, structure: &Structure, motion: &Motion<Q>) -> f64 {
        let Some(ground) = Q::foundation(structure) else { return f64::NAN };
        match self.value {
            ResidualValue::Output(of) => of.added_up(structure, motion.kept()).unwrap_or(f64::NAN),
            ResidualValue::Way => motion.state.u.slide(ground).unwrap_or(f64::NAN),
            ResidualValue::AtRest(value) => {
                let now = Some(libm::sin(motion.state.theta)).filter(|_| !motion.phase.properties().is_over);
                let rest = now.and_then(|now| ground.at_rest(structure, now, &|i| motion.settled.as_ref()[i]));
                rest.map_or(f64::INFINITY, |rest| value(ground, rest))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ground, Parameters};

    /// A bed of 11 points, rounded by much rocking: the middle carries most of the weight.
    #[test]
    fn a_structure_comes_to_rest_on_a_bed_that_rocking_has_rounded() {
        let parameters = Parameters { m: 450e3, m0: 150e3, J0: 5e5, H: 9.0, B: 3.0, f_fc: 1.5, ..Parameters::MCMANUS };
        let ground = Ground { f_v: Some(9.0), n_points: Some(11.0), fs: Some(4.0), ..Ground::default() };
        let structure = Structure::new(parameters).unwrap().on(&ground).unwrap();
        let under = structure.foundation().unwrap();
        let place = |i: usize| under.points[i].xi / 3.0;
        let s = |i: usize| -20.0 * under.y_s * place(i).powi(4) * (1.0 + 0.2 * place(i));
        let [y, sin] = under.at_rest(&structure, 0.0, &s).unwrap();
        let force =
            |i: usize| (under.points[i].k * (under.points[i].xi * sin - y - s(i))).clamp(0.0, under.points[i].q);
        let weight = 600e3 * parameters.g;
        assert!(((0..11).map(force).sum::<f64>() / weight - 1.0).abs() < 1e-12);
        let moment = (0..11).map(|i| under.points[i].xi * force(i)).sum::<f64>();
        let tan = sin / (1.0 - sin * sin).sqrt();
        let omega_fc = std::f64::consts::TAU * parameters.f_fc;
        let leans = 450e3 * parameters.g * (9.0 * tan + parameters.g / omega_fc.powi(2) * sin);
        assert!((moment - leans).abs() < 1e-12 * weight * 3.0 && sin > 1e-5, "{y} {sin}");
        let ground = Ground { n_points: Some(3.0), ..ground };
        let structure = Structure::new(parameters).unwrap().on(&ground).unwrap();
        let under = structure.foundation().unwrap();
        let rounded = |i: usize| if i == 1 { 0.0 } else { 0.02 };
        let rests = [1e-3, -1e-3].map(|now| under.at_rest(&structure, now, &rounded).unwrap());
        assert!(rests[0][1] > 1e-3 && rests[1] == [rests[0][0], -rests[0][1]], "{rests:?}");
    }
}
