//! The scene of the page: fields of text, as in the link. Numbers are parsed as on a command line.

use crate::says;
use rocking::engine::{DEFAULT_TOLERANCE, check_tolerance};
use rocking::names::unknown;
use rocking::run::record::Record;
use rocking::structure::description::{Damping, Storey};
use rocking::structure::ground::Ground;
use rocking::structure::natural_quantities::{NATURAL, Numbers, names};
use rocking::structure::parameters::{PARAMETERS, PRESETS};
use rocking::structure::quantity::Units;
use rocking::{Detail, Parameters, State, Structure};
use rocking_records::{Column, Origin, Reading};
use rocking_report::record::{Understood, advised};
use rocking_sweep::plan::Conditions;
use rocking_sweep::pulse::{Pulse, Shape};
use rocking_sweep::synthetic;
use serde::Deserialize;
use serde::de::value::{Error, StrDeserializer};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A number of the ground motion or of the run: name, unit, meaning, usual value, and the range of its slider. A field may
/// hold a number outside the slider's range.
pub type FieldRow = (&'static str, &'static str, &'static str, f64, [f64; 2]);

pub const NUMBERS: [FieldRow; 13] = [
    ("amplitude", "g", "peak ground acceleration", 0.6, [0.02, 4.0]),
    ("frequency", "Hz", "frequency of the pulse", 2.0, [0.1, 20.0]),
    ("cycles", "1", "periods of the pulse", f64::NAN, [0.25, 10.0]),
    ("phase", "rad", "phase of the pulse", 0.0, [-3.2, 3.2]),
    ("duration", "s", "duration of the ground motion", 10.0, [1.0, 60.0]),
    ("seed", "1", "seed of the noise", 1.0, [1.0, 100.0]),
    ("theta_0", "rad", "rotation at the start", 0.0, [-0.3, 0.3]),
    ("u_0", "m", "elastic displacement at the start; of floors from below: 0.01, 0.02", 0.0, [-0.05, 0.05]),
    ("scale", "1", "factor on the accelerations", 1.0, [0.1, 10.0]),
    ("time_scale", "1", "factor on the times", 1.0, [0.1, 10.0]),
    ("tolerance", "1", "relative tolerance of the results", DEFAULT_TOLERANCE, [1e-12, 1e-3]),
    ("zeta", "1", "damping ratio of each mode", 0.02, [0.0, 0.2]),
    ("keep", "1", "modes kept; the mass of the others turns rigidly with the base", f64::NAN, [1.0, 24.0]),
];

/// The numbers of ground that gives, as [`Ground`] has them; without all of them the ground is rigid.
pub const OF_GROUND: [FieldRow; 7] = [
    ("f_v", "Hz", "frequency of the bounce on the ground", 10.0, [0.5, 200.0]),
    ("k_v", "N/m", "vertical stiffness of the ground (Winkler springs)", f64::NAN, [1e6, 1e12]),
    ("zeta_v", "1", "damping ratio of the bounce", 0.2, [0.0, 1.0]),
    ("n_points", "1", "contact points from edge to edge", 2.0, [2.0, 21.0]),
    ("kr_ratio", "1", "rotational stiffness of more than two points over k_v B^2", f64::NAN, [0.2, 1.0]),
    ("mu_c", "1", "coefficient of friction of a base that may slide", f64::NAN, [0.0, 2.0]),
    ("fs", "1", "capacity of the ground over its load at rest", f64::NAN, [1.05, 20.0]),
];

/// The preset of a structure whose numbers stand alone.
const NO_PRESET: &str = "none";

/// Numbers of a structure of many masses, beside its storeys and its base.
const OF_STRUCTURE: [&str; 2] = ["zeta", "keep"];

/// The ground motion that the page contains, which it shows when it opens.
pub const EL_CENTRO: &str = "el_centro";

/// Ground motions other than pulses, with the names of their numbers.
pub const MOTIONS: [(&str, &[&str]); 4] = [
    (EL_CENTRO, &["scale", "time_scale"]),
    ("record", &["scale", "time_scale"]),
    ("synthetic", &["amplitude", "duration", "seed", "time_scale"]),
    ("free", &["duration", "theta_0", "u_0"]),
];

/// Keys of a link that say how the record's file is read.
pub const READING: [&str; 5] = ["unit", "dt", "column", "column_v", "ignore_npts"];

/// Keys of a link that scale the ground motion.
pub const SCALES: [&str; 2] = ["time_scale", "scale"];

/// Keys of a link that say how the motion starts and how it is computed.
pub const RUN: [&str; 4] = ["theta_0", "u_0", "detail", "tolerance"];

/// Names of the numbers of the ground motion called `motion`, none if it is unknown.
pub fn numbers_of(motion: &str) -> Option<Vec<&'static str>> {
    let shape = Shape::ALL.into_iter().find(|shape| shape.name() == motion);
    let of_pulse = |shape: Shape| if shape.has_choice() { 4 } else { 2 };
    let of_pulse = shape.map(|shape| NUMBERS[..of_pulse(shape)].iter().map(|number| number.0).collect());
    of_pulse.or_else(|| MOTIONS.iter().find(|(name, _)| *name == motion).map(|(_, numbers)| numbers.to_vec()))
}

/// The scene as key and text: parameters and natural quantities, the ground motion, how the motion is computed.
#[derive(Deserialize)]
#[serde(transparent)]
pub struct Fields(BTreeMap<String, String>);

/// Records of the page: the one of El Centro, and the user's own, or why it is not there.
pub struct Files {
    pub el_centro: Result<File, String>,
    pub own: Result<File, String>,
}

impl Default for Files {
    fn default() -> Files {
        let missing = || Err("this scene needs a record: open its file".into());
        Files { el_centro: missing(), own: missing() }
    }
}

/// A record's file, and its last two readings: of both components.
pub struct File {
    pub path: PathBuf,
    pub bytes: Vec<u8>,
    read: Vec<(Reading, (Record, Origin))>,
}

impl Fields {
    /// Reads the page's JSON. A key without use in this scene is an error.
    pub fn read(json: &str) -> Result<Fields, String> {
        let given: BTreeMap<String, String> = serde_json::from_str(json).map_err(says)?;
        let fields = Fields(given.into_iter().map(|(key, text)| (key, text.trim().to_owned())).collect());
        let kind = fields.kind();
        let numbers = numbers_of(kind).ok_or_else(|| {
            let known = Shape::ALL.map(Shape::name).into_iter().chain(MOTIONS.map(|(name, _)| name));
            unknown(format_args!("record = {kind:?} is unknown"), kind, &Vec::from_iter(known))
        })?;
        let of_structure = if fields.is_frame() { [&["storeys"], &OF_STRUCTURE[..]].concat() } else { vec!["preset"] };
        let of_ground = OF_GROUND.map(|number| number.0);
        let mut known: Vec<_> =
            of_structure.into_iter().chain(names()).chain(of_ground).chain(["record"]).chain(numbers).collect();
        let others = fields.of_file().chain(RUN).filter(|name| !known.contains(name)).collect::<Vec<_>>();
        known.extend(others);
        match fields.0.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => Err(unknown(format_args!("{key:?} of the link is unknown with record = {kind}"), key, &known)),
            None => Ok(fields),
        }
    }

    pub fn kind(&self) -> &str {
        self.text("record").unwrap_or(EL_CENTRO)
    }

    /// Keys that say how this kind of ground motion is read from its file and scaled.
    pub fn of_file(&self) -> impl Iterator<Item = &'static str> {
        let (reading, scales) = match self.kind() {
            "record" => (READING.as_slice(), SCALES.as_slice()),
            "free" => (&[][..], &[][..]),
            _ => (&[][..], SCALES.as_slice()),
        };
        reading.iter().chain(scales).copied()
    }

    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    fn given(&self, name: &str) -> Option<Result<f64, String>> {
        self.text(name).map(|text| number_of(name, unit_of(name), text))
    }

    /// The number called `name` of [`NUMBERS`], or its usual value.
    pub fn number(&self, name: &str) -> Result<f64, String> {
        let default = || NUMBERS.iter().find(|number| number.0 == name).expect("it is one of them").3;
        self.given(name).unwrap_or_else(|| Ok(default()))
    }

    /// The value of a library's type that is given by its name, or else called `default`.
    fn named<'a, T: Deserialize<'a>>(&'a self, name: &str, default: &'a str) -> Result<T, String> {
        T::deserialize(StrDeserializer::<Error>::new(self.text(name).unwrap_or(default))).map_err(says)
    }

    pub fn is_frame(&self) -> bool {
        self.text("storeys").is_some()
    }

    /// Whether the given numbers replace those of a specimen.
    pub fn has_preset(&self) -> bool {
        !self.is_frame() && self.text("preset") != Some(NO_PRESET)
    }

    /// Whether the structure outside the page is a file: of storeys, or of ground that gives.
    pub fn has_file(&self) -> bool {
        self.is_frame() || OF_GROUND.iter().any(|number| self.text(number.0).is_some())
    }

    fn preset(&self) -> Result<Option<Parameters>, String> {
        let preset = || Parameters::preset(self.text("preset").unwrap_or(PRESETS[0].0));
        self.has_preset().then(preset).transpose().map_err(says)
    }

    /// Ground that gives; none if it is rigid.
    fn ground(&self) -> Result<Option<Ground>, String> {
        let given =
            OF_GROUND.iter().filter_map(|of| Some(self.given(of.0)?.map(|value| (of.0.to_owned(), value.into()))));
        let given = given.collect::<Result<toml::Table, _>>()?;
        (!given.is_empty()).then(|| given.try_into().map_err(says)).transpose()
    }

    /// The structure: storeys on a base, a specimen with the given numbers in place of its own, or these numbers alone.
    pub fn structure(&self) -> Result<Structure, String> {
        let given = names().filter_map(|name| Some(self.given(name)?.map(|value| (name, value))));
        let given = Numbers::of(&given.collect::<Result<Vec<_>, _>>()?).map_err(says)?;
        let (ground, preset) = (self.ground()?, self.preset()?);
        if let Some(storeys) = self.text("storeys") {
            return self.frame(&given, storeys, ground);
        }
        // the r of a specimen is of rigid ground
        let r = |of: &Parameters| if ground.is_some() { f64::NAN } else { of.r };
        let preset = preset.map(|of| Parameters { r: r(&of), ..of });
        given.on(ground).structure(preset.as_ref()).map_err(says)
    }

    fn frame(&self, base: &Numbers, storeys: &str, ground: Option<Ground>) -> Result<Structure, String> {
        let storeys = (1..).zip(storeys.split_whitespace()).map(|(number, row)| storey(number, row));
        let storeys = storeys.collect::<Result<Vec<_>, _>>()?;
        let frame = Structure::from_storeys(base, &Damping::All(self.number("zeta")?), &storeys).map_err(says)?;
        let frame = frame.on(&ground).map_err(says)?;
        match self.keep()? {
            None => Ok(frame),
            Some(count) => frame.keeping(count).map_err(says),
        }
    }

    /// The number of modes that are kept, if it is given.
    fn keep(&self) -> Result<Option<usize>, String> {
        match self.given("keep").transpose()? {
            None => Ok(None),
            Some(count) if count >= 1.0 && count.fract() == 0.0 => Ok(Some(count as usize)),
            Some(count) => Err(format!("keep = {count} is out of range: a whole number of at least 1 is needed")),
        }
    }

    /// The ground motion, scaled; `g` in m/s².
    pub fn motion(&self, files: &mut Files, g: f64) -> Result<Understood, String> {
        self.multiplied(files, [self.number("time_scale")?, self.number("scale")?], g)
    }

    /// The ground motion, its times and its accelerations multiplied by `factors`; `g` in m/s².
    pub fn multiplied(&self, files: &mut Files, factors: [f64; 2], g: f64) -> Result<Understood, String> {
        let made = |record| Understood::made(record, factors, g).map_err(|error| rocking_report::message(&error));
        match self.kind() {
            EL_CENTRO => files.el_centro.as_mut().map_err(|why| why.clone())?.motion(Reading::default(), factors, g),
            "record" => {
                let (file, how) = (files.own.as_mut().map_err(|why| why.clone())?, self.reading()?);
                let along = file.motion(how.clone(), factors, g)?;
                let Some(column) = self.text("column_v") else { return Ok(along) };
                let up = file.motion(Reading { column: Some(Column::from(column)), ..how }, factors, g)?;
                let others = up.sentences[1..].iter().filter(|warning| !along.sentences.contains(warning));
                let others: Vec<_> = others.cloned().collect();
                let mut both =
                    along.with_vertical(up, g, "column_v").map_err(|error| rocking_report::message(&error))?;
                both.sentences.extend(others);
                Ok(both)
            }
            "free" => made(Record::at_rest(self.number("duration")?)),
            "synthetic" => {
                let pga = g * self.number("amplitude")?;
                let (duration, seed) = (self.number("duration")?, self.number("seed")?);
                if seed as u64 as f64 != seed {
                    return Err(format!("seed = {seed} is out of range: a whole number of at least 0 is needed"));
                }
                made(synthetic::record(pga, duration, seed as u64).map_err(says)?)
            }
            shape => {
                let title = format!("{shape} pulse, {} g, {} Hz", self.number("amplitude")?, self.number("frequency")?);
                made(self.pulse(g)?.record().map_err(says)?.titled(title))
            }
        }
    }

    pub fn pulse(&self, g: f64) -> Result<Pulse, String> {
        let shape = self.named("record", Shape::Sine.name())?;
        let pulse = Pulse::new(shape, g * self.number("amplitude")?, self.number("frequency")?);
        Ok(Pulse { cycles: self.given("cycles").unwrap_or(Ok(pulse.cycles))?, phase: self.number("phase")?, ..pulse })
    }

    pub fn reading(&self) -> Result<Reading, String> {
        let dt = self.given("dt").transpose()?;
        let unit = self.text("unit").map(|_| self.named("unit", "")).transpose()?;
        let ignores_count = match self.text("ignore_npts") {
            None => false,
            Some("true") => true,
            Some(asked) => return Err(format!("ignore_npts = {asked:?} is unknown: it is true or left out")),
        };
        Ok(Reading { unit, dt, column: self.text("column").map(Column::from), ignores_count })
    }

    /// Start, method and end of the run.
    pub fn conditions(&self) -> Result<Conditions, String> {
        let of_floor = |text: &str| number_of("u_0", "m", text.trim());
        let u = self.text("u_0").unwrap_or("0").split(',').map(of_floor).collect::<Result<_, _>>()?;
        let initial = State { theta: self.number("theta_0")?, u, ..State::default() };
        let duration = (self.kind() == "free").then(|| self.number("duration")).transpose()?;
        let (detail, tolerance) = (self.detail()?, self.tolerance()?);
        Ok(Conditions { initial, detail, tolerance, duration, finds_condition: false })
    }

    pub fn detail(&self) -> Result<Detail, String> {
        self.named("detail", Detail::default().name())
    }

    pub fn tolerance(&self) -> Result<f64, String> {
        let tolerance = self.number("tolerance")?;
        check_tolerance(tolerance).map(|()| tolerance).map_err(|error| error.to_string())
    }
}

pub fn unit_of(name: &str) -> &'static str {
    let of_structure = PARAMETERS.iter().find(|of| of.name == name).map(|of| of.unit);
    let of_natural = || NATURAL.iter().find(|of| of.name == name).map(|of| of.derived().unit);
    let of_run = || NUMBERS.iter().chain(&OF_GROUND).find(|of| of.0 == name).map(|of| of.1);
    of_structure.or_else(of_natural).or_else(of_run).unwrap_or("s") // dt
}

/// The number in `text`, which has the `name` and the `unit`. A number of the structure may have its unit behind it, or 1000 times
/// this unit: 1200 t, 45 kN/m.
pub fn number_of(name: &str, unit: &str, text: &str) -> Result<f64, String> {
    let large = Units::Kilonewtons.name(unit);
    let large = Some(&*large).filter(|large| *large != unit);
    let is_of_structure = unit != "1" && NUMBERS.iter().all(|of| of.0 != name) && name != "dt";
    let units = [Some((unit, 1.0)), large.map(|large| (large, 1e3))].into_iter().flatten().filter(|_| is_of_structure);
    let in_unit = |(unit, factor)| Some(factor * text.strip_suffix(unit)?.trim_end().parse::<f64>().ok()?);
    let needed = match (unit, large) {
        ("1", _) => "a number is needed, without a comma".to_owned(),
        (unit, Some(large)) => format!("a number in {unit} or {large} is needed, without a comma"),
        (unit, None) => format!("a number in {unit} is needed, without a comma"),
    };
    let number = text.parse().ok().or_else(|| { units }.find_map(in_unit));
    number.ok_or_else(|| format!("{name} = {text:?}: {needed}"))
}

/// The storey in `row`: m (kg), h (m) and k (N/m), with commas between them.
fn storey(number: usize, row: &str) -> Result<Storey, String> {
    let read = |((name, unit), text)| number_of(&format!("storey {number}: {name}"), unit, text);
    let numbers = [("m", "kg"), ("h", "m"), ("k", "N/m")]
        .into_iter()
        .zip(row.split(','))
        .map(read)
        .collect::<Result<Vec<_>, _>>()?;
    match numbers[..] {
        [m, h, k] if row.split(',').count() == 3 => Ok(Storey { m, h, k }),
        _ => Err(format!("storey {number} = {row:?}: m (kg), h (m) and k (N/m) are needed, with commas between them")),
    }
}

impl File {
    pub fn new(name: &str, bytes: Vec<u8>) -> File {
        File { path: Path::new(name).into(), bytes, read: Vec::new() }
    }

    fn motion(&mut self, how: Reading, factors: [f64; 2], g: f64) -> Result<Understood, String> {
        let told = |error| rocking_report::message(&error);
        if self.read.iter().all(|(before, _)| *before != how) {
            let read =
                advised(rocking_records::from_bytes(&self.path, &self.bytes, &how), str::to_owned).map_err(told)?;
            self.read.truncate(1);
            self.read.insert(0, (how.clone(), read));
        }
        let (_, known) = self.read.iter().find(|(before, _)| *before == how).expect("it has been read");
        Understood::new(&self.path.display().to_string(), known.clone(), factors, g, str::to_owned).map_err(told)
    }
}
