//! Restraints of rocking: a tendon and a pair of dissipators. They are ties between the base and the ground.
//!
//! A tie at ξ from the middle of the base has the lever l = sB − ξ about the pivot. A force that pulls is positive:
//!
//! ```text
//! e = 2 l sin(θ/2),   ∂e/∂θ = l cos(θ/2),   moment about the pivot − F l cos(θ/2), on the right side of (6)
//!
//! tendon         ξ = 0         F = P_0 + k_t e
//! viscous        ξ = ±ξ_d      F = c_d ė
//! elastoplastic  ξ = ±ξ_d      F = k_d (e − e_p),  |F| ≤ F_y,   ė_p = ė while |F| = F_y and e moves on that way, or else 0
//! ```
//!
//! Every tie is therefore a force, a stiffness and a damper. A yielding tie is a force alone, and e_p follows from the rotation
//! at the end. The equations for small angles have e = l θ instead. All elongations are 0 at θ = 0. An elastoplastic dissipator
//! then pulls with its residual force − k_d e_p. Impacts leave e_p unchanged.

use crate::numbers::{Angle, Number, Turn};
use crate::{Base, Side, Ties};
use serde::{Deserialize, Serialize};

/// The state of the dissipators and the energy they have taken. The first is at +ξ_d, the second at −ξ_d.
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
}

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
    /// The force F = F_0 + l (k · chord + c · rate of the chord), N.
    #[inline]
    pub(crate) fn force<N: Number>(&self, length: N, rate: N) -> N {
        N::constant(self.force) + (length * self.stiffness + rate * self.damping) * self.lever
    }

    /// The moment by which the tie that stands for all ties turns the base back at this `chord`, N·m.
    #[inline]
    pub(crate) fn moment<N: Number>(&self, chord: &Chord<N>) -> N {
        self.force(chord.length, chord.rate) * chord.half.cos
    }
}

/// The levers of the dissipators while rocking about `side`, m.
pub(crate) fn levers(base: &Base, side: Side) -> [f64; 2] {
    let &Base { B, ties: Ties { xi_d, .. }, .. } = base;
    [side.sign() * B - xi_d, side.sign() * B + xi_d]
}

/// The tendon and both dissipators of `base` about `side`, with the dissipators in this state.
#[inline]
pub(crate) fn ties(base: &Base, side: Side, dissipators: &Dissipators) -> [Tie; 3] {
    let &Base { B, ties: Ties { P_0, k_t, .. }, .. } = base;
    let tendon = Tie { lever: side.sign() * B, force: P_0, stiffness: k_t, damping: 0.0 };
    let [first, second] = pair(base, dissipators, levers(base, side), dissipators.plastic);
    [tendon, first, second]
}

/// Both dissipators of `base` with these levers, whose elongations beyond `plastic` (m) are elastic.
#[inline]
pub(crate) fn pair(base: &Base, dissipators: &Dissipators, levers: [f64; 2], plastic: [f64; 2]) -> [Tie; 2] {
    let Ties { c_d, k_d, F_y, .. } = base.ties;
    [0, 1].map(|j| {
        let (force, stiffness) = match dissipators.yields[j] {
            0 => (-k_d * plastic[j], k_d),
            way => (f64::from(way) * F_y, 0.0),
        };
        Tie { lever: levers[j], force, stiffness, damping: c_d }
    })
}

/// One tie with the lever 1 in place of all `ties`, each with this weight.
#[inline]
pub(crate) fn sum(ties: &[Tie; 3], weight: impl Fn(&Tie) -> f64) -> Tie {
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
        Restraint { base, side, ties: ties(base, side, dissipators) }
    }

    /// The forces of the ties at this `chord`.
    pub(crate) fn forces<N: Number>(&self, chord: &Chord<N>) -> Restraints<N> {
        let [P_t, F_d1, F_d2] = self.ties.map(|tie| tie.force(chord.length, chord.rate));
        Restraints { P_t, F_d1, F_d2 }
    }

    /// Bounds of the forces of the dissipators while |θ| and |θ̇| stay within `theta` (rad) and `theta_dot` (rad/s), N.
    pub(crate) fn most(&self, theta: f64, theta_dot: f64) -> [f64; 2] {
        let most = |tie: &Tie| tie.force.abs() + tie.lever.abs() * (tie.stiffness * theta + tie.damping * theta_dot);
        [most(&self.ties[1]), most(&self.ties[2])]
    }

    /// The tie that turns the base back about the pivot like all ties together: its force times cos(θ/2) is their moment, N·m.
    #[inline]
    pub(crate) fn moments(&self) -> Tie {
        sum(&self.ties, |tie| tie.lever)
    }

    /// The moment Σ F l cos(θ/2) about the pivot by which the ties turn the base back, N·m.
    #[inline]
    pub(crate) fn moment<N: Number>(&self, chord: &Chord<N>) -> N {
        self.moments().moment(chord)
    }

    /// Pulls of the ties on the ground, up and to the right, N, and their moment about the place of the middle of the base in
    /// full contact, N·m. The moment holds in full contact.
    pub(crate) fn pulls<N: Number>(&self, chord: &Chord<N>) -> [N; 3] {
        let middle = self.side.sign() * self.base.B;
        let force = |tie: Tie| tie.force(chord.length, chord.rate);
        let (pull, moment) = (force(sum(&self.ties, |_| 1.0)), force(sum(&self.ties, |tie| middle - tie.lever)));
        [pull * chord.half.cos, pull * chord.half.sin, moment * chord.half.cos]
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

/// The two moments that decide whether a structure centres itself after rocking, N·m. The first turns the base back at the ground,
/// [(m + m0) g + P_0] B. The second is the largest that the residual forces of the dissipators hold against it, Σ F_y |sB − ξ|. If the
/// second is larger, the structure may come to rest turned.
pub fn centring_moments(base: &Base) -> [f64; 2] {
    let &Base { m_t, B, g, ties: Ties { P_0, F_y, .. }, .. } = base;
    [(m_t * g + P_0) * B, levers(base, Side::Right).iter().map(|lever| F_y * lever.abs()).sum()]
}

impl Dissipators {
    /// The dissipators of a structure that has not moved yet.
    pub const NEW: Dissipators = Dissipators { plastic: [0.0; 2], yields: [0; 2], viscous: 0.0, hysteretic: 0.0 };

    /// The dissipators after a transition to rocking about a side at a rate θ̇ (rad/s), or to rest in contact (none). A dissipator
    /// that keeps moving the way it yielded keeps yielding.
    pub(crate) fn after(mut self, base: &Base, rocking: Option<(Side, f64)>) -> Dissipators {
        for j in 0..2 {
            let on = |(side, theta_dot)| f64::from(self.yields[j]) * levers(base, side)[j] * theta_dot > 0.0;
            if !rocking.is_some_and(on) {
                self.yields[j] = 0;
            }
        }
        self
    }

    /// The dissipators of `base` after a slow rotation to `theta` (rad) about `side` that does not turn back on its way.
    pub fn moved(&self, base: &Base, side: Side, theta: f64) -> Dissipators {
        self.moved_by(base, side, Angles::Any.chord(theta, 0.0))
    }

    /// [`Dissipators::moved`] to a rotation of this `chord`.
    pub(crate) fn moved_by(&self, base: &Base, side: Side, chord: Chord) -> Dissipators {
        let Ties { k_d, F_y, .. } = base.ties;
        let mut moved = Dissipators { yields: [0; 2], ..*self };
        if k_d == 0.0 {
            return moved; // not even on a path that a compiler takes beforehand is F_y divided by 0
        }
        for (j, lever) in levers(base, side).into_iter().enumerate() {
            let force = k_d * (lever * chord.length - moved.plastic[j]);
            if force.abs() > F_y {
                let plastic = lever * chord.length - F_y.copysign(force) / k_d;
                moved.hysteretic += F_y * (plastic - moved.plastic[j]).abs();
                moved.plastic[j] = plastic;
            }
        }
        moved
    }
}
