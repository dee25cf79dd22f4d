//! The command line driven from outside: what `simulate` writes.

use FlexibleRocking::{resources::Contents, variables::Table};
use fmi_unit::{Causality, DataType, Variable};
use rocking::engine::piece::Sample;
use rocking::{Detail, Output, Parameters, Run, Structure, run::End};
use rocking_records::Reading;
use std::{collections::BTreeSet, fs, path::Path, process::Command};
use tempfile::TempDir;

/// An empty folder with sines of 0.6 g and 0.5 s, which lift and land the McManus specimen.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    succeed(folder.path(), "pulse sine --amplitude 0.6 --period 0.5 --cycles 10");
    folder
}

fn succeed(folder: &Path, arguments: &str) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rocking-fmu"));
    let status = command.current_dir(folder).args(arguments.split_whitespace()).args(["--preset", "mcmanus"]).status();
    assert!(status.unwrap().success(), "{arguments}");
}

/// The headings and lines of the response in `folder`.
fn table(folder: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(folder.join("out.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
    (lines.next().unwrap(), lines.collect())
}

#[test]
fn the_response_has_every_output_of_the_fmu_under_its_name_and_unit() {
    let folder = folder();
    succeed(folder.path(), "simulate --record pulse.csv -o out.csv");
    let (headings, lines) = table(folder.path());
    assert!(lines.iter().all(|line| line.len() == 28 && line.iter().all(|cell| !cell.is_empty())));
    let mut expected = BTreeSet::from(["time[s]".to_owned(), "a_g[m/s2]".to_owned()]);
    expected.insert("a_v[m/s2]".to_owned());
    let locals = ["theta_dot", "u_dot", "phase", "transitions", "e_p1", "e_p2", "E_viscous", "E_hysteretic"];
    let contents = Contents::from(Structure::new(Parameters::MCMANUS).unwrap());
    let is_shown = |v: &&Variable| v.causality == Causality::Output || locals.contains(&&*v.name);
    expected.extend(Table::new(&contents).variables.iter().filter(is_shown).map(|variable| match variable.data_type {
        DataType::Real { unit, .. } => format!("{}[{unit}]", variable.name),
        _ => variable.name.to_string(),
    }));
    assert_eq!(headings.into_iter().collect::<BTreeSet<_>>(), expected);
}

/// At every level the CSV holds the bits that the engine has.
#[test]
fn the_response_reads_back_to_the_engines_numbers() {
    let folder = folder();
    let record = rocking_records::read(&folder.path().join("pulse.csv"), &Reading::default(), 9.81).unwrap().0;
    let ground = record.scaled(0.5, -2.0).unwrap();
    for detail in Detail::ALL {
        let level = format!("--detail {} --duration 2 -o out.csv", detail.name());
        succeed(folder.path(), &format!("simulate --record pulse.csv --scale -2 --time-scale 0.5 {level}"));
        let mut lines = table(folder.path()).1.into_iter();
        let run = Run { detail, end: End::At(2.0), ..Run::new(Structure::new(Parameters::MCMANUS).unwrap(), &ground) };
        let compare = |sample: &Sample| {
            let line = lines.next().unwrap();
            let (r, i) = (sample.reactions(), sample.motion.impulse);
            let of_motion = Vec::from_iter(Output::all(&run.structure).into_iter().map(sample.outputs()));
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
