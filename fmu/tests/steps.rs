//! `fmi2DoStep`, the input's value and slope, the outputs' rates.

#![allow(non_snake_case)] // the names of the field

mod host;

use approx::assert_relative_eq;
use host::*;
use rocking::Ramp;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::{Engine, Outputs, Parameters, Phase, State, Structure};

fn engine(initial: State, start: f64, tolerance: f64) -> Engine {
    Engine::new(Structure::new(Parameters::EVISON).unwrap(), initial, start, tolerance).unwrap()
}

fn advance(engine: &mut Engine, interval: f64, value: f64, slope: f64) {
    engine.advance(interval, Ramp { value, slope }, &mut ()).unwrap();
}

/// Every output of the instance is, bit for bit, that of the engine.
fn assert_same(host: &Host, engine: &Engine) {
    let motion = engine.motion();
    let o = Outputs::of(engine.structure(), motion.phase, &motion.state, 0.0);
    let names = ["theta", "u", "a_t", "V_t", "M_t", "theta_dot", "u_dot", "uplift", "delta_t", "v_t"];
    let expected = [o.theta, o.u, o.a_t, o.V_t, o.M_t, o.theta_dot, o.u_dot, o.uplift, o.delta_t, o.v_t];
    assert_eq!(host.try_get(&names).unwrap(), expected);
    assert_eq!(host.integer("transitions"), motion.transitions as i32);
    assert_eq!(host.last_successful_time(), motion.time);
}

#[test]
fn the_slope_holds_for_one_step_and_its_end_value_from_then_on() {
    let host = Host::started(&[("theta_0", 0.01)]);
    let mut engine = engine(State { theta: 0.01, ..State::default() }, 0.0, DEFAULT_TOLERANCE);

    assert_eq!((host.set(&[("a_g", 2.0)]), host.set_slope("a_g", 1, 30.0)), (OK, OK));
    assert_eq!(host.step(0.0, 0.1), OK);
    advance(&mut engine, 0.1, 2.0, 30.0);
    assert_same(&host, &engine);
    assert_eq!(host.get("a_g"), 5.0);

    assert_eq!(host.step(0.1, 0.05), OK);
    advance(&mut engine, 0.05, 5.0, 0.0);
    assert_same(&host, &engine);

    // A slope may be set before the value.
    assert_eq!((host.set_slope("a_g", 1, 0.5), host.set(&[("a_g", -1.5)])), (OK, OK));
    assert_eq!(host.step(0.15, 1.0), OK);
    advance(&mut engine, 1.0, -1.5, 0.5);
    assert_same(&host, &engine);

    // A slope alone starts from the value held.
    let held = host.get("a_g");
    assert_relative_eq!(held, -1.0, max_relative = 1e-14);
    assert_eq!(host.set_slope("a_g", 1, -10.0), OK);
    assert_eq!(host.step(1.15, 0.1), OK);
    advance(&mut engine, 0.1, held, -10.0);
    assert_same(&host, &engine);
    assert!(engine.motion().transitions > 1, "the comparison saw {} transitions", engine.motion().transitions);
    assert_relative_eq!(host.get("a_g"), -2.0, max_relative = 1e-14);
}

#[test]
fn initial_values_tolerance_and_start_time_reach_the_engine() {
    let host = Host::new();
    let initial = State { u: 1e-4, u_dot: -0.02, theta: -0.03, theta_dot: 0.1 };
    let start_values = [("u_0", initial.u), ("u_dot_0", initial.u_dot), ("theta_0", initial.theta)];
    assert_eq!(host.set(&start_values), OK);
    assert_eq!(host.setup(Some(1e-4), 5.0, Some(7.0)), OK);
    assert_eq!(host.enter(), OK);
    assert_eq!(host.set(&[("theta_dot_0", initial.theta_dot)]), OK);
    assert_eq!(host.exit(), OK);
    let mut loose = engine(initial, 5.0, 1e-4);
    assert_same(&host, &loose);
    assert_eq!(host.step(5.0, 2.0), OK);
    advance(&mut loose, 2.0, 0.0, 0.0);
    assert_same(&host, &loose);
    let mut default = engine(initial, 5.0, DEFAULT_TOLERANCE);
    advance(&mut default, 2.0, 0.0, 0.0);
    assert_ne!(host.get("theta"), default.motion().state.theta, "the tolerance makes no difference");
}

#[test]
fn rates_are_those_of_the_equations_of_motion_under_the_present_input() {
    let host = Host::started(&[("theta_0", 0.05)]);
    assert_eq!((host.set(&[("a_g", 1.0)]), host.set_slope("a_g", 1, 20.0)), (OK, OK));
    assert_eq!(host.step(0.0, 0.05), OK);
    let mut engine = engine(State { theta: 0.05, ..State::default() }, 0.0, DEFAULT_TOLERANCE);
    advance(&mut engine, 0.05, 1.0, 20.0);
    for a_g in [2.0, -7.0] {
        let (rates, _) = engine.rates(Ramp { value: a_g, slope: 0.0 }.into());
        assert_eq!(host.rate("theta", 1), Ok(engine.motion().state.theta_dot));
        for (name, rate) in [
            ("theta_dot", rates.theta_dot),
            ("u_dot", rates.u_dot),
            ("a_t", rates.a_t),
            ("delta_t", rates.delta_t),
            ("v_t", rates.v_t),
        ] {
            assert_relative_eq!(host.rate(name, 1).unwrap(), rate, max_relative = 1e-13);
        }
        assert_eq!(host.set(&[("a_g", -7.0)]), OK);
    }
    let message =
        "fmi2GetRealOutputDerivatives: order = 2 for theta is out of range: only derivatives of order 1 exist";
    host.assert_refused(|| host.rate("theta", 2), Err(ERROR), message);
    for name in ["phase", "a_g", "chi", "I_v"] {
        let message =
            format!("fmi2GetRealOutputDerivatives: {name} has no derivative: only continuous real outputs have");
        host.assert_refused(|| host.rate(name, 1), Err(ERROR), &message);
    }
}

#[test]
fn a_useless_slope_is_refused() {
    let host = Host::started(&[]);
    assert_eq!((host.set(&[("a_g", 1.0)]), host.set_slope("a_g", 1, 5.0)), (OK, OK));
    for (name, order, slope, message) in [
        ("a_g", 2, 1.0, "order = 2 for a_g is out of range: only derivatives of order 1 exist"),
        ("a_g", 0, 1.0, "order = 0 for a_g is out of range: only derivatives of order 1 exist"),
        ("a_g", 1, f64::NAN, "the derivative of a_g, NaN, is out of range: it must be finite"),
        ("theta", 1, 1.0, "theta has no derivative that can be set: only the inputs have"),
    ] {
        let message = format!("fmi2SetRealInputDerivatives: {message}");
        host.assert_refused(|| host.set_slope(name, order, slope), ERROR, &message);
    }
    assert_eq!(host.set_slope("a_g", 1, 1e5), OK);
    let message = "fmi2DoStep: at the end of the step, a_g = 20001 m/s2 is out of range: it must lie between -10000 and \
                   10000 m/s2 (horizontal ground acceleration, positive to the right)";
    host.assert_refused(|| host.step(0.0, 0.2), ERROR, message);
}

#[test]
fn a_step_starts_where_the_instance_is_and_ends_before_the_stop_time() {
    let host = Host::new();
    assert_eq!(host.setup(None, 10.0, Some(12.0)), OK);
    assert_eq!((host.enter(), host.exit()), (OK, OK));
    assert_eq!(host.step(10.0, 0.5), OK);
    let wrong_point = |given: &str| {
        format!(
            "fmi2DoStep: currentCommunicationPoint = {given} s is not where the FMU is, t = 10.5 s: step from there, or \
             go back with fmi2SetFMUstate"
        )
    };
    host.assert_refused(|| host.step(10.0, 0.5), ERROR, &wrong_point("10"));
    host.assert_refused(|| host.step(10.5001, 0.5), ERROR, &wrong_point("10.5001"));
    host.assert_refused(|| host.step(f64::NAN, 0.5), ERROR, &wrong_point("NaN"));
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-16] {
        let message = format!(
            "fmi2DoStep: communicationStepSize = {step} s is out of range: it must be positive, finite, and large enough \
             to move t = 10.5 s"
        );
        host.assert_refused(|| host.step(10.5, step), ERROR, &message);
    }
    let message = "fmi2DoStep: the step would end at t = 12.1 s, past stopTime = 12 s given to fmi2SetupExperiment: \
                   shorten it";
    host.assert_refused(|| host.step(10.5, 1.6), ERROR, message);
    // Rounding is no error: neither in the point, nor at the stop time.
    assert_eq!(host.step(10.5 + 1e-9, 0.5), OK);
    assert_eq!(host.last_successful_time(), 10.5 + 1e-9 + 0.5);
    assert_eq!(host.step(11.0, 1.0 + 1e-9), OK);
}

fn started_at(start: f64, start_values: &[(&str, f64)]) -> Host {
    let host = Host::new();
    assert_eq!(host.set(start_values), OK);
    assert_eq!((host.setup(None, start, None), host.enter(), host.exit()), (OK, OK, OK));
    host
}

/// However late it is, a step is not taken from a point that is half a step away.
#[test]
fn another_time_is_refused_at_any_start_time() {
    for start in [0.0, -3.0, 1e6, 1.7e9, 1e12] {
        let host = started_at(start, &[]);
        let ulp = f64::next_up(f64::abs(start)) - f64::abs(start);
        let step = f64::max(0.01, 4.0 * ulp);
        for wrong in [1.0, 100.0, 0.75 * step, step].into_iter().flat_map(|wrong| [wrong, -wrong]) {
            assert_eq!(host.step(start + wrong, step), ERROR, "{wrong} s from {start} s with a step of {step} s");
        }
        assert_eq!(host.step(start + 2.0 * ulp, step), OK);
    }
}

/// The step is the interval: where the motion takes place in time makes no difference in any bit.
#[test]
fn the_results_are_the_same_at_every_start_time() {
    let step = 1.0 / 64.0;
    let run = |start: f64| {
        let host = started_at(start, &[("theta_0", 0.02), ("r", 0.9)]);
        let mut shown = Vec::new();
        for i in 0..200 {
            let a_g = 6.0 * (0.2 * f64::from(i)).sin();
            assert_eq!((host.set(&[("a_g", a_g)]), host.set_slope("a_g", 1, 20.0)), (OK, OK));
            assert_eq!(host.step(start + step * f64::from(i), step), OK);
            shown.extend(host.try_get(&["theta", "u", "a_t", "R_v", "a_g"]).unwrap());
        }
        assert_eq!(host.last_successful_time(), start + 200.0 * step);
        (shown, host.integer("transitions"))
    };
    let expected = run(0.0);
    assert!(expected.1 > 5, "{} transitions", expected.1);
    for start in [-1.0, 1e6, 1.7e9, 1e12] {
        assert_eq!(run(start), expected, "at {start} s");
    }
}

/// A host that multiplies is never more than a rounding from where its last step ended.
#[test]
fn a_host_that_multiplies_does_not_drift_away() {
    for (start, step) in [(0.0, 1e-3), (1.7e9, 0.01), (-1.0, 1e-3)] {
        let host = started_at(start, &[]);
        for i in 0..20_000 {
            let point = start + step * f64::from(i);
            assert_eq!(host.step(point, step), OK);
            assert_eq!(host.last_successful_time(), point + step);
        }
    }
}

/// The reaction follows the ramp to its end: the rate there is that of the ramp, until the input is set anew.
#[test]
fn rates_know_the_slope_just_followed() {
    let host = Host::started(&[]);
    let slope = 20.0;
    assert_eq!(host.set_slope("a_g", 1, slope), OK);
    assert_eq!(host.step(0.0, 0.05), OK);
    let engine_rate = |slope: f64| {
        let mut engine = engine(State::default(), 0.0, DEFAULT_TOLERANCE);
        advance(&mut engine, 0.05, 0.0, 20.0);
        engine.rates(Ramp { value: 1.0, slope }.into()).1.R_h
    };
    assert_relative_eq!(host.rate("R_h", 1).unwrap(), engine_rate(slope), max_relative = 1e-13);
    assert_ne!(engine_rate(slope), engine_rate(0.0));
    // of F_t nothing was followed, and nothing is forgotten with it
    assert_eq!(host.set(&[("F_t", 0.0)]), OK);
    assert_relative_eq!(host.rate("R_h", 1).unwrap(), engine_rate(slope), max_relative = 1e-13);
    let state = host.keep();
    assert_eq!(host.set(&[("a_g", host.get("a_g"))]), OK);
    assert_relative_eq!(host.rate("R_h", 1).unwrap(), engine_rate(0.0), max_relative = 1e-13);
    assert_eq!((host.go_back(state), host.set_slope("a_g", 1, 7.0)), (OK, OK));
    assert_relative_eq!(host.rate("R_h", 1).unwrap(), engine_rate(7.0), max_relative = 1e-13);
    // the next step holds the value, and is then what was followed
    assert_eq!((host.go_back(state), host.step(0.05, 0.01)), (OK, OK));
    assert_eq!(host.get("a_g"), 1.0);
    let rate = host.rate("R_h", 1);
    assert_eq!(host.set(&[("a_g", 1.0)]), OK);
    assert_eq!(host.rate("R_h", 1), rate);
}

/// Eq 27 with the present ground acceleration; at rest the top mass moves with the ground.
#[test]
fn rigid_outputs_are_those_of_the_present_inputs() {
    let host = Host::started(&[("detail", 5.0)]);
    for a_g in [1.5, -0.5] {
        assert_eq!(host.set(&[("a_g", a_g)]), OK);
        let m = host.get("m");
        assert_eq!(host.try_get(&["a_t", "V_t", "M_t"]), Ok(vec![a_g, m * a_g, m * host.get("H") * a_g]));
    }
}

#[test]
fn experiments_out_of_range_are_refused() {
    let host = Host::new();
    for (tolerance, start, stop, message) in [
        (Some(1.0), 0.0, None, "tolerance = 1 is out of range: it must be between 0 and 1, such as 1e-9"),
        (Some(f64::NAN), 0.0, None, "tolerance = NaN is out of range: it must be between 0 and 1, such as 1e-9"),
        (None, f64::NAN, None, "startTime = NaN is out of range: it must be finite"),
        (None, 2.0, Some(1.9), "stopTime = 1.9 is out of range: it must be finite and not before startTime = 2 s"),
    ] {
        let message = format!("fmi2SetupExperiment: {message}");
        host.assert_refused(|| host.setup(tolerance, start, stop), ERROR, &message);
    }
}

#[test]
fn overturning_discards_the_step_and_ends_the_simulation_at_its_instant() {
    let initial = State { theta: 1.5, theta_dot: 1.0, ..State::default() };
    let mut engine = engine(initial, 0.0, DEFAULT_TOLERANCE);
    advance(&mut engine, 2.0, 0.5, 0.25);
    assert!(matches!(engine.motion().phase, Phase::Overturned(_)));

    let host = Host::started(&[("theta_0", 1.5), ("theta_dot_0", 1.0)]);
    assert!(!host.is_terminated());
    assert_eq!((host.set(&[("a_g", 0.5)]), host.set_slope("a_g", 1, 0.25)), (OK, OK));
    assert_eq!(host.step(0.0, 2.0), DISCARD);
    let time = engine.motion().time;
    let log = host.log.take();
    assert_eq!(log[0].text, format!("fmi2DoStep: the structure overturned at t = {time} s; the simulation ends there"));
    assert_eq!((log.len(), log[0].status, log[0].category.as_str()), (1, DISCARD, "logStatusDiscard"));
    assert!(host.is_terminated());
    assert_same(&host, &engine);
    assert_eq!(host.get("a_g"), 0.5 + 0.25 * time);
    assert_eq!((host.integer("phase"), host.try_boolean("overturned")), (4, Ok(1)));
    assert_eq!(host.rate("theta", 1), Ok(0.0));
    let message = "fmi2DoStep: not allowed in the state \"step failed (overturned)\"; allowed in: step complete";
    host.assert_refused(|| host.step(time, 0.1), ERROR, message);
    assert_eq!(host.terminate(), OK);
    assert_eq!(host.get("theta"), engine.motion().state.theta);
}
