//! The force on the top mass, against ground motion that does the same and against free vibration.

use crate::common::start;
use crate::modes::three_storeys;
use approx::assert_relative_eq;
use rocking::run::record::Record;
use rocking::run::{End, Ending, Runs};
use rocking::{Detail, LinearLoad, Load, Modes, OneMass, Parameters, Run, Sample, State, Structure};

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

/// A constant force holds its static displacement φ F/k of each mode. Once it is released, each mode vibrates freely.
fn snaps_back<Q: Runs>(structure: &Structure, released: f64) {
    let (F_t, top) = (50.0, structure.floors().last().unwrap());
    let ground = Record::at_rest(2.0 * released).with_force(&[0.0, released], &[F_t; 2]).unwrap();
    let u = Q::each(structure, |j, mode| F_t * top.shape.numbers()[j] / mode.stiffness);
    let initial = State { u, u_dot: Q::parts(structure, 0.0), theta: 0.0, theta_dot: 0.0 };
    let (detail, tolerance, end) = (Detail::Auto, 1e-12, End::At(released + 0.5));
    let run = Run { structure: structure.clone(), ground: &ground, initial, detail, tolerance, end };
    let see = |sample: &Sample<Q>| {
        for (j, mode) in structure.modes().iter().enumerate() {
            let (omega, tau) = (mode.omega(), (sample.motion.time - released).max(0.0));
            let decay = mode.damping / (2.0 * mode.mass);
            let omega_d = (omega * omega - decay * decay).sqrt();
            let free = (-decay * tau).exp() * ((omega_d * tau).cos() + decay / omega_d * (omega_d * tau).sin());
            assert_relative_eq!(sample.motion.state.u.of(j), u.of(j) * free, epsilon = 1e-7 * u.of(j).abs());
        }
    };
    let finish = run.sample((-50..50).map(|i| released + 0.01 * f64::from(i)), see, &mut ()).unwrap();
    assert_eq!((finish.ending, finish.motion.transitions), (Ending::AtTime, 0));
}

#[test]
fn a_released_force_leaves_free_vibration() {
    for released in [0.5, 3600.0] {
        snaps_back::<f64>(&OneMass::new(Parameters::MCMANUS).unwrap().into(), released);
        snaps_back::<Modes>(&three_storeys(0.02, &[]), released);
    }
}

#[test]
fn a_force_needs_a_floor() {
    let ground = Record::at_rest(1.0).with_force(&[0.0, 1.0], &[1.0; 2]).unwrap();
    let one = Structure::from(OneMass::new(Parameters::MCMANUS).unwrap());
    let without_floors = Structure::of_body(*one.body(), one.modes(), &[]).unwrap();
    let refused = Run::of_modes(without_floors, &ground).peaks().unwrap_err().to_string();
    assert!(refused.starts_with("the force on the top floor needs a structure with floors"), "{refused}");
}
