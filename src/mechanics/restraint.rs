//! What restrains rocking: a tendon and a pair of dissipators, ties between the base and the ground.
//!
//! A tie at ξ from the middle of the base has the lever l = sB − ξ about the pivot; pulled is positive:
//!
//! ```text
//! e = 2 l sin(θ/2),   ∂e/∂θ = l cos(θ/2),   moment about the pivot − F l cos(θ/2), on the right side of (6)
//!
//! tendon         ξ = 0         F = P_0 + k_t e
//! viscous        ξ = ±ξ_d      F = c_d ė
//! elastoplastic  ξ = ±ξ_d      F = k_d (e − e_p),  |F| ≤ F_y,   ė_p = ė while |F| = F_y and e moves on that way, or else 0
//! ```
//!
//! So every tie is a force, a stiffness and a damper. A yielding one is a force alone, and e_p follows from it at the end.
//! The equations for small angles have e = l θ instead. At θ = 0 all e are 0: what an elastoplastic dissipator then pulls
//! is its residual force − k_d e_p. Impacts leave e_p as it is.

use crate::{Side, State, Structure};
use serde::{Deserialize, Serialize};

/// What the dissipators keep, and what they have taken: the first is at +ξ_d, the second at −ξ_d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Dissipators {
    /// Plastic elongations e_p, m.
    pub plastic: [f64; 2],
    /// +1 of one that yields pulled, −1 pressed, 0 of one that is elastic.
    pub yields: [i8; 2],
    /// Energy that the viscous ones have taken, J.
    pub viscous: f64,
    /// Energy that the elastoplastic ones have taken, J.
    pub hysteretic: f64,
}

/// Forces of the restraints, N; pulled is positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Restraints {
    /// Tendon.
    pub P_t: f64,
    /// Dissipators at +ξ_d, viscous and elastoplastic together.
    pub F_d1: f64,
    /// Those at −ξ_d.
    pub F_d2: f64,
}

/// How large the rotations are that the equations are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Angles {
    Any,
    Small,
}

/// 2 sin(θ/2), for small angles θ, and its rate: over the lever the elongation of every tie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chord {
    pub length: f64,
    pub rate: f64,
}

impl Angles {
    /// The chord at the rotation `theta` (rad) and its rate.
    pub(crate) fn chord(self, theta: f64, theta_dot: f64) -> Chord {
        let (sin, cos) = libm::sincos(theta / 2.0);
        match self {
            Angles::Any => Chord { length: 2.0 * sin, rate: cos * theta_dot },
            Angles::Small => Chord { length: theta, rate: theta_dot },
        }
    }

    /// The rate of the chord that has the rate `theta_dot` (rad/s), which changes by `theta_ddot` (rad/s²).
    fn chord_rate(self, theta: f64, theta_dot: f64, theta_ddot: f64) -> Chord {
        let (sin, cos) = libm::sincos(theta / 2.0);
        let rate = match self {
            Angles::Any => cos * theta_ddot - 0.5 * sin * theta_dot * theta_dot,
            Angles::Small => theta_ddot,
        };
        Chord { length: self.chord(theta, theta_dot).rate, rate }
    }

    /// The rotation (rad) that has a chord of this `length`, if one has.
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
    /// At e = ė = 0, N.
    pub force: f64,
    /// N/m.
    pub stiffness: f64,
    /// N·s/m.
    pub damping: f64,
}

impl Tie {
    /// Its force at `chord`, N.
    pub(crate) fn force_at(&self, chord: Chord) -> f64 {
        self.force + self.lever * (self.stiffness * chord.length + self.damping * chord.rate)
    }
}

/// The levers of the dissipators while rocking about `side`, m.
pub(crate) fn levers(structure: &Structure, side: Side) -> [f64; 2] {
    let &crate::Parameters { B, xi_d, .. } = structure.parameters();
    [side.sign() * B - xi_d, side.sign() * B + xi_d]
}

/// Tendon and dissipators while rocking about `side`.
pub(crate) fn ties(structure: &Structure, side: Side, dissipators: &Dissipators) -> [Tie; 3] {
    let &crate::Parameters { B, P_0, k_t, c_d, k_d, F_y, .. } = structure.parameters();
    let levers = levers(structure, side);
    let dissipator = |j: usize| {
        let (force, stiffness) = match dissipators.yields[j] {
            0 => (-k_d * dissipators.plastic[j], k_d),
            way => (f64::from(way) * F_y, 0.0),
        };
        Tie { lever: levers[j], force, stiffness, damping: c_d }
    };
    let tendon = Tie { lever: side.sign() * B, force: P_0, stiffness: k_t, damping: 0.0 };
    [tendon, dissipator(0), dissipator(1)]
}

/// What all ties do together: (force + stiffness chord + damping its rate) cos(θ/2), for small angles without the cosine.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    pub force: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl Sum {
    /// The moment Σ F l cos(θ/2) about the pivot by which tendon and dissipators turn the base back, N·m.
    pub(crate) fn of_moments(structure: &Structure, side: Side, dissipators: &Dissipators) -> Sum {
        Sum::of(&ties(structure, side, dissipators), |tie| tie.lever)
    }

    /// Their vertical pull Σ F cos(θ/2), N.
    pub(crate) fn of_pulls(ties: &[Tie; 3]) -> Sum {
        Sum::of(ties, |_| 1.0)
    }

    fn of(ties: &[Tie; 3], weight: impl Fn(&Tie) -> f64) -> Sum {
        ties.iter().fold(Sum::default(), |sum, tie| {
            let of_elongation = weight(tie) * tie.lever;
            Sum {
                force: sum.force + weight(tie) * tie.force,
                stiffness: sum.stiffness + of_elongation * tie.stiffness,
                damping: sum.damping + of_elongation * tie.damping,
            }
        })
    }

    /// At the rotation `theta` (rad) and its rate.
    pub(crate) fn at(&self, angles: Angles, theta: f64, theta_dot: f64) -> f64 {
        let Chord { length, rate } = angles.chord(theta, theta_dot);
        let towards = if angles == Angles::Any { libm::cos(theta / 2.0) } else { 1.0 };
        towards * (self.force + self.stiffness * length + self.damping * rate)
    }
}

impl Restraints {
    /// Of `structure` about `side` at the rotation `theta` (rad); the dissipators are elongated as `chord` says.
    pub(crate) fn of(
        structure: &Structure,
        side: Side,
        theta: f64,
        dissipators: &Dissipators,
        chord: Chord,
    ) -> Restraints {
        let [tendon, first, second] = ties(structure, side, dissipators);
        let P_t = tendon.force_at(Angles::Any.chord(theta, 0.0));
        Restraints { P_t, F_d1: first.force_at(chord), F_d2: second.force_at(chord) }
    }

    /// Their rates, N/s, in `state` while θ̇ changes by `theta_ddot` (rad/s²); the dissipators are elongated as `angles` say.
    pub(crate) fn rates(
        structure: &Structure,
        side: Side,
        dissipators: &Dissipators,
        angles: Angles,
        &State { theta, theta_dot, .. }: &State,
        theta_ddot: f64,
    ) -> Restraints {
        let rate = |tie: Tie, angles: Angles| {
            Tie { force: 0.0, ..tie }.force_at(angles.chord_rate(theta, theta_dot, theta_ddot))
        };
        let [tendon, first, second] = ties(structure, side, dissipators);
        Restraints { P_t: rate(tendon, Angles::Any), F_d1: rate(first, angles), F_d2: rate(second, angles) }
    }
}

/// Energy that the restraints of `structure` store about `side` at the rotation `theta` (rad), J: P_0 e + ½ k_t e² + Σ F²/(2 k_d).
pub fn stored_energy(structure: &Structure, side: Side, theta: f64, dissipators: &Dissipators) -> f64 {
    let &crate::Parameters { P_0, k_t, k_d, F_y, .. } = structure.parameters();
    let [tendon, rest @ ..] = ties(structure, side, dissipators);
    let chord = Angles::Any.chord(theta, 0.0);
    let e = tendon.lever * chord.length;
    let elastic = |tie: &Tie| {
        let force = Tie { damping: 0.0, ..*tie }.force_at(chord);
        if F_y > 0.0 { force * force / (2.0 * k_d) } else { 0.0 }
    };
    e * (P_0 + 0.5 * k_t * e) + rest.iter().map(elastic).sum::<f64>()
}

/// The displacement u_cr,s (m) towards `side` at which the base lifts off about it, where its turning moment then suffices:
///
/// ```text
/// u_cr,s = { [(m + m0)(g + a_v) + P_0] B + Σ F (B − s ξ) }/(m H ω_fc²)
/// ```
///
/// Where it is not above 0 the weight no longer holds the base. `a_v` in m/s².
pub fn uplift_displacement(structure: &Structure, side: Side, a_v: f64, dissipators: &Dissipators) -> f64 {
    let more = holding_moment(structure, side, a_v, dissipators);
    structure.u_cr + more / (structure.parameters().H * structure.stiffness)
}

/// Over m, the moment about the pivot that holds the base down beside that of its weight at rest, m²/s².
pub(crate) fn holding_moment(structure: &Structure, side: Side, a_v: f64, dissipators: &Dissipators) -> f64 {
    let &crate::Parameters { m, B, .. } = structure.parameters();
    let held = Sum::of_moments(structure, side, dissipators).force;
    structure.gamma * a_v * B + side.sign() * held / m
}

/// Whether a structure centres itself once it has rocked: what turns it back at the ground, [(m + m0) g + P_0] B, and the most that
/// the residual forces of the dissipators hold against it, Σ F_y |sB − ξ|, N·m. Where the latter is more it may come to rest
/// turned.
pub fn centring_moments(structure: &Structure) -> [f64; 2] {
    let &crate::Parameters { m, m0, B, g, P_0, F_y, .. } = structure.parameters();
    [((m + m0) * g + P_0) * B, levers(structure, Side::Right).iter().map(|lever| F_y * lever.abs()).sum()]
}

/// Moment that turns the base of a structure back about the right pivot at the rotation `theta` (rad), at rest, u = 0, N·m:
///
/// ```text
/// M(θ) = (m + m0) g B cos θ − m g H sin θ + P_0 B cos(θ/2) + k_t B² sin θ + Σ_j F_j (B − ξ_j) cos(θ/2)
/// ```
pub fn restoring_moment(structure: &Structure, theta: f64, dissipators: &Dissipators) -> f64 {
    let &crate::Parameters { m, m0, H, B, g, .. } = structure.parameters();
    let of_ties = Sum::of_moments(structure, Side::Right, dissipators).at(Angles::Any, theta, 0.0);
    let (sin, cos) = libm::sincos(theta);
    (m + m0) * g * B * cos - m * g * H * sin + of_ties
}

impl Dissipators {
    /// Of a structure that has not moved yet.
    pub const NEW: Dissipators = Dissipators { plastic: [0.0; 2], yields: [0; 2], viscous: 0.0, hysteretic: 0.0 };

    /// After a transition to rocking about `side` at the rate `theta_dot` (rad/s), or at rest in contact (none): what goes on
    /// the way it yielded goes on yielding.
    pub(crate) fn after(mut self, structure: &Structure, rocking: Option<(Side, f64)>) -> Dissipators {
        for j in 0..2 {
            let on = |(side, theta_dot)| f64::from(self.yields[j]) * levers(structure, side)[j] * theta_dot > 0.0;
            if !rocking.is_some_and(on) {
                self.yields[j] = 0;
            }
        }
        self
    }

    /// Moved slowly from where they are to the rotation `theta` (rad) of `structure` about `side`, without turning back on the
    /// way: plastic elongations and the energy taken.
    pub fn moved(&self, structure: &Structure, side: Side, theta: f64) -> Dissipators {
        self.moved_by(structure, side, Angles::Any.chord(theta, 0.0))
    }

    /// [`Dissipators::moved`] to a rotation of this `chord`.
    pub(crate) fn moved_by(&self, structure: &Structure, side: Side, chord: Chord) -> Dissipators {
        let &crate::Parameters { k_d, F_y, .. } = structure.parameters();
        let mut moved = Dissipators { yields: [0; 2], ..*self };
        for (j, lever) in levers(structure, side).into_iter().enumerate() {
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
