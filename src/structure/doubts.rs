//! Numbers that a structure may have, but that are usual in another unit.

use crate::digits::{short, with_unit};
use crate::{Base, Structure, Ties};
use std::f64::consts::TAU;

/// Frequency times height of buildings, m/s: the mean of 163 (Ellis 1980, not read; as quoted by others).
const USUAL_SPEED: f64 = 46.0;

/// Ratio to that frequency from which a unit is in doubt: of buildings, and of one mass, which many a soft pier or model carries. A unit
/// of mass or stiffness wrong by 1000 makes 32, heights in cm make 100, a period in ms makes 1000.
const UNUSUAL: [f64; 2] = [10.0, 30.0];

/// A force below this fraction of the weight changes next to nothing. Forces in kN are below it.
const NEXT_TO_NOTHING: f64 = 1e-3;

/// Mass over width and height from which on kg are no tonnes, kg/m². The paper's bridge pier, a light model, has 186. A building has
/// some 7,000 and a pier 10,000 to 20,000, so the limit doubts tonnes up to 50,000.
const LIGHT: f64 = 50.0;

/// Least ratio of the foundation's mass to the mass above, and of the mass above to the foundation's, if both are in one unit.
const ONE_UNIT: [f64; 2] = [1e-3, 1e-2];

/// Names of the numbers that are doubted. A sentence begins with its name.
pub const DOUBTED: [&str; 8] = ["P_0", "F_y", "xi_d", "m0", "f", "m_t", "zeta", "B"];

/// Damping ratio of the lowest mode that no structure exceeds without dampers.
const MOST_DAMPING: f64 = 0.2;

/// The name of the number that a `doubt` begins with, one of [`DOUBTED`].
pub fn doubted(doubt: &str) -> &str {
    doubt.split(" = ").next().unwrap_or(doubt)
}

impl Structure {
    /// A sentence for each number that is usual in another unit, before anything moves. It begins with the name of the number, whose
    /// units are those in which it was given.
    pub fn doubts(&self) -> Vec<String> {
        self.doubts_in_si().into_iter().map(|doubt| self.units().message(doubt)).collect()
    }

    fn doubts_in_si(&self) -> Vec<String> {
        let (&Base { m_t, m0, g, B, tan_alpha_cg, ties: Ties { P_0, xi_d, F_y, .. }, .. }, body) =
            (self.base(), self.body());
        let weight = m_t * g;
        let is_small = |(_, force): &(&str, f64)| (0.0..NEXT_TO_NOTHING * weight).contains(force) && *force > 0.0;
        let doubt = |(name, force)| {
            let [force, weight] = [force, weight].map(|force| with_unit(force, "N"));
            format!(
                "{name} = {force} changes next to nothing under the weight of the structure, {weight}: is {name} in N?"
            )
        };
        let mut doubts: Vec<_> = [("P_0", P_0), ("F_y", F_y)].into_iter().filter(is_small).map(doubt).collect();
        if xi_d > 2.0 * B {
            doubts.push(format!(
                "xi_d = {} m is more than the width of the base, {} m: is xi_d in m, not in mm?",
                short(xi_d),
                short(2.0 * B)
            ));
        }
        if m0 > 0.0 && (m0 < ONE_UNIT[0] * body.m_s || body.m_s < ONE_UNIT[1] * m0) {
            let [m0, m_s] = [m0, body.m_s].map(short);
            doubts.push(format!("m0 = {m0} kg of the foundation does not fit {m_s} kg above it: are both in kg?"));
        }
        // of mass that is spread evenly over the height
        let of_floors = self.floors().iter().map(|floor| floor.height).reduce(f64::max);
        let height = of_floors.unwrap_or(2.0 * body.S_1 / body.m_s);
        let Some((mode, f)) = self.lowest().map(|mode| (mode, mode.omega() / TAU)) else { return doubts };
        let usual = USUAL_SPEED / height;
        let (height, area) = (short(height), 2.0 * B * height);
        if (f / usual).max(usual / f) > UNUSUAL[usize::from(self.one().is_some())] {
            doubts.push(format!(
                "f = {f:.2} Hz of the lowest mode is far from the usual frequency of a structure {height} m high, about {usual:.2} Hz: \
                 are masses in kg, heights in m, stiffnesses in N/m, and f in Hz?"
            ));
        }
        if m_t < LIGHT * area {
            doubts.push(format!(
                "m_t = {} kg is little for a structure {} m wide and {height} m high: are masses in kg?",
                short(m_t),
                short(2.0 * B)
            ));
        }
        let zeta = mode.zeta();
        if zeta > MOST_DAMPING {
            doubts.push(format!("zeta = {} of the lowest mode is large: is it a fraction, not per cent?", short(zeta)));
        }
        if tan_alpha_cg > 1.0 {
            doubts.push(format!(
                "B = {} m is more than the height of the centre of gravity: is B half of the base's width, and are B and heights in m?",
                short(B)
            ));
        }
        doubts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::description::{Damping, Storey};
    use crate::structure::natural_quantities::Given;
    use crate::structure::quantity::Units;
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
            "P_0 = {P_0} N changes next to nothing under the weight of the structure, {weight} N: is P_0 in N?"
        );
        assert!(doubts[0] == expected && doubts[1].starts_with("F_y = ") && doubts.len() == 2, "{doubts:?}");
    }

    #[test]
    fn storeys_in_another_unit_are_doubted() {
        let doubts = |[of_m, of_h, of_k]: [f64; 3]| {
            let base = Given::of(&[("m0", 2e4), ("J0", 3e4), ("B", 1.5 * of_h)]).unwrap();
            let storey = |m, h, k| Storey { m: of_m * m, h: of_h * h, k: of_k * k };
            let storeys = [storey(4e4, 3.5, 6e7), storey(3e4, 7.0, 4e7)];
            Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap().doubts().len()
        };
        let units = [[1.0; 3], [1e-3, 1.0, 1.0], [1e-3, 1.0, 1e-3], [1.0, 100.0, 1.0], [1.0, 1.0, 1e-3]];
        assert_eq!(units.map(doubts), [0, 3, 2, 2, 1]);
    }

    #[test]
    fn one_mass_in_another_unit_is_doubted() {
        let doubts = |change: fn(&mut Parameters)| {
            let mut parameters = Parameters { m: 1e5, m0: 5e4, H: 8.0, B: 1.5, f_fc: 2.0, ..Parameters::MCMANUS };
            change(&mut parameters);
            Structure::new(parameters).unwrap().doubts()
        };
        assert!(doubts(|_| ()).is_empty());
        type Change = fn(&mut Parameters);
        let changes: [(Change, &str); 9] = [
            (|of| (of.m, of.m0) = (100.0, 50.0), "m_t = 150 kg is little"),
            (|of| (of.m, of.m0, of.H, of.B) = (970.0, 480.0, 12.0, 3.2), "m_t = 1450 kg is little"),
            (|of| of.m0 = 50.0, "m0 = 50 kg of the foundation does not fit 100000 kg above it: are both"),
            (|of| of.m = 100.0, "m0 = 50000 kg of the foundation does not fit 100 kg above it: are both"),
            (|of| of.xi_d = 320.0, "xi_d = 320 m is more than the width of the base, 3 m: is xi_d in m"),
            (|of| of.f_fc = 400_f64.recip(), "f = 0.00 Hz of the lowest mode is far"),
            (|of| (of.H, of.B) = (8e3, 1.5e3), "f = 2.00 Hz of the lowest mode is far"),
            (|of| of.zeta_fc = 0.5, "zeta = 0.5 of the lowest mode is large"),
            (|of| of.B = 15.0, "B = 15 m is more than the height"),
        ];
        for (change, expected) in changes {
            assert!(doubts(change)[0].starts_with(expected), "{:?}", doubts(change));
            assert!(doubts(change).iter().all(|doubt| DOUBTED.contains(&doubted(doubt))));
        }
        let light = Structure::new(Parameters { m: 100.0, m0: 50.0, H: 8.0, B: 1.5, f_fc: 2.0, ..Parameters::MCMANUS })
            .unwrap();
        let expected = "m_t = 0.15 t is little for a structure 3 m wide and 8 m high: are masses in t?";
        assert!(light.measured_in(Units::Kilonewtons).doubts().contains(&expected.into()));
    }
}
