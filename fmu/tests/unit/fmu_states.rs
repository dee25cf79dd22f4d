//! FMU states: kept, restored, serialized.

use crate::host::*;
use crate::records::at2;
use FlexibleRocking::BUILD;
use FlexibleRocking::fmi2;
use std::ptr::null_mut;

/// The outputs that are compared.
fn outputs(host: &Host) -> Vec<f64> {
    const OUTPUTS: &str =
        "theta u a_t theta_dot u_dot e_p1 E_viscous a_v_ground a_ground theta_max R_v_min energy_gain_max";
    host.try_get(&Vec::from_iter(OUTPUTS.split(' '))).unwrap()
}

/// A hundred steps of 10 ms from `time` on; the outputs after each.
fn run(host: &Host, time: f64) -> Vec<Vec<f64>> {
    (0..100)
        .map(|i| {
            let t = time + 0.01 * f64::from(i);
            let [a_g, F_t] = [6.0 * (9.0 * t).sin(), 40.0 * (7.0 * t).sin()];
            let loads = [("a_g", a_g), ("F_t", F_t), ("a_v", 0.3 * a_g)];
            let slopes = [("a_g", 2.0), ("a_v", 0.6)].map(|(name, slope)| host.set_slope(name, 1, slope));
            assert_eq!((host.set(&loads), slopes), (OK, [OK; 2]));
            assert_eq!(host.step(t, 0.01), OK, "{:?}", host.log);
            outputs(host)
        })
        .collect()
}

/// In the middle of rocking with dissipators and a record, one input with a slope set and one that goes on with that of its
/// last two values.
fn rocking() -> Host {
    let dissipators = [("xi_d", 0.2), ("c_d", 5.0), ("k_d", 1e6), ("F_y", 30.0)];
    let host = Host::initializing(&[&[("theta_0", 0.02), ("r", 0.9)], &dissipators[..]].concat());
    host.write("quake.AT2", &at2(600));
    let switches = ["F_t_extrapolated", "peaks", "validity"].map(|name| host.set_boolean(name, 1));
    assert_eq!((switches, host.set_record("quake.AT2"), host.exit()), ([OK; 3], OK, OK), "{:?}", host.log);
    run(&host, 0.0);
    assert_eq!((host.set(&[("a_g", 3.0)]), host.set_slope("a_g", 1, -40.0)), (OK, OK));
    host
}

/// In the instance itself and, from bytes, in another whose archive has the record, too. The log has the same messages: no
/// limit is told again that was told before.
#[test]
fn going_back_repeats_the_same_bits() {
    let [host, other] = [rocking(), Host::new()];
    assert_eq!([&host, &other].map(|host| host.set_debug_logging(true, &[])), [OK; 2]);
    assert!(host.log.take().iter().any(|message| message.text.contains("R_v_min")));
    let (state, bytes) = (host.keep(), host.bytes());
    let go_on = |host: &Host| {
        assert_eq!(host.step(1.0, 0.01), OK);
        (outputs(host), run(host, 1.01), host.bytes(), host.log.take())
    };
    let first = go_on(&host);
    assert!(host.integer("transitions") > 3 && host.rate("R_h", 1).is_ok() && !first.3.is_empty());
    assert_eq!(host.bytes(), first.2, "reading changes nothing");
    for _ in 0..2 {
        assert!((host.go_back(state), go_on(&host)) == (OK, first.clone()));
    }
    assert!((host.terminate(), host.go_back(state), go_on(&host)) == (OK, OK, first.clone()));
    other.write("quake.AT2", &at2(600));
    let state = other.deserialize(&bytes).unwrap();
    assert_eq!(other.bytes(), Host::new().bytes(), "deserializing alone changes nothing");
    assert_eq!((other.go_back(state), other.bytes(), other.record().as_str()), (OK, bytes, "quake.AT2"));
    assert_eq!(other.try_get(&["r", "theta_0", "a_g"]).unwrap(), [0.9, 0.02, 3.0]);
    assert!(go_on(&other) == first);
}

#[test]
fn a_state_is_refused_without_the_samples_of_its_record() {
    let bytes = rocking().bytes();
    let [other, without] = [Host::new(), Host::new()];
    other.write("quake.AT2", &at2(599));
    let message = "fmi2SetFMUstate: the samples of record = \"quake.AT2\" changed after the FMU state was saved";
    for (host, message) in [(other, message), (without, "record = \"quake.AT2\" is not in ")] {
        let state = host.deserialize(&bytes).unwrap();
        host.assert_refused(|| host.go_back(state), ERROR, message);
    }
}

/// The engine is not built anew where only the motion differs.
#[test]
fn a_state_that_is_kept_again_takes_little_memory() {
    let host = rocking();
    let state = host.keep();
    assert_eq!(host.step(1.0, 0.01), OK);
    let kept = allocation_counter::measure(|| assert_eq!(host.try_keep(state), Ok(state)));
    let gone_back = allocation_counter::measure(|| assert_eq!(host.go_back(state), OK));
    // the peaks are two lists; going back reads the inputs, the state at the start and the names of the records anew
    assert_eq!((kept.count_total, gone_back.count_total), (2, 8));
}

#[test]
fn a_state_can_be_overwritten_and_outlives_a_reset() {
    let host = rocking();
    let state = host.keep();
    assert_eq!(host.step(1.0, 0.01), OK);
    let later = host.bytes();
    assert_eq!(host.try_keep(state), Ok(state));
    assert_eq!((host.reset(), host.go_back(state)), (OK, OK));
    assert_eq!(host.bytes(), later);
    let limited = Host::new();
    limited.begin(None, 0.0, Some(1.0));
    assert_eq!(host.go_back(host.deserialize(&limited.bytes()).unwrap()), OK);
    host.assert_refused(|| host.step(0.0, 2.0), ERROR, "the step would end at t = 2 s, past stopTime = 1 s");
}

/// Freed states and what is none are among the hostile calls.
#[test]
fn a_state_of_another_instance_is_refused_everywhere() {
    let (host, other) = (rocking(), Host::new());
    let state = other.keep();
    let message = format!("fmi2SetFMUstate: FMUstate {:#x} is not one that this instance has handed", state.addr());
    host.assert_refused(|| host.go_back(state), ERROR, &message);
    let refused = [host.try_keep(state).is_err(), host.size(state).is_err(), host.serialize(state, 300).is_err()];
    assert_eq!((refused, host.free_state(state)), ([true; 3], ERROR));
    assert_eq!(host.free_state(null_mut()), OK);
    assert_eq!(unsafe { fmi2::FreeFMUstate(host.component, null_mut()) }, OK);
}

#[test]
fn bytes_that_are_no_state_of_this_build_are_refused() {
    let host = rocking();
    let bytes = host.bytes();
    let refused = |change: &dyn Fn(&mut Vec<u8>), reason: &str| {
        let mut bytes = bytes.clone();
        change(&mut bytes);
        let message =
            format!("fmi2DeSerializeFMUstate: serializedState is not a serialized state of this FMU: {reason}");
        host.assert_refused(|| host.deserialize(&bytes), Err(ERROR), &message);
    };
    assert_eq!(&bytes[..38], BUILD.as_bytes());
    refused(&|bytes| bytes.clear(), "it does not begin with the name of this build");
    refused(&|bytes| bytes[20] ^= 1, "it does not begin with the name of this build");
    for length in [38, 53, bytes.len() - 1] {
        refused(&|bytes| bytes.truncate(length), "its checksum is wrong");
    }
    refused(&|bytes| bytes.push(0), "its checksum is wrong");
    for at in 38..bytes.len() {
        refused(&|bytes| bytes[at] ^= 0x10, "its checksum is wrong");
    }
    let needed = bytes.len();
    let state = host.keep();
    for given in [0, needed - 1, needed + 1] {
        let message = format!(
            "fmi2SerializeFMUstate: size = {given} does not fit: the serialized FMU state takes {needed} bytes \
             (fmi2SerializedFMUstateSize)"
        );
        host.assert_refused(|| host.serialize(state, given), Err(ERROR), &message);
    }
}
