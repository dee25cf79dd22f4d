//! Hosts that unload the library after every run count on this: nothing of a run is left. Alone in its process: all instances
//! share the records.
#![allow(unsafe_code)] // the C interface

mod host;

use host::*;
use std::fs;

/// Nothing is left of a run: neither its record, nor the states that were kept amid it.
#[test]
fn nothing_is_left_when_the_last_instance_goes() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str| {
        let path = folder.path().join(name);
        let samples: String =
            (0..2000).map(|i| format!("{:.2},{:.1}\n", 0.01 * f64::from(i), f64::from(i % 7))).collect();
        fs::write(&path, samples).unwrap();
        let [first, second] = [Host::new(), Host::new()];
        for host in [&first, &second] {
            assert_eq!(host.set_record(path.to_str().unwrap()), OK);
            host.begin(None, 0.0, None);
            assert_eq!(host.step(0.0, 1.0), OK);
            assert!(!host.keep().is_null());
            assert_eq!(host.go_back(host.deserialize(&host.bytes()).unwrap()), OK);
        }
    };
    run("first.csv");
    let left = allocation_counter::measure(|| run("second.csv"));
    assert_eq!((left.bytes_current, left.count_current), (0, 0));
}
