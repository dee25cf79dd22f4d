//! Restraints of rocking: a tendon and a pair of dissipators. They are ties between the base and the ground.
//!
//! A tie at ξ from the middle of the base has the lever l = sB − ξ about the pivot. A force that pulls is positive:
//!
//! ```text
//! e = 2 l sin(θ/2),   ∂e/∂θ = l cos(θ/2),   moment about the pivot − F l cos(θ/2), on the right side of (6)
//!
//! tendon         ξ = 0         F = P_0 + k_t e
//! viscous        ξ = ±ξ_d      F = c_d ė
//! elastoplastic  ξ = ±ξ_d      F = k_d (e − e_p),  |F| ≤ F_y,   ė_p = ė while |F| = F_y and e moves on that sign, or else 0
//! ```
//!
//! Every tie is therefore a force, a stiffness and a damper. A yielding tie is a force alone, and e_p follows from the rotation
//! at the end. The equations for small angles have e = l θ instead. All elongations are 0 at θ = 0. An elastoplastic dissipator
//! then pulls with its residual force − k_d e_p. Impacts leave e_p unchanged. On ground that gives e = y − y_s − ξ sin θ.

use crate::mechanics::arc::Arc;
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::numbers::{Angle, Number, Turn};
use crate::series::taylor::{Series, ZERO, product};
use crate::series::terms::Terms;
use crate::structure::ground::{Footing, Settlements};
use crate::{Base, Foundation, Side, Ties};
use serde::{Deserialize, Serialize};

/// The state of the dissipators and the energy that they, friction and the ground have taken. The first is at +ξ_d, the second at −ξ_d.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dissipators {
    /// Plastic elongations e_p, m.
    pub plastic: [f64; 2],
    /// Yielding of each: +1 pulled, −1 pressed, 0 elastic.
    pub yields: [i8; 2],
    /// Energy that the viscous dissipators have taken, J.
    pub viscous: f64,
    /// Energy that the elastoplastic dissipators have taken, J.
    pub hysteretic: f64,
    /// Sum of the slips of a base that may slide, m, and the energy that friction has taken, J.
    pub slip: f64,
    #[allow(missing_docs)]
    pub friction: f64,
    /// Energy that the ground has taken by settling for good, J.
    pub settling: f64,
}

/// What a motion keeps beside its state: the dissipators, and how far contact points have settled for good, m.
pub(crate) type Kept<'a> = (&'a Dissipators, &'a Settlements);

/// Forces of the restraints, N; a force that pulls is positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Restraints<N = f64> {
    /// Tendon.
    pub P_t: N,
    /// Dissipators at +ξ_d, viscous and elastoplastic together.
    pub F_d1: N,
    /// Dissipators at −ξ_d.
    pub F_d2: N,
}

/// Size of the rotations that the equations are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Angles {
    Any,
    Small,
}

/// The chord 2 sin(θ/2), which is the elongation of every tie per lever, with the turn by θ/2, which is the
/// direction of the ties. For small angles the chord is θ, and the ties stay vertical.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chord<N = f64> {
    pub length: N,
    pub rate: N,
    half: Turn<N>,
}

impl Angles {
    /// The chord at the rotation `theta` (rad) and the rate `theta_dot` (rad/s).
    #[inline(always)] // so that nobody pays for a part that he does not read
    pub(crate) fn chord<N: Angle>(self, theta: N, theta_dot: N) -> Chord<N> {
        let (half, length) = match self {
            Angles::Any => {
                let half = (theta * 0.5).turn();
                (half, half.sin * 2.0)
            }
            Angles::Small => (Turn::none(), theta),
        };
        Chord { length, rate: half.cos * theta_dot, half }
    }

    /// The rotation (rad) with a chord of this `length`, if there is one.
    pub(crate) fn rotation(self, length: f64) -> Option<f64> {
        match self {
            Angles::Any => Some(2.0 * libm::asin(length / 2.0)).filter(|theta| !theta.is_nan()),
            Angles::Small => Some(length),
        }
    }
}

/// A force, a stiffness and a damper.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tie {
    /// l, m.
    pub lever: f64,
    /// Force at e = ė = 0, N.
    pub force: f64,
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Damping, N·s/m.
    pub damping: f64,
}

impl Tie {
    /// The force on ground that gives, N, at this place of the base with these rates.
    #[inline(always)]
    fn force_on_ground<N: Number>(&self, footing: &Footing<N>, rates: &Footing<N>) -> N {
        let &Tie { lever, force, stiffness, damping } = self;
        N::constant(force) + footing.height(lever) * stiffness + rates.height(lever) * damping
    }

    /// The force F = F_0 + l (k · chord + c · rate of the chord), N.
    #[inline]
    fn force<N: Number>(&self, length: N, rate: N) -> N {
        N::constant(self.force) + (length * self.stiffness + rate * self.damping) * self.lever
    }
}

/// The places ξ of the dissipators from the middle of the base, m.
pub(crate) fn places(base: &Base) -> [f64; 2] {
    [base.ties.xi_d, -base.ties.xi_d]
}

/// The levers of the dissipators while rocking about `side`, m.
pub(crate) fn levers(base: &Base, side: Side) -> [f64; 2] {
    places(base).map(|xi| side.sign() * base.B - xi)
}

/// The tendon and both dissipators of `base`, with the dissipators in this state. Each has its place ξ for a lever, and its elongation is
/// its height above `rest`: 0 on rigid ground, and y_s on ground that gives, where it pulls with F_0 + k (y − ξ sin θ) + c (ẏ − ξ θ̇ cos θ).
#[inline]
pub(crate) fn ties(base: &Base, dissipators: &Dissipators, y_s: f64, is_slack: bool) -> [Tie; 3] {
    let Ties { P_0, k_t, xi_d, c_d, k_d, F_y, .. } = base.ties;
    let dissipator = |j: usize, lever: f64| {
        let (force, stiffness) = match dissipators.yields[j] {
            0 => (-k_d * (dissipators.plastic[j] + y_s), k_d),
            sign => (f64::from(sign) * F_y, 0.0),
        };
        Tie { lever, force, stiffness, damping: c_d }
    };
    let [force, stiffness] = if is_slack { [0.0; 2] } else { [P_0 - k_t * y_s, k_t] };
    [Tie { lever: 0.0, force, stiffness, damping: 0.0 }, dissipator(0, xi_d), dissipator(1, -xi_d)]
}

/// One tie with the lever 1 in place of all `ties`, each with this weight.
#[inline]
fn sum(ties: &[Tie; 3], weight: impl Fn(&Tie) -> f64) -> Tie {
    ties.iter().fold(Tie { lever: 1.0, force: 0.0, stiffness: 0.0, damping: 0.0 }, |sum, tie| {
        let of_elongation = weight(tie) * tie.lever;
        Tie {
            force: sum.force + weight(tie) * tie.force,
            stiffness: sum.stiffness + of_elongation * tie.stiffness,
            damping: sum.damping + of_elongation * tie.damping,
            ..sum
        }
    })
}

/// The dampers in a motion `arc` about a pivot: c (N·m·s/rad) and the rate (rad/s) of each, whose power is c times the square of the rate.
pub(crate) fn dampers<Q>(base: &Base, angles: Angles, arc: &Arc<Q>) -> impl Iterator<Item = (f64, Terms)> {
    let c = base.ties.c_d * base.ties.pair(base.B);
    let motion = || [&arc.theta, &arc.theta_dot].map(|series| Terms::of(series, arc.order));
    let rate = |[theta, theta_dot]: [Terms; 2]| angles.chord(theta, theta_dot).rate;
    (c > 0.0).then(|| (c, rate(motion()))).into_iter()
}

/// The same on this `ground` that gives, with c (N·s/m) and the rate (m/s).
pub(crate) fn dampers_on_ground<Q: Coordinates>(
    base: &Base,
    arc: &Arc<Q>,
    ground: &Foundation,
) -> impl Iterator<Item = (f64, Terms)> {
    let rate = move |xi: f64| Terms::from_fn(arc.order, |k| arc.u_dot[k].footing(ground).height(xi));
    let c_d = base.ties.c_d;
    places(base).into_iter().filter(move |_| c_d > 0.0).map(move |xi| (c_d, rate(xi)))
}

/// The moment of the ties about a pivot over a step, order by order: cos(θ/2) and sin(θ/2) have derivatives that follow from the derivative
/// of θ.
#[derive(Clone, Debug)]
pub(crate) struct MomentSeries {
    tie: Tie,
    /// cos(θ/2), sin(θ/2) and 2 sin(θ/2); for small angles 1, 0 and θ.
    cos: Series,
    sin: Series,
    chord: Series,
    /// The force along the tie.
    force: Series,
    angles: Angles,
}

impl MomentSeries {
    /// Coefficient `n` of the series, from θ̇ to that order and the orders before; `per` is the span over n + 1.
    pub(crate) fn next(&mut self, theta_dot: &Series, n: usize, per: f64) -> f64 {
        let MomentSeries { tie, cos, sin, chord, force, angles } = self;
        let rate = product(cos, theta_dot, n);
        force[n] = tie.force(chord[n], rate);
        tie.force = 0.0; // a constant has only the order 0
        chord[n + 1] = rate * per;
        if *angles == Angles::Any {
            sin[n + 1] = 0.5 * chord[n + 1];
            cos[n + 1] = -0.5 * product(sin, theta_dot, n) * per;
        }
        product(cos, force, n)
    }
}

/// Tendon and dissipators of a structure that rocks, or is about to lift off, about a side.
#[derive(Clone, Copy, Debug)]
pub struct Restraint<'a> {
    base: &'a Base,
    side: Side,
    /// The tendon and both dissipators.
    ties: [Tie; 3],
}

impl<'a> Restraint<'a> {
    /// The restraint of `base` about `side`, with the dissipators in this state.
    #[inline]
    pub fn about(base: &'a Base, side: Side, dissipators: &Dissipators) -> Restraint<'a> {
        let mut ties = ties(base, dissipators, 0.0, false);
        ties.iter_mut().for_each(|tie| tie.lever = side.sign() * base.B - tie.lever);
        Restraint { base, side, ties }
    }

    /// Bounds of the forces of the dissipators while |θ| and |θ̇| stay within `theta` (rad) and `theta_dot` (rad/s), N.
    pub(crate) fn most(&self, theta: f64, theta_dot: f64) -> [f64; 2] {
        let most = |tie: &Tie| tie.force.abs() + tie.lever.abs() * (tie.stiffness * theta + tie.damping * theta_dot);
        [most(&self.ties[1]), most(&self.ties[2])]
    }

    /// The tie that turns the base back about the pivot like all ties together: its force times cos(θ/2) is their moment, N·m.
    #[inline]
    fn moments(&self) -> Tie {
        sum(&self.ties, |tie| tie.lever)
    }

    /// The moment Σ F l cos(θ/2) about the pivot by which the ties turn the base back, N·m.
    #[inline]
    pub(crate) fn moment<N: Number>(&self, chord: &Chord<N>) -> N {
        let tie = self.moments();
        tie.force(chord.length, chord.rate) * chord.half.cos
    }

    /// This moment as a series from the rotation `theta` (rad) on.
    pub(crate) fn series(&self, angles: Angles, theta: f64) -> MomentSeries {
        let [mut cos, mut sin, mut chord] = [ZERO; 3];
        (sin[0], cos[0]) = if angles == Angles::Any { libm::sincos(theta / 2.0) } else { (0.0, 1.0) };
        chord[0] = angles.chord(theta, 0.0).length;
        MomentSeries { tie: self.moments(), cos, sin, chord, force: ZERO, angles }
    }

    /// The square of the rate that the springs of the ties give to an `inertia` (kg·m²) about the pivot, 1/s², and the rate that their
    /// dampers give to it, 1/s.
    pub(crate) fn rates(&self, inertia: f64) -> [f64; 2] {
        let Tie { stiffness, damping, .. } = self.moments();
        [stiffness / inertia, damping / inertia]
    }

    /// The moment Σ F l of the dissipators with the base down and at rest, N·m.
    pub(crate) fn residual(&self) -> f64 {
        self.ties[1..].iter().map(|tie| tie.lever * tie.force).sum()
    }

    /// Moment that turns the base back about the pivot at the rotation `theta` (rad), at rest and with u = 0, N·m:
    ///
    /// ```text
    /// M(θ) = m_t g B (s cos θ − sin θ/tan α_cg) + s P_0 B cos(θ/2) + k_t B² sin θ + Σ_j F_j (sB − ξ_j) cos(θ/2)
    /// ```
    pub fn restoring_moment(&self, theta: f64) -> f64 {
        let &Base { m_t, g, B, tan_alpha_cg, .. } = self.base;
        let of_ties = self.moment(&Angles::Any.chord(theta, 0.0));
        let (sin, cos) = libm::sincos(theta);
        m_t * g * B * (self.side.sign() * cos - sin / tan_alpha_cg) + of_ties
    }
}

/// The forces of the restraints at the instant `x`, N, at the `angles` of its level with the dissipators in this state.
pub(crate) fn restraints<N: Angle, Q: Lateral<N>>(
    x: &Instant<N, Q>,
    angles: Angles,
    dissipators: &Dissipators,
) -> Restraints<N> {
    let [P_t, F_d1, F_d2] = match Q::foundation(x.structure) {
        Some(ground) => {
            let [footing, rates] = x.footing(ground);
            let ties = ties(x.base(), dissipators, ground.y_s, x.contact.is_slack);
            let force = |j: usize| ties[j].force_on_ground(&footing, &rates);
            [force(0), force(1), force(2)] // a map would copy series
        }
        None => {
            let chord = angles.chord(x.theta, x.theta_dot);
            let ties = Restraint::about(x.base(), Side::of(x.s.into()), dissipators).ties;
            ties.map(|tie| tie.force(chord.length, chord.rate))
        }
    };
    Restraints { P_t, F_d1, F_d2 }
}

/// Pulls of the ties on the ground at the instant `x`, up and to the right, N, and their moment about the place of the middle of the base in
/// full contact, N·m. The moment holds in full contact.
pub(crate) fn pulls<N: Angle, Q: Lateral<N>>(x: &Instant<N, Q>, angles: Angles, dissipators: &Dissipators) -> [N; 3] {
    if Q::foundation(x.structure).is_some() {
        let Restraints { P_t, F_d1, F_d2 } = restraints(x, angles, dissipators);
        return [P_t + F_d1 + F_d2, N::constant(0.0), (F_d1 - F_d2) * x.base().ties.xi_d * x.turn.cos];
    }
    let Restraint { base, side, ties } = Restraint::about(x.base(), Side::of(x.s.into()), dissipators);
    let (middle, chord) = (side.sign() * base.B, angles.chord(x.theta, x.theta_dot));
    let force = |tie: Tie| tie.force(chord.length, chord.rate);
    let (pull, moment) = (force(sum(&ties, |_| 1.0)), force(sum(&ties, |tie| middle - tie.lever)));
    [pull * chord.half.cos, pull * chord.half.sin, moment * chord.half.cos]
}

/// The two moments that decide whether a structure centres itself after rocking, N·m. The first turns the base back at the ground,
/// [(m + m0) g + P_0] B. The second is the largest that the residual forces of the dissipators hold against it, Σ F_y |sB − ξ|. If the
/// second is larger, the structure may come to rest turned.
pub fn centring_moments(base: &Base) -> [f64; 2] {
    let &Base { m_t, B, g, ties: Ties { P_0, F_y, .. }, .. } = base;
    [(m_t * g + P_0) * B, levers(base, Side::Right).iter().map(|lever| F_y * lever.abs()).sum()]
}

impl Dissipators {
    /// The dissipators of a structure that has not moved yet.
    pub const NEW: Dissipators = Dissipators {
        plastic: [0.0; 2],
        yields: [0; 2],
        viscous: 0.0,
        hysteretic: 0.0,
        slip: 0.0,
        friction: 0.0,
        settling: 0.0,
    };

    /// The dissipators after a transition to rocking about a side at a rate θ̇ (rad/s), or to rest in contact (none). A dissipator
    /// that keeps moving the sign it yielded keeps yielding.
    pub(crate) fn after(mut self, base: &Base, rocking: Option<(Side, f64)>) -> Dissipators {
        for j in 0..2 {
            let on = |(side, theta_dot)| f64::from(self.yields[j]) * levers(base, side)[j] * theta_dot > 0.0;
            if !rocking.is_some_and(on) {
                self.yields[j] = 0;
            }
        }
        self
    }

    /// The dissipators after a step. At its end those that yield have these elongations `e` (m), and each damper has `taken` an energy (J).
    pub(crate) fn stepped(
        &self,
        base: &Base,
        e: impl Fn(usize) -> f64,
        taken: impl Iterator<Item = f64>,
    ) -> Dissipators {
        let (Ties { k_d, F_y, .. }, mut moved) = (base.ties, *self);
        for j in 0..2 {
            let sign = f64::from(self.yields[j]);
            if sign != 0.0 {
                let plastic = e(j) - sign * F_y / k_d;
                moved.hysteretic += sign * F_y * (plastic - moved.plastic[j]);
                moved.plastic[j] = plastic;
            }
        }
        moved.viscous = taken.fold(moved.viscous, |sum, of| sum + of);
        moved
    }

    /// The dissipators of `base` after a slow rotation to `theta` (rad) about `side` that does not turn back on its sign.
    pub fn moved(&self, base: &Base, side: Side, theta: f64) -> Dissipators {
        let chord = Angles::Any.chord(theta, 0.0).length;
        self.moved_to(base, |j| levers(base, side)[j] * chord)
    }

    /// The dissipators of `base` after a slow motion to the elongations `e` (m) that does not turn back on its sign.
    pub(crate) fn moved_to(&self, base: &Base, e: impl Fn(usize) -> f64) -> Dissipators {
        let Ties { k_d, F_y, .. } = base.ties;
        let mut moved = Dissipators { yields: [0; 2], ..*self };
        if k_d == 0.0 {
            return moved; // not even on a path that a compiler takes beforehand is F_y divided by 0
        }
        for j in 0..2 {
            let force = k_d * (e(j) - moved.plastic[j]);
            if force.abs() > F_y {
                let plastic = e(j) - F_y.copysign(force) / k_d;
                moved.hysteretic += F_y * (plastic - moved.plastic[j]).abs();
                moved.plastic[j] = plastic;
            }
        }
        moved
    }
}
