//! Inputs of which nothing but the value is set, for hosts that cannot send slopes: a_g one step late, F_t extrapolated.

use crate::host::*;
use approx::assert_relative_eq;

const SHOWN: [&str; 6] = ["theta", "u", "a_t", "R_h", "a_g", "F_t"];

fn started(switches: &[&str], start_values: &[(&str, f64)]) -> Host {
    let host = Host::initializing(start_values);
    switches.iter().for_each(|switch| assert_eq!(host.set_boolean(switch, 1), OK));
    assert_eq!(host.exit(), OK);
    host
}

/// Value and slope that are set, step, value and slope that act.
type Line = (Option<f64>, Option<f64>, f64, (f64, f64));

/// Steps of different lengths beside a host that sends the lines themselves. Outputs between two steps are those of what acts.
fn follow(input: &str, acting: &str, [host, other]: [&Host; 2], lines: &[Line]) {
    let mut time = 0.0;
    for &(value, slope, step, line) in lines {
        // set again and again, as a master does that iterates: the last value counts
        value.into_iter().for_each(|value| assert_eq!(host.set(&[(input, 9.0), (input, value)]), OK));
        slope.into_iter().for_each(|slope| assert_eq!(host.set_slope(input, 1, slope), OK));
        assert_relative_eq!(host.get(input), value.unwrap_or(line.0), max_relative = 1e-13);
        assert_relative_eq!(host.get(acting), line.0, max_relative = 1e-13);
        assert_eq!((other.set(&[(input, line.0)]), other.set_slope(input, 1, line.1)), (OK, OK));
        assert_eq!((host.step(time, step), other.step(time, step)), (OK, OK));
        for (found, expected) in host.try_get(&SHOWN).unwrap().into_iter().zip(other.try_get(&SHOWN).unwrap()) {
            assert_relative_eq!(found, expected, max_relative = 1e-11);
        }
        let [found, expected] = [host, other].map(|host| host.rate("R_h", 1).unwrap());
        assert_relative_eq!(found, expected, max_relative = 1e-9, epsilon = 1e-9);
        time += step;
    }
}

/// From the value at the start on, to what is set, or on where nothing is; a slope that is set wins.
#[test]
fn a_g_is_followed_one_step_late() {
    let hosts = [&started(&["a_g_late", "peaks"], &[("a_g", 0.5)]), &Host::started(&[("a_g", 0.5)])];
    assert_eq!(hosts[0].get("a_ground"), 0.5);
    let lines = [
        (Some(1.5), None, 0.1, (0.5, 10.0)),
        (Some(0.5), None, 0.05, (1.5, -20.0)),
        (None, None, 0.1, (0.5, 0.0)),
        (Some(3.0), Some(-4.0), 0.25, (3.0, -4.0)),
        (Some(-2.0), None, 0.2, (2.0, -20.0)),
        (None, Some(5.0), 0.1, (-2.0, 5.0)),
        (Some(-1.5), Some(0.0), 0.1, (-1.5, 0.0)),
        (Some(0.0), None, 0.1, (-1.5, 15.0)),
    ];
    follow("a_g", "a_ground", hosts, &lines);
}

/// From the second step on, of what is set and has no slope of its own.
#[test]
fn F_t_goes_on_with_the_slope_of_its_last_two_values() {
    let lines = [
        (Some(100.0), None, 0.1, (100.0, 0.0)),
        (Some(200.0), None, 0.05, (200.0, 1000.0)),
        (Some(300.0), None, 0.1, (300.0, 2000.0)),
        (None, None, 0.1, (500.0, 0.0)),
        (Some(450.0), Some(-100.0), 0.2, (450.0, -100.0)),
        (Some(-100.0), Some(0.0), 0.1, (-100.0, 0.0)),
        (Some(-200.0), None, 0.1, (-200.0, -1000.0)),
    ];
    follow("F_t", "F_t", [&started(&["F_t_extrapolated"], &[]), &started(&[], &[])], &lines);
}

/// While a_g is late it has no feedthrough: what is set changes no output before the next step.
#[test]
fn what_is_late_does_not_act_at_once() {
    let host = started(&["a_g_late"], &[("theta_0", 0.02)]);
    let by_a_g = |host: &Host| host.derivative("R_h", "a_g");
    assert_eq!((host.set(&[("a_g", 1.0)]), host.step(0.0, 0.01)), (OK, OK));
    let before = host.try_get(&["R_h", "a_t", "a_ground"]).unwrap();
    assert_eq!((host.set(&[("a_g", 5.0)]), host.try_get(&["R_h", "a_t", "a_ground"]).unwrap()), (OK, before));
    assert_eq!((host.set(&[("a_v", 0.5)]), host.get("a_v_ground")), (OK, 0.0));
    assert_eq!(by_a_g(&host), 0.0);
    assert_eq!(host.set_slope("a_g", 1, 0.0), OK);
    assert_eq!((host.get("a_ground"), by_a_g(&host) < -1.0), (5.0, true));
}

/// A jump over a tiny step has a slope that leads nowhere: the input is held, and the late one where it was.
#[test]
fn a_slope_that_leads_out_of_the_range_is_not_followed() {
    let host = started(&["a_g_late", "F_t_extrapolated"], &[]);
    assert_eq!((host.set(&[("F_t", 1.0)]), host.step(0.0, 1e-9)), (OK, OK));
    assert_eq!((host.set(&[("F_t", 1e8)]), host.step(1e-9, 0.1)), (OK, OK));
    assert_eq!(host.get("F_t"), 1e8);
    for a_g in [1e4, -1e4, 1e4] {
        assert_eq!((host.set(&[("a_g", a_g), ("F_t", 0.0)]), host.step(host.last_successful_time(), 1e-6)), (OK, OK));
        assert_eq!(host.get("a_ground"), a_g);
    }
}

/// Samples of a motion that are held from step to step are told once, by what to do; a push, slopes and a_g_late are not.
#[test]
fn a_host_that_holds_samples_of_a_motion_is_warned_once() {
    let warnings = |host: &Host, a_g: fn(i32) -> f64, slopes: bool| {
        for step in 0..20 {
            let (time, value) = (f64::from(step) * 0.01, a_g(step));
            assert_eq!(host.set(&[("a_g", value)]), OK);
            assert!(!slopes || host.set_slope("a_g", 1, (a_g(step + 1) - value) / 0.01) == OK);
            assert_eq!(host.step(time, 0.01), OK);
        }
        host.log.take()
    };
    let quake = |step: i32| (0.3 * f64::from(step)).sin();
    for still in [|_| 0.0, |_| 2.0, |step| if step < 3 { 0.0 } else { 1.0 }, |step| if step == 7 { -2.0 } else { 0.0 }]
    {
        assert_eq!(warnings(&started(&[], &[]), still, false), []);
    }
    assert_eq!(warnings(&started(&["a_g_late"], &[]), quake, false), []);
    assert_eq!(warnings(&started(&[], &[]), quake, true), []);
    let host = started(&[], &[]);
    let told = warnings(&host, quake, false);
    assert_eq!((told.len(), told[0].status, told[0].category.as_str()), (1, WARNING, "logStatusWarning"), "{told:?}");
    assert!(["record", "a_g_late", "slope"].iter().all(|remedy| told[0].text.contains(remedy)), "{told:?}");
    assert_eq!(host.reset(), OK);
    host.begin(None, 0.0, None);
    assert_eq!(warnings(&host, quake, false), told, "another simulation is warned again");
}
