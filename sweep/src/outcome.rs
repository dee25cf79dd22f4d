//! Outcome of a run in a few numbers, and whether the run exceeded a limit.

use crate::{Refused, ensure};
use rocking::digits::{short, with_unit};
use rocking::estimates::intensity::IntensityMeasure;
use rocking::estimates::response_spectrum::{FloorContents, floor_spectra};
use rocking::mechanics::shown::UNITS;
use rocking::names::unknown;
use rocking::run::fall::RunResult;
use rocking::run::residual::{RESIDUALS, Residual};
use rocking::run::{Ending, Run, RunError, Runs};
use rocking::{Output, Structure};
use smallvec::{SmallVec, smallvec};
use std::f64::consts::FRAC_PI_2;
use std::fmt;

#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    Ended(Summary),
    /// The run could not be continued: the fate of the structure is unknown.
    Failed {
        /// Time of the failure, s.
        time: f64,
        reason: String,
    },
}

/// Results of a run that reached its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    pub ending: Ending,
    /// Time of the end, s.
    pub end: f64,
    /// Magnitude of each measure, NaN if the structure does not have it; peaks of a structure that overturns are those before it falls.
    pub peaks: PeakMagnitudes,
    pub transitions: u64,
    pub steps: u64,
    /// Right-hand-side evaluations.
    pub evaluations: u64,
    /// Sure digits of the run, if they are found: [`digits_of_run`](crate::condition::digits_of_run).
    pub digits: Option<u8>,
}

/// Magnitudes in place if they are of one mass without ties: blocks of memory that outlive a run slow the next runs down.
pub type PeakMagnitudes = SmallVec<[f64; Output::PEAKS_OF_ONE.len() + 1]>;

/// Name and unit of a peak.
pub type Measure = (String, String);

/// The measures of a run of `structure`: its peaks, the largest rotation as a fraction of the slenderness angle, and what is left at its end.
pub fn measures(structure: &Structure) -> Vec<Measure> {
    let named = |of: Output| (of.name(structure), of.unit().into());
    let all = Output::with_peak(structure).into_iter().map(named);
    let left = Residual::all(structure).map(|of| (of.name.into(), of.unit.into()));
    all.chain([("theta/alpha_cg".into(), "1".into())]).chain(left).collect()
}

/// The heading of the column of a measure called `name`, without its unit.
pub fn column(name: &str) -> String {
    if RESIDUALS.iter().any(|of| of.name == name) { name.into() } else { format!("peak_{name}") }
}

/// The name of the measure of a column with this heading, if the column has one.
pub fn of_column(heading: &str) -> Option<&str> {
    let name = heading.split('[').next().unwrap_or(heading);
    heading.strip_prefix("peak_").or_else(|| RESIDUALS.iter().any(|of| of.name == name).then_some(heading))
}

/// The contents called `name`, such as S_a[3](0.5 s) or S_a[3](0.5 s, 2 %), with the name of their measure.
pub(crate) fn contents(name: &str) -> Result<(FloorContents, String), Refused> {
    let read = || {
        let (number, oscillator) = name.strip_prefix("S_a[")?.split_once(']')?;
        let floor = number.parse::<usize>().ok()?.checked_sub(1)?;
        let measure = IntensityMeasure::read(&format!("S_a{oscillator}"))?;
        let IntensityMeasure::SaAt(T, zeta) = measure else { return None };
        let name = measure.name().replacen("S_a", &format!("S_a[{}]", floor + 1), 1);
        Some((FloorContents { floor, T, zeta }, name))
    };
    let needed = "S_a[FLOOR](PERIOD) is needed, such as S_a[3](0.5 s) or S_a[3](0.5 s, 2 %); one mass is floor 1";
    read().ok_or_else(|| Refused::by(format!("contents = {name:?}: {needed}")))
}

/// Places of the measures of one kind of structures among the measures of a plan.
#[derive(Clone, Debug)]
pub(crate) struct MeasurePlaces {
    /// Outputs with a peak; those of one mass have other names.
    outputs: Vec<Output>,
    is_of_one: bool,
    /// The place of each of [`measures`].
    places: Vec<usize>,
    /// FloorContents, and the places of their S_a.
    contents: (Vec<FloorContents>, Vec<usize>),
}

impl MeasurePlaces {
    /// Layout of structures like `structure`, whose measures are added to `all` if they are not there.
    pub(crate) fn new(structure: &Structure, all: &mut Vec<Measure>) -> MeasurePlaces {
        let own = measures(structure);
        let added: Vec<_> = own.iter().filter(|measure| !all.contains(measure)).cloned().collect();
        all.extend(added);
        let places = own.iter().filter_map(|own| all.iter().position(|of| of == own)).collect();
        let (outputs, is_of_one) = (Output::with_peak(structure), structure.is_one_mass());
        MeasurePlaces { outputs, is_of_one, places, contents: Default::default() }
    }

    /// Has `contents` measured, too, at this `place`. Returns whether the structures have their floor.
    pub(crate) fn measure_too(&mut self, contents: FloorContents, place: usize) -> bool {
        let has_floor = self.outputs.contains(&Output::a_t(contents.floor));
        self.contents.extend(has_floor.then_some((contents, place)));
        has_floor
    }

    /// The place of the largest rotation as a fraction of the slenderness angle.
    pub(crate) fn rotation(&self) -> usize {
        self.places[self.outputs.len()]
    }

    /// Whether the measures of `structure` are these.
    pub(crate) fn is_of(&self, structure: &Structure) -> bool {
        self.is_of_one == structure.is_one_mass() && self.outputs == Output::with_peak(structure)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// The structure stands.
    Overturning,
    /// A peak stays below a value; a structure that overturned has exceeded every value.
    Peak {
        /// Name of a measure such as a_t[3], or a_t, which is the largest of all floors.
        name: String,
        /// Positions of these measures.
        measures: Vec<usize>,
        /// In `unit`.
        value: f64,
        /// The measure's own unit or a usual one, such as deg.
        unit: String,
    },
}

impl Outcome {
    /// The outcome of a run in which every measure of one mass had this `peak`.
    #[cfg(test)]
    pub(crate) fn ended(ending: Ending, peak: f64) -> Outcome {
        let peaks = smallvec![peak; Output::PEAKS_OF_ONE.len() + 1];
        Outcome::Ended(Summary { ending, end: 1.0, peaks, transitions: 0, steps: 0, evaluations: 0, digits: None })
    }

    /// Outcome of a `run` with this result: its peaks are at the places of `layout` among so many `measures`.
    pub(crate) fn found<Q: Runs>(
        run: &Run<Q>,
        of: (&MeasurePlaces, usize),
        found: Result<RunResult<Q>, RunError>,
    ) -> Outcome {
        let (layout, measures) = of;
        let (contents, places) = &layout.contents;
        let with_contents = |found: RunResult<Q>| {
            let end = found.fall.unwrap_or(found.finish.motion.time);
            let S_a = if contents.is_empty() { Vec::new() } else { floor_spectra(run, end, contents, &mut ())? };
            Ok((found, S_a))
        };
        let (RunResult { peaks, finish, .. }, S_a) = match found.and_then(with_contents) {
            Ok(found) => found,
            Err(error) => {
                let time = error.time().unwrap_or(run.ground.start());
                return Outcome::Failed { time, reason: error.to_string() };
            }
        };
        let rotation = peaks.theta().magnitude / libm::atan(run.structure.base().tan_alpha_cg);
        let magnitudes = layout.outputs.iter().map(|of| peaks.of(*of).map_or(f64::NAN, |peak| peak.magnitude));
        let mut all = smallvec![f64::NAN; measures];
        let moved = run.structure.moved_at(run.detail);
        let left = Residual::all(&moved).map(|of| of.of(&moved, &finish.motion).abs());
        let (places, all_of_run) =
            (layout.places.iter().chain(places), magnitudes.chain([rotation]).chain(left).chain(S_a));
        places.zip(all_of_run).for_each(|(place, magnitude)| all[*place] = magnitude);
        Outcome::Ended(Summary {
            ending: finish.ending,
            end: finish.motion.time,
            peaks: all,
            transitions: finish.motion.transitions,
            steps: finish.motion.work.steps,
            evaluations: finish.motion.work.evaluations,
            digits: None,
        })
    }

    /// Whether the structure exceeded `limit` under `g` (m/s²), as in [`Limit::is_exceeded`]; None if the run failed.
    pub fn exceeds(&self, limit: &Limit, g: f64) -> Option<bool> {
        let Outcome::Ended(Summary { ending, peaks, .. }) = self else { return None };
        let peak = limit.measures().iter().fold(f64::NAN, |most, measure| most.max(peaks[*measure]));
        limit.is_exceeded(*ending, peak, g)
    }

    /// The largest peak as a fraction of `limit` under `g` (m/s²), 0 within a limit of overturning; infinite beyond that, and where
    /// [`Outcome::exceeds`] does not know.
    pub fn demand(&self, limit: &Limit, g: f64) -> f64 {
        match (self, limit, self.exceeds(limit, g)) {
            (Outcome::Ended(Summary { ending, peaks, .. }), Limit::Peak { value, unit, .. }, Some(_))
                if *ending != Ending::Overturned =>
            {
                let peak = limit.measures().iter().fold(f64::NAN, |most, measure| most.max(peaks[*measure]));
                peak / in_own_unit(*value, unit, g)
            }
            (_, Limit::Overturning, Some(false)) => 0.0,
            _ => f64::INFINITY,
        }
    }
}

/// A `value` in a usual `unit`, or in the own unit of a measure, in that own unit; `g` in m/s².
fn in_own_unit(value: f64, unit: &str, g: f64) -> f64 {
    value * UNITS.iter().find(|(usual, ..)| *usual == unit).map_or(1.0, |(_, _, size, _)| size.unwrap_or(g))
}

impl Limit {
    /// Reads `overturned`, or one of `measures` and a value such as `theta/alpha_cg >= 0.5`, `theta >= 3 deg` or `a_t[2] >= 0.3 g`,
    /// as a limit is shown. `a_t` alone is the largest a_t of all floors.
    pub fn read(text: &str, measures: &[Measure]) -> Result<Limit, Refused> {
        if text == Limit::Overturning.to_string() {
            return Ok(Limit::Overturning);
        }
        let known = || Vec::from_iter(measures.iter().map(|(name, _)| &**name));
        let (name, given) = text.split_once(">=").map_or((text, ""), |(name, given)| (name.trim(), given.trim()));
        if given.is_empty() {
            let needed = format!("overturned or MEASURE >= VALUE is needed, with a measure of {}", known().join(", "));
            return Err(Refused::by(format!("limit = {text:?}: {needed}")));
        }
        let is_meant = |of: &str| of == name || of.split_once('[').is_some_and(|(of_floors, _)| of_floors == name);
        let meant: Vec<_> = (0..measures.len()).filter(|at| is_meant(&measures[*at].0)).collect();
        let own = meant.first().map(|at| &*measures[*at].1);
        let is_unknown = || Refused::by(unknown(format_args!("{name:?} is unknown"), name, &known()));
        let own = own.ok_or_else(is_unknown)?;
        let usual = UNITS.iter().filter(|(_, of, ..)| *of == own).map(|(usual, ..)| *usual);
        let units: Vec<_> = [own].into_iter().chain(usual).collect();
        let in_unit = |unit| Some((given.strip_suffix(unit)?.trim_end().parse().ok()?, unit));
        let value = given.parse().ok().map(|value| (value, own)).or(units.iter().copied().find_map(in_unit));
        let (value, unit): (f64, _) = value.ok_or_else(|| {
            let possible = units.iter().map(|unit| if *unit == "1" { "no unit" } else { unit });
            let possible = Vec::from_iter(possible).join(", ");
            Refused::by(format!("limit = {text:?}: a number is needed, in {possible}"))
        })?;
        ensure(value > 0.0 && value.is_finite(), || {
            format!("{name} = {} is out of range: a finite number greater than 0 is needed", with_unit(value, unit))
        })?;
        Ok(Limit::Peak { name: name.into(), measures: meant, value, unit: unit.into() })
    }

    /// Positions of the measures whose largest peak the limit compares.
    pub fn measures(&self) -> &[usize] {
        if let Limit::Peak { measures, .. } = self { measures } else { &[] }
    }

    /// Whether a run with this `ending` and largest `peak` exceeded the limit under `g` (m/s²). None if that is unknown: the peak is
    /// NaN, or the structure still rocks and has stayed within the limit so far.
    pub fn is_exceeded(&self, ending: Ending, peak: f64, g: f64) -> Option<bool> {
        let is_exceeded = match self {
            Limit::Peak { .. } if peak.is_nan() => return None,
            _ if ending == Ending::Overturned => true,
            Limit::Overturning => false,
            Limit::Peak { value, unit, .. } => peak >= in_own_unit(*value, unit, g),
        };
        Some(is_exceeded).filter(|is_exceeded| *is_exceeded || ending != Ending::StillRocking)
    }

    /// Refuses a peak that no structure with a base of this `half_width` (m) reaches without overturning: for such a limit the
    /// curve would silently be the curve of overturning.
    pub fn check(&self, half_width: f64) -> Result<(), Refused> {
        let Limit::Peak { name, value, unit, .. } = self else { return Ok(()) };
        let (most, shown) = match &**name {
            "theta" => (FRAC_PI_2, "pi/2 rad"),
            "uplift" => (2.0 * half_width, &*format!("2 B = {} m", short(2.0 * half_width))),
            _ => return Ok(()),
        };
        let is_reached = in_own_unit(*value, unit, 1.0) < most;
        ensure(is_reached, || {
            format!("{self} is out of range: a structure that stands stays below {shown}; use overturned")
        })
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Limit::Overturning => write!(out, "overturned"),
            Limit::Peak { name, value, unit, .. } if unit == "1" => write!(out, "{name} >= {value}"),
            Limit::Peak { name, value, unit, .. } => write!(out, "{name} >= {value} {unit}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::Parameters;

    /// A limit of one mass.
    fn limit(text: &str) -> Result<Limit, Refused> {
        Limit::read(text, &measures(&Structure::new(Parameters::EVISON).unwrap()))
    }

    #[test]
    fn a_limit_is_read_as_it_is_shown() {
        for text in
            ["overturned", "theta/alpha_cg >= 0.5", "uplift >= 0.002 m", "theta >= 3 deg", "theta/alpha_cg >= 50 %"]
        {
            assert_eq!(limit(text).unwrap().to_string(), text);
        }
        assert_eq!(limit("a_t >= 3"), limit("a_t >= 3 m/s2"));
        assert_eq!(limit("uplift>=1cm"), limit("uplift >= 1 cm"));
        let refused = limit("fallen").unwrap_err().to_string();
        assert!(refused.starts_with("limit = \"fallen\": overturned or MEASURE >= VALUE is needed"));
        let is_reached = |text| limit(text).unwrap().check(0.5).is_ok();
        assert_eq!(["overturned", "theta >= 89 deg", "uplift >= 99 cm", "u >= 3"].map(is_reached), [true; 4]);
        assert_eq!(["theta >= 90 deg", "uplift >= 101 cm"].map(is_reached), [false; 2]);
    }

    #[test]
    fn what_is_not_known_is_neither_exceeded_nor_not() {
        let (limit, ended) = (limit("theta >= 0.1").unwrap(), Outcome::ended);
        for (outcome, overturned, exceeded) in [
            (ended(Ending::AtRest, 0.2), Some(false), Some(true)),
            (ended(Ending::AtRest, 0.05), Some(false), Some(false)),
            (ended(Ending::Overturned, 0.0), Some(true), Some(true)),
            (ended(Ending::StillRocking, 0.2), None, Some(true)),
            (ended(Ending::StillRocking, 0.05), None, None),
            (Outcome::Failed { time: 1.0, reason: "chatter".into() }, None, None),
        ] {
            assert_eq!(outcome.exceeds(&Limit::Overturning, 9.81), overturned, "{outcome:?}");
            assert_eq!(outcome.exceeds(&limit, 9.81), exceeded, "{outcome:?}");
        }
    }
}
