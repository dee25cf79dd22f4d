//! The example's table against what its model computes.

#[path = "../examples/bouncing_ball.rs"]
#[allow(dead_code)] // main
mod bouncing_ball;

use bouncing_ball::Ball;
use fmi_unit::variables::{dependencies, position};
use fmi_unit::{Causality, DataType, Experiment, Model, Role, Step, Value};
use std::collections::BTreeSet;
use std::path::Path;

/// A change of one known changes exactly the unknowns that depend on it, by the table.
#[test]
fn derived_dependencies_are_the_true_ones() {
    let mut ball = Ball::open(Path::new("")).unwrap();
    let table = ball.variables();
    let is_known = |at: &usize| table[*at].causality == Causality::Parameter || table[*at].role == Role::State;
    let is_real = |at: &usize| matches!(table[*at].data_type, DataType::Real { .. });
    let unknowns: Vec<_> = (0..table.len() - 1).filter(|at| !is_known(at)).filter(is_real).collect();
    let show = |ball: &mut Ball| unknowns.iter().map(|at| ball.get(*at as u32).unwrap()).collect::<Vec<_>>();
    let before = show(&mut ball);
    let (mut found, mut stated) = (BTreeSet::new(), BTreeSet::new());
    for known in (0..table.len()).filter(is_known) {
        let mut changed = Ball::open(Path::new("")).unwrap();
        changed.set(known as u32, Value::Real(0.5));
        let after = show(&mut changed);
        let differ = unknowns.iter().zip(before.iter().zip(after)).filter(|(_, (before, after))| *before != after);
        found.extend(differ.map(|(unknown, _)| (*unknown, known)));
    }
    unknowns.iter().for_each(|of| stated.extend(dependencies(&table, *of, true).into_iter().map(|known| (*of, known))));
    assert_eq!(found, stated);
    assert_eq!(dependencies(&table, position(&table, "der(h)"), false), [position(&table, "v")]);
    let calculated = table.iter().filter(|variable| variable.is_initial_unknown());
    assert_eq!(calculated.map(|variable| &*variable.name).collect::<Vec<_>>(), ["der(h)", "der(v)", "bounces"]);
}

/// Directional derivatives by states come from the table and differences, and steps of any length follow one motion.
#[test]
fn what_the_model_does_not_write_follows_from_what_it_does() {
    let mut ball = Ball::open(Path::new("")).unwrap();
    let by = ball.derivatives(&[4, 6], &[(0, 2.0), (1, 3.0)], true).unwrap();
    assert!((by[0] - 3.0).abs() < 1e-6 && (by[1] - 2.0).abs() < 1e-6, "{by:?}");
    assert_eq!((ball.states().unwrap(), ball.state_rates().unwrap()), (vec![1.0, 0.0], vec![0.0, -9.81]));
    ball.set_up(&Experiment { start_time: 2.0, ..Experiment::default() });
    assert_eq!(ball.time().unwrap(), 2.0);
    let log = fmi_unit::Logger::new(Box::new(|_, _, _| ()));
    ball.start(fmi_unit::Interface::ModelExchange, &log).unwrap();
    let mut once = Ball::open(Path::new("")).unwrap();
    let mut state = Vec::new();
    ball.state(&mut state);
    once.restore(&state).unwrap();
    let step = |start, duration| Step { start, duration, stops_at_events: false };
    once.advance(step(2.0, 4.0), &log).unwrap();
    (0..400).for_each(|at| drop(ball.advance(step(2.0 + 0.01 * f64::from(at), 0.01), &log)));
    assert_eq!((ball.states().unwrap(), ball.get(7).unwrap()), (once.states().unwrap(), once.get(7).unwrap()));
}
