//! The command line driven from outside: what `simulate` writes.

use crate::{folder, succeed};
use FlexibleRocking::{resources::Contents, variables::Table};
use fmi_unit::{Causality, DataType, Variable};
use rocking::engine::piece::Sample;
use rocking::{Detail, Parameters, Run, Structure, run::End};
use rocking_records::Reading;
use std::{collections::BTreeSet, fs, path::Path};

/// The headings and lines of a CSV file.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
    (lines.next().unwrap(), lines.collect())
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

/// In the first scene the rotation passes α_cg, comes back, and passes α_cg again for good, so that its peak is long before the
/// fall. In the second the record's peak is after the overturning.
#[test]
fn the_picture_marks_peaks_on_the_curve_and_says_from_when_the_structure_falls() {
    for (scene, fall) in [("--time-scale 2 --scale 1.1", "1.99196"), ("--time-scale 20 --theta-0 0.3", "1.37111")] {
        let folder = folder();
        succeed(folder.path(), &format!("simulate --record pulse.AT2 {scene} --picture fall.svg"));
        let svg = fs::read_to_string(folder.path().join("fall.svg")).unwrap();
        assert!(svg.contains(&format!(", falls from {fall} s on, peaks until then")), "{scene}");
        let elements = |name: &str| svg.split(&format!("<{name} ")).skip(1).map(str::to_owned).collect::<Vec<_>>();
        let attribute = |element: &str, name: &str| {
            let (_, rest) = element.split_once(&format!("{name}=\"")).unwrap();
            rest.split_once('"').unwrap().0.to_owned()
        };
        let point = |(x, y): (&str, &str)| [x, y].map(|number| number.parse::<f64>().unwrap());
        let points = |line: &String| {
            attribute(line, "points")
                .split_whitespace()
                .map(|at| point(at.split_once(',').unwrap()))
                .collect::<Vec<_>>()
        };
        let curves: Vec<_> = elements("polyline").iter().map(points).filter(|curve| curve.len() > 2).collect();
        let marks: Vec<_> =
            elements("circle").iter().map(|dot| point((&attribute(dot, "cx"), &attribute(dot, "cy")))).collect();
        assert_eq!([curves.len(), marks.len()], [5, 5], "{scene}");
        for (curve, [x, y]) in curves.iter().zip(marks) {
            let miss = |ends: &[[f64; 2]]| {
                let [[x0, y0], [x1, y1]] = [ends[0], ends[1]];
                let part = if x1 > x0 { ((x - x0) / (x1 - x0)).clamp(0.0, 1.0) } else { 0.0 };
                (x0 + part * (x1 - x0) - x).hypot(y0 + part * (y1 - y0) - y)
            };
            let miss = curve.windows(2).map(miss).fold(f64::INFINITY, f64::min);
            assert!(miss <= 8.0, "{scene}: a pixel is 8 units; the mark at ({x}, {y}) misses its curve by {miss}");
        }
    }
}
