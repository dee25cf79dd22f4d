//! The command line driven from outside: `describe` and `simulate`, their tables, messages and exit codes.
#![allow(non_snake_case)] // V_t, M_t: the paper's own letters

mod command_line;

use FlexibleRocking::variables::{Causality, DataType, PHASES, VARIABLES, Variable};
use command_line::{DT, SAMPLES, command, fail, folder, pulse, succeed};
use rocking::{
    Engine, Impulse, Load, Outputs, Parameters, Phase, Ramp, Reactions, State, Structure, engine::DEFAULT_TOLERANCE,
};
use std::{
    collections::BTreeSet,
    fs,
    io::Read,
    path::Path,
    process::{Output, Stdio},
};

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
fn describe_shows_the_specimen_with_units_and_equations() {
    let folder = folder();
    let (mcmanus, _) = succeed(folder.path(), "describe");
    for line in [
        "  m                 130.1 kg     top mass",
        "  r                  0.99 -      coefficient of restitution on the angular velocity at impact",
        "  u_cr         0.00231348 m      after Eq 4    critical displacement: uplift",
        "  J_P             467.046 kg.m2  after Eq 8    inertia about a pivot",
        "  p_l             2.24234 rad/s  before Eq 11  frequency parameter",
        "  chi            0.943090 -      after Eq 13   modal participation of rocking",
    ] {
        assert!(mcmanus.lines().any(|found| found == line), "{line}\n{mcmanus}");
    }
    assert_eq!(mcmanus, succeed(folder.path(), "describe --preset mcmanus").0);

    let (evison, _) = succeed(folder.path(), "describe --preset evison");
    let (computed, _) = succeed(folder.path(), "describe --preset mcmanus --width 3 --alpha-cg 0.25");
    assert!(computed.contains("  H               8.82752 m "), "{computed}");
    assert!(evison.contains("  f_u             36.5739 Hz     before Eq 18"), "{evison}");

    let parameters = "m = 125.8\nm0 = 44.02\nH = 1.05\nB = 0.285\nf_fc = 11\nzeta_fc = 0.015\nr = 0.96\n";
    fs::write(folder.path().join("wall.toml"), parameters).unwrap();
    assert_eq!(evison, succeed(folder.path(), "describe --parameters wall.toml").0);
}

#[test]
fn the_response_has_every_output_of_the_fmu_under_its_name_and_unit() {
    let folder = folder();
    succeed(folder.path(), "simulate --record pulse.AT2 -o response.csv");
    let (headings, lines) = table(&folder.path().join("response.csv"));
    assert!(lines.iter().all(|line| line.len() == 20 && line.iter().all(|cell| !cell.is_empty())));
    let mut expected = BTreeSet::from(["time[s]".to_owned(), "a_g[m/s2]".to_owned()]);
    let locals = ["theta_dot", "u_dot", "phase", "transitions"];
    let is_shown = |v: &&Variable| v.causality == Causality::Output || locals.contains(&v.name);
    expected.extend(VARIABLES.iter().filter(is_shown).map(|variable| match variable.data_type {
        DataType::Real { unit, .. } => format!("{}[{unit}]", variable.name),
        _ => variable.name.to_owned(),
    }));
    assert_eq!(headings.into_iter().collect::<BTreeSet<_>>(), expected);
}

/// The CSV holds the bits that the engine has.
#[test]
fn the_response_reads_back_to_the_engines_numbers() {
    let folder = folder();
    let (summary, _) =
        succeed(folder.path(), "simulate --record pulse.AT2 --scale -2 --time-scale 0.5 --duration 2 -o out.csv");
    let (_, lines) = table(&folder.path().join("out.csv"));
    assert_eq!(lines.len(), SAMPLES);

    let acceleration = |i: usize| pulse(i) * 9.81 * -2.0;
    let time = |i: usize| i as f64 * DT * 0.5;
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    let mut engine = Engine::new(structure, State::default(), 0.0, DEFAULT_TOLERANCE).unwrap();
    for (i, line) in lines.iter().enumerate() {
        if i > 0 {
            let slope = (acceleration(i) - acceleration(i - 1)) / (time(i) - time(i - 1));
            let a_g = Ramp { value: acceleration(i - 1), slope };
            engine.advance(time(i) - engine.motion().time, a_g, &mut ()).unwrap();
        }
        let motion = engine.motion();
        let o = Outputs::of(&structure, motion.phase, &motion.state, 0.0);
        let numbers: Vec<f64> = line[..18].iter().map(|number| number.parse().unwrap()).collect();
        assert_eq!(numbers[0], time(i));
        assert!((numbers[1] - acceleration(i)).abs() <= 1e-14 * 12.0, "{} {}", numbers[1], acceleration(i));
        let expected = [o.theta, o.u, o.a_t, o.V_t, o.M_t, o.theta_dot, o.u_dot, o.uplift, o.delta_t, o.v_t];
        assert_eq!(numbers[2..12], expected, "line {i}");
        let Reactions { R_h, R_v, R_m } = engine.reactions(Load::ground(numbers[1]));
        let Impulse { I_h, I_v, I_m } = motion.impulse;
        assert_eq!(numbers[12..], [R_h, R_v, R_m, I_h, I_v, I_m], "line {i}");
        assert!(PHASES.items.contains(&line[18].as_str()));
        assert_eq!(line[18] == "full contact", motion.phase == Phase::FullContact);
        assert_eq!(line[19], motion.transitions.to_string());
    }
    let transitions = engine.motion().transitions;
    assert!(transitions > 2);
    let work = engine.motion().work;
    for line in [
        format!("transitions    {transitions}"),
        "overturned     not by then".into(),
        format!("work           {} steps, {} evaluations; ", work.steps, work.evaluations),
    ] {
        assert!(summary.lines().any(|found| found.starts_with(&line)), "{line}\n{summary}");
    }
}

/// The numbers of the paper's Fig 5: released at theta = 0.04 rad, u = u_cr.
#[test]
fn free_vibration_of_the_wall_has_its_impacts_on_time() {
    let folder = folder();
    let u_cr = Structure::new(Parameters::EVISON).unwrap().u_cr;
    let run = format!(
        "simulate --preset evison --free 2 --theta-0 0.04 --u-0 {u_cr} --interval 1e-5 --events events.csv -o free.csv"
    );
    let (summary, talk) = succeed(folder.path(), &run);

    let (headings, events) = table(&folder.path().join("events.csv"));
    assert_eq!(
        headings[..6].join(" "),
        "time[s] kind u_before[m] u_dot_before[m/s] theta_before[rad] theta_dot_before[rad/s]"
    );
    let impacts: Vec<f64> = column(&folder.path().join("events.csv"), "time[s]");
    let expected = [0.168487319, 0.486378723, 0.783968665, 1.062370970, 1.321721172, 1.562668213];
    for (impact, expected) in impacts.iter().zip(expected) {
        assert!((impact - expected).abs() < 1e-9, "{impact} {expected}");
    }
    let (before, after) = (
        column(&folder.path().join("events.csv"), "theta_dot_before[rad/s]"),
        column(&folder.path().join("events.csv"), "theta_dot_after[rad/s]"),
    );
    assert_eq!(events[0][1], "impact left");
    assert_eq!(after[0], 0.96 * before[0]);

    for line in [
        "free vibration, 0.00000 to 2.00000 s",
        "peak |a_t|         0.920607 g    at 1.33495 s",
        "first uplift   none",
        "first impact   at 0.168487 s",
    ] {
        assert!(summary.lines().any(|found| found == line), "{line}\n{summary}");
    }
    assert!(talk.ends_with("\nresponse       free.csv\ntransitions    events.csv\n"), "{talk}");
    let a_t = column(&folder.path().join("free.csv"), "a_t[m/s2]");
    assert_eq!(a_t.len(), 200_001);
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
        ("--interval 8", &[1.0, 2.2]),
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
fn standard_output_gets_the_same_table_and_may_be_closed_early() {
    let folder = folder();
    succeed(folder.path(), "simulate --record pulse.AT2 -o out.csv");
    let (stdout, summary) = succeed(folder.path(), "simulate --record pulse.AT2 -o -");
    assert_eq!(stdout, fs::read_to_string(folder.path().join("out.csv")).unwrap());
    assert!(summary.contains("peak |theta|") && !summary.contains("response"), "{summary}");

    let run = "simulate --free 100 --theta-0 0.1 -o - --quiet";
    let mut child = command(folder.path(), run).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut first = [0; 7];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    assert_eq!(&first, b"time[s]");
    let Output { status, stderr, .. } = child.wait_with_output().unwrap();
    assert_eq!((status.code(), String::from_utf8(stderr).unwrap()), (Some(0), String::new()));
}

#[test]
fn overturning_is_a_result() {
    let folder = folder();
    let (summary, _) =
        succeed(folder.path(), "simulate --record pulse.AT2 --scale 0 --theta-0 -0.3 --events events.csv -o out.csv");
    let (_, lines) = table(&folder.path().join("out.csv"));
    let (_, events) = table(&folder.path().join("events.csv"));
    let [.., before, last] = lines.as_slice() else { panic!("{lines:?}") };
    assert_eq!([&before[18], &last[18]], ["rocking left", "overturned"]);
    assert!((last[2].parse::<f64>().unwrap() + std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    assert_eq!(events.len(), 1);
    assert_eq!(events[0][..2], [last[0].as_str(), "overturning left"]);
    assert!(summary.lines().any(|line| line.starts_with("overturned     to the left at 1.61")), "{summary}");
}

#[test]
fn an_error_names_its_cause_and_exits_with_1() {
    let folder = folder();
    let at2 = fs::read_to_string(folder.path().join("pulse.AT2")).unwrap();
    for (name, text) in [
        ("short.at2", at2.trim_end().rsplit_once('\n').unwrap().0),
        ("velocity.AT2", &at2.replace("ACCELERATION", "VELOCITY")),
        ("word.csv", "t,a\n0,0\n0.1,much\n"),
        ("key.toml", "m = 1\nmass = 2\n"),
        ("range.toml", "m = 1\nm0 = 1\nH = 1\nB = -1\nf_fc = 1\nzeta_fc = 0\nr = 1\n"),
        ("text.toml", "m = 1\nm0 = 'one'\n"),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    for (arguments, expected) in [
        ("simulate --record absent.AT2", "error: the record absent.AT2 cannot be read: No such file"),
        ("simulate --record pulse.vt2", "error: the record pulse.vt2 cannot be read: No such file"),
        (
            "simulate --record short.at2",
            "error: short.at2, line 84: NPTS states 401 samples, and the file has 400; --ignore-npts takes those",
        ),
        ("simulate --record velocity.AT2", "error: velocity.AT2, line 3: found \"VELOCITY TIME SERIES"),
        ("simulate --record word.csv", "error: word.csv, line 3: the acceleration \"much\" is not a number"),
        ("simulate --record pulse.AT2 -o no/out.csv", "error: no/out.csv cannot be written: there is no folder no"),
        (
            "simulate --record pulse.AT2 --scale 1e308",
            "error: time_scale = 1.0 and scale = 1e308 leave no ground motion of \"Full sine\"",
        ),
        ("simulate --free 1 --theta-dot-0 0.1", "error: theta_dot_0 = 0.1 rad/s contradicts theta_0 = 0"),
        ("simulate --free 1 --theta-0 nan", "error: theta_0 = NaN rad is out of range"),
        ("describe --parameters absent.toml", "error: parameters in absent.toml: No such file"),
        ("describe --parameters key.toml", "error: parameters in key.toml: TOML parse error at line 2, column 1"),
        ("describe --parameters text.toml", "error: parameters in text.toml: TOML parse error at line 2, column 6"),
        ("describe --parameters range.toml", "error: parameters in range.toml: B = -1 m is out of range"),
    ] {
        let (code, message) = fail(folder.path(), &format!("{arguments} --quiet"));
        assert_eq!(code, 1, "{arguments}: {message}");
        assert!(message.starts_with(expected), "{arguments}: {message}");
    }
    let (_, message) = fail(folder.path(), "describe --parameters key.toml");
    assert!(message.contains("\"mass\" is unknown; these are known: m, m0, H, B, "), "{message}");
}

#[test]
fn wrong_usage_exits_with_2() {
    let folder = folder();
    for (arguments, expected) in [
        ("", "Usage: rocking-fmu [OPTIONS] <COMMAND>"),
        ("simulate", "--record <FILE>"),
        ("simulate --record pulse.AT2 --free 1", "cannot be used with"),
        ("simulate --free 1 --scale 2", "cannot be used with"),
        ("simulate --free 0", "a finite number greater than 0 is needed"),
        ("simulate --free 1 --interval inf", "a finite number greater than 0 is needed"),
        ("simulate --free 1 --tolerance 1", "a number less than 1 is needed"),
        (
            "simulate --record pulse.csv --unit km/s2",
            "[possible values: g, m/s2, cm/s2, gal, mm/s2, in/s2, ft/s2, mg, %g]",
        ),
        ("describe --preset evison --parameters a.toml", "cannot be used with"),
        ("describe --preset housner", "[possible values: evison, mcmanus]"),
    ] {
        let (code, message) = fail(folder.path(), arguments);
        assert_eq!(code, 2, "{arguments}: {message}");
        assert!(message.contains(expected), "{arguments}: {message}");
    }
    let version = format!("rocking-fmu {}\nbuild {}\n", env!("CARGO_PKG_VERSION"), FlexibleRocking::BUILD);
    assert!(succeed(folder.path(), "--version").0.starts_with(&version));
}

#[test]
fn a_damaged_response_is_refused_where_it_is_damaged() {
    let folder = folder();
    succeed(folder.path(), "simulate --record pulse.AT2 -o whole.csv");
    let (headings, lines) = table(&folder.path().join("whole.csv"));
    let line = lines.iter().position(|line| line[18] == "rocking left").unwrap();
    let number = line + 2;
    for (column, value, expected) in [
        (0, "NaN", "column 1, time[s]: \"NaN\" is not a finite number".to_owned()),
        (0, &lines[line - 1][0], format!("column 1, time[s]: {0:?} does not come after {0} s", lines[line - 1][0])),
        (1, "", "column 2, a_g[m/s2]: \"\" is not a finite number".to_owned()),
        (2, "nan", "column 3, theta[rad]: \"nan\" is not a finite number".to_owned()),
        (8, "inf", "column 9, u_dot[m/s]: \"inf\" is not a finite number".to_owned()),
        (
            18,
            "rocking",
            "column 19, phase: \"rocking\" is not one of full contact, rocking left, rocking right, overturned"
                .to_owned(),
        ),
    ] {
        let mut damaged = lines.clone();
        damaged[line][column] = value.to_owned();
        let text: Vec<_> = [&headings].into_iter().chain(&damaged).map(|line| line.join(",")).collect();
        fs::write(folder.path().join("damaged.csv"), text.join("\n") + "\n").unwrap();
        let (code, message) = fail(folder.path(), "modes --response damaged.csv --quiet");
        assert_eq!((code, message), (1, format!("error: damaged.csv: line {number}, {expected}\n")));
        assert!(!folder.path().join("modes.csv").exists());
    }
}

#[test]
fn the_response_of_another_structure_is_refused() {
    let folder = folder();
    succeed(folder.path(), "simulate --preset mcmanus --record pulse.AT2 -o response.csv");
    succeed(folder.path(), "modes --preset mcmanus --r 0.9 --response response.csv"); // r moves it, and shows nowhere
    for other in [
        "--preset evison",
        "--preset mcmanus --m 131",
        "--preset mcmanus --m0 66",
        "--preset mcmanus --f-fc 5.1",
        "--preset mcmanus --B 0.3",
    ] {
        let (code, message) = fail(folder.path(), &format!("modes {other} --response response.csv"));
        assert!(code == 1 && message.contains("it is the response of another structure"), "{other}: {message}");
    }
}

#[test]
fn what_cannot_be_written_is_found_before_the_run() {
    let folder = folder();
    let (code, message) = fail(folder.path(), "simulate --free 1 --theta-0 0.1 -o - --events -"); // and prints nothing
    assert!(code == 1 && message.contains("standard output: something else is written there, too"), "{message}");
    for (options, expected) in [
        (
            "--duration 1e9",
            "an interval of 0.01 s over 1000000000 s makes 1e11 rows: 1e6 are possible; see --interval\n",
        ),
        // the pulse is over long before the structure stands
        ("--interval 9e-7 --time-scale 0.2", "an interval of 9e-7 s over "),
    ] {
        let (code, message) = fail(folder.path(), &format!("simulate --record pulse.AT2 {options} -o out.csv --quiet"));
        assert!(code == 1 && message.starts_with(&format!("error: {expected}")), "{message}");
        assert!(!folder.path().join("out.csv").exists());
    }
}

#[test]
fn files_are_written_that_are_asked_for() {
    let folder = folder();
    for arguments in ["simulate --record pulse.AT2", "simulate --free 1 --theta-0 0.1", "pushover"] {
        let (_, said) = succeed(folder.path(), arguments);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{arguments}: {said}");
    }
    let (code, message) = fail(folder.path(), "simulate --free 1 --theta-0 0.1 --interval 0.1");
    assert!(code == 2 && message.contains("--output <FILE.csv>"), "{message}");
}

/// The peaks of a fall are those before it begins, and the ground's is the record's, though the run ends before it.
#[test]
fn the_peaks_of_a_fall_are_those_before() {
    let folder = folder();
    let alpha_cg = Structure::new(Parameters::MCMANUS).unwrap().tan_alpha_cg.atan();
    // the pulse, and a stronger one long after it
    let samples: Vec<_> = (0..=1200)
        .map(|i| {
            format!(
                "{},{}\n",
                f64::from(i) * DT,
                1.5 * pulse(i as usize) - 2.0 * pulse((i as usize + 10).abs_diff(1000))
            )
        })
        .collect();
    fs::write(folder.path().join("two.csv"), format!("t (s),a (g)\n{}", samples.concat())).unwrap();
    let run = "simulate --preset mcmanus --record two.csv";
    let (json, _) = succeed(folder.path(), &format!("{run} --format json -o out.csv --interval 0.001"));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["ending"], "overturned");
    let fall = json["fall"].as_f64().unwrap();
    let out = folder.path().join("out.csv");
    let time = column(&out, "time[s]");
    let last = column(&out, "theta[rad]").iter().rposition(|theta| theta.abs() < alpha_cg).unwrap();
    assert!(time[last] <= fall && fall <= time[last + 1], "{fall}");
    for (i, heading) in ["a_g[m/s2]", "theta[rad]", "u[m]", "delta_t[m]", "uplift[m]", "a_t[m/s2]"].iter().enumerate() {
        let peak = |of: &str| json["peaks"][i][of].as_f64().unwrap();
        let values = column(&out, heading);
        let most = values[..=last].iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        if i == 0 {
            assert!(
                peak("time") > *time.last().unwrap() && peak("peak") > 1.1 * most,
                "the second pulse is the stronger"
            );
        } else {
            assert!(peak("time") <= fall && most <= peak("peak") && peak("peak") < 1.1 * most, "{heading}: {most}");
        }
    }
    let (text, _) = succeed(folder.path(), run);
    assert!(text.contains("\nfall           from "), "{text}");
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

#[test]
fn a_response_has_its_first_and_its_last_row_whatever_the_interval() {
    let folder = folder();
    for interval in ["0.4", "1e7"] {
        succeed(folder.path(), &format!("simulate --free 0.5 --theta-0 0.01 -o out.csv --interval {interval}"));
        let times = column(&folder.path().join("out.csv"), "time[s]");
        assert_eq!((times[0], times[times.len() - 1]), (0.0, 0.5), "{interval}");
    }
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

#[test]
fn help_does_not_offer_what_is_refused() {
    let folder = folder();
    let (code, _) = fail(folder.path(), "describe --preset evison --parameters wall.toml");
    let (help, _) = succeed(folder.path(), "describe --help");
    assert!(code == 2 && !help.contains("both"), "{help}");
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

/// Of a structure as large as a bridge in kN and kN.m, of a specimen in N.
#[test]
fn forces_are_in_units_of_their_size() {
    let folder = folder();
    let pier = "--H 30 --width 9 --weight 12000 --weight0 6000 --period-fc 1.0 --zeta-fc 0.05 --r 0.93";
    let csv = succeed(folder.path(), &format!("simulate --record pulse.AT2 {pier} --format csv")).0;
    let value = |name: &str| -> f64 {
        let line = csv.lines().find(|line| line.starts_with(&format!("{name},"))).unwrap();
        line.split(',').nth(1).unwrap().parse().unwrap()
    };
    let [V_t, M_t] = ["V_t", "M_t"].map(|name| 1e-3 * value(name));
    let shown = |command: &str, before: &str, unit: &str| -> f64 {
        let text = succeed(folder.path(), command).0;
        let line = text.lines().find(|line| line.contains(before)).unwrap_or_else(|| panic!("{text}"));
        let (_, after) = line.split_once(before).unwrap();
        let mut words = after.split_whitespace();
        let number = words.next().unwrap().parse().unwrap();
        assert_eq!(words.next().unwrap().trim_end_matches(','), unit, "{line}");
        number
    };
    for (command, before) in [("simulate", ["peak |V_t|", "peak |M_t|"]), ("advise", [" V_t ", " M_t "])] {
        for (before, (expected, unit)) in before.into_iter().zip([(V_t, "kN"), (M_t, "kN.m")]) {
            let found = shown(&format!("{command} --record pulse.AT2 {pier}"), before, unit);
            assert!((found / expected - 1.0).abs() < 1e-5, "{command}: {found} {expected}");
        }
    }
    shown(&format!("estimate {pier}"), "  V_t ", "kN");
    shown(&format!("pushover {pier}"), ", P ", "kN");
    shown("simulate --preset mcmanus --record pulse.AT2", "peak |V_t|", "N");
}

/// Asked as bash asks: of the last word that has been begun.
#[test]
fn bash_completes_options_of_a_command() {
    let folder = folder();
    let (script, _) = succeed(folder.path(), "completions bash");
    fs::write(folder.path().join("completions"), script).unwrap();
    for (words, expected) in [("sim", "simulate"), ("simulate --re", "--record"), ("simulate --detail mod", "modal")] {
        let before = words.rsplit_once(' ').map_or("rocking-fmu", |(before, _)| before.rsplit(' ').next().unwrap());
        let ask = format!(
            "source completions; COMP_WORDS=(rocking-fmu {words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
             _rocking__fmu rocking-fmu \"${{COMP_WORDS[COMP_CWORD]}}\" {before}; echo \"${{COMPREPLY[*]}}\""
        );
        let answer = std::process::Command::new("bash").args(["-c", &ask]).current_dir(folder.path()).output().unwrap();
        assert_eq!(String::from_utf8(answer.stdout).unwrap(), format!("{expected}\n"), "{words}");
    }
}

#[test]
fn a_tip_is_one_that_helps() {
    let folder = folder();
    let (_, message) = fail(folder.path(), "modes --format json");
    assert_eq!(message, "error: unexpected argument '--format' found\n\nFor more information, try '--help'.\n");
    assert!(fail(folder.path(), "modes --respons a.csv").1.contains("a similar argument exists: '--response'"));
}

#[test]
fn a_table_for_programs_has_the_ending_and_the_counts() {
    let folder = folder();
    let (stdout, _) =
        succeed(folder.path(), "simulate --record pulse.AT2 --scale 0 --theta-0 -0.3 --format csv -o out.csv");
    let lines: Vec<Vec<_>> = stdout.lines().map(|line| line.split(',').collect()).collect();
    let line = |name: &str| lines.iter().find(|line| line[0] == name).unwrap()[1..4].to_vec();
    assert_eq!(line("name"), ["value", "unit", "time"]);
    let end = column(&folder.path().join("out.csv"), "time[s]").pop().unwrap().to_string();
    assert_eq!(line("ending"), ["overturned", "", &end]);
    assert_eq!(line("transitions"), ["1", "1", ""]);
    assert_eq!(line("first_uplift"), ["", "", ""]);
}
