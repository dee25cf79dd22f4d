//! `record`, and the options by which every command reads one.

mod command_line;

use approx::assert_relative_eq;
use command_line::{DT, SAMPLES, command, fail, folder, pulse, succeed};
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;

const G: f64 = 9.81;

/// The pulse, which nobody reads without options: counted samples, and accelerations in mg beside others.
fn write_odd(folder: &Path) {
    let line = |i: usize| format!("{} {:e} {}\n", i + 1, 1e3 * pulse(i), i % 3);
    let text = (0..SAMPLES).map(line).collect::<String>();
    fs::write(folder.join("odd.txt"), "n   east   west\n".to_owned() + &text).unwrap();
}

const OPTIONS: &str = "--dt 0.01 --column east --unit mg --scale 2 --time-scale 0.5";

/// A sine of A and T: A T/π, π/(2 g) A² T/2, A T²/(2π), but for the chords' share of (ω h)²/6.
#[test]
fn what_a_record_amounts_to_is_that_of_a_sine() {
    let folder = folder();
    let (printed, _) = succeed(folder.path(), "record pulse.AT2 --format json --picture pulse.svg -o pulse.csv");
    let printed: Value = serde_json::from_str(&printed).unwrap();
    let lines = printed["rows"].as_array().unwrap();
    let amount = |name: &str| lines.iter().find(|line| line["name"] == name).unwrap()["value"].as_f64().unwrap();
    assert_eq!((&printed["file"], &printed["record_unit"]), (&"pulse.AT2".into(), &"g".into()));
    assert_eq!((&printed["scale"], &printed["time_scale"]), (&1.0.into(), &1.0.into()));
    assert!(printed["record"].is_string() && printed["version"].is_string(), "{printed}");
    let (a, period) = (0.6 * G, 0.5);
    let error = (TAU / period * DT).powi(2) / 4.0;
    assert_relative_eq!(amount("PGA"), a, max_relative = error);
    assert_relative_eq!(amount("PGV"), a * period / PI, max_relative = error);
    assert_relative_eq!(amount("I_A"), PI / (2.0 * G) * a * a * period / 2.0, max_relative = error);
    assert_relative_eq!(2.0 * amount("t_5") + amount("D_5-95"), period, max_relative = 1e-9); // the sine is as strong from behind
    assert_relative_eq!(amount("v_end"), 0.0, epsilon = 1e-12);
    assert_relative_eq!(amount("d_end"), a * period * period / TAU, max_relative = error);
    assert_eq!(amount("samples"), SAMPLES as f64);
    let table = fs::read_to_string(folder.path().join("pulse.csv")).unwrap();
    assert!(table.starts_with("time[s],a_g[g]\n0.0,0.0\n0.01,"), "{table}");
    assert!(fs::read_to_string(folder.path().join("pulse.svg")).unwrap().contains("period T (s)"));
}

/// The table that `record` writes with options is read as the file is with them: by `simulate`, by a sweep, in an archive.
#[test]
fn every_command_reads_with_the_same_options() {
    let folder = folder();
    let here = folder.path();
    write_odd(here);
    succeed(here, &format!("record odd.txt {OPTIONS} -o plain.csv"));
    let peaks = |arguments: &str| {
        let (printed, _) = succeed(here, &format!("simulate --preset mcmanus --format json -o rows.csv {arguments}"));
        serde_json::from_str::<Value>(&printed).unwrap()["peaks"].clone()
    };
    let expected = peaks("--record plain.csv");
    assert!(expected[0]["peak"].as_f64().unwrap() > 0.0, "{expected}");
    let in_mg = |(one, other): (&Value, &Value)| {
        assert_relative_eq!(one["peak"].as_f64().unwrap(), other["peak"].as_f64().unwrap(), max_relative = 1e-6);
    };
    let found = peaks(&format!("--record odd.txt {OPTIONS}"));
    found.as_array().unwrap().iter().zip(expected.as_array().unwrap()).for_each(in_mg);

    let sweep = |record: &str| {
        let file = format!("records = [{record}]\nscale = [1]\n[[structures]]\nname = 'pier'\npreset = 'mcmanus'\n");
        fs::write(here.join("sweep.toml"), file).unwrap();
        succeed(here, "sweep sweep.toml -o sweep.csv");
        let rows = fs::read_to_string(here.join("sweep.csv")).unwrap();
        fs::remove_file(here.join("sweep.csv")).unwrap();
        let headings: Vec<_> = rows.lines().next().unwrap().split(',').map(str::to_owned).collect();
        let column = headings.iter().position(|heading| heading.starts_with("peak_theta[")).unwrap();
        rows.lines().nth(1).unwrap().split(',').nth(column).unwrap().parse::<f64>().unwrap()
    };
    let options = "dt = 0.01, column = 'east', unit = 'mg', time_scale = 0.5, scale = 2";
    let found = sweep(&format!("{{ file = 'odd.txt', {options} }}"));
    assert_relative_eq!(found, sweep("'plain.csv'"), max_relative = 1e-6);
    for (keys, expected) in [
        ("column = 'east'", "the time between samples is not known; give it, { file = ..., dt = SECONDS }\n"),
        ("colum = 2", "unknown field `colum`, expected one of `unit`, `dt`, `column`"),
        ("dt = -1", "dt = -1 is out of range: a finite number greater than 0 is needed\n"),
    ] {
        fs::write(here.join("bad.toml"), format!("records = [{{ file = 'odd.txt', {keys} }}]\nscale = [1]\nstructures = [{{ name = 'pier', preset = 'mcmanus' }}]\n")).unwrap();
        let (_, message) = fail(here, "sweep bad.toml");
        assert!(message.contains(expected), "{message}");
    }

    succeed(here, &format!("export --record odd.txt {OPTIONS} -o odd.fmu"));
    let mut archive = zip::ZipArchive::new(fs::File::open(here.join("odd.fmu")).unwrap()).unwrap();
    let packed = std::io::read_to_string(archive.by_name("resources/odd.csv").unwrap()).unwrap();
    assert_eq!(packed, fs::read_to_string(here.join("plain.csv")).unwrap());
    fs::write(here.join("block.txt"), "0.1 0.3 0.2\n0.4 -0.1 0.2\n").unwrap();
    fs::write(here.join("lines.csv"), "time[s],a_g[m/s2]\n0,.1\n.01,.3\n.02,.2\n.03,.4\n.04,-.1\n.05,.2\n").unwrap();
    assert_eq!(sweep("{ file = 'block.txt', dt = 0.01, column = 'all' }"), sweep("'lines.csv'"));
    let (_, refused) = fail(here, "record block.txt --dt 0.01");
    assert!(refused.contains("--column NUMBER") && refused.contains("--column all"), "{refused}");
    succeed(here, "export --record block.txt --dt 0.01 --column all -o block.fmu");
    let (_, refused) = fail(here, "export --record odd.txt -o odd.fmu");
    assert!(refused.ends_with("choose with --column, by number or heading\n"), "{refused}");
}

#[test]
fn a_record_and_parameters_come_from_standard_input_each_alone() {
    let folder = folder();
    let piped = |arguments: &str, input: &[u8]| {
        let mut child = command(folder.path(), arguments);
        let mut child = child.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(input).unwrap();
        let output = child.wait_with_output().unwrap();
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let record = fs::read(folder.path().join("pulse.AT2")).unwrap();
    for command in ["record FILE --format csv", "estimate --preset mcmanus --format csv --record FILE"] {
        let (expected, _) = succeed(folder.path(), &command.replace("FILE", "pulse.AT2"));
        let found = piped(&command.replace("FILE", "-"), &record).0;
        assert_eq!(found.replace(",-,", ",pulse.AT2,"), expected, "but for the name of the file");
    }
    piped("view --record - --duration 0.1", &record);
    assert!(folder.path().join("record_view.html").exists());
    let parameters = succeed(folder.path(), "describe --template --preset evison").0;
    let expected = succeed(folder.path(), "describe --preset evison --format csv").0;
    assert_eq!(piped("describe --parameters - --format csv", parameters.as_bytes()).0, expected);
    let (_, refused) = piped("estimate --parameters - --record -", parameters.as_bytes());
    assert_eq!(refused, "error: standard input is read already: only one file can be `-`\n");
    let (_, refused) = piped("record -", b"0;1\n0.5;?\n");
    assert_eq!(refused, "error: standard input, line 2: the acceleration \"?\" is not a number\n");
}
