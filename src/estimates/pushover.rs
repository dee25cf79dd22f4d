//! Displacement-controlled pushover (Fig 1): a horizontal force P on the top mass, slow enough for equilibrium.
//!
//! In full contact P = k u up to u_cr (after Eq 4). Beyond it, Eqs 5 and 6 without inertia, damping and ground motion,
//! P in the direction of each coordinate on the other side:
//!
//! ```text
//! P cos θ                        = k u − m g sin θ                                                     (5)
//! P [H cos θ + (sB − u) sin θ]   = s (m + m0) g B cos θ − m g H sin θ − m g u cos θ                    (6)
//! ```
//!
//! Without P, for s = +1, they leave a quadratic in u, whose smaller root is the equilibrium:
//!
//! ```text
//! k sin θ u² − [k (H cos θ + B sin θ) + m g] u + g B (m + m0 cos² θ) = 0
//! ```
//!
//! Ties ([`restraint`](crate::mechanics::restraint)) add their moment Σ F s l cos(θ/2) to the right side of (6), and cos θ times
//! that to the last term of the quadratic.
//!
//! The bracket of P is the height of the top mass, so that (6) is the balance of moments about the pivot. At θ → 0 the quadratic
//! gives u_cr/(1 + g/(ω_fc² H)), because u_cr leaves out the moment m g u of the top mass. The force drops by this fraction as the
//! base lifts off (2e-3 for Evison, 5e-3 for McManus).

use crate::mechanics::instant::Place;
use crate::mechanics::restraint::{Angles, Dissipators, Restraint};
use crate::numbers::Angle;
use crate::run::fall::angle_of_no_return;
use crate::series::bisection::last_where;
use crate::{OneMass, Phase, Side};
use std::f64::consts::FRAC_PI_2;

/// The structure at rest under a horizontal force on the top mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Phase: full contact, or rocking about a side.
    pub phase: Phase,
    /// Rotation of the base, rad.
    pub theta: f64,
    /// Elastic displacement, m.
    pub u: f64,
    /// Lateral displacement of the top mass, m (Eq 26).
    pub delta_t: f64,
    /// Horizontal force on the top mass, P, N.
    pub force: f64,
    /// Its moment about the base, the restoring moment, N·m.
    pub moment: f64,
}

/// Most points on each branch of a [`curve`].
pub const MOST_POINTS: u32 = 1_000_000;

/// Why there is no pushover.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PushoverError {
    /// Another number of points than a curve has.
    #[error("points = {0} is out of range: 2 to {MOST_POINTS} on each branch are possible")]
    BadPoints(u32),
    /// The strut gives way before the structure overturns.
    #[error("the strut is too soft to hold the structure all the way to overturning: raise f_fc or lower m0")]
    TooSoft,
}

/// The pushover from rest to overturning, to the right: `points` evenly over the displacements in full contact, then as many
/// while rocking.
pub fn curve(structure: &OneMass, points: u32) -> Result<Vec<Equilibrium>, PushoverError> {
    if !(2..=MOST_POINTS).contains(&points) {
        return Err(PushoverError::BadPoints(points));
    }
    let end = at_overturning(structure).ok_or(PushoverError::TooSoft)?.delta_t;
    let u_cr = structure.u_cr;
    let evenly = |from: f64, to: f64| {
        let part = move |i| f64::from(i) / f64::from(points - 1);
        (0..points).map(move |i| if i == points - 1 { to } else { from + (to - from) * part(i) })
    };
    let displacements = evenly(0.0, u_cr).chain(evenly(u_cr.next_up(), end));
    displacements.map(|delta_t| at_displacement(structure, delta_t).ok_or(PushoverError::TooSoft)).collect()
}

/// Full contact at the elastic displacement `u` (m), |u| ≤ u_cr.
pub fn in_full_contact(structure: &OneMass, u: f64) -> Equilibrium {
    let force = structure.k * u;
    let moment = structure.parameters().H * force;
    Equilibrium { phase: Phase::FullContact, theta: 0.0, u, delta_t: u, force, moment }
}

/// Rocking at the rotation `theta` (rad), |θ| < π/2; 0 is the start of rocking to the right. `None` for a strut too
/// soft to hold the structure there. The dissipators have been moved there from rest.
pub fn at_rotation(structure: &OneMass, theta: f64) -> Option<Equilibrium> {
    let &crate::Parameters { m, m0, H, B, g, .. } = structure.parameters();
    let k = structure.k;
    let side = Side::of(theta);
    let s = side.sign();
    let (sin, cos) = libm::sincos(theta.abs());
    let (quadratic, linear) = (k * sin, k * (H * cos + B * sin) + m * g);
    let dissipators = Dissipators::NEW.moved(structure.base(), side, theta);
    let held = s * Restraint::about(structure.base(), side, &dissipators).moment(&Angles::Any.chord(theta, 0.0));
    let constant = g * B * (m + m0 * cos * cos) + held * cos;
    let discriminant = linear * linear - 4.0 * quadratic * constant;
    if discriminant < 0.0 {
        return None;
    }
    let u = 2.0 * constant / (linear + discriminant.sqrt());
    let force = (k * u - m * g * sin) / cos;
    let moment = force * (H * cos + (B - u) * sin);
    let phase = Phase::Rocking(side);
    let delta_t = Place { share: 1.0, height: H, u: s * u }.right(s * B, &theta.turn());
    Some(Equilibrium { phase, theta, u: s * u, delta_t, force: s * force, moment: s * moment })
}

/// The pushover at the lateral displacement `delta_t` (m) of the top mass: full contact up to u_cr, rocking beyond.
/// `None` where rocking does not reach, B + H at most.
pub fn at_displacement(structure: &OneMass, delta_t: f64) -> Option<Equilibrium> {
    if delta_t.abs() <= structure.u_cr {
        return Some(in_full_contact(structure, delta_t));
    }
    let reaches = |theta| at_rotation(structure, theta).is_some_and(|there| there.delta_t >= delta_t.abs());
    if !reaches(FRAC_PI_2) {
        return None;
    }
    let theta = last_where(0.0, FRAC_PI_2, |theta| !reaches(theta));
    at_rotation(structure, theta.copysign(delta_t))
}

/// The unstable equilibrium without a force, beyond which the structure overturns (to the right); at π/2 of one that its
/// tendon turns back from everywhere. `None` for a strut too soft to hold the structure on the way there.
pub fn at_overturning(structure: &OneMass) -> Option<Equilibrium> {
    let farthest = angle_of_no_return(structure.base()).unwrap_or(FRAC_PI_2); // an elastic strut overturns before
    let restores = |theta| at_rotation(structure, theta).is_some_and(|there| there.force >= 0.0);
    at_rotation(structure, last_where(0.0, farthest, restores))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::State;
    use crate::levels::nonlinear::accelerations;
    use crate::mechanics::load::Load;
    use approx::assert_relative_eq;
    use nalgebra::{Matrix2, Vector2};
    use proptest::prelude::*;

    fn specimens() -> [OneMass; 2] {
        [Parameters::EVISON, Parameters::MCMANUS].map(|parameters| OneMass::new(parameters).unwrap())
    }

    #[test]
    fn more_points_than_fit_into_memory_are_refused() {
        for points in [0, 1, 2_000_000_000] {
            let refused = curve(&specimens()[0], points).unwrap_err().to_string();
            assert_eq!(refused, format!("points = {points} is out of range: 2 to 1000000 on each branch are possible"));
        }
        assert_eq!(curve(&specimens()[0], 2).unwrap().len(), 4);
    }

    #[test]
    fn the_points_of_each_branch_are_even() {
        let points = curve(&specimens()[0], 5).unwrap();
        for branch in points.chunks(5) {
            let step = (branch[4].delta_t - branch[0].delta_t) / 4.0;
            for pair in branch.windows(2) {
                assert_relative_eq!(pair[1].delta_t - pair[0].delta_t, step, max_relative = 1e-9);
            }
        }
    }

    proptest! {
        /// The force cancels the accelerations of Eqs 5 and 6.
        #[test]
        fn the_force_balances_equations_5_and_6(theta in -1.4..1.4f64, preset in 0..3usize) {
            let tied = Parameters { P_0: 300.0, k_t: 2e4, k_d: 1e5, F_y: 200.0, ..Parameters::MCMANUS };
            let [evison, mcmanus] = specimens();
            let structure = [evison, mcmanus, OneMass::new(tied).unwrap()][preset];
            let &Parameters { m, m0, H, B, J0, .. } = structure.parameters();
            let Equilibrium { u, force, .. } = at_rotation(&structure, theta).unwrap();
            let side = Side::of(theta);
            let lever = side.sign() * B - u;
            let state = State { u, theta, ..State::default() };
            let moved = Dissipators::NEW.moved(structure.base(), side, theta);
            let released = accelerations(&structure, side, &state, Load::default(), &moved).unwrap();
            let mass = Matrix2::new(m, m * H, m * H, J0 + m * H * H + m * lever * lever + m0 * B * B);
            let direction = Vector2::new(theta.cos(), H * theta.cos() + lever * theta.sin());
            let unbalanced = mass * released + force * direction;
            let size = structure.k * u.abs().max(0.1 * structure.u_cr) * H;
            prop_assert!(unbalanced.norm() < 1e-13 * size, "{unbalanced}");
        }

        #[test]
        fn a_displacement_is_met_to_rounding(delta_t in -1.3..1.3f64, preset in 0..2usize) {
            let structure = specimens()[preset];
            let there = at_displacement(&structure, delta_t).unwrap();
            prop_assert!((there.delta_t - delta_t).abs() < 1e-15, "{there:?}");
        }
    }

    #[test]
    fn uplift_follows_full_contact_with_the_drop_that_u_cr_leaves_out() {
        for structure in specimens() {
            let &Parameters { H, g, .. } = structure.parameters();
            let left_out = 1.0 + g / (structure.omega_fc * structure.omega_fc * H);
            let rocking = at_rotation(&structure, 0.0).unwrap();
            assert_relative_eq!(rocking.u, structure.u_cr / left_out, max_relative = 1e-15);
            let contact = at_displacement(&structure, structure.u_cr).unwrap();
            assert_eq!(contact.phase, Phase::FullContact);
            assert_relative_eq!(contact.force, left_out * rocking.force, max_relative = 1e-15);
            let weight_moment = structure.gamma * structure.parameters().m * g * structure.parameters().B;
            assert_relative_eq!(contact.moment, weight_moment, max_relative = 1e-15);
            let lifted = at_displacement(&structure, -structure.u_cr.next_up()).unwrap();
            assert_eq!(lifted.phase, Phase::Rocking(Side::Left));
        }
    }

    /// While rocking the force falls all the way to overturning, where the moment is 0 with it.
    #[test]
    fn the_stiffness_is_negative_until_overturning() {
        for structure in specimens() {
            let end = at_overturning(&structure).unwrap();
            let weight = structure.gamma * structure.parameters().m * structure.parameters().g;
            assert!(end.force >= 0.0 && end.force < 1e-13 * weight);
            assert_relative_eq!(end.theta, libm::atan(structure.tan_alpha_cg), max_relative = 6e-3);
            assert!(end.theta < libm::atan(structure.tan_alpha_cg));
            let forces: Vec<_> = (0..=50)
                .map(|i| at_rotation(&structure, f64::from(i) / 50.0 * end.theta).unwrap())
                .map(|there| (there.force, there.moment))
                .collect();
            assert!(forces.windows(2).all(|pair| pair[1].0 < pair[0].0 && pair[1].1 < pair[0].1));
        }
    }

    #[test]
    fn too_soft_a_strut_and_too_far_a_displacement_have_no_equilibrium() {
        let soft = OneMass::new(Parameters { f_fc: 0.05, m0: 5e4, ..Parameters::EVISON }).unwrap();
        assert_eq!(at_rotation(&soft, 0.5), None);
        assert_eq!(at_displacement(&specimens()[0], 1.4), None);
    }
}
