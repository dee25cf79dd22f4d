//! FMU states: kept, restored, serialized.
#![allow(unsafe_code)]

mod host;

use FlexibleRocking::BUILD;
use FlexibleRocking::condition::Condition;
use FlexibleRocking::fmi2::*;
use host::*;
use std::ffi::c_void;
use std::ptr::{null_mut, without_provenance_mut};

const OUTPUTS: [&str; 5] = ["theta", "u", "a_t", "theta_dot", "u_dot"];

/// A hundred steps of 10 ms from `time` on; the outputs after each.
fn run(host: &Host, time: f64) -> Vec<Vec<f64>> {
    (0..100)
        .map(|i| {
            let t = time + 0.01 * f64::from(i);
            assert_eq!((host.set(&[("a_g", 6.0 * (9.0 * t).sin())]), host.set_slope("a_g", 1, 2.0)), (OK, OK));
            assert_eq!(host.step(t, 0.01), OK, "{:?}", host.log);
            host.try_get(&OUTPUTS).unwrap()
        })
        .collect()
}

/// In the middle of rocking, an input with a slope set.
fn rocking() -> Host {
    let host = Host::started(&[("theta_0", 0.02), ("r", 0.9)]);
    run(&host, 0.0);
    assert_eq!((host.set(&[("a_g", 3.0)]), host.set_slope("a_g", 1, -40.0)), (OK, OK));
    host
}

#[test]
fn going_back_repeats_the_same_bits() {
    let host = rocking();
    let state = host.keep();
    assert_eq!(host.step(1.0, 0.01), OK);
    let first = (host.try_get(&OUTPUTS).unwrap(), run(&host, 1.01), host.bytes());
    assert!(host.integer("transitions") > 3 && host.rate("R_h", 1).is_ok());
    assert_eq!(host.bytes(), first.2, "reading changes nothing");
    for _ in 0..2 {
        assert_eq!(host.go_back(state), OK);
        assert_eq!(host.step(1.0, 0.01), OK);
        assert_eq!((host.try_get(&OUTPUTS).unwrap(), run(&host, 1.01), host.bytes()), first);
    }
    assert_eq!(host.terminate(), OK);
    assert_eq!(host.go_back(state), OK);
    assert_eq!(host.step(1.0, 0.01), OK, "the state of the state machine went back, too");
}

/// The slope that the last step followed, of which the rates tell, is part of the state.
#[test]
fn a_state_remembers_the_ramp() {
    let host = rocking();
    assert_eq!(host.step(1.0, 0.01), OK);
    let rate = host.rate("R_h", 1);
    let other = Host::new();
    assert_eq!(other.go_back(other.deserialize(&host.bytes()).unwrap()), OK);
    assert_eq!(other.rate("R_h", 1), rate);
    assert_eq!(
        (host.set(&[("a_g", host.get("a_g"))]), other.go_back(other.deserialize(&host.bytes()).unwrap())),
        (OK, OK)
    );
    assert_eq!(other.rate("R_h", 1), host.rate("R_h", 1));
    assert_ne!(other.rate("R_h", 1), rate);
}

/// Nor is the engine built anew where only the motion differs.
#[test]
fn a_state_is_a_few_dozen_numbers() {
    assert!(size_of::<Condition>() <= 170 * size_of::<f64>(), "{} bytes", size_of::<Condition>());
    let host = rocking();
    let state = host.keep();
    assert_eq!(host.step(1.0, 0.01), OK);
    let allocated = allocation_counter::measure(|| {
        assert_eq!(host.try_keep(state), Ok(state));
        assert_eq!(host.go_back(state), OK);
    });
    assert_eq!(allocated.count_total, 0);
}

#[test]
fn another_instance_goes_on_from_the_bytes_with_the_same_bits() {
    let host = rocking();
    let bytes = host.bytes();
    let other = Host::new();
    let state = other.deserialize(&bytes).unwrap();
    assert_eq!(other.bytes(), Host::new().bytes(), "deserializing alone changes nothing");
    assert_eq!(other.go_back(state), OK);
    assert_eq!(other.bytes(), bytes);
    assert_eq!(other.try_get(&["r", "theta_0", "a_g"]).unwrap(), [0.9, 0.02, 3.0]);
    for host in [&host, &other] {
        assert_eq!(host.step(1.0, 0.01), OK);
    }
    assert_eq!(run(&host, 1.01), run(&other, 1.01));
    assert_eq!(host.bytes(), other.bytes());
}

#[test]
fn a_state_before_the_start_holds_what_was_set() {
    let host = Host::new();
    assert_eq!((host.set(&[("m", 300.0), ("theta_0", 0.1)]), host.setup(Some(1e-6), 1.0, Some(2.0))), (OK, OK));
    let instantiated = host.keep();
    let before = host.bytes();
    assert_eq!((host.reset(), host.enter()), (OK, OK));
    assert_eq!(host.go_back(instantiated), OK);
    assert_eq!(host.bytes(), before);
    assert_eq!(host.enter(), OK);
    assert_eq!(host.try_get(&["m", "theta"]).unwrap(), [300.0, 0.1]);
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
}

#[test]
fn a_state_that_is_not_the_instances_own_is_refused_everywhere() {
    let host = rocking();
    let other = Host::new();
    let freed = host.keep();
    assert_eq!(host.free_state(freed), OK);
    let _reuses_its_memory = host.keep();
    let local = 0_u64;
    for state in [freed, other.keep(), (&raw const local).cast_mut().cast::<c_void>(), without_provenance_mut(1)] {
        let message = |function: &str| {
            format!(
                "fmi2{function}: FMUstate {:#x} is not one that this instance has handed out and not freed; pass a \
                 pointer to NULL for a new one",
                state.addr()
            )
        };
        host.assert_refused(|| host.go_back(state), ERROR, &message("SetFMUstate"));
        host.assert_refused(|| host.try_keep(state), Err(ERROR), &message("GetFMUstate"));
        host.assert_refused(|| host.free_state(state), ERROR, &message("FreeFMUstate"));
        host.assert_refused(|| host.size(state), Err(ERROR), &message("SerializedFMUstateSize"));
        host.assert_refused(|| host.serialize(state, 300), Err(ERROR), &message("SerializeFMUstate"));
    }
    assert_eq!(host.free_state(null_mut()), OK);
    assert_eq!(unsafe { fmi2FreeFMUstate(host.component, null_mut()) }, OK);
    assert_eq!(host.go_back(null_mut()), ERROR);
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
    assert_eq!(&bytes[12..50], BUILD.as_bytes());
    refused(&|bytes| bytes.clear(), "it is too short");
    refused(&|bytes| bytes.truncate(49), "it is too short");
    refused(&|bytes| bytes.truncate(53), "it is too short");
    refused(&|bytes| bytes[0] ^= 1, "it does not begin as one");
    refused(&|bytes| bytes[8] ^= 1, "it has another format version");
    refused(&|bytes| bytes[20] ^= 1, "it was written by another build of the FMU");
    refused(&|bytes| bytes[50] ^= 1, "its length is not the one that it states");
    refused(&|bytes| bytes.push(0), "its length is not the one that it states");
    refused(&|bytes| bytes.truncate(bytes.len() - 1), "its length is not the one that it states");
    for at in 54..bytes.len() {
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
