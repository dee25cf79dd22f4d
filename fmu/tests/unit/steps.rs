//! `fmi2DoStep`, the input's value and slope, the outputs' rates.

use crate::host::*;
use approx::assert_relative_eq;
use rocking::Ramp;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::{Engine, Load, Output, Parameters, Phase, State, Structure};

fn engine(initial: State, start: f64, tolerance: f64) -> Engine {
    Engine::new(Structure::new(Parameters::EVISON).unwrap(), initial, start, tolerance).unwrap()
}

fn advance(engine: &mut Engine, interval: f64, value: f64, slope: f64) {
    engine.advance(interval, Ramp { value, slope }, &mut ()).unwrap();
}

/// Every output of the instance is, bit for bit, that of the engine.
fn assert_same(host: &Host, engine: &Engine) {
    let motion = engine.motion();
    let outputs = Output::all(engine.structure());
    let names = Vec::from_iter(outputs.iter().map(|output| output.symbol()));
    let expected = Vec::from_iter(outputs.iter().copied().map(engine.outputs(Load::default())));
    assert_eq!(host.try_get(&names).unwrap(), expected);
    assert_eq!(host.integer("transitions"), motion.transitions as i32);
    assert_eq!(host.last_successful_time(), motion.time);
}

#[test]
fn the_slope_holds_for_one_step_and_its_end_value_from_then_on() {
    let host = Host::started(&[("theta_0", 0.01)]);
    let mut engine = engine(State { theta: 0.01, ..State::default() }, 0.0, DEFAULT_TOLERANCE);

    // a slope may be set before the value; alone it starts from the value held
    let mut time = 0.0;
    for (value, slope, step, line) in [
        (Some(2.0), Some(30.0), 0.1, (2.0, 30.0)),
        (None, None, 0.05, (5.0, 0.0)),
        (Some(-1.5), Some(0.5), 1.0, (-1.5, 0.5)),
        (None, Some(-10.0), 0.1, (-1.0, -10.0)),
    ] {
        let held = value.unwrap_or(host.get("a_g"));
        assert_relative_eq!(held, line.0, max_relative = 1e-14);
        slope.into_iter().for_each(|slope| assert_eq!(host.set_slope("a_g", 1, slope), OK));
        value.into_iter().for_each(|value| assert_eq!(host.set(&[("a_g", value)]), OK));
        assert_eq!(host.step(time, step), OK);
        advance(&mut engine, step, held, line.1);
        assert_same(&host, &engine);
        time += step;
    }
    assert!(engine.motion().transitions > 1, "the comparison saw {} transitions", engine.motion().transitions);
    assert_relative_eq!(host.get("a_g"), -2.0, max_relative = 1e-14);
}

#[test]
fn rates_are_those_of_the_equations_of_motion_under_the_present_input() {
    let host = Host::started(&[("theta_0", 0.05)]);
    assert_eq!((host.set(&[("a_g", 1.0)]), host.set_slope("a_g", 1, 20.0)), (OK, OK));
    assert_eq!(host.step(0.0, 0.05), OK);
    let mut engine = engine(State { theta: 0.05, ..State::default() }, 0.0, DEFAULT_TOLERANCE);
    advance(&mut engine, 0.05, 1.0, 20.0);
    for a_g in [2.0, -7.0] {
        let rates = engine.rates(Ramp { value: a_g, slope: 0.0 }.into());
        assert_eq!(host.rate("theta", 1), Ok(engine.motion().state.theta_dot));
        for (name, rate) in [
            ("theta_dot", rates.of(Output::theta_dot)),
            ("u_dot", rates.of(Output::u_dot(0))),
            ("a_t", rates.of(Output::a_t(0))),
            ("delta_t", rates.of(Output::delta_t(0))),
            ("v_t", rates.of(Output::v_t(0))),
        ] {
            assert_relative_eq!(host.rate(name, 1).unwrap(), rate, max_relative = 1e-13);
        }
        assert_eq!(host.set(&[("a_g", -7.0)]), OK);
    }
}

/// Beside what a tiny step changes.
#[test]
fn restraints_have_rates() {
    let restraints = [("P_0", 200.0), ("k_t", 1e5), ("xi_d", 0.2), ("c_d", 50.0), ("k_d", 1e6), ("F_y", 1e3)];
    let host = Host::started(&[&[("theta_0", 0.02), ("theta_dot_0", -0.3)], &restraints[..]].concat());
    let names = ["P_t", "F_d1", "F_d2"];
    let (before, rates) = (host.try_get(&names).unwrap(), names.map(|name| host.rate(name, 1).unwrap()));
    assert_eq!(host.step(0.0, 1e-8), OK);
    for (at, after) in host.try_get(&names).unwrap().into_iter().enumerate() {
        assert_relative_eq!(rates[at], (after - before[at]) / 1e-8, max_relative = 1e-4);
    }
}

/// The step is the interval: where the motion takes place in time makes no difference in any bit. A host that multiplies
/// is never more than a rounding away, and nothing else but that is taken for rounding.
#[test]
fn the_results_are_the_same_at_every_start_time() {
    const STEPS: u32 = 2000;
    let run = |start: f64| {
        let host = Host::new();
        assert_eq!(host.set(&[("theta_0", 0.02), ("r", 0.9)]), OK);
        let last = start + 0.01 * f64::from(STEPS);
        host.begin(None, start, Some(last));
        let mut shown = Vec::new();
        for i in 0..STEPS {
            let a_g = 6.0 * (0.2 * f64::from(i)).sin();
            assert_eq!((host.set(&[("a_g", a_g)]), host.set_slope("a_g", 1, 20.0)), (OK, OK));
            let point = start + 0.01 * f64::from(i);
            for wrong in [1.0, 100.0, 0.0075, 0.01].into_iter().flat_map(|wrong| [wrong, -wrong]) {
                assert_eq!(host.step(point + wrong, 0.01), ERROR, "{wrong} s from {point} s");
            }
            assert_eq!(host.step(point, 0.01), OK);
            assert_eq!(host.last_successful_time(), point + 0.01);
            shown.extend(host.try_get(&["theta", "u", "a_t", "R_v", "a_g"]).unwrap());
        }
        (shown, host.integer("transitions"))
    };
    let expected = run(0.0);
    assert!(expected.1 > 5, "{} transitions", expected.1);
    for start in [-1.0, 10.5 + 1e-9, 1e6, 1.7e9, 1e12] {
        assert_eq!(run(start), expected, "at {start} s");
    }
}

/// A host that adds its steps up is off by many roundings.
#[test]
fn a_point_and_the_stop_time_are_met_but_for_rounding() {
    let host = Host::new();
    host.begin(None, 10.0, Some(12.0));
    assert_eq!((host.step(10.0 + 1e-9, 0.5), host.last_successful_time()), (OK, 10.0 + 1e-9 + 0.5));
    assert_eq!(host.step(10.5, 1.5 + 1e-9), OK);
    let (late, start) = (Host::new(), 1e12_f64);
    late.begin(None, start, None);
    let rounding = start.next_up() - start;
    assert_eq!(late.step(start + 2.0 * rounding, 2.0 * rounding), ERROR, "a step would be missed");
    let last = Host::new();
    last.begin(None, 1.7e308, None);
    last.assert_refused(|| last.step(1.7e308, 1.7e308), ERROR, "communicationStepSize = 1.7e308 s is out of range");
}

/// A host may keep its clock as a float32, as game engines do: a step ends at its point plus its duration all the same.
#[test]
fn a_clock_of_single_precision_loses_no_time() {
    let host = Host::started(&[("theta_0", 0.02)]);
    assert_eq!((host.step(0.0, 0.01), host.step(0.01 + 2e-6, 0.01)), (OK, OK));
    assert_eq!(host.last_successful_time(), 0.01 + 2e-6 + 0.01);
    let clock = |frame: u32| 500.0 + f64::from(frame) / 60.0;
    let single = |time: f64| f64::from(time as f32);
    let from_start = || {
        let host = Host::new();
        assert_eq!(host.set(&[("theta_0", 0.02)]), OK);
        host.begin(None, 500.0, None);
        host
    };
    let (host, once) = (from_start(), from_start());
    for frame in 0..60 {
        let (point, step) = (single(clock(frame)), single(clock(frame + 1) - clock(frame)));
        assert_eq!((host.step(point, step), host.last_successful_time()), (OK, point + step));
    }
    assert_eq!(once.step(500.0, host.last_successful_time() - 500.0), OK);
    assert!(once.integer("transitions") > 3);
    assert_relative_eq!(host.get("theta"), once.get("theta"), max_relative = 1e-8);
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
        engine.rates(Ramp { value: 1.0, slope }.into()).reactions().R_h
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
    let message = "fmi2DoStep: not allowed in the state \"step failed\"; allowed in: step complete";
    host.assert_refused(|| host.step(time, 0.1), ERROR, message);
    assert_eq!(host.terminate(), OK);
    assert_eq!(host.get("theta"), engine.motion().state.theta);
}
