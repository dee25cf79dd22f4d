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

/// What an editor of another system makes of the file is gone on with; rows that are there twice count once.
#[test]
fn lines_may_end_as_they_do_elsewhere_and_be_there_twice() {
    let folder = sweep(SWEEP);
    let (summary, _) = succeed(folder.path(), "sweep sweep.toml");
    let whole = read(&folder, "sweep.csv");
    let lines: Vec<_> = whole.lines().take(20).chain(whole.lines().skip(1).take(3)).collect();
    let edited: String = lines.iter().map(|line| format!("{line}\r\n")).collect();
    fs::write(folder.path().join("sweep.csv"), &edited).unwrap();
    let (again, said) = succeed(folder.path(), "sweep sweep.toml");
    assert!(said.starts_with("sweep.csv: 19 of 54 runs done"), "{said}");
    assert!(said.contains("sweep.csv: 3 row(s) are there again: counted once"), "{said}");
    assert_eq!(again, summary);
    assert!(read(&folder, "sweep.csv").starts_with(&edited));
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

/// Two values of H/B whose products with B are one H.
#[test]
fn runs_that_are_the_same_are_refused() {
    let folder = sweep(&SWEEP.replace("[4, 6, 8], r", "[7.142857142857144, 7.142857142857145], r"));
    let (code, message) = fail(folder.path(), "sweep sweep.toml --quiet");
    let expected = "error: two runs are the same: values that vary differ by less than a rounding error\n";
    assert_eq!((code, message.as_str()), (1, expected));
}

#[test]
fn a_refused_sweep_says_what_to_change() {
    for (from, to, expected) in [
        ("pulse.AT2", "absent*.AT2", "records: there is no file absent*.AT2"),
        ("'pulse.AT2'", "", "records is empty: give one or more"),
        ("[0.5, 1, 2, 3, 4, 6]", "[0, 1]", "scale = 0 leaves no ground motion: leave it out"),
        ("[0.5, 1, 2, 3, 4, 6]", "[nan]", "scale = NaN is not a finite number"),
        ("records", "time_scale = -1\nrecords", "time_scale = -1.0 and scale = 1.0 leave no ground motion of"),
        ("name = 'wall'", "name = 'pier'", "two populations have the name \"pier\": rename one"),
        ("preset = 'mcmanus'\n", "", "structures \"pier\": give either preset or parameters"),
        ("[4, 6, 8], r", "[4], H = [1], r", "structures \"pier\": H and slenderness cannot both vary"),
        ("r = [0.9, 1]", "q = [1]", "structures \"pier\": \"q\" cannot vary: these can: m, m0, H, B, J0, f_fc"),
        ("r = [0.9, 1]", "r = [0, 1]", "structures \"pier\": r = 0"),
        ("r = 0.96", "r = 0.96, g = 1.62", "g = 1.62 m/s2 and g = 9.81 m/s2: a sweep has one g"),
        ("\"theta/alpha_cg\"", "drift", "limits: \"drift\" is unknown; these are known: theta, u, delta_t, uplift"),
        ("[0.6]", "[0]", "limits: theta/alpha_cg = 0 is out of range"),
        ("[0.6]", "[]", "limits: theta/alpha_cg is empty: give one or more\n"),
        ("'pulse.AT2'", "'zero.csv'", "the ground motion \"zero.csv\" is at rest throughout: leave it out\n"),
        (
            "'pulse.AT2'",
            "'pulse.AT2', { file = 'p*.AT2', scale = 2 }",
            "pulse.AT2 is named twice in records, with different options: leave one out\n",
        ),
        ("'pulse.AT2'", "{ file = 'pulse.AT2', scale = 0 }", "the ground motion \"pulse.AT2\" is at rest throughout"),
        (
            "'pulse.AT2'",
            "'pulse.AT2', 'copy/pulse.AT2'",
            "the ground motions \"pulse.AT2\" and \"copy/pulse.AT2\": they are the same and would count twice: leave one out\n",
        ),
        ("records", "intensity = 'PGD'\nrecords", "intensity = \"PGD\" is unknown; these are known: PGA, PGV, S_a\n"),
        ("records", "tolerance = 1\nrecords", "tolerance = 1 is out of range: a number between 0 and 1 is needed\n"),
        ("records", "duration = -1\nrecords", "duration = -1 is out of range: a finite number greater than 0"),
        ("[0.5, 1, 2, 3, 4, 6]", "[1, 2, 1]", "scale = 1 is there twice and would count twice: leave one out"),
        (
            "[0.5, 1, 2, 3, 4, 6]",
            "{ from = 1, to = 2, count = 100000000000 }",
            "scale: count = 100000000000 is out of range: 2 to 10000000 values are possible from 1 to 2",
        ),
        (
            "[0.5, 1, 2, 3, 4, 6]",
            "{ from = 1, to = 2, count = 2000000 }",
            "9 structures x 1 ground motions x 2000000 scale factors: more than 10000000 runs",
        ),
        ("r = [0.9, 1]", "g = [9.81]", "structures \"pier\": g cannot vary: a sweep has one g"),
        ("records", "record", "TOML parse error at line 2, column 1"),
        ("records", "initial = { theta = 1 }\nrecords", "TOML parse error at line 2, column 13"),
    ] {
        assert!(SWEEP.contains(from));
        let folder = sweep(&SWEEP.replacen(from, to, 1));
        fs::write(folder.path().join("zero.csv"), "0,0\n.05,0\n").unwrap();
        fs::create_dir(folder.path().join("copy")).unwrap();
        fs::copy(folder.path().join("pulse.AT2"), folder.path().join("copy/pulse.AT2")).unwrap();
        let (code, message) = fail(folder.path(), "sweep sweep.toml");
        assert_eq!(code, 1);
        assert!(message.starts_with(&format!("error: sweep in sweep.toml: {expected}")), "{message}");
        assert!(!folder.path().join("sweep.csv").exists(), "nothing is written");
    }
    let folder = sweep(SWEEP);
    let (code, message) = fail(folder.path(), "sweep sweep.toml --threads 0");
    assert!(code == 2 && message.contains("0 is not in 1..=1024"), "{message}");
}

/// The file of something else, or with a row that nobody can read, is left as it is.
#[test]
fn a_damaged_file_is_refused_by_its_line() {
    let folder = sweep(SWEEP);
    succeed(folder.path(), "sweep sweep.toml --threads 1");
    let whole = read(&folder, "sweep.csv");
    let (headings, rows) = whole.split_once('\n').unwrap();
    let row = rows.lines().next().unwrap();
    let not_headings = format!(
        "line 1 is not the headings of this sweep's rows, in this version of the program: name another file with -o, or \
         remove this one. These are the headings:\n{headings}\n"
    );
    for (content, expected) in [
        (rows.to_owned(), not_headings.as_str()),
        ("# rocking-fmu sweep\n".into(), &not_headings),
        (whole.replacen(row, "1,2", 1), "CSV error: record 1 (line: 2, "),
        (whole.replacen(&row[..30], "key", 1), "line 2 cannot be read: remove it, to do its run again: "),
    ] {
        fs::write(folder.path().join("sweep.csv"), &content).unwrap();
        let (code, message) = fail(folder.path(), "sweep sweep.toml");
        assert!(code == 1 && message.starts_with(&format!("error: sweep.csv: {expected}")), "{message}");
        assert_eq!(read(&folder, "sweep.csv"), content);
    }
}
