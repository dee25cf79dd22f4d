//! The columns of validity in the rows of a `sweep`, against the library's own runs.

use crate::{folder, succeed};
use rocking::run::validity::{ASSUMPTIONS, Findings, Limits};
use rocking::{Parameters, Run, Structure};
use rocking_records::Reading;
use std::{fs, path::Path};

/// The pulse under McManus's specimen with this restitution.
fn found(folder: &Path, r: f64, scale: f64) -> Findings {
    let ground = rocking_records::read(&folder.join("pulse.AT2"), &Reading::default(), 9.81)
        .unwrap()
        .0
        .scaled(1.0, scale)
        .unwrap();
    let structure = Structure::new(Parameters { r, ..Parameters::MCMANUS }).unwrap();
    Run::new(structure, &ground).validity(Limits::default()).unwrap().0
}

/// The columns of a sweep are filled where they are asked for, in rows of their own.
#[test]
fn a_sweep_has_columns_of_it() {
    let folder = folder();
    let path = folder.path();
    let sweep = "records = ['pulse.AT2']\nscale = [1, 0.1]\n[[structures]]\nname = 'pier'\npreset = 'mcmanus'\nvary.r = [0.99, 1]\n";
    fs::write(path.join("sweep.toml"), sweep).unwrap();
    succeed(path, "sweep sweep.toml");
    let plain = fs::read_to_string(path.join("sweep.csv")).unwrap();
    let (_, said) = succeed(path, "sweep sweep.toml --validity");
    assert!(said.starts_with("sweep.csv: 0 of 4 runs done"), "{said}");
    succeed(path, "sweep sweep.toml --validity -o beyond.csv");
    let beyond = fs::read_to_string(path.join("beyond.csv")).unwrap();
    let headings: Vec<_> = plain.lines().next().unwrap().split(',').collect();
    let cell = |row: &str, heading: &str| {
        let position = headings.iter().position(|found| *found == heading).unwrap();
        row.split(',').nth(position).unwrap().to_owned()
    };
    assert_eq!((plain.lines().count(), beyond.lines().count()), (5, 5));
    assert!(plain.lines().skip(1).all(|row| cell(row, "R_v_min").is_empty()));
    let mut gains = 0;
    for row in beyond.lines().skip(1) {
        let number = |heading: &str| cell(row, heading).parse::<f64>().unwrap();
        let found = found(path, number("r"), number("scale"));
        for (assumption, worst) in ASSUMPTIONS.iter().zip(&found.worst) {
            assert_eq!(number(assumption.name), worst.value, "{row}");
            assert_eq!(number(&format!("{}[s]", assumption.time_name)), worst.time, "{row}");
        }
        assert_eq!((number("energy_gains"), number("settlings")), (found.gains as f64, found.settlings as f64));
        gains += found.gains;
    }
    assert!(gains > 0);
}
