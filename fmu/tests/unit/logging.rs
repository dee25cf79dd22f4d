//! The messages to the host, and their occasions.

use crate::host::*;

fn categories(host: &Host) -> Vec<String> {
    let mut categories: Vec<_> = host.log.take().into_iter().map(|message| message.category).collect();
    categories.dedup();
    categories
}

/// In FMI 2.0 events alone are switched, in FMI 3.0 each category by itself; the reasons of refused calls are always logged.
#[test]
fn a_host_gets_the_categories_that_it_switches_on() {
    let (all, events, warnings) = (&[][..], &["logStatusError", "logEvents"][..], &["logStatusWarning"][..]);
    for (is_fmi_3, logging_on, switched, expected) in [
        (false, 0, vec![], "Warning Error"),
        (false, 1, vec![], "Warning Events Error"),
        (false, 0, vec![(true, all)], "Warning Events Error"),
        (false, 1, vec![(false, all)], "Warning Error"),
        (false, 1, vec![(false, events)], "Warning Error"),
        (false, 0, vec![(true, events)], "Warning Events Error"),
        (false, 1, vec![(true, warnings)], "Warning Error"),
        (true, 0, vec![], "Error"),
        (true, 1, vec![], "Warning Events Error"),
        (true, 0, vec![(true, all)], "Warning Events Error"),
        (true, 0, vec![(true, all), (false, warnings)], "Events Error"),
        (true, 0, vec![(true, warnings)], "Warning Error"),
        (true, 0, vec![(true, all), (false, all)], "Error"),
    ] {
        let host = Host::instantiate(Instantiate { is_fmi_3, logging_on, ..Instantiate::default() }).unwrap();
        switched.iter().for_each(|(on, names)| assert_eq!(host.set_debug_logging(*on, names), OK));
        let host = host.initialized(&[("theta_0", 0.01), ("r", 0.5)]);
        assert_eq!((host.exit(), host.step(0.0, 0.5), host.step(0.0, 0.5)), (OK, OK, ERROR));
        let expected = expected.replace("Warning", "StatusWarning").replace("Error", "StatusError");
        let expected: Vec<_> = expected.split(' ').map(|name| format!("log{name}")).collect();
        assert_eq!(categories(&host), expected, "{is_fmi_3} {logging_on} {switched:?}");
    }
}

/// What follows from the parameters alone is a warning at the start, whatever is asked for; the call returns OK, as there
/// are hosts that end a simulation at `fmi2Warning`. Evison's geometry: an edge pulls below r = 0.8191, the energy can
/// grow at u_cr outside 0.6396 to 0.9980, and u_cr is B at 0.5652 Hz.
#[test]
fn what_the_parameters_alone_say_is_warned_of() {
    let (pull, gain, slow) = ("pulls at one of the edges", "can raise the energy", "u_cr = ");
    let far = "far from the usual frequency";
    for (values, expected) in [
        (vec![("r", 0.639)], vec![pull, gain]),
        (vec![("r", 0.641)], vec![pull]),
        (vec![("r", 0.818)], vec![pull]),
        (vec![("r", 0.820)], vec![]),
        (vec![("r", 0.998)], vec![]),
        (vec![("r", 0.9981)], vec![gain]),
        (vec![("f_fc", 0.565)], vec![far, slow, gain]),
        (vec![("f_fc", 0.566)], vec![far, gain]),
        (vec![("f_fc", 0.565), ("r", 0.5), ("detail", 5.0)], vec![far, pull]),
        (vec![("f_fc", 0.565), ("r", 0.5), ("detail", 6.0)], vec![far]),
    ] {
        let host = Host::started(&values);
        let log = host.log.take();
        assert_eq!(log.len(), expected.len(), "{values:?}: {log:?}");
        for (message, expected) in log.iter().zip(expected) {
            assert!(message.text.contains(expected), "{values:?}: {}", message.text);
            assert_eq!((message.status, message.category.as_str()), (WARNING, "logStatusWarning"));
        }
    }
}

/// An unknown category is refused, and the others of the call with it.
#[test]
fn a_reset_instance_logs_as_it_was_instantiated_and_has_no_stop_time() {
    let host = Host::new();
    host.begin(None, 0.0, Some(0.1));
    assert_eq!((host.set_debug_logging(true, &[]), host.reset()), (OK, OK));
    let message = "fmi2SetDebugLogging: log category \"100 %% of ##it\" does not exist; see LogCategories in \
                   modelDescription.xml";
    host.assert_refused(|| host.set_debug_logging(true, &["logEvents", "100 % of #it"]), ERROR, message);
    assert_eq!(host.set(&[("theta_0", 0.01)]), OK);
    host.begin(None, 0.0, None);
    assert_eq!(host.step(0.0, 0.5), OK);
    assert!(host.integer("transitions") > 0);
    assert_eq!(categories(&host), Vec::<String>::new());
}
