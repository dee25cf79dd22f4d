//! Inputs that go on with the slope of their last two values, for hosts that cannot send slopes.
#![allow(unsafe_code, non_snake_case)] // the C interface; F_t

mod host;

use approx::assert_relative_eq;
use host::*;

const SHOWN: [&str; 6] = ["theta", "u", "a_t", "R_h", "a_g", "F_t"];

fn started(extrapolate: bool, start_values: &[(&str, f64)]) -> Host {
    let host = Host::initializing(start_values);
    assert_eq!((host.set_boolean("extrapolate", extrapolate.into()), host.exit()), (OK, OK));
    host
}

/// Beside a host that sends the slopes: from the second step on, of what is set and has no slope of its own.
#[test]
fn an_input_goes_on_with_the_slope_of_its_last_two_values() {
    let [host, other] = [started(true, &[]), started(false, &[])];
    let mut time = 0.0;
    // value and slope that are set, step, slope that is followed
    for (a_g, F_t, step, followed) in [
        ((Some(1.0), None), Some(5.0), 0.1, (0.0, 0.0)),
        ((Some(2.0), None), Some(2.0), 0.05, (10.0, -30.0)),
        ((Some(3.0), None), None, 0.1, (20.0, 0.0)),
        ((None, None), Some(4.5), 0.1, (0.0, 40.0)),
        ((Some(5.0), Some(-1.0)), Some(4.5), 0.2, (-1.0, 0.0)),
        ((Some(-1.0), Some(0.0)), Some(4.5), 0.1, (0.0, 0.0)),
        ((Some(-2.0), None), None, 0.1, (-10.0, 0.0)),
    ] {
        for host in [&host, &other] {
            for (name, value) in [("a_g", a_g.0), ("F_t", F_t)] {
                // set again and again, as a master does that iterates: the last value counts
                value.into_iter().for_each(|value| assert_eq!(host.set(&[(name, 9.0), (name, value)]), OK));
            }
            a_g.1.into_iter().for_each(|slope| assert_eq!(host.set_slope("a_g", 1, slope), OK));
        }
        assert_relative_eq!(other.get("a_g"), host.get("a_g"), max_relative = 1e-14);
        let kept = host.get("F_t");
        assert_eq!(
            (other.set(&[("F_t", kept), ("a_g", host.get("a_g"))]), other.set_slope("a_g", 1, followed.0)),
            (OK, OK)
        );
        assert_eq!(other.set_slope("F_t", 1, followed.1), OK);
        // of what is not set, the rates tell how it came here
        if let ((Some(_), _), Some(_)) = (a_g, F_t) {
            let rates = [&host, &other].map(|host| host.rate("R_h", 1).unwrap());
            assert_relative_eq!(rates[0], rates[1], max_relative = 1e-12, epsilon = 1e-9);
        }
        assert_eq!((host.step(time, step), other.step(time, step)), (OK, OK));
        for (found, expected) in host.try_get(&SHOWN).unwrap().into_iter().zip(other.try_get(&SHOWN).unwrap()) {
            assert_relative_eq!(found, expected, max_relative = 1e-11);
        }
        time += step;
    }
}

/// What went before is part of a state: a step repeated, in this instance or another, has the same bits.
#[test]
fn a_state_remembers_the_value_before() {
    let host = started(true, &[("theta_0", 0.02)]);
    let step = |host: &Host, time: f64, a_g: f64| {
        assert_eq!((host.set(&[("a_g", a_g)]), host.step(time, 0.01)), (OK, OK));
        host.try_get(&SHOWN).unwrap()
    };
    step(&host, 0.0, 1.0);
    let (state, bytes) = (host.keep(), host.bytes());
    let first = [step(&host, 0.01, 3.0), step(&host, 0.02, 2.0)];
    assert_eq!(host.go_back(state), OK);
    assert_eq!([step(&host, 0.01, 3.0), step(&host, 0.02, 2.0)], first);
    let other = Host::new();
    assert_eq!(other.go_back(other.deserialize(&bytes).unwrap()), OK);
    assert_eq!([step(&other, 0.01, 3.0), step(&other, 0.02, 2.0)], first);
}

/// A jump over a tiny step has a slope that leads nowhere: the input is held.
#[test]
fn a_slope_that_leads_out_of_the_range_is_not_followed() {
    let host = started(true, &[]);
    assert_eq!((host.set(&[("a_g", 1.0)]), host.step(0.0, 1e-9)), (OK, OK));
    assert_eq!((host.set(&[("a_g", 2.0)]), host.step(1e-9, 0.1)), (OK, OK));
    assert_eq!(host.get("a_g"), 2.0);
}

/// Held, an input is right to the first order of the step; continued, to the second.
#[test]
fn the_error_is_of_second_order() {
    let at_end = |steps: u32, mode: Option<bool>| {
        let host = started(mode == Some(true), &[("theta_0", 0.1)]);
        let step = 0.1 / f64::from(steps);
        let a_g = |k: u32| 8.0 * (30.0 * step * f64::from(k)).sin();
        for k in 0..steps {
            assert_eq!(host.set(&[("a_g", a_g(k))]), OK);
            if mode.is_none() {
                assert_eq!(host.set_slope("a_g", 1, (a_g(k + 1) - a_g(k)) / step), OK);
            }
            assert_eq!(host.step(step * f64::from(k), step), OK);
        }
        host.get("theta")
    };
    let exact = at_end(4000, None);
    for (mode, order) in [(false, 1.0), (true, 2.0)] {
        let [coarse, fine] = [50, 100].map(|steps| (at_end(steps, Some(mode)) - exact).abs());
        let found = (coarse / fine).log2();
        assert!((found - order).abs() < 0.2, "order {found} for {order}: {coarse:e}, {fine:e}");
    }
}
