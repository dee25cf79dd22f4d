//! The FMU under an integrator of the host's.

use crate::host::*;
use approx::assert_relative_eq;

const PHASE_IN_CONTACT: i32 = 1;

/// An input that the host changes while it integrates acts at each trial as it is set; one that jumps, from the event on.
#[test]
fn inputs_act_as_they_are_set() {
    let host = Host::going_model(&[]);
    assert_eq!(host.derivatives(), Ok(vec![0.0; 4]));
    assert_eq!(host.set(&[("a_g", 2.0)]), OK);
    assert_eq!(host.derivatives(), Ok(vec![0.0, -2.0, 0.0, 0.0]));
    assert_eq!(host.get("der(u_dot)"), -2.0);
    // a push that would lift the structure in 10 ms, had it acted before the event
    let host = Host::going_model(&[("zeta_fc", 0.0)]);
    assert_eq!((host.set_time(0.02), host.complete()), (OK, Ok((false, false))));
    assert_eq!((host.set_time(0.04), host.enter_event_mode()), (OK, OK));
    assert_eq!(host.set(&[("a_g", 50.0)]), OK);
    assert!(!host.update().unwrap().has_new_states);
    assert_eq!((host.states(), host.integer("phase")), (Ok(vec![0.0; 4]), PHASE_IN_CONTACT));
}

/// While a host integrates it can set a state by its name, too; at an event, which puts the states right, it cannot.
#[test]
fn a_state_can_be_set_as_a_variable() {
    let starts = [("theta_0", 0.02)];
    let (by_name, at_once) = (Host::going_model(&starts), Host::going_model(&starts));
    assert_eq!(by_name.set(&[("theta", 0.015), ("u_dot", -0.1), ("a_g", 1.0), ("u", 2e-4)]), OK);
    assert_eq!((at_once.set_states(&[2e-4, -0.1, 0.015, 0.0]), at_once.set(&[("a_g", 1.0)])), (OK, OK));
    assert_eq!(by_name.bytes(), at_once.bytes());
    let before = by_name.bytes();
    assert_eq!(by_name.set(&[("u", 1e-3), ("theta", f64::NAN)]), DISCARD);
    assert_eq!(
        by_name.log.take()[0].text,
        "fmi2SetReal: theta = NaN is out of range: a state must be finite; take a shorter step"
    );
    assert_eq!(by_name.bytes(), before, "all of the values or none");
    let modal = Host::going_model(&[("theta_0", 0.02), ("detail", 4.0)]);
    modal.assert_refused(
        || modal.set(&[("theta", 0.015), ("a_v", 1.0)]),
        ERROR,
        "fmi2SetReal: detail = modal has no modes",
    );
    assert_eq!(by_name.enter_event_mode(), OK);
    let refusal = "fmi2SetReal: theta cannot be set: it is an output, computed by the FMU";
    by_name.assert_refused(|| by_name.set(&[("theta", 0.01)]), ERROR, refusal);
}

/// A host that never looks at an indicator, nor at the states, has the floor under it all the same.
#[test]
fn a_step_over_an_impact_is_put_right() {
    let host = Host::going_model(&[("theta_0", 0.02)]);
    assert_eq!(host.set_debug_logging(true, &[]), OK);
    let before = host.states().unwrap();
    assert_eq!(host.set_time(0.5), OK);
    assert_eq!(host.complete(), Ok((true, false)));
    assert_eq!(host.states(), Ok(before), "the host's states are its own until the event is dealt with");
    assert_eq!(host.enter_event_mode(), OK);
    let info = host.update().unwrap();
    assert_eq!((info.has_new_states, info.has_ended), (true, false));
    let slave = Host::started(&[("theta_0", 0.02)]);
    assert_eq!(slave.step(0.0, 0.5), OK);
    assert_eq!(host.states().unwrap(), ["u", "u_dot", "theta", "theta_dot"].map(|name| slave.get(name)));
    assert_eq!(host.integer("transitions"), slave.integer("transitions"));
    let log = host.log.take();
    assert_eq!(log.len(), 1 + slave.integer("transitions") as usize);
    let told = &log.last().unwrap().text;
    assert!(told.starts_with("t = 0.5 s: the integrator's step from t = 0 s shows nothing of impact left, "), "{told}");
    assert!(log.iter().all(|message| message.category == "logEvents"));
}

/// After an uplift θ is exactly 0 and grows as t³: neither is that a root, nor is a return within the step missed.
#[test]
fn no_indicator_is_zero_where_integration_starts() {
    let host = Host::new_model().initialized(&[("u_0", 8e-4)]);
    assert_eq!(host.exit(), OK);
    let info = host.update().unwrap();
    assert_eq!((host.integer("transitions"), info.has_new_states), (1, false));
    assert_eq!(host.states().unwrap()[2], 0.0);
    let variables = host.try_get(&["phase_indicator", "overturning_indicator"]).unwrap();
    assert_eq!(host.indicators().unwrap().to_vec(), variables);
    assert!(host.indicators().unwrap().iter().all(|indicator| *indicator > 0.0));
    // the free edge rises as the base turns on, to either side, of which the other is none
    let by_theta = |host: &Host| host.derivative("uplift", "theta");
    let other_side = Host::new_model().initialized(&[("u_0", -8e-4)]);
    assert_eq!((other_side.exit(), other_side.update().is_ok()), (OK, true));
    for (host, phase) in [(&host, 3), (&other_side, 2)] {
        let sign = f64::from(2 * phase - 5);
        assert_eq!(host.integer("phase"), phase);
        assert_relative_eq!(by_theta(host), sign * 2.0 * host.get("B"), max_relative = 1e-6);
    }
}

#[test]
fn overturning_ends_the_simulation() {
    let host = Host::going_model(&[("theta_0", 1.5), ("theta_dot_0", 1.0)]);
    assert_eq!(host.set_time(1.0), OK);
    assert_eq!(host.complete(), Ok((true, false)));
    assert_eq!(host.enter_event_mode(), OK);
    assert!(host.update().unwrap().has_ended);
    let slave = Host::started(&[("theta_0", 1.5), ("theta_dot_0", 1.0)]);
    assert_eq!(slave.step(0.0, 1.0), DISCARD);
    assert_eq!(host.try_boolean("overturned"), Ok(1));
    assert_eq!(host.get("t_overturned"), slave.get("t_overturned"));
    assert_eq!(host.get("theta"), slave.get("theta"));
    assert_eq!((host.go_on(), host.set_time(2.0), host.complete()), (OK, OK, Ok((false, true))));
    assert_eq!(host.get("t_overturned"), slave.get("t_overturned"));
    assert_eq!(host.derivatives(), Ok(vec![0.0; 4]));
    assert_eq!((host.set_time(0.0), host.complete()), (OK, Ok((false, true))), "no step is checked any more");
}

/// The record acts at every trial time as it is there; where it jumps is foreseen, and a kink by hosts to which it matters.
#[test]
fn the_record_acts_at_every_instant_and_its_jumps_are_foreseen() {
    let pushed = |tolerance: f64| {
        let host = Host::new_model();
        host.write("push.csv", "t (s),a\n0,0.5\n1,0.25\n2,1\n");
        assert_eq!((host.set_record("push.csv"), host.set(&[("record_start", 0.5)])), (OK, OK));
        host.begin(Some(tolerance), 10.0, None);
        host
    };
    let updates = |host: &Host| {
        let update = |time: f64| {
            assert_eq!(host.set_time(time), OK);
            host.update().unwrap().next_event
        };
        [10.0, 10.5, 11.0, 12.5].map(update)
    };
    assert_eq!(updates(&pushed(1e-9)), [Some(10.5), Some(11.5), Some(11.5), None]);
    let host = pushed(1e-6);
    assert_eq!(updates(&host), [Some(10.5), Some(12.5), Some(12.5), None]);
    for (time, a_g) in [(10.0, 0.0), (10.5, 0.5), (11.0, 0.375), (11.5, 0.25), (12.0, 0.625), (10.75, 0.4375)] {
        assert_eq!(host.set_time(time), OK);
        assert_eq!(host.get("a_ground"), a_g, "at {time}");
        assert_eq!(host.derivatives().unwrap()[1], -a_g);
    }
}

/// Contact that is held after too many impacts ends at an instant that is foreseen: no push lifts the structure before.
#[test]
fn the_end_of_held_contact_is_foreseen() {
    const RIGID: f64 = 5.0;
    let host = Host::going_model(&[("detail", RIGID), ("r", 0.9999), ("theta_0", 1e-11)]);
    let period = 1.0 / host.get("p_l");
    assert_eq!((host.set_time(0.9 * period), host.complete()), (OK, Ok((true, false))));
    let update = |time: f64, a_g: f64| {
        assert_eq!((host.set_time(time), host.enter_event_mode(), host.set(&[("a_g", a_g)])), (OK, OK, OK));
        let next = host.update().unwrap().next_event;
        assert_eq!(host.go_on(), OK);
        (host.integer("phase"), next)
    };
    let end = update(0.9 * period, 0.0).1.unwrap();
    let held = "; too many transitions within one vibration period: contact is held for the rest of it";
    let warnings: Vec<_> = host.log.take().into_iter().filter(|message| message.text.ends_with(held)).collect();
    assert!(warnings.len() == 1 && warnings[0].status == WARNING, "a warning even if no events are asked for");
    assert!(
        warnings[0].text.contains(" s: landing in full contact; u = 0 m, u_dot = 0 m/s (before: 0), theta_dot = 0 ")
    );
    let (phase, foreseen) = update(0.95 * period, 9.0);
    assert_eq!(phase, PHASE_IN_CONTACT);
    assert_relative_eq!(foreseen.unwrap(), end, max_relative = 1e-14);
    assert_relative_eq!(end, period, max_relative = 1e-4);
    assert_eq!(update(end, 9.0), (2, None));
}

/// The next event is the very sample's instant, wherever the host is between two samples, and in an instance that goes on
/// from a kept state.
#[test]
fn a_sample_has_one_instant_however_the_host_gets_there() {
    let samples: Vec<_> = (0..500).map(|i| f64::from(6 * i) / 1e3).collect();
    let text: String = samples.iter().map(|time| format!("{time:.3},{}\n", (9.0 * time).sin())).collect();
    let host = || {
        let host = Host::new_model();
        host.write("quake.csv", &format!("t (s),a (m/s2)\n{text}"));
        host
    };
    let (first, second) = (host(), host());
    assert_eq!(first.set_record("quake.csv"), OK);
    first.begin(None, 0.7, None);
    let follow = |host: &Host, steps: std::ops::Range<u32>| {
        for step in steps {
            let time = 0.7 + f64::from(step) * 0.002;
            assert_eq!((host.set_time(time), host.enter_event_mode()), (OK, OK));
            let next = samples.iter().map(|sample| 0.7 + (sample - samples[0])).find(|sample| *sample > time + 1e-9);
            assert_eq!((host.update().unwrap().next_event, host.go_on()), (next, OK), "at {time} s");
        }
    };
    assert_eq!((first.update().is_ok(), first.go_on()), (true, OK));
    follow(&first, 1..400);
    assert_eq!(second.go_back(second.deserialize(&first.bytes()).unwrap()), OK);
    follow(&second, 400..900);
}

/// A host that arrives at a jump sees what led there until it enters event mode, which a kept state remembers, and one that
/// never does sees what comes after it as soon as it has passed the jump.
#[test]
fn a_jump_is_still_to_come_until_its_event() {
    let host = Host::new_model();
    host.write("push.csv", "t (s),a_g (m/s2)\n0,4\n1,2\n");
    assert_eq!((host.set_record("push.csv"), host.set(&[("record_start", 0.5)])), (OK, OK));
    host.begin(None, 10.0, None);
    assert_eq!((host.update().unwrap().next_event, host.go_on()), (Some(10.5), OK));
    let acts = |a_g: f64, slope: f64| {
        assert_eq!((host.get("a_ground"), host.derivatives().unwrap()[1]), (a_g, -a_g));
        assert_relative_eq!(host.derivative("a_ground", "time"), slope, max_relative = 1e-12);
    };
    assert_eq!(host.set_time(10.5), OK);
    acts(0.0, 0.0);
    assert_eq!(host.complete(), Ok((false, false)));
    acts(0.0, 0.0);
    let arrived = host.keep();
    assert_eq!(host.enter_event_mode(), OK);
    acts(4.0, -2.0);
    let at_event = host.bytes();
    assert_eq!(host.go_back(arrived), OK);
    acts(0.0, 0.0);
    assert_eq!(host.go_back(host.deserialize(&at_event).unwrap()), OK);
    acts(4.0, -2.0);
    assert_eq!((host.update().unwrap().next_event, host.go_on()), (Some(11.5), OK));
    acts(4.0, -2.0);
    for (time, a_g, slope) in [(11.5, 2.0, -2.0), (10.5, 4.0, -2.0), (11.5f64.next_up(), 2.0, -2.0), (11.501, 0.0, 0.0)]
    {
        assert_eq!(host.set_time(time), OK);
        acts(a_g, slope);
    }
}

#[test]
fn what_no_integrator_should_try_is_sent_back() {
    let host = Host::going_model(&[("theta_0", 0.02)]);
    let before = host.bytes();
    let said = |text: &str| {
        let log = host.log.take();
        assert_eq!(log.len(), 1);
        assert!(log[0].text.starts_with(text), "{}", log[0].text);
    };
    assert_eq!(host.set_states(&[0.0, f64::NAN, 0.0, 0.0]), DISCARD);
    said("fmi2SetContinuousStates: u_dot = NaN is out of range");
    assert_eq!(host.set_states(&[0.0, 0.0, -2e12, 0.0]), DISCARD);
    said("fmi2SetContinuousStates: theta = -2000000000000 is out of range");
    assert_eq!(host.set_states(&[0.0; 3]), ERROR);
    said("fmi2SetContinuousStates: nx = 3 is not 4");
    assert_eq!(host.set_time(f64::INFINITY), ERROR);
    said("fmi2SetTime: time = inf s is out of range");
    assert_eq!(host.bytes(), before);
    assert_eq!((host.set_time(1e-3), host.complete()), (OK, Ok((false, false))));
    assert_eq!((host.set_time(-0.5), host.complete()), (OK, Err(ERROR)));
    said("fmi2CompletedIntegratorStep: the integrator's step from t = 0.001 s ends at t = -0.5 s");

    let host = Host::going_model(&[("m0", 0.0), ("J0", 0.0), ("theta_0", 0.1)]);
    assert_eq!(host.set_states(&[0.285, 0.0, 0.1, 0.0]), OK);
    assert_eq!(host.derivatives(), Err(DISCARD));
    assert_eq!((host.set_states(&[0.0, 0.0, 0.1, 0.0]), host.derivatives().is_ok()), (OK, true));
}

/// A host that enters no event mode, or completes no step, holds a structure down that should rock: it is warned once.
#[test]
fn a_host_that_ignores_events_is_warned_once() {
    let pushed = || {
        let host = Host::going_model(&[]);
        assert_eq!(host.set(&[("a_g", 9.0)]), OK);
        host
    };
    let warnings = |host: &Host, expected: &[&str]| {
        let log = host.log.take();
        assert_eq!(log.len(), expected.len(), "{log:?}");
        for (message, expected) in log.iter().zip(expected) {
            assert!(message.status == WARNING && message.text.contains(expected), "{log:?}");
        }
    };
    let go_on = |host: &Host, step: u32| assert_eq!(host.set_time(0.01 * f64::from(step)), OK);
    let (obeys, ignores, never, briefly) = (pushed(), pushed(), pushed(), pushed());
    for step in 1..20 {
        obeys.integrate(0.01 * f64::from(step - 1), 0.01);
        go_on(&ignores, 5 * step);
        assert!(ignores.complete().is_ok());
    }
    assert_eq!((obeys.terminate(), obeys.get("theta") != 0.0, ignores.get("theta")), (OK, true, 0.0));
    warnings(&obeys, &[]);
    warnings(&ignores, &["t = 0.1 s: the host completes steps but does not enter event mode"]);
    (1..3000).for_each(|step| go_on(&never, step));
    warnings(&never, &["the host integrates without completing steps"]);
    go_on(&briefly, 1);
    assert_eq!(briefly.terminate(), OK);
    warnings(&briefly, &["the host integrates without completing steps"]);
}

/// Peaks between the host's steps are not the FMU's to see.
#[test]
fn peaks_and_validity_are_not_watched() {
    let host = Host::new_model();
    assert_eq!((host.set_boolean("peaks", 1), host.set_boolean("validity", 1)), (OK, OK));
    let host = host.initialized(&[("theta_0", 0.02)]);
    host.log.borrow_mut().clear();
    assert_eq!((host.exit(), host.update().is_ok(), host.go_on()), (OK, true, OK), "{:?}", host.log);
    let warnings: Vec<_> = host.log.take().into_iter().map(|message| (message.status, message.text)).collect();
    let expected = ["peaks", "validity"].map(|name| {
        let text =
            "= true has no effect in model exchange, where the host integrates: the values are NaN; use co-simulation";
        (WARNING, format!("{name} {text}"))
    });
    assert_eq!(warnings, expected);
    host.integrate(0.0, 1e-3);
    assert!(host.get("theta_max").is_nan() && host.get("mu_required").is_nan());
}

/// Beside differences of the values; in full contact the base does not turn. On ground that follows a record, whose pieces
/// are straight, time is a known as well.
#[test]
fn directional_derivatives_are_the_slopes_of_the_values() {
    let knowns = [("u", 1e-6), ("u_dot", 1e-4), ("theta", 1e-6), ("theta_dot", 1e-4), ("a_g", 1e-2), ("F_t", 1.0)];
    let unknowns = ["der(u)", "der(u_dot)", "der(theta)", "der(theta_dot)", "u", "theta", "delta_t", "R_v"];
    for states in [[1e-3, -0.1, 0.03, 0.4], [-2e-3, 0.2, -0.01, 0.5], [1e-4, 0.1, 0.0, 0.0]] {
        let host = Host::going_model(&[("theta_0", states[2]), ("a_g", 3.0), ("F_t", 200.0)]);
        assert_eq!(host.set_states(&states), OK);
        for (known, step) in knowns {
            if states[2] == 0.0 && known.starts_with("theta") {
                assert_eq!(["der(u_dot)", "der(theta_dot)"].map(|unknown| host.derivative(unknown, known)), [0.0; 2]);
                continue;
            }
            let value = host.get(known);
            let [more, less] = [step, -step].map(|step| {
                assert_eq!(host.set(&[(known, value + step)]), OK);
                host.try_get(&unknowns).unwrap()
            });
            assert_eq!(host.set(&[(known, value)]), OK);
            for (at, unknown) in unknowns.into_iter().enumerate() {
                let expected = 0.5 * (more[at] - less[at]) / step;
                assert_relative_eq!(host.derivative(unknown, known), expected, max_relative = 1e-6, epsilon = 1e-6);
            }
        }
        assert_eq!(host.states(), Ok(states.to_vec()));
    }
    let host = Host::new_model();
    host.write("ramp.csv", "0,1\n0.5,-3\n");
    host.write("up.csv", "0,2\n0.5,-2\n");
    assert_eq!((host.set_record("ramp.csv"), host.set_text("record_v", "up.csv")), (OK, OK));
    let host = host.initialized(&[("theta_0", 0.03)]);
    assert_eq!((host.exit(), host.update().is_ok(), host.go_on()), (OK, true, OK), "{:?}", host.log);
    let [before, after] = [0.125, 0.25].map(|time| {
        assert_eq!(host.set_time(time), OK);
        host.try_get(&unknowns).unwrap()
    });
    assert_eq!((host.derivative("a_ground", "time"), host.derivative("a_v_ground", "time")), (-8.0, -8.0));
    for (at, unknown) in unknowns.into_iter().enumerate() {
        assert_relative_eq!(host.derivative(unknown, "time"), (after[at] - before[at]) / 0.125, max_relative = 1e-9);
    }
}
