//! The command line driven from outside: structures, what `simulate` and `modes` write, what a result comes from.
#![allow(non_snake_case)] // H, V_t, M_t: the paper's own letters

mod command_line;

use FlexibleRocking::variables::{Causality, DataType, VARIABLES, Variable};
use command_line::{SAMPLES, command, folder, pulse, succeed};
use rocking::engine::piece::Sample;
use rocking::structure::natural_quantities::names;
use rocking::{Detail, Parameters, Run, Structure, run::End};
use rocking_records::Reading;
use std::{collections::BTreeSet, fs, path::Path, process::Output};

/// The headings and lines of a CSV file.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
    (lines.next().unwrap(), lines.collect())
}

fn column(path: &Path, heading: &str) -> Vec<f64> {
    let (headings, lines) = table(path);
    let index = headings.iter().position(|found| found == heading).unwrap();
    lines.iter().map(|line| line[index].parse().unwrap()).collect()
}

#[test]
fn the_response_has_every_output_of_the_fmu_under_its_name_and_unit() {
    let folder = folder();
    succeed(folder.path(), "simulate --record pulse.AT2 -o response.csv");
    let (headings, lines) = table(&folder.path().join("response.csv"));
    assert!(lines.iter().all(|line| line.len() == 28 && line.iter().all(|cell| !cell.is_empty())));
    let mut expected = BTreeSet::from(["time[s]".to_owned(), "a_g[m/s2]".to_owned()]);
    expected.insert("a_v[m/s2]".to_owned());
    let locals = ["theta_dot", "u_dot", "phase", "transitions", "e_p1", "e_p2", "E_viscous", "E_hysteretic"];
    let is_shown = |v: &&Variable| v.causality == Causality::Output || locals.contains(&v.name);
    expected.extend(VARIABLES.iter().filter(is_shown).map(|variable| match variable.data_type {
        DataType::Real { unit, .. } => format!("{}[{unit}]", variable.name),
        _ => variable.name.to_owned(),
    }));
    assert_eq!(headings.into_iter().collect::<BTreeSet<_>>(), expected);
}

/// At every level the CSV holds the bits that the engine has.
#[test]
fn the_response_reads_back_to_the_engines_numbers() {
    let folder = folder();
    let record = rocking_records::read(&folder.path().join("pulse.AT2"), &Reading::default(), 9.81).unwrap().0;
    let ground = record.scaled(0.5, -2.0).unwrap();
    for detail in Detail::ALL {
        let level = format!("--detail {} --duration 2 -o out.csv", detail.name());
        succeed(folder.path(), &format!("simulate --record pulse.AT2 --scale -2 --time-scale 0.5 {level}"));
        let mut lines = table(&folder.path().join("out.csv")).1.into_iter();
        let run = Run { detail, end: End::At(2.0), ..Run::new(Structure::new(Parameters::MCMANUS).unwrap(), &ground) };
        let compare = |sample: &Sample| {
            let line = lines.next().unwrap();
            let (o, r, i) = (sample.outputs(), sample.reactions(), sample.motion.impulse);
            let of_motion = [o.theta, o.u, o.a_t, o.V_t, o.M_t, o.theta_dot, o.u_dot, o.uplift, o.delta_t, o.v_t];
            let on_ground = [r.R_h, r.R_v, r.R_m, i.I_h, i.I_v, i.I_m];
            let expected = [&[sample.motion.time, sample.load.a_g], &of_motion[..], &on_ground].concat();
            assert_eq!(line[..18].iter().map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>(), expected);
            assert_eq!(line[26..], [sample.motion.phase.name().to_owned(), sample.motion.transitions.to_string()]);
            assert!(line[18..26].iter().all(|cell| cell.parse() == Ok(0.0)), "nothing restrains it: {line:?}");
        };
        let finish = run.sample(ground.times().iter().copied(), compare, &mut ()).unwrap();
        assert!(lines.next().is_none() && (finish.motion.transitions > 2 || detail == Detail::FixedBase));
    }
}

#[test]
fn output_times_are_the_samples_or_multiples_of_the_interval_and_always_the_end() {
    let folder = folder();
    let record = "time,a_g\n1,0\n1.25,0.5\n2,0\n";
    fs::write(folder.path().join("three.csv"), record).unwrap();
    for (options, expected) in [
        ("", &[1.0, 1.25, 2.0, 2.2][..]), // a period of vibration in full contact after the record
        ("--time-scale 2", &[2.0, 2.5, 4.0, 4.2]),
        ("--duration 0.5", &[1.0, 1.25, 1.5]),
        ("--duration 2", &[1.0, 1.25, 2.0, 2.75, 3.0]),
        ("--interval 0.5", &[1.0, 1.5, 2.0, 2.2]),
        ("--interval 0.5 --duration 1.125", &[1.0, 1.5, 2.0, 2.125]),
        ("--interval 1e7", &[1.0, 2.2]),
    ] {
        succeed(folder.path(), &format!("simulate --record three.csv -o out.csv --events events.csv {options}"));
        assert_eq!(column(&folder.path().join("out.csv"), "time[s]"), expected, "{options}");
        assert_eq!(column(&folder.path().join("events.csv"), "time[s]"), [0.0; 0], "{options}");
    }
    // The thirtieth sample is one rounding error short of the end.
    succeed(folder.path(), "simulate --record pulse.AT2 --time-scale 0.2 --duration 0.058 -o out.csv");
    assert_eq!(column(&folder.path().join("out.csv"), "time[s]").len(), 30);
    // The vibration after the record ends a rounding error after the hundredth interval.
    succeed(folder.path(), "simulate --record pulse.AT2 --scale 0.05 --time-scale 0.2 -o out.csv");
    assert_eq!(column(&folder.path().join("out.csv"), "time[s]").len(), SAMPLES + 100);
    succeed(folder.path(), "simulate --record three.csv --unit g --interval 0.25 --duration 1.5 -o out.csv");
    let a_g = column(&folder.path().join("out.csv"), "a_g[m/s2]");
    let expected = [0.0, 0.5, 1.0 / 3.0, 1.0 / 6.0, 0.0, 0.0, 0.0].map(|a_g| a_g * 9.81);
    assert!(a_g.iter().zip(expected).all(|(a_g, expected)| (a_g - expected).abs() < 1e-14), "{a_g:?}");
}

#[test]
fn the_peak_of_the_ground_is_that_of_the_record_as_it_is_followed() {
    let folder = folder();
    let (json, _) = succeed(folder.path(), "simulate --record pulse.AT2 --duration 0.055 --format json");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let peak = &json["peaks"][0];
    let expected = 9.81 * 0.5 * (pulse(5) + pulse(6));
    assert!((peak["peak"].as_f64().unwrap() / expected - 1.0).abs() < 1e-12, "{peak}");
    assert_eq!((&peak["name"], &peak["time"]), (&"a_g".into(), &0.055.into()));
}

/// As far as it is text.
#[cfg(target_os = "linux")]
#[test]
fn a_file_whose_name_is_no_text_is_named_in_results() {
    use std::{ffi::OsStr, os::unix::ffi::OsStrExt};
    let folder = folder();
    let name = OsStr::from_bytes(b"puls\xe9.AT2");
    fs::rename(folder.path().join("pulse.AT2"), folder.path().join(name)).unwrap();
    for format in ["json", "csv"] {
        let arguments = format!("simulate --duration 1 --format {format} --record");
        let Output { status, stdout, stderr } = command(folder.path(), &arguments).arg(name).output().unwrap();
        assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
        assert!(String::from_utf8(stdout).unwrap().contains("puls\u{fffd}.AT2"));
    }
}

/// What a result comes from stands beside it, in both formats.
#[test]
fn a_result_can_be_traced_to_its_cause() {
    let folder = folder();
    let scene = "--preset evison --f-fc 8 --record pulse.AT2 --time-scale 0.5 --scale 1.5";
    let level = "--detail modal --tolerance 1e-7 --theta-0 0.01";
    let version = format!("{}+{}", env!("CARGO_PKG_VERSION"), &FlexibleRocking::BUILD[1..9]);
    let of_structure = [
        ("/structure/J0", "J0[kg.m2]", "0.0"),
        ("/structure/f_fc", "f_fc[Hz]", "8.0"),
        ("/structure/g", "g[m/s2]", "9.81"),
    ];
    let of_record = [("/time_scale", "time_scale", "0.5"), ("/scale", "scale", "1.5")];
    let of_level = [("/tolerance", "tolerance", "1e-7"), ("/initial/theta", "theta_0[rad]", "0.01")];
    for (command, numbers) in [
        (format!("simulate {scene} {level}"), [&of_structure[..], &of_record, &of_level].concat()),
        (format!("advise {scene}"), [&of_structure[..], &of_record].concat()),
        (format!("estimate {scene}"), [&of_structure[..], &of_record].concat()),
        ("pushover --preset evison --f-fc 8".to_owned(), of_structure.to_vec()),
    ] {
        let json: serde_json::Value =
            serde_json::from_str(&succeed(folder.path(), &format!("{command} --format json")).0).unwrap();
        let csv = succeed(folder.path(), &format!("{command} --format csv")).0;
        let mut table = csv::Reader::from_reader(csv.as_bytes());
        let headings = table.headers().unwrap().clone();
        let rows: Vec<_> = table.records().map(Result::unwrap).collect();
        let is_in_every_row = |heading: &str, expected: &str| {
            let column = headings.iter().position(|found| found == heading).unwrap();
            assert!(rows.len() > 2 && rows.iter().all(|row| &row[column] == expected), "{command}: {heading}\n{csv}");
        };
        assert_eq!(json["version"], version);
        is_in_every_row("version", &version);
        for (pointer, heading, expected) in &numbers {
            let found = json.pointer(pointer).and_then(serde_json::Value::as_f64);
            assert_eq!(found, Some(expected.parse().unwrap()), "{command}: {pointer}");
            is_in_every_row(heading, expected);
        }
        if numbers.len() > of_structure.len() {
            assert_eq!((&json["record"], &json["file"]), (&"Full sine".into(), &"pulse.AT2".into()));
            is_in_every_row("file", "pulse.AT2");
        }
        if command.starts_with("simulate") {
            assert_eq!(json["detail"], "modal");
            is_in_every_row("detail", "modal");
        }
    }
}

#[test]
fn the_template_is_the_structure() {
    let folder = folder();
    for structure in ["--preset evison --c-ratio 0.5", "--preset mcmanus --m0 0 --g 1.62"] {
        let (template, talk) = succeed(folder.path(), &format!("describe {structure} --template"));
        assert!(talk.starts_with("structure      from ") && talk.lines().count() == 1, "{talk}");
        fs::write(folder.path().join("pier.toml"), &template).unwrap();
        let described = succeed(folder.path(), &format!("describe {structure}")).0;
        assert_eq!(succeed(folder.path(), "describe --parameters pier.toml").0, described);
        for name in names() {
            let has_line =
                template.lines().any(|line| line.trim_start_matches("# ").starts_with(&format!("{name} = ")));
            assert!(has_line, "{name}\n{template}");
        }
    }
}
