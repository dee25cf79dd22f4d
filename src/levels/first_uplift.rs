//! The first instant of a motion in full contact at which [uplift](crate::mechanics::uplift) is due.

use crate::mechanics::restraint::{holding_moment, uplift_displacement};
use crate::mechanics::uplift::{LEAST_EXCESS, TurningMoment};
use crate::series::first_crossing::{Crossing, Guard, first_time_all_closed};
use crate::series::taylor::{Arc, Series, Start, evaluate};
use crate::{Side, Structure};

/// The first instant of `arc`, a motion in full contact, at which uplift is due, and the side about which it rocks
/// from there. `turning` is that of the equations by which it will.
pub(crate) fn first_on(structure: &Structure, turning: &TurningMoment, arc: &Arc) -> (Crossing, Side) {
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

/// [`first_on`] of a restrained structure, or one shaken vertically, from `start`.
pub(crate) fn first_of_restrained(
    structure: &Structure,
    turning: &TurningMoment,
    start: &Start,
    arc: &Arc,
) -> (Crossing, Side) {
    let a_v = |k: usize| start.a_v.coefficient(k, arc.span);
    let about = |side: Side| {
        let of = |a_v: f64| {
            let held = turning.weight + holding_moment(structure, side, a_v, start.dissipators);
            (uplift_displacement(structure, side, a_v, start.dissipators), held)
        };
        let (now, at_end) = (of(a_v(0)), of(a_v(0) + a_v(1)));
        let line = |now: f64, end: f64, k: usize| [now, end - now].get(k).copied().unwrap_or(0.0);
        let s = side.sign();
        let limit = arc.series(|k| line(now.0, at_end.0, k));
        let displacement = arc.series(|k| limit[k] - s * arc.u[k]);
        let moment = arc.series(|k| {
            let lifted = a_v(0) * arc.u[k] + if k > 0 { a_v(1) * arc.u[k - 1] } else { 0.0 };
            line(now.1, at_end.1, k) - s * (turning.u * arc.u[k] + turning.u_dot * arc.u_dot[k] + lifted)
        });
        let turns = || Guard::new(arc.used(&moment), 1.0, LEAST_EXCESS * turning.weight);
        let first = |of: &Series| first_time_all_closed([Guard::new(arc.used(of), 1.0, 0.0), turns()], arc.reach);
        let (far, loose) = (first(&displacement), first(&limit));
        (if far.sigma() <= loose.sigma() { far } else { loose }, moment)
    };
    let [right, left] = [Side::Right, Side::Left].map(about);
    let sigma = right.0.sigma();
    let turns = |(_, moment): &(Crossing, Series)| evaluate(arc.used(moment), sigma);
    let is_right = match sigma == left.0.sigma() && sigma < f64::INFINITY {
        true => turns(&right) <= turns(&left),
        false => sigma <= left.0.sigma(),
    };
    if is_right { (right.0, Side::Right) } else { (left.0, Side::Left) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::full_contact;
    use crate::levels::nonlinear::accelerations;
    use crate::mechanics::load::{Load, Ramp};
    use crate::mechanics::restraint::Dissipators;
    use crate::{Parameters, State};
    use proptest::prelude::*;

    fn first_from(structure: &Structure, state: State) -> (Crossing, Side) {
        let mut arc = Arc::default();
        let a_g = Ramp::default();
        full_contact::series(
            structure,
            &Start { state, a_g, a_top: a_g, interval: 1e-9, local_error: 1e-13, ..Start::default() },
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
            let load = Load { a_g, F_t, a_v: 0.0 };
            let theta_ddot = accelerations(&structure, side, &state, load, &Dissipators::NEW).unwrap()[1];
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
            &Start { state, a_g: push, a_top: push, interval: 2e-3, local_error: 1e-15, ..Start::default() },
            &mut arc,
        );
        let (Crossing::At(sigma), Side::Right) = first_on(&structure, &TurningMoment::new(&structure), &arc) else {
            panic!("no uplift")
        };
        let there = arc.at(sigma);
        let load = Load::ground(push.value);
        let theta_ddot = accelerations(&structure, Side::Right, &there, load, &Dissipators::NEW).unwrap()[1];
        assert!(sigma * arc.span > 1e-5 && there.u > structure.u_cr);
        assert!((0.0..1e-9).contains(&theta_ddot), "{theta_ddot}");
    }
}
