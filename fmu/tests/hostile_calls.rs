//! Hostile calls of the structure.
#![allow(unsafe_code)] // the C interface

#[path = "../fmi/tests/hostile/mod.rs"]
mod hostile;
mod wall;

use FlexibleRocking::resources::{CONTENTS_FILE, Contents};
use FlexibleRocking::rocking_model::{Condition, Course, RockingModel};
use FlexibleRocking::{fmi2, fmi3};
use fmi_unit::snapshot::Snapshot;
use hostile::{Target, hostile_calls};
use rocking::engine::MAX_STEPS_PER_ADVANCE;
use rocking::run::Runs;
use rocking::run::validity::ASSUMPTIONS;
use rocking::structure::description::{Damping, Storey};
use rocking::structure::natural_quantities::Numbers;
use rocking::{Ground, Modes, Parameters, Refused, Structure};
use std::ffi::CString;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// As the calls name it.
type Model = RockingModel;

hostile_calls!(structure);

mod frame {
    use super::*;

    hostile_calls!(many_masses);
}

hostile_calls! { on_ground:
    no_call_of_co_simulation_on_ground_does_harm(3, false)
    no_call_of_model_exchange_on_ground_does_harm(3, true)
}

fn structure() -> Target {
    // the top mass above the pivot of a foundation without inertia
    let sticks = [("m0", 0.0), ("J0", 0.0), ("B", 0.3), ("theta_0", 0.1), ("u_0", 0.3)];
    let sticks = sticks.map(|(name, value)| (wall::reference(&wall::contents(), name), value)).into();
    Target { sticks, ..subject::<f64>(wall::resources(&wall::contents())) }
}

/// Two floors, with a mode left out, and dissipators; the foundation has inertia.
fn many_masses() -> Target {
    let ties = [("xi_d", 1.0), ("c_d", 2e4), ("k_d", 2e7), ("F_y", 4e4)];
    let base = Numbers::of(&[&[("m0", 2e4), ("J0", 3e4), ("B", 1.5), ("r", 0.93)][..], &ties].concat()).unwrap();
    let storey = |h| Storey { m: 3.5e4, h, k: 4e7 };
    of_modes(Structure::from_storeys(&base, &Damping::All(0.02), &[storey(3.5), storey(7.0)]).unwrap().keeping(1))
}

/// A pier with a tendon and dissipators, on ground of three points, where it may slide and settle.
fn on_ground() -> Target {
    let ties = Parameters { P_0: 100.0, k_t: 2e4, xi_d: 0.2, c_d: 50.0, k_d: 1e5, F_y: 300.0, ..Parameters::MCMANUS };
    let ground = Ground { f_v: Some(6.0), n_points: Some(3.0), mu_c: Some(0.3), fs: Some(1.5), ..Ground::default() };
    of_modes(Structure::new(ties).unwrap().on(&ground))
}

fn of_modes(structure: Result<Structure, Refused>) -> Target {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(CONTENTS_FILE), Contents::from(structure.unwrap()).to_bytes()).unwrap();
    subject::<Modes>(folder)
}

fn subject<Q: Runs>(resources: TempDir) -> Target {
    let texts = records(resources.path());
    Target { texts, may_be_infinite, checks: true, check_step: check_step::<Q>, ..Target::of(resources, time::<Q>) }
}

/// How far the simulation had come that `snapshot` is of, once it had started.
fn course<Q: Runs>(snapshot: &Snapshot) -> Option<Course<Q>> {
    postcard::from_bytes::<Condition<Q>>(&snapshot.model).unwrap().2
}

fn time<Q: Runs>(snapshot: &Snapshot) -> f64 {
    let Some(course) = course::<Q>(snapshot) else { return 0.0 };
    course.outside.map_or(course.motion.time, |outside| outside.known.motion.time)
}

/// Peaks and limits that nobody watches for are no numbers, nor is what ground would take from a fixed base; friction may be infinite.
fn may_be_infinite(name: &str) -> bool {
    let is_of_ground = ["N", "settlement", "settled", "tilt", "contact", "E_foundation", "pressure"]
        .iter()
        .any(|of| name.starts_with(of));
    is_of_ground || name.contains("_max") || ASSUMPTIONS.iter().any(|of| [of.name, of.time_name].contains(&name))
}

/// The work is bounded.
fn check_step<Q: Runs>(before: &Snapshot, after: &Snapshot) {
    let [before, after] = [before, after].map(|of| course::<Q>(of).unwrap().motion.work.steps);
    assert!(after - before <= MAX_STEPS_PER_ADVANCE, "{} steps", after - before);
}

/// Values of `record`: files of the archive in `folder` and elsewhere, sound and broken, and what is no file.
fn records(folder: &Path) -> Vec<CString> {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    let samples: String =
        (0..300).map(|i| format!("{:.3},{:.3}\n", 0.01 * f64::from(i), f64::from(i * i % 19 - 9))).collect();
    write("quake.csv", &samples);
    write("Quake 2.AT2", "-\n-\nACCELERATION IN UNITS OF G\n4, .005 NPTS, DT\n.1 -.2 .4 1e-3\n");
    write("broken.csv", "0,1\n1,%s%n#\n");
    write("huge.csv", "-1e308,1\n1e308,2\n");
    write("dense.csv", "0,1e-300\n5e-324,1e3\n1e-323,2\n1,-1e4\n");
    fs::create_dir(folder.join("folder.csv")).unwrap();
    let inside = folder.join("quake.csv").display().to_string();
    let (uri, long) = (format!("file://{inside}"), "a".repeat(70_000));
    let sound = ["quake.csv", "Quake 2.AT2"];
    let others = ["broken.csv", "huge.csv", "dense.csv", "folder.csv", "absent.csv", "", ".", ".."];
    let elsewhere = ["/dev/zero", "/dev/full", "/dev/stdin", "/", "/etc/passwd", "file:///dev/zero", "file:"];
    let texts = [&sound[..], &others, &elsewhere, &["file:///%00.csv", &inside, &uri, &long]].concat();
    texts.into_iter().map(|text| CString::new(text).unwrap()).chain([c"\xff%n".into()]).collect()
}
