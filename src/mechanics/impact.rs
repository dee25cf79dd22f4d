//! Impact: the change of the motion when s θ returns to 0.
//!
//! L is the angular momentum about the pivot that comes down, −s, just before:
//!
//! ```text
//! L = m H (u̇ + H θ̇) − [ m (B² − u²) + m0 B² − J0 ] θ̇
//! ```
//!
//! - L θ̇ > 0: rocking goes on about the other pivot: s ← −s, θ̇ ← r θ̇, u and u̇ unchanged;
//! - otherwise full contact: u̇ ← u̇ + H θ̇ (horizontal momentum is kept), θ = θ̇ = 0.
//!
//! With r < 1 a rigid structure comes to rest by infinitely many impacts in finite time. It is at rest after the first impact that
//! leaves |θ̇| ≤ ε p_l tan α_cg, where ε is the error that a step may have. Later impacts amplify the error of this rest like the
//! error of a step. The kinetic energy that is left out, ½ J_P θ̇², is at most the part ε² of ½ m g H tan² α_cg, the energy for
//! overturning at small angles. After any other impact rocking goes on, however squat the structure is. The momentum rule of elastic
//! structures would depend on the shape alone.
//!
//! Transitions are counted from the first of them on for a vibration period 2π/ω_u, then from 0 again. After
//! [`MAX_TRANSITIONS_PER_PERIOD`] the next impact is a landing whatever its momentum, and contact is held to the end of
//! the period ([`Settling`](crate::TransitionKind::Settling)): it sees two more at most. Bounces that fast are the start of infinitely
//! many in finite time, which end in contact; neither specimen comes near them. A rigid structure, which has no vibration
//! and does come to rest by ever faster impacts, has [`MAX_RIGID_TRANSITIONS_PER_PERIOD`] for each 1/p_l instead.

use crate::mechanics::lateral::Coordinates;
use crate::{Base, Mode, OneMass, Phase, Side, State, Structure};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Transitions within one period of the vibration mode (2π/ω_u) after which contact is held.
pub const MAX_TRANSITIONS_PER_PERIOD: u32 = 1000;

/// Transitions within 1/p_l after which contact of a rigid structure is held: coming to rest with r = 0.9997 takes as many.
pub const MAX_RIGID_TRANSITIONS_PER_PERIOD: u32 = 100_000;

/// Transitions in the present period, for the guarantee of progress.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Chatter {
    /// Time since the first of them, s.
    pub age: f64,
    /// Number of transitions since then.
    transitions: u32,
    /// Duration over which contact is held from now on, s.
    pub held: f64,
}

impl Chatter {
    /// The state of a motion that has had no transition.
    pub(crate) const NONE: Chatter = Chatter { age: f64::MAX, transitions: 0, held: 0.0 };

    /// The period (s) of `structure`, and how many transitions it may see.
    fn limit(structure: &Structure) -> (f64, u32) {
        match structure.is_rigid() {
            true => (1.0 / structure.base().p_l, MAX_RIGID_TRANSITIONS_PER_PERIOD),
            false => (TAU / structure.vibration().rocking[0], MAX_TRANSITIONS_PER_PERIOD),
        }
    }

    /// Passes `duration` seconds.
    #[inline]
    pub(crate) fn pass(&mut self, duration: f64) {
        self.age += duration;
        if self.held > 0.0 {
            self.held = (self.held - duration).max(0.0);
        }
    }

    /// Counts one more transition.
    pub(crate) fn count(&mut self, structure: &Structure) {
        if self.age >= Chatter::limit(structure).0 {
            (self.age, self.transitions) = (0.0, 0);
        }
        self.transitions += 1;
    }

    /// Whether the period may see no more transitions; contact is then held to its end.
    pub(crate) fn settles(&mut self, structure: &Structure) -> bool {
        let (period, most) = Chatter::limit(structure);
        let settles = self.transitions >= most && self.age < period;
        if settles {
            self.held = period - self.age;
        }
        settles
    }
}

/// Angular momentum L about the pivot that comes down, kg·m²/s, of a structure that touches the ground (θ = 0).
pub fn angular_momentum<Q: Coordinates>(structure: &Structure, before: &State<Q>) -> f64 {
    let &Base { m0, B, J0, .. } = structure.base();
    let &State { u, u_dot, theta_dot, .. } = before;
    let along = Q::sum(structure, |j, mode| mode.mass * mode.height * (u_dot.of(j) + mode.height * theta_dot));
    let across = Q::sum(structure, |j, mode| {
        let b = mode.share * B;
        mode.mass * (b * b - u.of(j) * u.of(j))
    });
    along - (across + m0 * B * B - J0) * theta_dot
}

/// The coefficient of restitution at an impact that ends rocking about `side` in the state `before`.
pub fn restitution<Q: Coordinates>(structure: &Structure, side: Side, before: &State<Q>) -> f64 {
    structure.base().restitution(|| {
        let square = Q::sum(structure, |j, mode| mode.mass * before.u.of(j) * before.u.of(j));
        let offset = Q::sum(structure, |j, mode| mode.gamma * before.u.of(j));
        [square, side.sign() * offset]
    })
}

/// Phase and state just after an impact that ends rocking about `side` in the state `before`, by steps of this `local_error`.
pub fn resolve<Q: Coordinates>(
    structure: &Structure,
    local_error: f64,
    side: Side,
    before: &State<Q>,
) -> (Phase, State<Q>) {
    let (r, &Base { p_l, tan_alpha_cg, .. }) = (restitution(structure, side, before), structure.base());
    let goes_on = match structure.is_rigid() {
        true => r * before.theta_dot.abs() > local_error * p_l * tan_alpha_cg,
        false => angular_momentum(structure, before) * before.theta_dot > 0.0 && r > 0.0,
    };
    if goes_on {
        (Phase::Rocking(side.opposite()), State { theta: 0.0, theta_dot: r * before.theta_dot, ..*before })
    } else {
        (Phase::FullContact, land(structure, before))
    }
}

/// Energy gained, J, at an impact that ends rocking about `side` in the state `before` and begins rocking about the other pivot.
/// J₋ is the inertia about the pivot before the impact:
///
/// ```text
/// T₊ − T₋ = −(1−r) m H u̇ θ̇ − ½ (1−r²) J₋ θ̇² + 2 r² m B s u θ̇²,      J₋ = J0 + m0 B² + m H² + m (sB−u)²
/// ```
///
/// The rule takes momentum from the base and not from the top mass, which adds energy if u̇ and θ̇ differ in sign. If s u > 0, the
/// new pivot is farther from the top mass, and keeping θ̇ adds energy even with r = 1. A landing always loses ½ J₋ θ̇² less
/// ½ m H² θ̇². With many masses, each term with m is a sum over the modes.
pub fn energy_gained<Q: Coordinates>(structure: &Structure, side: Side, before: &State<Q>) -> f64 {
    let (&Base { B, J_P, .. }, s) = (structure.base(), side.sign());
    let r = restitution(structure, side, before);
    let &State { u, u_dot, theta_dot, .. } = before;
    let sum = |term: &dyn Fn(usize, &Mode) -> f64| Q::sum(structure, term);
    let square = theta_dot * theta_dot;
    let inertia = J_P + sum(&|j, mode| mode.mass * (s * u.of(j)) * (s * u.of(j) - 2.0 * B * mode.share));
    sum(&|j, mode| -(1.0 - r) * mode.mass * mode.height * u_dot.of(j)) * theta_dot
        - 0.5 * (1.0 - r * r) * inertia * square
        + sum(&|j, mode| 2.0 * r * r * mode.gamma * B * s * u.of(j)) * square
}

/// A = J0 + m (H² + u²) and F = (m + m0) B², kg·m²: J₋ is A + F − 2 m B s u.
fn inertias(structure: &OneMass, u: f64) -> [f64; 2] {
    let &crate::Parameters { m, m0, H, B, J0, .. } = structure.parameters();
    [J0 + m * (H * H + u * u), (m + m0) * B * B]
}

/// The supremum of (T₊ − T₋)/θ̇², kg·m², over all impacts at the displacement `u` (m) after which rocking continues. `u` is
/// positive towards the pivot before the impact.
///
/// The gain falls as u̇/θ̇ rises, and L θ̇ > 0 bounds u̇/θ̇ from below. At this bound, with A = J0 + m (H² + u²) and
/// F = (m + m0) B², the gain is
///
/// ```text
/// ½ (1−r) [(1−r) A − (3+r) F] + (1+r²) m B s u
/// ```
pub fn greatest_gain(structure: &OneMass, u: f64) -> f64 {
    let &crate::Parameters { m, B, r, .. } = structure.parameters();
    let [a, f] = inertias(structure, u);
    0.5 * (1.0 - r) * ((1.0 - r) * a - (3.0 + r) * f) + (1.0 + r * r) * m * B * u
}

/// The two coefficients of restitution between which no impact at the displacement `u` (m) towards the pivot raises the energy.
/// [`greatest_gain`] is not positive between them. If there is no such range, the result is none. With U = 2 m B s u they are
///
/// ```text
/// r = [A − F ± √(4 F² − 2 U (A − F) − U²)]/(A + F + U),      at u = 0: 1 − 4 (m + m0) B²/J_P and 1
/// ```
pub fn lossless_restitution(structure: &OneMass, u: f64) -> Option<[f64; 2]> {
    let &crate::Parameters { m, B, .. } = structure.parameters();
    let [a, f] = inertias(structure, u);
    let lift = 2.0 * m * B * u;
    let square = 4.0 * f * f - 2.0 * lift * (a - f) - lift * lift;
    (square >= 0.0).then(|| [-square.sqrt(), square.sqrt()].map(|root| (a - f + root) / (a + f + lift)))
}

/// The coefficient of restitution below which an impact with u = 0 requires a pull at the edge that lifts off:
///
/// ```text
/// r < 1 − 2 (m + m0) B²/J_P
/// ```
///
/// The impulse at that edge is (I_v + s I_m/B)/2 = (|θ̇|/2B) [(1+r) F − (1−r) A + 2 r m B s u], A and F as above.
pub fn pulling_restitution(&Base { m_t, B, J_P, .. }: &Base) -> f64 {
    1.0 - 2.0 * (m_t * B * B) / J_P
}

/// The state just after landing: both pivots down, horizontal momentum kept.
pub fn land<Q: Coordinates>(structure: &Structure, before: &State<Q>) -> State<Q> {
    let u_dot = Q::each(structure, |j, mode| before.u_dot.of(j) + mode.height * before.theta_dot);
    State { u: before.u, u_dot, theta: 0.0, theta_dot: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::mechanics::energy::energy;
    use crate::mechanics::reactions::Impulse;

    /// Just outside those restitutions an impact at the least u̇/θ̇ with L θ̇ > 0 raises the energy; just inside none does.
    #[test]
    fn energy_can_grow_outside_the_lossless_restitutions() {
        for (parameters, part) in [(Parameters::EVISON, 0.0), (Parameters::EVISON, 1.0), (Parameters::MCMANUS, 1.0)] {
            let structure = OneMass::new(parameters).unwrap();
            let u = part * structure.u_cr;
            let [least, most] = lossless_restitution(&structure, u).unwrap();
            assert!(part > 0.0 || (least - (1.0 - 4.0 * structure.one_minus_chi)).abs() < 1e-14);
            for (r, can_gain) in
                [(least - 1e-6, true), (least + 1e-6, false), (most - 1e-6, false), (most + 1e-6, true)]
            {
                if r >= 1.0 {
                    continue;
                }
                let structure = OneMass::new(Parameters { r, ..parameters }).unwrap();
                assert_eq!(greatest_gain(&structure, u) > 0.0, can_gain);
                let &Parameters { m, m0, H, B, J0, .. } = structure.parameters();
                let bound = ((m + m0) * B * B - J0 - m * H * H - m * u * u) / (m * H);
                let theta_dot = -0.3;
                let before = State { u, u_dot: theta_dot * (bound + 1e-9), theta: 0.0, theta_dot };
                let (phase, after) = resolve(&structure.into(), 0.0, Side::Right, &before);
                assert_eq!(phase, Phase::Rocking(Side::Left));
                let gain = energy(&structure.into(), phase, &after)
                    - energy(&structure.into(), Phase::Rocking(Side::Right), &before);
                assert_eq!(gain > 0.0, can_gain, "r = {r}: {gain} J");
            }
        }
    }

    /// Below that restitution the impulse about the edge that comes down turns the other edge upwards.
    #[test]
    fn the_edge_that_lifts_off_pulls_below_the_pulling_restitution() {
        for parameters in [Parameters::EVISON, Parameters::MCMANUS] {
            let limit = pulling_restitution(OneMass::new(parameters).unwrap().base());
            for (r, pulls) in [(limit - 1e-6, true), (limit + 1e-6, false)] {
                let structure = OneMass::new(Parameters { r, ..parameters }).unwrap();
                let before = State { u: 0.0, u_dot: 0.0, theta: 0.0, theta_dot: -0.3 };
                let (phase, after) = resolve(&structure.into(), 0.0, Side::Right, &before);
                // about the right edge, which lifts off, only the impulse at the left one has a moment, 2B I_left
                let Impulse { I_v, I_m, .. } =
                    Impulse::of(&structure.into(), (Phase::Rocking(Side::Right), &before), (phase, &after));
                let right = 0.5 * (I_v + I_m / parameters.B);
                assert_eq!(right < 0.0, pulls, "r = {r}: {right}");
            }
        }
    }
}
