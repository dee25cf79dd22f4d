//! The engine from outside: advances that end at transitions.

use approx::assert_abs_diff_eq;
use rocking::engine::Settings;
use rocking::{Engine, Motion, OneMass, Parameters, Phase, Progress, Ramp, State, Transition};

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
