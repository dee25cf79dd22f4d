//! `sweep` driven from outside: its rows, its resumption after a violent end, its refusals, its probabilities.

mod command_line;

use command_line::{command, fail, folder, succeed};
use rocking_sweep::fragility::FragilityCurve;
use rocking_sweep::fragility::Trials;
use std::{
    collections::HashSet,
    fs::{self, File},
    process::{Command, Output},
};
use tempfile::TempDir;

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
const RUNS: usize = 54;

/// A folder with the pulse and `sweep.toml`.
fn sweep(toml: &str) -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("sweep.toml"), toml).unwrap();
    folder
}

fn read(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).unwrap()
}

/// The rows of a complete file, sorted.
fn rows(text: &str) -> Vec<&str> {
    assert!(text.ends_with('\n'));
    let mut rows: Vec<_> = text.lines().skip(1).collect();
    rows.sort_unstable();
    rows
}

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

#[test]
fn every_run_has_a_row_whatever_the_threads() {
    let folder = sweep(SWEEP);
    for (threads, output) in [(1, "one.csv"), (2, "two.csv"), (7, "seven.csv")] {
        succeed(folder.path(), &format!("sweep sweep.toml --threads {threads} -o {output}"));
    }
    succeed(folder.path(), "sweep sweep.toml");
    let one = read(&folder, "one.csv");
    let headings = "run,structures,version,m[kg],m0[kg],H[m],B[m],J0[kg.m2],f_fc[Hz],zeta_fc,c_ratio,r,g[m/s2],P_0[N],k_t[N/m],\
                    xi_d[m],c_d[N.s/m],k_d[N/m],F_y[N],slenderness,\
                    record,record_digest,record_scale,scale,PGA[g],PGV[m/s],S_a[g],detail,tolerance,duration[s],theta_0[rad],\
                    theta_dot_0[rad/s],u_0[m],u_dot_0[m/s],\
                    ending,end[s],peak_theta[rad],peak_u[m],peak_delta_t[m],peak_uplift[m],\
                    peak_a_t[m/s2],peak_V_t[N],peak_M_t[N.m],peak_theta/alpha_cg,transitions,steps,evaluations,\
                    tension_max,t_tension_max[s],R_v_min,t_R_v_min[s],mu_required,t_mu_required[s],mu_impact,\
                    t_mu_impact[s],tension_impact,t_tension_impact[s],energy_gain_max,t_energy_gain_max[s],\
                    energy_gains,settlings,reason";
    assert_eq!(one.lines().next(), Some(headings));
    assert_eq!(rows(&one).len(), RUNS);
    for other in ["two.csv", "seven.csv", "sweep.csv"] {
        assert_eq!(rows(&one), rows(&read(&folder, other)), "{other}");
    }
    assert_eq!(column(&one, "run").iter().collect::<HashSet<_>>().len(), RUNS);
}

/// A top mass that passes above the pivot of a foundation without inertia: the run is done, and not again.
#[test]
fn a_failed_run_is_an_outcome() {
    let light = "{ m = 130.1, m0 = 0, H = 1.84, B = 0.285, f_fc = 0.2, zeta_fc = 0.02, r = 0.99 }";
    let folder = sweep(&format!(
        "records = ['pulse.AT2']\nscale = [1, 6]\n[[structures]]\nname = 'light'\nparameters = {light}\n"
    ));
    let mut before = None;
    for done in [0, 2] {
        let Output { status, stdout, stderr } = command(folder.path(), "sweep sweep.toml").output().unwrap();
        let (summary, message) = (String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap());
        assert_eq!(status.code(), Some(1));
        assert!(message.starts_with(&format!("sweep.csv: {done} of 2 runs done")), "{message}");
        assert!(
            message.contains("error: 1 of 2 runs failed; the first: light, pulse.AT2, scale 6, see row "),
            "{message}"
        );
        assert!(summary.contains("1 failed and are not counted"), "{summary}");
        let text = read(&folder, "sweep.csv");
        assert_eq!(*before.get_or_insert(text.clone()), text);
    }
}

#[test]
fn a_file_cut_anywhere_is_completed() {
    let folder = sweep(SWEEP);
    let (summary, _) = succeed(folder.path(), "sweep sweep.toml");
    let whole = read(&folder, "sweep.csv");
    let first_row = whole.match_indices('\n').next().unwrap().0 + 1;
    let second_row = whole.match_indices('\n').nth(1).unwrap().0 + 1;
    for cut in [0, 30, first_row - 1, first_row, second_row - 1, whole.len() - 1] {
        fs::write(folder.path().join("sweep.csv"), &whole[..cut]).unwrap();
        assert_eq!(succeed(folder.path(), "sweep sweep.toml").0, summary);
        assert_eq!(rows(&read(&folder, "sweep.csv")), rows(&whole), "cut at {cut}");
    }
    let (again, progress) = succeed(folder.path(), "sweep sweep.toml");
    assert_eq!(again, summary);
    assert!(progress.starts_with("sweep.csv: 54 of 54 runs done") && !progress.contains("runs in"), "{progress}");
}

/// A disk that is full, until there is room again: the system refuses to write beyond a size limit.
#[cfg(unix)]
#[test]
fn the_first_row_that_cannot_be_written_is_the_last() {
    let folder = sweep(SWEEP);
    let (summary, _) = succeed(folder.path(), "sweep sweep.toml -o whole.csv");
    let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" sweep sweep.toml --threads 2";
    let program = env!("CARGO_BIN_EXE_rocking-fmu");
    let end = Command::new("sh").args(["-c", limited, program]).current_dir(folder.path()).output().unwrap();
    let message = String::from_utf8(end.stderr).unwrap();
    assert_eq!(end.status.code(), Some(1));
    assert!(message.contains("error: sweep.csv cannot be written"), "{message}");
    let text = read(&folder, "sweep.csv");
    let whole = read(&folder, "whole.csv");
    assert!(rows(&text).len() > 2 && rows(&text).iter().all(|row| rows(&whole).contains(row)), "whole rows only");
    assert_eq!(succeed(folder.path(), "sweep sweep.toml").0, summary);
    assert_eq!(rows(&read(&folder, "sweep.csv")), rows(&whole));
}

/// What changes brings rows of its own, and those that are there stay; they are not counted.
#[test]
fn rows_of_other_inputs_are_kept_and_not_counted() {
    let folder = sweep(SWEEP);
    let (summary, _) = succeed(folder.path(), "sweep sweep.toml");
    let original = read(&folder, "sweep.csv");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let pulse = read(&folder, "pulse.AT2");
    for (changed, record, done, others) in [
        (SWEEP.replace("0.5, 1, 2", "0.5, 1, 2, 2.5"), &pulse, 54, 0),
        (SWEEP.replace("0.5, 1, 2", "0.5, 1, 2.5"), &pulse, 45, 9),
        (SWEEP.replace("zeta_fc = 0.015", "zeta_fc = 0.0150001"), &pulse, 36, 18),
        (SWEEP.replace("name = 'wall'", "name = 'shear wall'"), &pulse, 36, 18),
        (SWEEP.replace("records", "time_scale = 0.5\nrecords"), &pulse, 0, 54),
        (SWEEP.into(), &pulse.replacen("0e0", "1e-9", 1), 0, 54),
        // a record that two patterns name counts once
        (SWEEP.replace("'pulse.AT2'", "'pulse.AT2', '*.AT2'"), &pulse, 54, 0),
        // What leaves the runs as they are may change: limits, patterns, comments.
        (format!("# ...\n{}", SWEEP.replace("[0.6]", "[0.1, 1.0]").replace("pulse.AT2", "p*.AT2")), &pulse, 54, 0),
    ] {
        write("sweep.toml", &changed);
        write("pulse.AT2", record);
        write("sweep.csv", &original);
        let (_, progress) = succeed(folder.path(), "sweep sweep.toml");
        assert!(progress.starts_with(&format!("sweep.csv: {done} of ")), "{changed}: {progress}");
        let said = format!("{others} row(s) are of runs that are not in this sweep (other inputs, or another build");
        assert_eq!(progress.contains(&said), others > 0, "{progress}");
        // which of two runs under one name is of which samples can be read
        let text = read(&folder, "sweep.csv");
        let digests: HashSet<_> = column(&text, "record_digest").into_iter().collect();
        assert_eq!(digests.len(), if done == 0 { 2 } else { 1 }, "{changed}");
        assert!(text.starts_with(&original));
    }
    write("sweep.toml", SWEEP);
    write("pulse.AT2", &pulse);
    assert_eq!(succeed(folder.path(), "sweep sweep.toml").0, summary);
}

/// Conditions are in the rows and in their keys; the intensity measure is neither.
#[test]
fn conditions_of_a_sweep_are_those_of_its_runs() {
    let folder = sweep(SWEEP);
    let (usual, _) = succeed(folder.path(), "sweep sweep.toml");
    let write = |text: &str| fs::write(folder.path().join("sweep.toml"), text).unwrap();
    for (line, heading, value) in [
        ("detail = 'linear'", "detail", "linear"),
        ("tolerance = 1e-6", "tolerance", "1e-6"),
        ("duration = 3", "duration[s]", "3.0"),
        ("initial = { theta_0 = 0.01, u_0 = 1e-3 }", "theta_0[rad]", "0.01"),
    ] {
        write(&format!("{line}\n{SWEEP}"));
        let (_, progress) = succeed(folder.path(), "sweep sweep.toml -o other.csv");
        assert!(progress.contains(": 0 of 54 runs done"), "{line}: {progress}");
        let text = read(&folder, "other.csv");
        assert!(column(&text, heading).iter().all(|found| *found == value), "{line}");
        if line.starts_with("duration") {
            let end = |(ending, end): (&&str, &str)| *ending == "overturned" || (*ending == "at time" && end == "3.0");
            assert!(column(&text, "ending").iter().zip(column(&text, "end[s]")).all(end));
        }
        fs::remove_file(folder.path().join("other.csv")).unwrap();
    }
    for (measure, unit) in [("PGV", "m/s"), ("S_a", "g")] {
        write(&format!("intensity = '{measure}'\n{SWEEP}"));
        let (table, progress) = succeed(folder.path(), "sweep sweep.toml");
        assert!(progress.starts_with("sweep.csv: 54 of 54 runs done"), "{progress}");
        assert!(table.contains(&format!("{measure}: from ")) && table.contains(&format!(" to ({unit}) ")), "{table}");
        assert_ne!(table, usual);
        assert!(read(&folder, "sweep.svg").contains(&format!("({unit})")));
    }
}

#[test]
fn two_sweeps_do_not_write_to_one_file() {
    let folder = sweep(SWEEP);
    let file = File::create(folder.path().join("sweep.csv")).unwrap();
    file.lock().unwrap();
    let (_, message) = fail(folder.path(), "sweep sweep.toml");
    assert_eq!(message, "error: sweep.csv: another sweep is writing to it: wait for its end\n");
}

/// The printed probabilities are those counted in the rows, and the curve is the fit to them.
#[test]
fn probabilities_and_curve_are_those_of_the_rows() {
    let folder = sweep(SWEEP);
    let (summary, _) = succeed(folder.path(), "sweep sweep.toml");
    let text = read(&folder, "sweep.csv");
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
        summary.contains("\noverturned: no curve: runs overlap nowhere: those within it go up to 0.598816, "),
        "{summary}"
    );

    assert!(summary.contains("\na run that overturns exceeds every limit\n"), "{summary}");

    let picture = read(&folder, "sweep.svg");
    for text in ["peak ground acceleration PGA (g)", "pier: overturned", "wall: theta/alpha_cg &gt;= 0.6"] {
        assert!(picture.contains(text), "{text}");
    }
    // A dot per scale factor and limit, and one in the legend.
    assert_eq!(picture.matches("<circle").count(), 4 * (6 + 1));
}

/// Few exceed the limit up to the strongest ground motion: what the curve makes of that is marked.
#[test]
fn a_median_beyond_the_runs_is_marked() {
    let toml = "
records = ['pulse.AT2']
scale = [1, 1.2]
[[structures]]
name = 'pier'
preset = 'mcmanus'
vary = { slenderness = [4, 5, 6, 8], r = [0.8, 0.9, 1] }
[limits]
\"theta/alpha_cg\" = [0.6]
";
    for (scales, is_beyond) in [("[1, 1.2]", true), ("[1, 1.2, 2]", false)] {
        let folder = sweep(&toml.replace("[1, 1.2]", scales));
        let (table, _) = succeed(folder.path(), "sweep sweep.toml");
        assert_eq!(table.contains("beyond the runs"), is_beyond, "{table}");
        assert_eq!(read(&folder, "sweep.svg").contains("beyond the runs: "), is_beyond, "the picture says so, too");
        let json = succeed(folder.path(), "sweep sweep.toml --format json --quiet").0;
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let of_limit = json.as_array().unwrap().iter().find(|curve| curve["median"].is_number()).unwrap();
        let strongest = of_limit["bins"].as_array().unwrap().last().unwrap()["highest"].as_f64().unwrap();
        assert_eq!(of_limit["median_is_beyond_the_runs"], is_beyond);
        assert_eq!(of_limit["median"].as_f64().unwrap() > strongest, is_beyond);
    }
}
