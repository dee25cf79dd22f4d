//! Uplift: full contact → rocking.
//!
//! With s = sign(u), the base lifts off at the first instant at which
//!
//! ```text
//! s u ≥ u_cr      and      s θ̈ > 0,   θ̈ by (5, 6) at θ = θ̇ = 0
//! ```
//!
//! There the equations leave [(J0 + m0 B²)/m + (sB − u)²] θ̈ = H (c_u u̇ + k u)/m + g u − sγ g B, whatever a_g and F_t
//! are: the second condition is that the moment which turns the structure about the pivot exceeds that of its weight.
//! While |u| grows through u_cr it always does; after a landing with |u| > u_cr it may not, and leaving it out makes
//! contact open and shut without end. "> 0" is taken as more than 1e-12 of the weight's moment, far above rounding.

use crate::first_crossing::{Crossing, Guard, first_time_all_closed};
use crate::taylor::{Arc, Series};
use crate::{Side, State, Structure};

/// Smallest excess of the turning moment over the weight's, as a part of the latter: far above rounding, so that what
/// has lifted off moves away from the ground.
pub(crate) const LEAST_EXCESS: f64 = 1e-12;

/// The sign of s θ̈ at θ = θ̇ = 0 is that of s (u·`u` + u̇·`u_dot`) − `weight`.
#[derive(Clone, Copy, Debug)]
pub struct TurningMoment {
    /// Moment per displacement.
    pub u: f64,
    /// Moment per velocity.
    pub u_dot: f64,
    /// Moment of the weight.
    pub weight: f64,
}

impl TurningMoment {
    /// By Eqs 5 and 6: over m, H (c_u u̇ + k u)/m + g u against γ g B.
    pub fn new(structure: &Structure) -> TurningMoment {
        let &crate::Parameters { H, B, g, .. } = structure.parameters();
        let &Structure { stiffness, damping_u, gamma, .. } = structure;
        TurningMoment { u: H * stiffness + g, u_dot: H * damping_u, weight: gamma * g * B }
    }
}

/// How far a structure in full contact in `state` is from uplift, in parts of u_cr or of the moment of the weight, whichever
/// lacks more, and the side that lacks less. Uplift is due where it is not positive.
pub fn margin(structure: &Structure, turning: &TurningMoment, state: &State) -> (f64, Side) {
    let displacement = state.u / structure.u_cr;
    let moment = (turning.u * state.u + turning.u_dot * state.u_dot) / turning.weight;
    let about = |side: Side| (1.0 - side.sign() * displacement).max(1.0 + LEAST_EXCESS - side.sign() * moment);
    let (right, left) = (about(Side::Right), about(Side::Left));
    if right <= left { (right, Side::Right) } else { (left, Side::Left) }
}

/// The first instant of `arc`, a motion in full contact, at which uplift is due, and the side about which it rocks
/// from there. `turning` is that of the equations by which it will.
pub fn first_on(structure: &Structure, turning: &TurningMoment, arc: &Arc) -> (Crossing, Side) {
    let right = first_about(structure, turning, arc, Side::Right);
    let left = first_about(structure, turning, arc, Side::Left);
    if right.sigma() <= left.sigma() { (right, Side::Right) } else { (left, Side::Left) }
}

fn first_about(structure: &Structure, turning: &TurningMoment, arc: &Arc, side: Side) -> Crossing {
    let s = side.sign();
    let u = arc.used(&arc.u);
    let displacement = Guard::new(u, -s, structure.u_cr);
    if displacement.is_open_throughout(arc.reach) {
        return Crossing::None;
    }
    let mut moment: Series = arc.u;
    for (k, coefficient) in moment[..=arc.order].iter_mut().enumerate() {
        *coefficient = turning.u * arc.u[k] + turning.u_dot * arc.u_dot[k];
    }
    let moment = Guard::new(arc.used(&moment), -s, (1.0 + LEAST_EXCESS) * turning.weight);
    first_time_all_closed([displacement, moment], arc.reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{Load, Ramp};
    use crate::nonlinear_rocking::accelerations;
    use crate::taylor::Start;
    use crate::{Parameters, full_contact};
    use proptest::prelude::*;

    fn first_from(structure: &Structure, state: State) -> (Crossing, Side) {
        let mut arc = Arc::default();
        let a_g = Ramp::default();
        full_contact::series(
            structure,
            &Start { state, a_g, a_top: a_g, interval: 1e-9, local_error: 1e-13 },
            &mut arc,
        );
        first_on(structure, &TurningMoment::new(structure), &arc)
    }

    proptest! {
        /// The condition on the moment is the condition s θ̈ > 0 of Eqs 5 and 6, for every load.
        #[test]
        fn the_moment_condition_is_that_of_equations_5_and_6(
            u in -0.02..0.02f64, u_dot in -3.0..3.0f64, a_g in -20.0..20.0f64, F_t in -3e3..3e3f64,
        ) {
            let structure = Structure::new(Parameters { zeta_fc: 0.1, ..Parameters::MCMANUS }).unwrap();
            let state = State { u, u_dot, ..State::default() };
            let side = Side::of(u);
            let theta_ddot = accelerations(&structure, side, &state, Load { a_g, F_t }).unwrap()[1];
            prop_assume!(theta_ddot.abs() > 1e-6 && (u.abs() - structure.u_cr).abs() > 1e-8);
            let both = u.abs() >= structure.u_cr && side.sign() * theta_ddot > 0.0;
            let expected = if both { (Crossing::At(0.0), side) } else { (Crossing::None, Side::Right) };
            prop_assert_eq!(first_from(&structure, state), expected);
        }
    }

    #[test]
    fn a_displacement_that_reaches_u_cr_lifts_off() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let at_rest = |factor: f64| State { u: factor * structure.u_cr, ..State::default() };
        assert_eq!(first_from(&structure, at_rest(1.0)), (Crossing::At(0.0), Side::Right));
        assert_eq!(first_from(&structure, at_rest(-1.0)), (Crossing::At(0.0), Side::Left));
        assert_eq!(first_from(&structure, at_rest(1.0 - 1e-12)).0, Crossing::None);
    }

    /// After a landing with u > u_cr and a velocity whose damping force holds the base down, contact lasts until the
    /// moment of the weight is overcome.
    #[test]
    fn a_landing_beyond_u_cr_waits_for_the_moment() {
        let structure = Structure::new(Parameters { zeta_fc: 0.2, ..Parameters::EVISON }).unwrap();
        let state = State { u: 1.05 * structure.u_cr, u_dot: -0.02, ..State::default() };
        let push = Ramp { value: -40.0, slope: 0.0 }; // turns the velocity round
        let mut arc = Arc::default();
        full_contact::series(
            &structure,
            &Start { state, a_g: push, a_top: push, interval: 2e-3, local_error: 1e-15 },
            &mut arc,
        );
        let (Crossing::At(sigma), Side::Right) = first_on(&structure, &TurningMoment::new(&structure), &arc) else {
            panic!("no uplift")
        };
        let there = arc.at(sigma);
        let theta_ddot = accelerations(&structure, Side::Right, &there, Load::ground(push.value)).unwrap()[1];
        assert!(sigma * arc.span > 1e-5 && there.u > structure.u_cr);
        assert!((0.0..1e-9).contains(&theta_ddot), "{theta_ddot}");
    }
}
