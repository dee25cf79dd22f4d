//! Validity at impacts, against the momenta and the kinetic energy before and after. `missed_peaks.rs` compares the motion
//! between impacts with dense sampling, and `reactions.rs` the reactions with the balance of momentum.

use crate::common::{Balance, balance, shaking, transitions_of};
use rocking::run::record::Record;
use rocking::run::validity::{ASSUMPTIONS, ENERGY, IMPACT_FRICTION, IMPACT_TENSION, Limits, TENSION, WEIGHT};
use rocking::run::{End, Run};
use rocking::{Detail, OneMass, Parameters, Phase, Side, State, Transition, TransitionKind};

/// Every level that has impacts, both specimens, stocky and slender, with little and full restitution.
fn scenes() -> Vec<(Parameters, State, Detail, Record)> {
    let (evison, mcmanus) = (Parameters::EVISON, Parameters::MCMANUS);
    let at_rest = State::default();
    let turned = State { theta: 0.03, ..State::default() };
    let elastic = Parameters { r: 1.0, zeta_fc: 0.05, ..evison };
    let dull = Parameters { r: 0.5, f_fc: 2.0, ..mcmanus };
    vec![
        (mcmanus, at_rest, Detail::Nonlinear, shaking(2, 0.01, 200, 2.0)),
        (elastic, at_rest, Detail::Auto, shaking(3, 0.02, 100, 3.0)),
        (dull, State { theta: 0.02, ..at_rest }, Detail::Auto, Record::at_rest(1.0)),
        (evison, at_rest, Detail::Linear, shaking(3, 0.02, 100, 2.5)),
        (mcmanus, at_rest, Detail::Modal, shaking(4, 0.01, 200, 2.0)),
        (mcmanus, turned, Detail::Rigid, shaking(5, 0.01, 150, 1.0)),
    ]
}

#[test]
fn impacts_go_beyond_what_momenta_say() {
    let mut tried = [0; ASSUMPTIONS.len()];
    for (i, (parameters, initial, detail, ground)) in scenes().into_iter().enumerate() {
        let structure = OneMass::new(parameters).unwrap();
        let run = Run { initial, detail, end: End::At(ground.end()), ..Run::new(structure, &ground) };
        let (found, _) = run.validity(Limits::default()).unwrap();
        let transitions = transitions_of(&run);
        // of mu_impact, tension_impact and energy_gain_max: the worst, how many are beyond the limit, the first of them
        let mut seen = [(0.0, 0.0, None), (-1.0, 0.0, None), (0.0, 0.0, None)];
        let (mut gains, mut impacts) = (0, 0);
        for Transition { time, kind, before, after } in &transitions {
            let (side, next) = match *kind {
                TransitionKind::Impact(side) => (side.opposite(), Phase::Rocking(side)),
                // where the rigid structure comes to rest nothing is left to strike
                TransitionKind::Landing if detail != Detail::Rigid => (Side::of(-before.theta_dot), Phase::FullContact),
                _ => continue,
            };
            let [before, after] = [(Phase::Rocking(side), before), (next, after)].map(|(phase, state)| {
                let Balance { right, up, turning, kinetic, .. } = balance(&parameters, phase, state);
                [right, -up, turning, kinetic]
            });
            let [I_h, I_v, I_m] = [0, 1, 2].map(|i| before[i] - after[i]);
            let gain = (after[3] - before[3]) / before[3];
            for (k, value) in [I_h.abs() / I_v, I_m.abs() / parameters.B / I_v - 1.0, gain].into_iter().enumerate() {
                let (worst, beyond, first) = &mut seen[k];
                *worst = value.max(*worst);
                let limit = (ASSUMPTIONS[IMPACT_FRICTION + k].limit)(&Limits::default());
                // the gain of an elastic impact may be 0 but for rounding
                if value > limit + 1e-12 {
                    *beyond += 1.0;
                    first.get_or_insert(*time);
                }
            }
            gains += u64::from(gain > 1e-12);
            impacts += 1;
        }
        assert_eq!((found.gains, found.impacts), (gains, impacts), "scene {i}");
        for (which, (worst, beyond, first)) in [IMPACT_FRICTION, IMPACT_TENSION, ENERGY].into_iter().zip(seen) {
            let (name, found) = (format!("scene {i}, {}", ASSUMPTIONS[which].name), found.worst[which]);
            assert!((found.value - worst).abs() < 1e-9 * (1.0 + worst.abs()), "{name}: {} {worst}", found.value);
            assert_eq!((found.beyond, found.first_beyond), (beyond, first), "{name}");
            tried[which] += usize::from(first.is_some());
        }
    }
    assert!(tried[IMPACT_FRICTION..=ENERGY].iter().all(|count| *count > 0), "{tried:?}");
}

/// A ground that accelerates upwards throughout presses the base down by more than its weight. A base that never stood has no
/// tension.
#[test]
fn the_worst_value_is_one_that_has_been() {
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    let [level, upwards] = [0.0, 2.0].map(|a| Record::from_samples("", vec![0.0, 1.0], vec![a, a]).unwrap());
    let ground = level.with_vertical(&upwards).unwrap();
    let worst = |initial, until| {
        let run = Run { initial, end: End::At(until), ..Run::new(structure, &ground) };
        run.validity(Limits::default()).unwrap().0.worst
    };
    let [standing, rocking] = [worst(State::default(), 0.5), worst(State { theta: 0.1, ..State::default() }, 0.01)];
    let weight = 1.0 + 2.0 / structure.parameters().g;
    assert_eq!([standing[WEIGHT].value, rocking[WEIGHT].value], [weight; 2]);
    assert!((standing[TENSION].value + weight).abs() < 1e-12, "{}", standing[TENSION].value);
    assert_eq!(rocking[TENSION].value, ASSUMPTIONS[TENSION].start);
}
