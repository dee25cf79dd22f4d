//! `sweep` driven from outside: its probabilities. The tour shows its rows.

use crate::{folder, succeed};
use rocking_sweep::fragility::FragilityCurve;
use rocking_sweep::fragility::Trials;
use std::fs;

/// 9 structures at 6 scale factors: some stay in contact, some rock, some overturn.
const SWEEP: &str = "
records = ['pulse.AT2']
scale = [0.5, 1, 2, 3, 4, 6]
[[structures]]
name = 'pier'
preset = 'mcmanus'
vary = { slenderness = [4, 6, 8], r = [0.9, 1] }
[[structures]]
name = 'wall'
parameters = { m = 125.8, m0 = 44.02, H = 1.05, B = 0.285, f_fc = 11, zeta_fc = 0.015, r = 0.96 }
vary.B = { from = 0.2, to = 0.3, count = 3 }
[limits]
\"theta/alpha_cg\" = [0.6]
";

/// The values in the column `heading`, in the order of the runs.
fn column<'a>(text: &'a str, heading: &str) -> Vec<&'a str> {
    let headings: Vec<_> = text.lines().next().unwrap().split(',').collect();
    let position = |heading| headings.iter().position(|found| *found == heading).unwrap();
    let mut rows: Vec<Vec<_>> = text.lines().skip(1).map(|row| row.split(',').collect()).collect();
    rows.sort_by(|a, b| {
        let number = |row: &[&str], heading| row[position(heading)].parse::<f64>().unwrap();
        let numbers = |row: &[&str]| ["B[m]", "r", "slenderness", "scale"].map(|heading| number(row, heading));
        let population = position("structures");
        a[population].cmp(b[population]).then(numbers(a).partial_cmp(&numbers(b)).unwrap())
    });
    rows.into_iter().map(|row| row[position(heading)]).collect()
}

/// The printed probabilities are those counted in the rows, and the curve is the fit to them.
#[test]
fn probabilities_and_curve_are_those_of_the_rows() {
    let folder = folder();
    let folder = folder.path();
    fs::write(folder.join("sweep.toml"), SWEEP).unwrap();
    let (summary, _) = succeed(folder, "sweep sweep.toml");
    let text = fs::read_to_string(folder.join("sweep.csv")).unwrap();
    let ending = column(&text, "ending");
    let relative: Vec<f64> = column(&text, "peak_theta/alpha_cg").iter().map(|value| value.parse().unwrap()).collect();
    let pga: Vec<f64> = column(&text, "PGA[g]").iter().map(|value| value.parse().unwrap()).collect();
    let table: Vec<Vec<_>> = summary.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(summary.lines().next(), Some("pier"));
    assert_eq!(table[1].join(" "), "PGA: from mean to (g) runs overturned theta/alpha_cg >= 0.6");
    let pier = |scale: usize| (0..36).filter(move |run| run % 6 == scale);
    let mut trials = Vec::new();
    for scale in 0..6 {
        let exceedances = pier(scale).filter(|run| ending[*run] == "overturned").count();
        let large = pier(scale).filter(|run| relative[*run] >= 0.6).count();
        let parts = [exceedances, large].map(|count| [format!("{:.4}", count as f64 / 6.0), format!("{count}/6")]);
        assert_eq!(table[2 + scale][3..], ["6", &parts[0][0], &parts[0][1], &parts[1][0], &parts[1][1]]);
        let mean: f64 = table[2 + scale][1].parse().unwrap();
        assert!((mean / pga[scale] - 1.0).abs() < 1e-5);
        let structures = pier(scale).enumerate().map(|(structure, run)| Trials {
            group: structure,
            intensity: pga[scale],
            runs: 1,
            exceedances: usize::from(ending[run] == "overturned"),
        });
        trials.extend(structures);
    }
    let curve = FragilityCurve::fit(&trials).unwrap();
    let (low, high) = curve.median_range().unwrap();
    let printed = [8, 9, 10, 11].map(|line| table[line][table[line].len() - 2].parse::<f64>().unwrap());
    for (printed, expected) in printed.into_iter().zip([curve.median, low, high, curve.dispersion]) {
        assert!((printed / expected - 1.0).abs() < 1e-5, "{printed} {expected}");
    }
    assert!(
        summary.contains("\noverturned: no curve: dispersion unknown: runs within the limit end at 0.598816, "),
        "{summary}"
    );

    assert!(summary.contains("\na run that overturns exceeds every limit\n"), "{summary}");

    let picture = fs::read_to_string(folder.join("sweep.svg")).unwrap();
    for text in ["peak ground acceleration PGA (g)", "pier: overturned", "wall: theta/alpha_cg &gt;= 0.6"] {
        assert!(picture.contains(text), "{text}");
    }
    // A dot per scale factor and limit, and one in the legend.
    assert_eq!(picture.matches("<circle").count(), 4 * (6 + 1));
}
