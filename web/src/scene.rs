//! A scene as the page has it: fields of text, as they stand in the link, read by the parser that reads a command line's.

use crate::says;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::{End, record::Record};
use rocking::structure::natural_quantities::{Given, names};
use rocking::structure::parameters::PRESETS;
use rocking::{Detail, Parameters, Run, State, Structure};
use rocking_records::{Column, Reading, Source, Unit};
use rocking_sweep::pulse::{Pulse, Shape};
use rocking_sweep::synthetic;
use serde::Deserialize;
use serde::de::value::{Error, StrDeserializer};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Name, unit and meaning of a number of the ground motion or of how the motion is computed, what it is unless something else
/// is asked for, and what the page's slider goes from and to; a field may have any number.
pub type Number = (&'static str, &'static str, &'static str, f64, [f64; 2]);

/// All of them.
pub const NUMBERS: [Number; 11] = [
    ("amplitude", "g", "peak ground acceleration", 0.6, [0.02, 4.0]),
    ("frequency", "Hz", "frequency of the pulse", 2.0, [0.1, 20.0]),
    ("cycles", "1", "periods of the pulse", f64::NAN, [0.25, 10.0]),
    ("phase", "rad", "phase of the pulse", 0.0, [-3.2, 3.2]),
    ("duration", "s", "duration of the ground motion", 10.0, [1.0, 60.0]),
    ("seed", "1", "what the noise begins with", 1.0, [1.0, 100.0]),
    ("theta_0", "rad", "rotation at the start", 0.0, [-0.3, 0.3]),
    ("u_0", "m", "elastic displacement at the start", 0.0, [-0.05, 0.05]),
    ("scale", "1", "multiplies the record's accelerations", 1.0, [0.1, 10.0]),
    ("time_scale", "1", "multiplies the record's times", 1.0, [0.1, 10.0]),
    ("tolerance", "1", "relative tolerance of the results", DEFAULT_TOLERANCE, [1e-12, 1e-3]),
];

/// Ground motions that are no pulses, with the names of their numbers.
pub const GROUNDS: [(&str, &[&str]); 3] = [
    ("synthetic", &["amplitude", "duration", "seed", "time_scale"]),
    ("record", &["scale", "time_scale"]),
    ("free", &["duration", "theta_0", "u_0"]),
];

/// What is asked for, by name: parameters and natural quantities, the ground motion, how the motion is computed.
#[derive(Clone, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct Fields(BTreeMap<String, String>);

/// A file that was dropped on the page, and how it was read last.
pub struct File {
    pub path: PathBuf,
    pub bytes: Vec<u8>,
    read: Option<(Reading, Record, Source)>,
}

/// A ground motion in m/s², and what is said of its file.
pub struct Ground {
    pub record: Record,
    pub remarks: Vec<String>,
}

impl Fields {
    /// Reads the page's JSON.
    pub fn read(json: &str) -> Result<Fields, String> {
        serde_json::from_str(json).map_err(says)
    }

    /// These without those called `names`.
    pub fn without(&self, names: &[&str]) -> Fields {
        let kept = self.0.iter().filter(|(name, _)| !names.contains(&name.as_str()));
        Fields(kept.map(|(name, text)| (name.clone(), text.clone())).collect())
    }

    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(|text| text.trim())
    }

    fn given(&self, name: &str) -> Option<Result<f64, String>> {
        self.text(name).map(|text| text.parse().map_err(|error| format!("{name} = {text:?}: {error}")))
    }

    /// One of [`NUMBERS`].
    fn number(&self, name: &str) -> Result<f64, String> {
        let default = || NUMBERS.iter().find(|number| number.0 == name).expect("it is one of them").3;
        self.given(name).unwrap_or_else(|| Ok(default()))
    }

    /// One of a library's names.
    fn named<'a, T: Deserialize<'a>>(&'a self, name: &str, default: &'a str) -> Result<T, String> {
        T::deserialize(StrDeserializer::<Error>::new(self.text(name).unwrap_or(default))).map_err(says)
    }

    /// The structure: a specimen with the numbers that are given in the place of its own.
    pub fn structure(&self) -> Result<Structure, String> {
        let preset = self.text("preset").unwrap_or(PRESETS[0].0);
        let base = Parameters::preset(preset).map_err(says)?;
        let mut given = Given::default();
        for name in names() {
            if let Some(value) = self.given(name) {
                given.give(name, value?).map_err(says)?;
            }
        }
        Structure::new(given.over(&base).map_err(says)?).map_err(says)
    }

    /// The ground motion before it is scaled; `g` in m/s².
    pub fn unscaled(&self, file: Option<&mut File>, g: f64) -> Result<Ground, String> {
        let alone = |record| Ground { record, remarks: Vec::new() };
        match self.text("ground").unwrap_or(Shape::Sine.name()) {
            "record" => file.ok_or("no record is here: drop its file on the page")?.ground(self.reading()?, g),
            "free" => Ok(alone(Record::at_rest(self.number("duration")?))),
            "synthetic" => {
                let pga = g * self.number("amplitude")?;
                synthetic::record(pga, self.number("duration")?, self.number("seed")? as u64).map(alone).map_err(says)
            }
            _ => self.pulse(g)?.record().map(alone).map_err(says),
        }
    }

    /// The ground motion that acts.
    pub fn ground(&self, file: Option<&mut File>, g: f64) -> Result<Ground, String> {
        let Ground { record, remarks } = self.unscaled(file, g)?;
        let [time_scale, scale] = self.scales()?;
        Ok(Ground { record: record.scaled(time_scale, scale).map_err(says)?, remarks })
    }

    /// Factors on times and accelerations.
    pub fn scales(&self) -> Result<[f64; 2], String> {
        Ok([self.number("time_scale")?, self.number("scale")?])
    }

    /// The pulse asked for.
    pub fn pulse(&self, g: f64) -> Result<Pulse, String> {
        let shape = self.named("ground", Shape::Sine.name())?;
        let pulse = Pulse::new(shape, g * self.number("amplitude")?, self.number("frequency")?);
        Ok(Pulse { cycles: self.given("cycles").unwrap_or(Ok(pulse.cycles))?, phase: self.number("phase")?, ..pulse })
    }

    /// How a file is read.
    pub fn reading(&self) -> Result<Reading, String> {
        let dt = self.given("dt").transpose()?;
        let asked = self.text("unit");
        let unit = asked.map(|asked| {
            let known = Unit::NAMES.iter().find(|(name, _)| *name == asked);
            known.map(|(_, unit)| *unit).ok_or_else(|| format!("unit = {asked:?} is unknown"))
        });
        Ok(Reading { unit: unit.transpose()?, dt, column: self.text("column").map(Column::from), ..Reading::default() })
    }

    /// The run of `structure` under `ground`.
    pub fn run<'a>(&self, structure: Structure, ground: &'a Record) -> Result<Run<'a>, String> {
        let (detail, tolerance) = (self.detail()?, self.tolerance()?);
        let initial = State { theta: self.number("theta_0")?, u: self.number("u_0")?, ..State::default() };
        let end = if self.text("ground") == Some("free") { End::At(ground.end()) } else { End::AtRest };
        Ok(Run { detail, tolerance, initial, end, ..Run::new(structure, ground) })
    }

    /// The level of detail.
    pub fn detail(&self) -> Result<Detail, String> {
        self.named("detail", Detail::default().name())
    }

    /// The relative tolerance of the results.
    pub fn tolerance(&self) -> Result<f64, String> {
        let tolerance = self.number("tolerance")?;
        match tolerance > 0.0 && tolerance < 1.0 {
            true => Ok(tolerance),
            false => Err(format!("tolerance = {tolerance} is out of range: a number between 0 and 1 is needed")),
        }
    }
}

impl File {
    pub fn new(name: &str, bytes: Vec<u8>) -> File {
        File { path: Path::new(name).into(), bytes, read: None }
    }

    fn ground(&mut self, how: Reading, g: f64) -> Result<Ground, String> {
        if self.read.as_ref().is_none_or(|(before, ..)| *before != how) {
            let (record, source) = rocking_records::from_bytes(&self.path, &self.bytes, &how).map_err(says)?;
            self.read = Some((how, record, source));
        }
        let (_, record, source) = self.read.clone().expect("it has just been read");
        let (record, source) = rocking_records::in_m_s2(record, source, g).map_err(says)?;
        let mut remarks = vec![format!("{}, {}", source.format, source.unit)];
        remarks.extend(source.remarks.into_iter().chain(source.warnings));
        Ok(Ground { record, remarks })
    }
}
