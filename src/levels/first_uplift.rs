//! The first instant of a motion in full contact at which [uplift](crate::mechanics::uplift) is due.

use crate::mechanics::restraint::Restraint;
use crate::mechanics::uplift::{self, LEAST_EXCESS, TurningMoment};
use crate::series::first_crossing::{Crossing, Gap, first_time_all_closed};
use crate::series::taylor::{Arc, Series, Start};
use crate::{Side, Structure};

/// The first instant of `arc`, a motion in full contact from `start`, at which uplift is due, and the side about which the
/// structure rocks from there. `turning` is that of the equations by which it will.
pub(crate) fn first(structure: &Structure, turning: &TurningMoment, start: &Start, arc: &Arc) -> (Crossing, Side) {
    let right = first_about(structure, turning, start, arc, Side::Right);
    let left = first_about(structure, turning, start, arc, Side::Left);
    sooner(right, left, |sigma| {
        let (state, a_v) = (arc.at(sigma), start.a_v.at(sigma * arc.span));
        uplift::margin(structure, turning, &state, a_v, start.dissipators).1
    })
}

/// The sooner of the uplifts about the `right` and the `left` side, and its side. If both come at the same σ, `both` gives the side.
#[inline(always)]
pub(crate) fn sooner(right: Crossing, left: Crossing, both: impl FnOnce(f64) -> Side) -> (Crossing, Side) {
    if right.sigma() == left.sigma() && right.sigma() < f64::INFINITY {
        return (right, both(right.sigma()));
    }
    if right.sigma() <= left.sigma() { (right, Side::Right) } else { (left, Side::Left) }
}

/// The first σ at which uplift is due: the gap of the `rule` and the gap of the moment that `turns` the base are closed. The right
/// side of the rule has the coefficients `limit`. Where this side is not above 0, nothing holds the base, and the moment decides alone.
#[inline(always)]
pub(crate) fn first_due(rule: Gap, turns: Gap, is_held: bool, limit: [f64; 2], reach: f64) -> Crossing {
    let far = first_time_all_closed([rule, turns], reach);
    if is_held {
        return far;
    }
    let loose = first_time_all_closed([Gap::new(&limit, 1.0, 0.0), turns], reach);
    if far.sigma() <= loose.sigma() { far } else { loose }
}

fn first_about(structure: &Structure, turning: &TurningMoment, start: &Start, arc: &Arc, side: Side) -> Crossing {
    let s = side.sign();
    let [a_v, a_v_change] = [0, 1].map(|k| start.a_v.coefficient(k, arc.span));
    let restraint = Restraint::about(structure, side, start.dissipators);
    let hold = restraint.hold(a_v);
    let end = if a_v_change == 0.0 { hold } else { restraint.hold(a_v + a_v_change) };
    let [rise, gain] = [end.displacement - hold.displacement, end.moment - hold.moment];
    let moving = a_v_change != 0.0;
    let mut risen;
    let mut displacement = &arc.u;
    if moving {
        risen = arc.u;
        risen[1] -= s * rise;
        displacement = &risen;
    }
    let displacement = Gap::new(arc.used(displacement), -s, hold.displacement);
    let is_held = hold.displacement.min(end.displacement) > 0.0;
    if is_held && displacement.is_open_throughout(arc.reach) {
        return Crossing::None;
    }
    let mut moment: Series = arc.u;
    for (k, coefficient) in moment[..=arc.order].iter_mut().enumerate() {
        *coefficient = turning.at(arc.u[k], arc.u_dot[k], a_v);
        if moving && k > 0 {
            *coefficient += a_v_change * arc.u[k - 1] - if k == 1 { s * gain } else { 0.0 };
        }
    }
    let moment = Gap::new(arc.used(&moment), -s, (1.0 + LEAST_EXCESS) * turning.weight + hold.moment);
    let limit = [hold.displacement, if moving { rise } else { 0.0 }];
    first_due(displacement, moment, is_held, limit, arc.reach)
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
        let start = Start { state, a_g, a_top: a_g, interval: 1e-9, local_error: 1e-13, ..Start::default() };
        full_contact::series(structure, &start, &mut arc);
        first(structure, &TurningMoment::new(structure), &start, &arc)
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
        let start = Start { state, a_g: push, a_top: push, interval: 2e-3, local_error: 1e-15, ..Start::default() };
        full_contact::series(&structure, &start, &mut arc);
        let (Crossing::At(sigma), Side::Right) = first(&structure, &TurningMoment::new(&structure), &start, &arc)
        else {
            panic!("no uplift")
        };
        let there = arc.at(sigma);
        let load = Load::ground(push.value);
        let theta_ddot = accelerations(&structure, Side::Right, &there, load, &Dissipators::NEW).unwrap()[1];
        assert!(sigma * arc.span > 1e-5 && there.u > structure.u_cr);
        assert!((0.0..1e-9).contains(&theta_ddot), "{theta_ddot}");
    }
}
