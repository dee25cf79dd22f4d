//! Numbers that a structure may have, but that are usual in another unit.

use crate::digits::short;
use crate::series::taylor::LONGEST_SPAN;
use crate::structure::parameters::TIES;
use crate::{Base, Body, Quantity, Structure};
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

/// Steps for each second of a motion from which a run of a minute takes several seconds of computing.
const MANY_STEPS: f64 = 1e4;

/// Names of the numbers that are doubted. A sentence begins with its name.
pub fn all_doubted() -> impl Iterator<Item = &'static str> {
    ["r", "f_v", "m0", "f", "m_t", "zeta", "B"].into_iter().chain(TIES.iter().map(|of| of.name))
}

/// Damping ratio of the lowest mode that no structure exceeds without dampers.
const MOST_DAMPING: f64 = 0.2;

/// The name of the number that a `doubt` begins with.
pub fn doubted(doubt: &str) -> &str {
    doubt.split(" = ").next().unwrap_or(doubt)
}

impl Structure {
    /// A sentence for each number of which a run takes very many steps.
    pub(crate) fn many_steps(&self) -> Vec<String> {
        let (base, &Body { B, J0, .. }) = (self.base(), self.body());
        let (units, show) = (self.units(), |value: f64, unit: &str| self.units().show(value, unit));
        let (B, J0) = (short(B), show(J0, "kg.m2"));
        let of_ties = base.ties.about_pivot(base.B).map(|(tie, [spring, damper])| {
            let &Quantity { name, unit, get, .. } = TIES.iter().find(|of| of.name == tie).expect("it is one of them");
            let (rate, value) = ((spring / base.J_P).sqrt().max(damper / base.J_P), show(get(&base.ties), unit));
            (rate, format!("{name} = {value}"), format!("is {name} in {}?", units.name(unit)))
        });
        let (rate, named, remedy) = match self.foundation().zip(self.fastest_on_ground()) {
            Some((ground, rate)) => {
                let [f_v, zeta_v] = [ground.omega_v(base) / TAU, ground.zeta_v(base)].map(short);
                let named = format!("f_v = {f_v} Hz with zeta_v = {zeta_v} and J0 = {J0}");
                (rate, named, "lower f_v or zeta_v, or raise J0")
            }
            None => (self.fastest_rocking(), format!("B = {B} m with J0 = {J0}"), "raise B or J0, lower f or zeta"),
        };
        let costs = of_ties.into_iter().chain([(rate, named, remedy.into())]);
        let many = costs.map(|(rate, named, remedy)| (rate / LONGEST_SPAN, named, remedy));
        let many = many.filter(|(steps, ..)| *steps > MANY_STEPS).map(|(steps, named, remedy)| {
            format!("{named} takes some {steps:.0e} steps of computing for each second of a motion: {remedy}")
        });
        many.collect()
    }

    /// A sentence for each number that is usual in another unit or has no effect, before anything moves. It begins with the name of the number, whose
    /// units are those in which it was given.
    pub fn doubts(&self) -> Vec<String> {
        let (units, show) = (self.units(), |value: f64, unit: &str| self.units().show(value, unit));
        let (&Base { m_t, m0, g, B, tan_alpha_cg, ties, .. }, body) = (self.base(), self.body());
        let weight = m_t * g;
        let is_small = |(_, force): &(&str, f64)| (0.0..NEXT_TO_NOTHING * weight).contains(force) && *force > 0.0;
        let forces = TIES.iter().filter(|of| of.unit == "N").map(|of| (of.name, (of.get)(&ties)));
        let doubt = |(name, force)| {
            let ([force, weight], unit) = ([force, weight].map(|force| show(force, "N")), units.name("N"));
            format!(
                "{name} = {force} changes next to nothing under the weight of the structure, {weight}: is {name} in {unit}?"
            )
        };
        let unused = self.foundation().and(self.base().r).map(|r| {
            format!("r = {} is not used on ground that gives, where no impact needs it: leave r out", short(r))
        });
        let small = forces.filter(is_small).map(doubt);
        let mut doubts: Vec<_> = unused.into_iter().chain(small).chain(self.many_steps()).collect();
        if ties.xi_d > 2.0 * B {
            doubts.push(format!(
                "xi_d = {} m is more than the width of the base, {} m: is xi_d in m, not in mm?",
                short(ties.xi_d),
                short(2.0 * B)
            ));
        }
        if m0 > 0.0 && (m0 < ONE_UNIT[0] * body.m_s || body.m_s < ONE_UNIT[1] * m0) {
            let ([m0, m_s], unit) = ([m0, body.m_s].map(|m| show(m, "kg")), units.name("kg"));
            doubts.push(format!("m0 = {m0} of the foundation does not fit {m_s} above it: are both in {unit}?"));
        }
        // of mass that is spread evenly over the height
        let of_floors = self.floors().iter().map(|floor| floor.height).reduce(f64::max);
        let height = of_floors.unwrap_or(2.0 * body.S_1 / body.m_s);
        let Some((mode, f)) = self.lowest().map(|mode| (mode, mode.omega() / TAU)) else { return doubts };
        let usual = USUAL_SPEED / height;
        let (height, area) = (short(height), 2.0 * B * height);
        if (f / usual).max(usual / f) > UNUSUAL[usize::from(self.is_one_mass())] {
            doubts.push(format!(
                "f = {f:.2} Hz of the lowest mode is far from the usual frequency of a structure {height} m high, about {usual:.2} Hz: \
                 are masses in {}, heights in m, stiffnesses in {}, and f in Hz?",
                units.name("kg"),
                units.name("N/m")
            ));
        }
        if m_t < LIGHT * area {
            doubts.push(format!(
                "m_t = {} is little for a structure {} m wide and {height} m high: are masses in {}?",
                show(m_t, "kg"),
                short(2.0 * B),
                units.name("kg")
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
