//! The force on the top mass, against ground motion that does the same and against its work.

use crate::common::{start, transitions};
use approx::assert_relative_eq;
use rocking::mechanics::energy::energy;
use rocking::{Detail, Engine, LinearLoad, Load, Output, Parameters, State, TransitionKind};

/// Linear between samples of `load` every 10 ms; `each` sees the engine after every one of `steps`.
fn follow(
    engine: &mut Engine,
    steps: usize,
    load: impl Fn(f64) -> Load,
    mut each: impl FnMut(&Engine, Option<TransitionKind>),
) {
    for k in 0..steps {
        let [from, to] = [k, k + 1].map(|k| k as f64 * 0.01);
        let (value, next) = (load(from), load(to));
        let slope = Load { a_g: (next.a_g - value.a_g) / 0.01, F_t: (next.F_t - value.F_t) / 0.01, a_v: 0.0 };
        let last = transitions(engine, to - engine.motion().time, LinearLoad { value, slope }).last().map(|it| it.kind);
        each(engine, last);
    }
}

/// On a foundation without mass −m a_g on the top mass is the same as a_g, at every level of detail.
#[test]
fn without_a_foundation_mass_it_is_as_good_as_ground_motion() {
    let parameters = Parameters { m0: 0.0, ..Parameters::MCMANUS };
    let a_g = |t: f64| 4.0 * (25.0 * t).sin() + 1.0 * (11.0 * t).cos();
    for detail in Detail::ALL {
        let [mut shaken, mut pushed] = [(); 2].map(|()| start(parameters, State::default(), detail));
        let mut states = Vec::new();
        follow(&mut shaken, 300, |t| Load::ground(a_g(t)), |engine, _| states.push(engine.motion().state));
        let size = states.iter().fold(0.0, |most: f64, state| most.max(state.theta.abs()).max(state.u.abs()));
        let mut expected = states.iter();
        let force = |t: f64| Load { a_g: 0.0, F_t: -parameters.m * a_g(t), a_v: 0.0 };
        follow(&mut pushed, 300, force, |engine, _| {
            let (found, expected) = (engine.motion().state, expected.next().unwrap());
            assert_relative_eq!(found.theta, expected.theta, epsilon = 1e-8 * size);
            assert_relative_eq!(found.u, expected.u, epsilon = 1e-8 * size);
        });
        assert_eq!(pushed.motion().transitions, shaken.motion().transitions);
        assert_eq!(shaken.motion().transitions > 3, detail != Detail::FixedBase, "{}", detail.name());
    }
}

/// Without damping and between transitions, energy grows by the work of the force alone: E − F_t δ_t is constant.
#[test]
fn energy_grows_by_its_work() {
    for detail in [Detail::Auto, Detail::Nonlinear] {
        let parameters = Parameters { zeta_fc: 0.0, ..Parameters::MCMANUS };
        let initial = State { u: 1e-3, u_dot: 0.1, theta: -0.01, theta_dot: 0.02 };
        let mut engine = start(parameters, initial, detail);
        let F_t = 90.0;
        let total = |engine: &Engine| {
            let motion = engine.motion();
            energy(engine.structure(), motion.phase, &motion.state)
                - F_t * engine.output(Output::delta_t(0), Load { a_g: 0.0, F_t, a_v: 0.0 })
        };
        let (mut before, mut pieces, mut moved) = (total(&engine), 0, 0.0_f64);
        follow(
            &mut engine,
            400,
            |_| Load { a_g: 0.0, F_t, a_v: 0.0 },
            |engine, transition| {
                let now = total(engine);
                if transition.is_none() {
                    assert_relative_eq!(now, before, max_relative = 1e-10);
                    pieces += 1;
                    moved = moved.max(engine.output(Output::delta_t(0), Load { a_g: 0.0, F_t, a_v: 0.0 }).abs());
                }
                before = now;
            },
        );
        assert!(pieces > 300 && engine.motion().transitions > 2 && F_t * moved > 0.5);
    }
}
