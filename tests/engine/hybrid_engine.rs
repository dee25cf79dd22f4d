//! The engine from outside: advances that end at transitions, overturning.

use approx::assert_abs_diff_eq;
use rocking::engine::{DEFAULT_TOLERANCE, Settings};
use rocking::{Engine, Motion, OneMass, Parameters, Phase, Progress, Ramp, Side, State, Transition, TransitionKind};
use std::f64::consts::FRAC_PI_2;

const STILL: Ramp = Ramp { value: 0.0, slope: 0.0 };

/// Advances and collects the transitions.
fn advance(engine: &mut Engine, until: f64, a_g: Ramp) -> Vec<Transition> {
    let mut transitions = Vec::new();
    engine
        .advance(until - engine.motion().time, a_g, &mut |transition: &Transition| transitions.push(*transition))
        .unwrap();
    transitions
}

/// Advances that end at transitions meet the transitions of one long advance, each before it is applied: the last state of
/// rocking is on the ground, and the last state of full contact at the limit of uplift.
#[test]
fn an_advance_can_end_at_every_transition() {
    let structure = OneMass::new(Parameters { r: 0.85, ..Parameters::EVISON }).unwrap();
    let released = State { theta: 0.01, ..State::default() };
    let new = |stops| Engine::with(structure, released, 0.0, Settings { stops, ..Settings::default() }).unwrap();
    let (mut through, mut to_each) = (new(false), new(true));
    let expected = advance(&mut through, 1.0, STILL);
    let mut transitions = Vec::new();
    while to_each.motion().time < 1.0 {
        let due = to_each.advance(1.0 - to_each.motion().time, STILL, &mut ()).unwrap() == Progress::Transition;
        let Motion { phase, state, .. } = *to_each.motion();
        assert_eq!(to_each.motion().is_transition_due(), due);
        if due {
            let met = if phase == Phase::FullContact { state.u.abs() - structure.u_cr } else { state.theta };
            assert!(met.abs() < 1e-14 || phase == Phase::FullContact && met > 0.0, "{phase:?} {state:?}");
            to_each.transit(&mut |transition: &Transition| transitions.push(*transition));
            assert_ne!(to_each.motion().phase, phase);
        }
    }
    assert!(expected.len() > 10);
    assert_eq!(transitions.len(), expected.len());
    for (transition, expected) in transitions.iter().zip(&expected) {
        assert_eq!(transition.kind, expected.kind);
        assert_abs_diff_eq!(transition.time, expected.time, epsilon = 1e-10);
        assert_abs_diff_eq!(transition.after.u_dot, expected.after.u_dot, epsilon = 1e-8);
    }
    // what is due is applied by the next advance if nobody has
    let mut left = new(true);
    while left.motion().time < 1.0 {
        left.advance(1.0 - left.motion().time, STILL, &mut ()).unwrap();
    }
    assert_eq!(left.motion().state, to_each.motion().state);
}

#[test]
fn a_tall_push_overturns_at_a_right_angle_and_stays_there() {
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    let mut engine = Engine::new(structure, State::default(), 10.0, DEFAULT_TOLERANCE).unwrap();
    let push = Ramp { value: -6.0, slope: 0.0 };
    let mut last = None;
    let progress = engine.advance(20.0, push, &mut |transition: &Transition| last = Some(*transition)).unwrap();
    assert_eq!(progress, Progress::Overturned);
    let end = *engine.motion();
    assert_eq!(last.unwrap().kind, TransitionKind::Overturning(Side::Right));
    assert_abs_diff_eq!(end.state.theta, FRAC_PI_2, epsilon = 1e-14);
    assert!(end.time > 10.0 && end.time < 20.0);
    assert_eq!(engine.advance(30.0, STILL, &mut ()).unwrap(), Progress::Overturned);
    assert_eq!(*engine.motion(), end);
}
