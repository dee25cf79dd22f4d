//! `advise` and `simulate --detail` driven from outside, against engines driven here.
#![allow(non_snake_case)] // the paper's own letters

mod command_line;

use command_line::{DT, SAMPLES, folder, pulse, succeed};
use rocking::estimates::demand::Demand;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::estimates::response_spectrum::spectral_acceleration;
use rocking::run::record::{Reading, Record};
use rocking::{Detail, Engine, Load, Parameters, Ramp, State, Structure, engine::DEFAULT_TOLERANCE};
use std::f64::consts::TAU;

/// The columns of the row of `level`.
fn row<'a>(table: &'a str, level: &str) -> Vec<&'a str> {
    let columns = |line: &'a str| line.trim_start_matches('>').split_whitespace().collect::<Vec<_>>();
    table.lines().map(columns).find(|row| row.first() == Some(&level)).unwrap_or_else(|| panic!("{level}\n{table}"))
}

/// McManus under the pulse, seen at `parts` instants of every sample; `see` is shown the engine at each.
fn run(detail: Detail, tolerance: f64, parts: usize, mut see: impl FnMut(&Engine, f64)) -> Engine {
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    let mut engine = Engine::with_detail(structure, State::default(), 0.0, tolerance, detail).unwrap();
    for i in 1..SAMPLES {
        let [from, to] = [i - 1, i].map(|i| 9.81 * pulse(i));
        let (start, duration) = ((i - 1) as f64 * DT, i as f64 * DT - (i - 1) as f64 * DT);
        for part in 1..=parts {
            let elapsed = engine.motion().time - start;
            let a_g = Ramp { value: from + (to - from) * elapsed / duration, slope: (to - from) / duration };
            let until = if part == parts { i as f64 * DT } else { start + duration * part as f64 / parts as f64 };
            engine.advance(until - engine.motion().time, a_g, &mut ()).unwrap();
            see(&engine, from + (to - from) * (until - start) / duration);
        }
    }
    engine
}

/// Peaks of theta, u, a_t, and their histories, seen at 100 instants of every sample.
fn seen(detail: Detail, tolerance: f64) -> ([f64; 3], Vec<[f64; 3]>) {
    let (mut peaks, mut history) = ([0.0f64; 3], Vec::new());
    run(detail, tolerance, 100, |engine, a_g| {
        let outputs = engine.outputs(Load::ground(a_g));
        let values = [outputs.theta, outputs.u, outputs.a_t];
        for (peak, value) in peaks.iter_mut().zip(values) {
            *peak = peak.max(value.abs());
        }
        history.push(values);
    });
    (peaks, history)
}

#[test]
fn the_errors_are_those_of_the_engines() {
    let folder = folder();
    let (table, _) = succeed(folder.path(), "advise --record pulse.AT2 --duration 4");
    let (expected, expected_history) = seen(Detail::Nonlinear, 1e-12);
    for detail in [Detail::FixedBase, Detail::Rigid, Detail::Modal, Detail::Linear] {
        let (peaks, history) = seen(detail, DEFAULT_TOLERANCE);
        let row = row(&table, detail.name());
        let of_peaks = [0, 1, 2].map(|i| (peaks[i] - expected[i]).abs() / expected[i]);
        let of_histories = [0, 1, 2].map(|i| {
            let differences =
                history.iter().zip(&expected_history).map(|(found, expected)| (found[i] - expected[i]).abs());
            differences.fold(0.0, f64::max) / expected[i]
        });
        for (shown, error) in row[1..7].iter().zip(of_peaks.into_iter().chain(of_histories)) {
            let shown: f64 = shown.parse().unwrap();
            // what is seen between instants there and at instants here, and rounded
            assert!((shown - 100.0 * error).abs() < 0.02 + 5e-3 * shown, "{}: {shown} {error}", detail.name());
        }
    }
    for detail in [Detail::Auto, Detail::Linear, Detail::Rigid, Detail::FixedBase] {
        let work = run(detail, DEFAULT_TOLERANCE, 1, |_, _| ()).motion().work;
        assert_eq!(row(&table, detail.name())[8..10], [work.steps.to_string(), work.evaluations.to_string()]);
    }

    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    let (record, _) = Record::read(&folder.path().join("pulse.AT2"), &Reading::default(), 9.81).unwrap();
    let S_a = spectral_acceleration(&record, TAU / structure.omega_u, structure.zeta_u);
    let estimate = Demand::new(&structure, S_a, 2.0).unwrap().a_t;
    let shown: f64 = row(&table, "estimate")[3].parse().unwrap();
    assert!((shown - 100.0 * (estimate / expected[2] - 1.0).abs()).abs() < 0.02 + 2e-3 * shown, "{shown}");
    let f_r = effective_frequency(&structure, expected[0]);
    assert!(table.contains(&format!("at that theta: {f_r:.4}")), "{f_r}\n{table}");
}

#[test]
fn a_base_that_never_lifts_off_is_a_fixed_base() {
    let folder = folder();
    let (table, _) = succeed(folder.path(), "advise --record pulse.AT2 --scale 0.1");
    assert!(table.contains("0 transitions") && table.contains("the base never lifts off"), "{table}");
    assert!(table.contains("\nuse detail = fixed_base: "), "{table}");
    assert!(table.lines().any(|line| line.starts_with("> fixed_base")), "{table}");
    for level in ["fixed_base", "modal", "linear", "auto", "nonlinear"] {
        let row = row(&table, level);
        assert_eq!([row[1], row[4], row[7]], ["0", "0", "no"], "{level}");
    }
    assert!(!table.contains("NaN"), "{table}");
}

#[test]
fn a_level_that_contradicts_the_initial_values_is_named_with_its_reason() {
    let folder = folder();
    let (table, _) =
        succeed(folder.path(), "advise --preset evison --free 1 --theta-0 0.04 --u-0 1e-3 --within 0.001%");
    for line in [
        "  fixed_base not possible here: theta_0 = 0.04 rad contradicts detail = fixed_base, where the base cannot turn: \
         set theta_0 to 0",
        "  rigid      not possible here: u_0 = 0.001 m, u_dot_0 = 0.0 m/s contradict detail = rigid, where u is always 0: \
         set both to 0",
        "use detail = auto: of the cheapest levels within 0.001 % in theta, u, a_t, theta_history, u_history, a_t_history \
         the simplest",
    ] {
        assert!(table.lines().any(|found| found == line), "{line}\n{table}");
    }
}

/// A pulse that overturns the structure: the fixed base is wrong about it, and no limit makes up for that.
#[test]
fn a_level_that_misses_overturning_is_not_advised() {
    let folder = folder();
    let (table, _) = succeed(folder.path(), "advise --record pulse.AT2 --scale 4 --within 99% --of theta");
    assert_eq!(row(&table, "auto")[7], "yes");
    assert_eq!(row(&table, "fixed_base")[7..9], ["no,", "wrong"]);
    assert!(!table.contains("use detail = fixed_base"), "{table}");
}

/// Without a loss at impacts it rocks on: nobody knows better than the reference.
#[test]
fn nothing_is_wrong_where_the_reference_does_not_know() {
    let folder = folder();
    let run = "advise --record pulse.AT2 --preset mcmanus --r 1 --zeta-fc 0";
    let (table, _) = succeed(folder.path(), run);
    assert!(table.contains("whether it overturns is not known") && !table.contains("wrong"), "{table}");
    assert_eq!(row(&table, "fixed_base")[7..9], ["no", "(?)"]);
    assert_eq!(row(&table, "nonlinear")[7], "unknown");
    let (rows, _) = succeed(folder.path(), &format!("{run} --format csv"));
    let lines: Vec<Vec<_>> = rows.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| lines[0].iter().position(|heading| *heading == name).unwrap();
    assert!(lines[1..].iter().all(|line| line[column("is_right_about_overturning")].is_empty()), "{rows}");
    let reference = &lines[1];
    assert_eq!(reference[0], "reference");
    let theta: f64 = reference[column("theta")].parse().unwrap();
    assert!(table.contains(&format!("peaks: theta {theta:.6} rad")), "{theta}\n{table}");
}
