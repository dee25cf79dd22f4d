//! How far outputs reach: bounds of their magnitudes, which spare most pieces of a motion the search for peaks.

use crate::mechanics::arc::Arc;
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::{Coordinates, Mosts};
use crate::mechanics::load::Load;
use crate::mechanics::outputs::Search;
use crate::numbers::Turn;
use crate::numbers::most::Most;
use crate::series::extremes::off_chord;
use crate::series::taylor::{ORDERS, ZERO, evaluate};
use crate::structure::gauge::Reach;
use crate::structure::ground::{NONE_SETTLED, Settlements};
use crate::structure::mode::Modes;
use crate::{Base, Foundation, Gauge, Output, Phase, PressedPoints, Ramp, Side, State, Structure};

/// Bounds of the magnitudes of a motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Magnitudes<'a, Q> {
    /// The motion over a polynomial, the ground acceleration and how far points have settled, if an output depends on the ground
    /// acceleration, or on ground that gives.
    pub arc: Option<(&'a Arc<Q>, Ramp, &'a Settlements)>,
    /// Part of the viscous damping in full contact.
    pub damping: f64,
    pub u: Q,
    pub u_dot: Q,
    pub theta: f64,
    pub theta_dot: f64,
    pub a_g: f64,
    pub F_t: Q,
    /// With ÿ on ground that gives, if an output depends on ÿ.
    pub a_v: f64,
}

/// Bounds of the magnitudes between two instants with these `loads`, given bounds of the state.
#[inline(always)]
pub(crate) fn magnitudes<Q: Coordinates>(
    structure: &Structure,
    phase: Phase,
    loads: &[Load<Q>; 2],
    State { u, u_dot, theta, theta_dot }: State<Q>,
) -> Magnitudes<'static, Q> {
    let ([first, last], largest) = (loads, |a: f64, b: f64| a.abs().max(b.abs()));
    Magnitudes {
        arc: None,
        damping: structure.base().damping(phase),
        u,
        u_dot,
        theta,
        theta_dot,
        a_g: largest(first.a_g, last.a_g),
        F_t: match loads.iter().all(|load| load.F_t.is_within(&Q::ZERO)) {
            true => Q::ZERO, // with no numbers to weigh
            false => Q::each(structure, |j, _| largest(first.F_t.of(j), last.F_t.of(j))),
        },
        a_v: largest(first.a_v, last.a_v),
    }
}

/// How far a motion leaves the chords between its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OffChord<Q> {
    u: Q,
    u_dot: Q,
    /// Of sin θ, cos θ and 1 − cos θ.
    turn: f64,
    /// Of a number times cos θ: beyond the number itself, as a part of its largest magnitude. A product of two chords leaves its own
    /// chord by at most a quarter of the product of their rises.
    product: f64,
}

impl<Q: Coordinates> OffChord<Q> {
    /// Of a motion in which u, u̇ and θ (rad) leave their chords by this much, and θ goes from one of these angles to the other.
    pub(crate) fn new(u: Q, u_dot: Q, theta: f64, [from, to]: [f64; 2]) -> OffChord<Q> {
        let (turned, most) = ((to - from).abs(), from.abs().max(to.abs()) + theta);
        let turn = theta + turned * turned / 8.0;
        OffChord { u, u_dot, turn, product: turn + most * turned / 2.0 }
    }

    /// Of the motion of `arc`, whose rotations at the ends are `thetas` (rad).
    pub(crate) fn of(arc: &Arc<Q>, thetas: [f64; 2]) -> OffChord<Q> {
        let [u, u_dot] = [&arc.u, &arc.u_dot].map(|of| Q::off_chord(arc.used(of), arc.reach));
        OffChord::new(u, u_dot, off_chord(arc.used(&arc.theta), arc.reach), thetas)
    }
}

impl<Q: Coordinates> Magnitudes<'_, Q> {
    /// The motion of `structure` in bounds of its magnitudes. θ̈ has no bound.
    fn instant<'a>(&self, structure: &'a Structure) -> Instant<'a, Most, Mosts<Q>> {
        let &Magnitudes { damping, u, u_dot, theta, theta_dot, a_g, F_t, a_v, .. } = self;
        let [cos, theta_ddot] = [1.0, f64::INFINITY].map(Most);
        Instant {
            structure,
            s: 1.0,
            settled: &NONE_SETTLED,
            contact: PressedPoints { pressed: u32::MAX, ..PressedPoints::default() },
            damping,
            u: Mosts(u),
            u_dot: Mosts(u_dot),
            theta: Most(theta),
            theta_dot: Most(theta_dot),
            theta_ddot,
            turn: Turn { sin: Most(theta), cos, versine: Most(0.5 * theta * theta) },
            a_g: Most(a_g),
            F_t: Mosts(F_t),
            a_v: Most(a_v),
        }
    }

    /// Bound of the magnitude of any `output` of `structure`: its formula in these bounds. Infinite where no bound is known.
    pub(crate) fn bound(&self, output: Output, structure: &Structure) -> f64 {
        let Most(bound) = output.smooth(&self.instant(structure));
        if bound.is_nan() { f64::INFINITY } else { bound } // of 0 θ̈
    }
}

/// The reaches of the outputs of `structure` that have [bounds](Output::bounded), each at its place. The formula of an output in bounds of
/// magnitudes is linear in what the weights are of, so that one magnitude of 1 among others of 0 shows its weight.
fn reaches(structure: &Structure) -> Vec<Reach> {
    let [none, one] = [0.0, 1.0].map(Most);
    let of_mode = |j: usize| Modes::each(structure, |i, _| f64::from(i == j));
    let most = magnitudes::<Modes>(structure, Phase::FullContact, &[Load::default(); 2], State::default());
    let x = Instant { theta_ddot: none, ..most.instant(structure) };
    #[cfg(feature = "lanes")]
    let flat = Instant::<f64, Modes>::of(structure, Phase::FullContact, &State::default(), Load::default());
    // nothing is weighed if all weights are 0
    let weights = |of: &dyn Fn(usize) -> Most| {
        let weights = Modes::each(structure, |j, _| of(j).0);
        if weights.is_within(&Modes::ZERO) { Modes::ZERO } else { weights }
    };
    let reach = |output: Output| {
        if output.search() == Search::Curved {
            return Reach { is_curved: true, ..Reach::default() };
        }
        let of = |x: &Instant<Most, Mosts<Modes>>| output.smooth(x).0;
        let sin = Turn { sin: one, ..x.turn };
        Reach {
            is_curved: false,
            turn: [
                of(&Instant { theta: one, turn: sin, ..x }),
                of(&Instant { turn: Turn { versine: one, ..x.turn }, ..x }),
            ],
            a_g: output.has_feedthrough(structure).then(|| of(&Instant { a_g: one, ..x })),
            u: weights(&|j| output.smooth(&Instant { u: Mosts(of_mode(j)), ..x })),
            u_dot: weights(&|j| output.smooth(&Instant { u_dot: Mosts(of_mode(j)), ..x })),
            push: weights(&|j| output.smooth(&Instant { F_t: Mosts(of_mode(j)), ..x })),
            #[cfg(feature = "lanes")]
            signed: [
                Modes::each(structure, |j, _| output.smooth(&Instant { u: of_mode(j), ..flat })),
                Modes::each(structure, |j, _| output.smooth(&Instant { u_dot: of_mode(j), ..flat })),
            ],
        }
    };
    Output::bounded(structure).map(reach).collect()
}

impl Structure {
    /// How far each output reaches that may have a peak.
    #[inline(always)]
    pub(crate) fn reaches(&self) -> &[Reach] {
        self.reaches_by(reaches)
    }
}

impl Output {
    /// The magnitude that is usual in a motion of `structure`: of the force of a tie the weight, of others the bound where all others are
    /// usual. None on ground that gives, of which a bound tells little.
    pub fn usual(self, structure: &Structure) -> Option<f64> {
        let (usual, &Base { m_t, g, p_l, tan_alpha_cg, .. }) = (structure.usual::<Modes>(), structure.base());
        if Output::OF_TIES.contains(&self) {
            return Some(m_t * g);
        }
        let load = Load { a_g: g * tan_alpha_cg, ..Load::default() };
        let most = magnitudes(structure, Phase::Rocking(Side::Right), &[load; 2], usual);
        let x = Instant { theta_ddot: Most(p_l * usual.theta_dot), ..most.instant(structure) };
        (!self.is_of_ground()).then(|| self.smooth(&x).0)
    }

    /// The place of an output that is searched for its peak among the reaches of `structure`.
    pub(crate) fn place(self, structure: &Structure) -> Option<usize> {
        Output::bounded(structure).position(|of| of == self)
    }
}

/// A magnitude that stands for 0 among those that a weight is divided by.
const NEGLIGIBLE: f64 = 1e-200;

impl Reach {
    /// The part of the bound of magnitudes of u and u̇, with this part `damping` of the damping in full contact.
    #[inline(always)]
    pub(crate) fn elastic<Q: Coordinates>(&self, damping: f64, u: &Q, u_dot: &Q) -> f64 {
        u.weighed(&self.u) + damping * u_dot.weighed(&self.u_dot)
    }

    /// A reach whose [elastic bound](Reach::bound_together) is below 1 only where the bounds of all these outputs are below these magnitudes.
    /// None if an output is not linear, or reads the ground acceleration or the height of the base.
    pub(crate) fn together<'a>(
        structure: &Structure,
        outputs: impl Iterator<Item = (&'a Reach, f64)>,
    ) -> Option<Reach> {
        let mut all = Reach::default();
        for (Reach { is_curved, turn, a_g, u, u_dot, push, .. }, least) in outputs {
            let least = least.max(NEGLIGIBLE);
            if *is_curved || a_g.is_some() || structure.foundation().is_some() {
                return None;
            }
            let largest = |all: f64, weight: f64| all.max(weight / least);
            all.turn = [0, 1].map(|i| largest(all.turn[i], turn[i]));
            for (all, of) in [(&mut all.u, u), (&mut all.u_dot, u_dot), (&mut all.push, push)] {
                *all = all.with(of, largest);
            }
        }
        Some(all)
    }

    /// Bound of the magnitude of an output that does not read the ground acceleration, or of [outputs together](Reach::together), given
    /// bounds of the motion.
    #[inline(always)]
    pub(crate) fn bound_together<Q: Coordinates>(&self, most: &Magnitudes<Q>) -> f64 {
        let [sin, versine] = self.turn;
        let elastic = self.elastic(most.damping, &most.u, &most.u_dot) + most.F_t.weighed(&self.push);
        elastic + sin * most.theta + versine * (0.5 * most.theta * most.theta)
    }

    /// Weights in `phase` without force of θ, of |θ|³/6 and of θ²/2, the last two without a sign, and of u and u̇. Those of θ, u and u̇ add up
    /// to this `output` but for the other two and for θ²/2 of the elastic part.
    #[cfg(feature = "lanes")]
    pub(crate) fn weights(
        &self,
        output: Output,
        structure: &Structure,
        phase: Phase,
    ) -> ([f64; 3], impl Fn(usize) -> [f64; 2]) {
        let ([sin, versine], damping, [u, u_dot]) = (self.turn, structure.base().damping(phase), &self.signed);
        let of_sin = if output.is_component() { 0.0 } else { sin };
        ([sin, of_sin, versine], move |j| [u.of[j], damping * u_dot.of[j]])
    }

    /// Bound of the magnitude of this `output` of `structure`, given bounds of the motion.
    #[inline(always)]
    pub(crate) fn bound<Q: Coordinates>(&self, output: Output, structure: &Structure, most: &Magnitudes<Q>) -> f64 {
        let Reach { a_g, push, .. } = self;
        if let (Some((arc, _, settled)), Some(foundation)) = (most.arc, Q::foundation(structure)) {
            let base = structure.base();
            let bound = |of: Output| {
                let [xi, k, c, offset] = of.of_height(base, foundation)?;
                let (offset, limit) = match of {
                    Output::N(i) if foundation.yields => (k * settled[i], foundation.points[i].q),
                    _ => (offset, f64::INFINITY),
                };
                Some(most_of_height(arc, foundation, [xi, k, c, offset]).min(limit))
            };
            let and = |sum: Option<f64>, (i, factor)| Some(sum.unwrap_or(0.0) + bound(Output::N(i))? * factor);
            let edge = if let Output::edge(side) = output { Some(foundation.of_edge(side, base.B)) } else { None };
            if let Some(bound) = edge.into_iter().flatten().fold(bound(output), and) {
                return bound;
            }
        }
        let elastic = || self.elastic(most.damping, &most.u, &most.u_dot) + most.F_t.weighed(push);
        match (a_g, most.arc) {
            _ if most.theta == f64::INFINITY => f64::INFINITY,
            _ if self.is_curved => most.bound(output, structure),
            (None, _) => self.bound_together(most),
            (Some(_), Some((arc, a_g, _))) => {
                let gauge = output.gauge(structure).expect("a gauge alone reads the ground acceleration");
                let place = Q::foundation(structure).and_then(Foundation::slide);
                elastic() + gauge.turning(structure.base(), (arc, a_g), most, place)
            }
            (Some(a_g), None) if most.theta == 0.0 => elastic() + a_g * most.a_g,
            _ => f64::INFINITY,
        }
    }

    /// How far this `output` of `structure` leaves the chord between its ends. The motion is within `most` and leaves its chords by `off`;
    /// the load is linear in time. Infinite where no bound is known.
    pub(crate) fn off_chord<Q: Coordinates>(
        &self,
        output: Output,
        structure: &Structure,
        most: &Magnitudes<Q>,
        off: &OffChord<Q>,
    ) -> f64 {
        let is_known = match Q::foundation(structure) {
            Some(foundation) => self.a_g.is_none() && output.of_height(structure.base(), foundation).is_none(),
            None => self.a_g.is_none() || most.theta == 0.0,
        };
        if self.is_curved || !is_known {
            return f64::INFINITY;
        }
        let [sin, versine] = self.turn;
        let elastic = self.elastic(most.damping, &most.u, &most.u_dot) + most.F_t.weighed(&self.push);
        self.elastic(most.damping, &off.u, &off.u_dot) + (sin + versine) * off.turn + elastic * off.product
    }
}

impl Gauge {
    /// Bound of the magnitude of the terms of [`Gauge::at`] in θ and in the acceleration of the base, which has `slide` among its coordinates if it
    /// may slide, over a polynomial, within `most`.
    /// They are added up before they are bounded, because θ̈ opposes the ground acceleration. The rest of b is at most
    /// B θ̇² + |a_g| θ²/2 + |a_v| |θ|, on ground that gives without B θ̇².
    pub(crate) fn turning<Q: Coordinates>(
        &self,
        base: &Base,
        (arc, a_g): (&Arc<Q>, Ramp),
        most: &Magnitudes<Q>,
        slide: Option<usize>,
    ) -> f64 {
        let ([height, share], mut linear) = (self.left, ZERO);
        let tilt = base.g * (self.weight - share);
        for k in 0..=arc.order {
            let theta_ddot = if k < arc.order { ORDERS[k + 1] * arc.theta_dot[k + 1] / arc.span } else { 0.0 };
            linear[k] = height * theta_ddot + tilt * arc.theta[k];
            if let Some(place) = slide.filter(|_| k < arc.order) {
                linear[k] += share * ORDERS[k + 1] * arc.u_dot[k + 1].of(place) / arc.span;
            }
        }
        linear[0] += share * a_g.value;
        linear[1] += share * a_g.slope * arc.span;
        let linear = arc.used(&linear);
        let &Magnitudes { theta, theta_dot, a_g, a_v, .. } = most;
        let ground = base.B * theta_dot * theta_dot + a_g * theta * theta / 2.0 + a_v * theta;
        let rest = share.abs() * ground + tilt.abs() * theta * theta * theta / 6.0;
        f64::most(linear, &evaluate(linear, arc.reach), arc.reach) + rest
    }
}

/// Bound of the positive part of offset + k e + c ė of the height e at ξ, on ground that gives. y and ξ sin θ cancel in e: their series are
/// added before they are bounded.
fn most_of_height<Q: Coordinates>(arc: &Arc<Q>, ground: &Foundation, [xi, k, c, offset]: [f64; 4]) -> f64 {
    let mut series = ZERO;
    let height = |q: &Q| q.footing(ground).height(xi);
    series.iter_mut().zip(arc.used(&arc.u)).for_each(|(of, u)| *of = k * height(u));
    if c != 0.0 {
        series.iter_mut().zip(arc.used(&arc.u_dot)).for_each(|(of, u_dot)| *of += c * height(u_dot));
    }
    series[0] += offset;
    let used = arc.used(&series);
    (used[0].max(evaluate(used, arc.reach)) + off_chord(used, arc.reach)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::lateral::Lateral;
    use crate::mechanics::load::Load;
    use crate::structure::description::tests::three_storeys;
    use proptest::prelude::*;

    proptest! {
        /// No output of three storeys leaves its chord by more than its bound, under a force that is linear in time.
        #[test]
        fn chords_hold(
            u in prop::array::uniform4(prop::array::uniform3(-0.1..0.1f64)), theta in prop::array::uniform4(-0.4..0.4f64),
            u_dot in prop::array::uniform4(prop::array::uniform3(-1.0..1.0f64)), reach in 0.1..1.0f64,
            forces in prop::array::uniform2(prop::array::uniform3(-1e5..1e5f64)),
        ) {
            let structure = three_storeys();
            let mut arc = Arc { order: 3, span: 0.01, reach, ..Arc::default() };
            for k in 0..=3 {
                (arc.u[k], arc.u_dot[k], arc.theta[k]) = (Modes::new(&u[k]), Modes::new(&u_dot[k]), theta[k]);
            }
            let ends = [0.0, reach].map(|sigma| arc.at(sigma));
            let loads = forces.map(|forces| structure.load(0.0, 0.0, &forces).unwrap());
            let phase = Phase::Rocking(Side::Right);
            let most = magnitudes(&structure, phase, &loads, arc.most(&ends[1]));
            let off = OffChord::of(&arc, ends.map(|of| of.theta));
            for output in Output::all(&structure) {
                let Some(place) = output.place(&structure) else { continue };
                let at = |part: f64| {
                    let F_t = loads[0].F_t.times(1.0 - part).plus(loads[1].F_t, part);
                    output.at(&structure, phase, &arc.at(part * reach), Load { F_t, ..loads[0] })
                };
                let bound = structure.reaches()[place].off_chord(output, &structure, &most, &off);
                for part in (1..8).map(|i| f64::from(i) / 8.0) {
                    let away = (at(part) - at(0.0) * (1.0 - part) - at(1.0) * part).abs();
                    prop_assert!(away <= bound * (1.0 + 1e-12), "{output:?} {away} beyond {bound}");
                }
            }
        }

        /// No output of three storeys exceeds its bound.
        #[test]
        fn bounds_hold(
            u in prop::array::uniform3(-9.0..9.0f64), u_dot in prop::array::uniform3(-90.0..90.0f64), theta in -1.5..1.5f64,
            forces in prop::array::uniform3(-1e5..1e5f64), more in 1.0..1.2f64,
        ) {
            let structure = three_storeys();
            let [u, u_dot] = [u, u_dot].map(|of| Modes::new(&of));
            let Load { F_t, .. } = structure.load(0.0, 0.0, &forces).unwrap();
            let most = |of: Modes| Modes::each(&structure, |j, _| of.of(j).abs() * more);
            let (phase, state) = (Phase::Rocking(Side::of(theta)), State { u, u_dot, theta, theta_dot: 0.0 });
            let largest = State { u: most(u), u_dot: most(u_dot), theta: theta.abs() * more, theta_dot: 0.0 };
            let bounds = magnitudes(&structure, Phase::FullContact, &[Load { F_t, ..Load::default() }; 2], largest);
            for output in Output::all(&structure) {
                let value = output.at(&structure, phase, &state, Load { a_g: 0.0, F_t, a_v: 0.0 });
                let by_weights = output.place(&structure).map(|at| structure.reaches()[at].bound(output, &structure, &bounds));
                let bound = by_weights.unwrap_or(f64::INFINITY).min(bounds.bound(output, &structure));
                prop_assert!(value.abs() <= bound * (1.0 + 1e-12), "{output:?} = {value} beyond {bound}");
            }
        }
    }
}
