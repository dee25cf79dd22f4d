//! Numbers that a structure may have, but that are usual in another unit.

use crate::digits::{short, with_unit};
use crate::{Base, Mode, Structure, Ties};
use std::f64::consts::TAU;

/// Frequency times height of buildings, m/s: the mean of 163 (Ellis 1980, not read; as quoted by others).
const USUAL_SPEED: f64 = 46.0;

/// Ratio to that frequency from which a unit is in doubt. A unit of mass or stiffness wrong by 1000 makes 32, heights in cm make 100.
const UNUSUAL: f64 = 10.0;

/// A force below this fraction of the weight changes next to nothing. Forces in kN are below it.
const NEXT_TO_NOTHING: f64 = 1e-3;

impl Structure {
    /// A sentence for each number that is usual in another unit, before anything moves.
    pub fn doubts(&self) -> Vec<String> {
        if self.one().is_some() { of_base(self.base()) } else { of_many(self) }
    }
}

/// The doubts about the forces of tendon and dissipators.
fn of_base(&Base { m_t, g, ties: Ties { P_0, F_y, .. }, .. }: &Base) -> Vec<String> {
    let weight = m_t * g;
    let is_small = |(_, force): &(&str, f64)| (0.0..NEXT_TO_NOTHING * weight).contains(force) && *force > 0.0;
    let doubt = |(name, force)| {
        let [force, weight] = [force, weight].map(|force| with_unit(force, "N"));
        format!(
            "{name} = {force} changes next to nothing under the weight of the structure, {weight}: is {name} in N, not in kN?"
        )
    };
    [("P_0", P_0), ("F_y", F_y)].into_iter().filter(is_small).map(doubt).collect()
}

/// The doubts about a structure of many masses.
fn of_many(frame: &Structure) -> Vec<String> {
    let body = frame.body();
    // of mass that is spread evenly over the height
    let height = frame.floors().iter().map(|floor| floor.height).reduce(f64::max).unwrap_or(2.0 * body.S_1 / body.m_s);
    let lowest = frame.modes().iter().map(Mode::omega).reduce(f64::min);
    let usual = USUAL_SPEED / height;
    let f = lowest.map_or(usual, |omega| omega / TAU); // none of a rigid structure
    let mut doubts = of_base(frame.base());
    if (f / usual).max(usual / f) > UNUSUAL {
        doubts.push(format!(
            "f = {f:.2} Hz of the lowest mode is far from the usual frequency of a structure {} m high, about {usual:.2} Hz: \
             are masses in kg, heights in m, stiffnesses in N/m, and f in Hz?",
            short(height)
        ));
    }
    doubts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::description::{Damping, Storey};
    use crate::structure::natural_quantities::Given;
    use crate::{OneMass, Parameters};

    #[test]
    fn a_force_in_kilonewtons_is_doubted() {
        let Parameters { m, m0, g, .. } = Parameters::MCMANUS;
        let weight = (m + m0) * g;
        let doubts = |[P_0, F_y]: [f64; 2]| {
            let structure = OneMass::new(Parameters { P_0, F_y, k_d: 1e3 * F_y, ..Parameters::MCMANUS }).unwrap();
            Structure::from(structure).doubts()
        };
        assert!(doubts([0.0; 2]).is_empty() && doubts([0.5 * weight, 0.01 * weight]).is_empty());
        let doubts = doubts([0.5e-3 * weight, 0.01e-3 * weight]);
        let [P_0, weight] = [0.5e-3 * weight, weight].map(short);
        let expected = format!(
            "P_0 = {P_0} N changes next to nothing under the weight of the structure, {weight} N: is P_0 in N, not in kN?"
        );
        assert!(doubts[0] == expected && doubts[1].starts_with("F_y = ") && doubts.len() == 2, "{doubts:?}");
    }

    #[test]
    fn storeys_in_another_unit_are_doubted() {
        let doubts = |[of_m, of_h, of_k]: [f64; 3]| {
            let mut base = Given::default();
            for (name, value) in [("m0", 2e4), ("J0", 3e4), ("B", 1.5 * of_h)] {
                base.give(name, value).unwrap();
            }
            let storey = |m, h, k| Storey { m: of_m * m, h: of_h * h, k: of_k * k };
            let storeys = [storey(4e4, 3.5, 6e7), storey(3e4, 7.0, 4e7)];
            Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap().doubts().len()
        };
        let [usual, tonnes, centimetres, per_mm] =
            [[1.0; 3], [1e-3, 1.0, 1.0], [1.0, 100.0, 1.0], [1.0, 1.0, 1e-3]].map(doubts);
        assert_eq!([usual, tonnes, centimetres, per_mm], [0, 1, 1, 1]);
    }
}
