//! Values in and out, and the table of variables against what the FMU computes.

use crate::host::*;
use FlexibleRocking::variables::PHASES;
use approx::assert_relative_eq;
use fmi_unit::variables::dependencies;
use fmi_unit::{Causality, DataType, Role, Variable};
use rocking::run::validity::ASSUMPTIONS;
use std::collections::BTreeSet;

/// A change of one parameter or initial value changes the initial value of exactly those variables that state it.
#[test]
fn the_stated_dependencies_are_the_true_ones() {
    let u_cr = 7.52467e-4;
    let rigid = 5.0;
    let restrained = |yields_at| {
        [
            ("theta_0", 0.3),
            ("theta_dot_0", -0.4),
            ("P_0", 300.0),
            ("k_t", 2e4),
            ("xi_d", 0.1),
            ("c_d", 50.0),
            ("k_d", 1e6),
            ("F_y", yields_at),
        ]
    };
    let bases: [&[(&str, f64)]; 13] = [
        &[("theta_0", 0.3), ("u_0", 2e-3), ("record_scale", 2.0), ("record_start", -0.25)],
        &[("detail", rigid), ("theta_0", 0.3), ("record_scale", 2.0), ("record_start", -0.25)],
        &[("detail", rigid), ("theta_0", 0.3), ("theta_dot_0", -0.4), ("J0", 2.0)],
        &[("detail", rigid), ("record_scale", 2.0), ("record_start", -0.25)],
        &[("u_0", 3e-4), ("u_dot_0", 0.2)],
        &[("theta_0", 0.3), ("theta_dot_0", -0.4), ("u_0", 2e-3), ("u_dot_0", 0.3), ("c_ratio", 0.7), ("J0", 2.0)],
        &[("u_0", u_cr * (1.0 - 1e-4)), ("u_dot_0", 0.01)],
        &[("u_0", u_cr * (1.0 + 1e-4)), ("u_dot_0", -0.01)],
        &[("u_0", 3e-4), ("u_dot_0", 0.2), ("P_0", 300.0)],
        &[&restrained(2e5)[..], &[("u_0", 2e-3)]].concat(),
        &[&restrained(200.0)[..], &[("u_0", 2e-3)]].concat(), // which yields
        &[&restrained(2e5)[..], &[("detail", rigid)]].concat(),
        &[&restrained(200.0)[..], &[("detail", rigid)]].concat(),
    ];
    // in g; the ground follows them where the base says when
    let pulse = "-\n-\nACCELERATION IN UNITS OF G\n3, .5 NPTS, DT\n.1 .2 .4\n";
    let up = "-\n-\nACCELERATION IN UNITS OF G\n4, .4 NPTS, DT\n.1 -.3 .2 .1\n";
    let show = |values: &[(&str, f64)], [record, record_v]: [&str; 2]| {
        let host = Host::initializing(values);
        host.write("pulse.AT2", pulse);
        host.write("up.AT2", up);
        assert_eq!((host.set_text("record", record), host.set_text("record_v", record_v)), (OK, OK));
        let show = |name: &&str| match VARIABLES[reference(name) as usize].data_type {
            DataType::Real { .. } => host.get(name),
            DataType::Boolean => host.try_boolean(name).unwrap().into(),
            DataType::Integer | DataType::Enumeration(_) => host.integer(name).into(),
            DataType::String => panic!("{name}"),
        };
        computed().map(|name| (name, show(&name))).collect::<Vec<_>>()
    };
    fn computed() -> impl Iterator<Item = &'static str> {
        use Causality::{CalculatedParameter, Local, Output};
        let is_computed = |variable: &&Variable| {
            let is_peak = variable.name.ends_with("_max");
            let is_worst = ASSUMPTIONS.iter().any(|of| [of.name, of.time_name].contains(&&*variable.name));
            matches!(variable.causality, Output | CalculatedParameter | Local) && !is_peak && !is_worst
        };
        VARIABLES.iter().filter(is_computed).map(|variable| &*variable.name)
    }
    let mut found: BTreeSet<(&str, &str)> = BTreeSet::new();
    for base in bases {
        let host = Host::initializing(base);
        let has_record = base.iter().any(|(name, _)| *name == "record_start");
        let is_rigid = f64::from(host.integer("detail")) == rigid;
        // either may be the longer one
        let records = match (has_record, is_rigid) {
            (true, true) => ["up.AT2", "pulse.AT2"],
            (true, false) => ["pulse.AT2", "up.AT2"],
            (false, _) => [""; 2],
        };
        let before = show(base, records);
        for known in VARIABLES.iter().filter(|variable| variable.causality == Causality::Parameter) {
            let name = &*known.name;
            // In full contact the base does not turn, and what is rigid is not deformed; of two numbers each needs the other.
            if name == "theta_dot_0" && host.get("theta_0") == 0.0
                || is_rigid && name.starts_with("u_")
                || ["k_d", "F_y"].contains(&name) && host.get(name) == 0.0
            {
                continue;
            }
            let [record, record_v] = records;
            let other_records = match name {
                "record" => ["", record_v],
                "record_v" => [record, ""],
                _ => records,
            };
            let changed = match known.data_type {
                DataType::Boolean => continue,
                DataType::Enumeration(_) if !is_rigid => continue,
                DataType::Enumeration(_) | DataType::String => 1.0,
                _ if host.get(name) == 0.0 => 1e-3,
                _ => host.get(name) * (1.0 - 1e-3),
            };
            let mut values = base.to_vec();
            values.retain(|(name, _)| *name != known.name);
            if known.data_type != DataType::String {
                values.push((&*known.name, changed));
            }
            for ((name, before), (_, after)) in before.iter().zip(show(&values, other_records)) {
                if (after - before).abs() > 1e-9 * before.abs() {
                    found.insert((name, &*known.name));
                }
            }
        }
    }
    let of = |name: &str| dependencies(&VARIABLES, reference(name) as usize, true);
    let stated: BTreeSet<(&str, &str)> = computed()
        .flat_map(|name| of(name).into_iter().map(move |known| (name, &VARIABLES[known])))
        .filter(|(_, known)| known.causality == Causality::Parameter)
        // what indicators depend on is stated for the running simulation, with dissipators that have yielded
        .filter(|(name, _)| VARIABLES[reference(name) as usize].role != Role::Indicator)
        .map(|(name, known)| (name, &*known.name))
        .collect();
    let of_indicators = |(name, _): &(&str, &str)| VARIABLES[reference(name) as usize].role == Role::Indicator;
    let (of_indicators, found): (BTreeSet<_>, BTreeSet<_>) = found.into_iter().partition(of_indicators);
    for (name, known) in of_indicators {
        assert!(of(name).contains(&(reference(known) as usize)), "{name} depends on {known}");
    }
    let [at_start, later] = [true, false].map(|at_start| {
        dependencies(&VARIABLES, reference("a_ground") as usize, at_start).contains(&(reference("time") as usize))
    });
    assert_eq!((at_start, later), (false, true));
    assert_eq!(found.difference(&stated).collect::<Vec<_>>(), Vec::<&(&str, &str)>::new(), "found, not stated");
    assert_eq!(stated.difference(&found).collect::<Vec<_>>(), Vec::<&(&str, &str)>::new(), "stated, not found");
}

#[test]
fn values_during_initialization_follow_what_is_set() {
    let host = Host::initializing(&[]);
    assert_eq!(host.set(&[("theta_0", -0.04), ("u_0", 1e-3), ("B", 0.3)]), OK);
    assert_eq!(host.try_get(&["theta", "u", "theta_0"]).unwrap(), [-0.04, 1e-3, -0.04]);
    assert_relative_eq!(host.get("uplift"), 0.6 * 0.04_f64.sin(), max_relative = 1e-14);
    let h_cg = 0.285 / 0.35122_f64.tan();
    assert_relative_eq!(host.get("alpha_cg"), (0.3 / h_cg).atan(), max_relative = 2e-5);
    assert_eq!(host.integer("phase"), 2);
    assert_eq!(host.set(&[("theta_0", 0.04)]), OK);
    assert_eq!(host.integer("phase"), 3);
    assert_eq!(host.set(&[("theta_0", 0.0)]), OK);
    assert_eq!((host.integer("phase"), host.integer("transitions"), host.try_boolean("overturned")), (1, 0, Ok(0)));
    for on in [1, 0] {
        assert_eq!((host.set_boolean("a_g_late", on), host.try_boolean("a_g_late")), (OK, Ok(on)));
    }
    assert_eq!((host.record().as_str(), host.set_record("a ü.csv"), host.record().as_str()), ("", OK, "a ü.csv"));
    assert_eq!(PHASES.items, ["full contact", "rocking left", "rocking right", "overturned", "flight"]);
}
