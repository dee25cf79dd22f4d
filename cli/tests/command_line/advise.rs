//! `advise` driven from outside, against runs that are looked at here.

use crate::{DT, SAMPLES, folder, succeed};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::estimates::demand::Demand;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::estimates::response_spectrum::spectral_acceleration;
use rocking::{Detail, OneMass, Parameters, Run, run::End};
use rocking_records::Reading;
use std::f64::consts::TAU;

/// The columns of the row of `level`.
fn row<'a>(table: &'a str, level: &str) -> Vec<&'a str> {
    let columns = |line: &'a str| line.trim_start_matches('>').split_whitespace().collect::<Vec<_>>();
    table.lines().map(columns).find(|row| row.first() == Some(&level)).unwrap_or_else(|| panic!("{level}\n{table}"))
}

#[test]
fn the_errors_are_those_of_the_runs() {
    let folder = folder();
    let (table, _) = succeed(folder.path(), "advise --record pulse.AT2 --duration 4");
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    let (record, _) = rocking_records::read(&folder.path().join("pulse.AT2"), &Reading::default(), 9.81).unwrap();
    // theta, u, a_t at 100 instants of every sample, their peaks, and the work that it took
    let seen = |detail, tolerance| {
        let run = Run { detail, tolerance, end: End::At(4.0), ..Run::new(structure, &record) };
        let mut history = Vec::new();
        let times = (0..100 * SAMPLES).map(|i| i as f64 * DT / 100.0);
        let see = |sample: &rocking::engine::piece::Sample| {
            let outputs = sample.outputs();
            history.push([outputs.theta, outputs.u, outputs.a_t]);
        };
        let work = run.sample(times, see, &mut ()).unwrap().motion.work;
        let peaks = [0, 1, 2].map(|i| history.iter().fold(0.0_f64, |peak, values| peak.max(values[i].abs())));
        (peaks, history, work)
    };
    let (expected, expected_history, _) = seen(Detail::Nonlinear, 1e-12);
    for detail in [Detail::FixedBase, Detail::Rigid, Detail::Modal, Detail::Linear] {
        let (peaks, history, work) = seen(detail, DEFAULT_TOLERANCE);
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
        assert_eq!(row[8..10], [work.steps.to_string(), work.evaluations.to_string()]);
    }
    let S_a = spectral_acceleration(&record, TAU / structure.omega_u, structure.zeta_u);
    let estimate = Demand::new(&structure, S_a, 2.0).unwrap().a_t;
    let shown: f64 = row(&table, "estimate")[3].parse().unwrap();
    assert!((shown - 100.0 * (estimate / expected[2] - 1.0).abs()).abs() < 0.02 + 2e-3 * shown, "{shown}");
    let f_r = effective_frequency(&structure, expected[0]).unwrap();
    assert!(table.contains(&format!("at that theta: {f_r:.4}")), "{f_r}\n{table}");
}
