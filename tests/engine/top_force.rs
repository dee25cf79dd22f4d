//! The force on the top mass, against ground motion that does the same.

use crate::common::start;
use approx::assert_relative_eq;
use rocking::{Detail, LinearLoad, Load, Parameters, State};

/// On a foundation without mass −m a_g on the top mass is the same as a_g, at every level of detail.
#[test]
fn without_a_foundation_mass_it_is_as_good_as_ground_motion() {
    let parameters = Parameters { m0: 0.0, ..Parameters::MCMANUS };
    let a_g = |t: f64| 4.0 * (25.0 * t).sin() + 1.0 * (11.0 * t).cos();
    for detail in Detail::ALL {
        let follow = |load: fn(f64) -> Load| {
            let mut engine = start(parameters, State::default(), detail);
            let states = Vec::from_iter((0..300).map(|k| {
                let [from, to] = [k, k + 1].map(|k| f64::from(k) * 0.01);
                let [value, slope] = [a_g(from), (a_g(to) - a_g(from)) / 0.01].map(load);
                engine.advance(to - engine.motion().time, LinearLoad { value, slope }, &mut ()).unwrap();
                engine.motion().state
            }));
            (states, engine.motion().transitions)
        };
        let (shaken, pushed) =
            (follow(Load::ground), follow(|a_g| Load { F_t: -Parameters::MCMANUS.m * a_g, ..Load::default() }));
        let size = shaken.0.iter().fold(0.0, |most: f64, state| most.max(state.theta.abs()).max(state.u.abs()));
        for (found, expected) in pushed.0.iter().zip(&shaken.0) {
            assert_relative_eq!(found.theta, expected.theta, epsilon = 1e-8 * size);
            assert_relative_eq!(found.u, expected.u, epsilon = 1e-8 * size);
        }
        assert_eq!(pushed.1, shaken.1);
        assert_eq!(shaken.1 > 3, detail != Detail::FixedBase, "{}", detail.name());
    }
}
