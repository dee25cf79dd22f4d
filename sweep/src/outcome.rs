//! Outcome of a run in a few numbers, and whether the run exceeded a limit.

use crate::{Refused, ensure};
use rocking::digits::{short, with_unit};
use rocking::run::fall::Found;
use rocking::run::{Ending, Run, RunError};
use rocking::{Output, Watch};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;
use std::str::FromStr;

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The run reached its end.
    Ended(Summary),
    /// The run could not be continued: the fate of the structure is unknown.
    Failed {
        /// Time of the failure, s.
        time: f64,
        /// Why.
        reason: String,
    },
}

/// Results of a run that reached its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Ending of the run.
    pub ending: Ending,
    /// Time of the end, s.
    pub end: f64,
    /// Largest magnitudes, in the order of [`MEASURES`]; of a structure that overturns, before it falls.
    pub peaks: [f64; MEASURES.len()],
    /// Transitions.
    pub transitions: u64,
    /// Steps taken.
    pub steps: u64,
    /// Right-hand-side evaluations.
    pub evaluations: u64,
}

/// Measures of a run with their units: [`Output::PEAKS_OF_ONE`], and the largest rotation as a fraction of the slenderness angle.
pub const MEASURES: [(&str, &str); Output::PEAKS_OF_ONE.len() + 1] = {
    let mut measures = [("theta/alpha_cg", "1"); Output::PEAKS_OF_ONE.len() + 1];
    let mut i = 0;
    while i < Output::PEAKS_OF_ONE.len() {
        measures[i] = (Output::PEAKS_OF_ONE[i].symbol(), Output::PEAKS_OF_ONE[i].unit());
        i += 1;
    }
    measures
};

/// Usual units of limits: name, unit of the measure, and how many of that one it is; g is the structure's own.
const USUAL_UNITS: [(&str, &str, Option<f64>); 8] = [
    ("deg", "rad", Some(PI / 180.0)),
    ("mrad", "rad", Some(1e-3)),
    ("cm", "m", Some(1e-2)),
    ("mm", "m", Some(1e-3)),
    ("g", "m/s2", None),
    ("cm/s2", "m/s2", Some(1e-2)),
    ("kN", "N", Some(1e3)),
    ("kN.m", "N.m", Some(1e3)),
];

/// Limit that a run can exceed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The structure stands.
    Overturning,
    /// A peak stays below a value; a structure that overturned has exceeded every value.
    Peak {
        /// Which of [`MEASURES`].
        measure: usize,
        /// In `unit`.
        value: f64,
        /// The measure's own unit or a usual one, such as deg.
        unit: &'static str,
    },
}

impl Outcome {
    /// The outcome of a run in which every measure had this `peak`.
    #[cfg(test)]
    pub(crate) fn ended(ending: Ending, peak: f64) -> Outcome {
        let peaks = [peak; MEASURES.len()];
        Outcome::Ended(Summary { ending, end: 1.0, peaks, transitions: 0, steps: 0, evaluations: 0 })
    }

    /// Follows `run` to its end, watched by `watch`.
    pub fn of(run: &Run, watch: &mut impl Watch) -> Outcome {
        Outcome::found(run, run.found(watch))
    }

    /// Outcome of a `run` with this result.
    pub(crate) fn found(run: &Run, found: Result<Found, RunError>) -> Outcome {
        let Found { peaks, finish, .. } = match found {
            Ok(found) => found,
            Err(error) => {
                let time = error.time().unwrap_or(run.ground.start());
                return Outcome::Failed { time, reason: error.to_string() };
            }
        };
        let mut magnitudes = [peaks.theta().magnitude / libm::atan(run.structure.base().tan_alpha_cg); MEASURES.len()];
        for (magnitude, output) in magnitudes.iter_mut().zip(Output::PEAKS_OF_ONE) {
            *magnitude = peaks.of(output).map_or(f64::NAN, |peak| peak.magnitude);
        }
        Outcome::Ended(Summary {
            ending: finish.ending,
            end: finish.motion.time,
            peaks: magnitudes,
            transitions: finish.motion.transitions,
            steps: finish.motion.work.steps,
            evaluations: finish.motion.work.evaluations,
        })
    }

    /// Whether the structure exceeded `limit` under `g` (m/s²). None if that is unknown: the run failed, the peak is NaN, or the
    /// structure still rocks and has stayed within the limit so far.
    pub fn exceeds(&self, limit: &Limit, g: f64) -> Option<bool> {
        let Outcome::Ended(summary) = self else { return None };
        let has_exceeded = match *limit {
            _ if summary.ending == Ending::Overturned => true,
            Limit::Overturning => false,
            Limit::Peak { measure, .. } if summary.peaks[measure].is_nan() => return None,
            Limit::Peak { measure, value, unit } => summary.peaks[measure] >= in_own_unit(value, unit, g),
        };
        Some(has_exceeded).filter(|has_exceeded| *has_exceeded || summary.ending != Ending::StillRocking)
    }
}

/// A `value` in a usual `unit`, or in the own unit of a measure, in that own unit; `g` in m/s².
fn in_own_unit(value: f64, unit: &str, g: f64) -> f64 {
    let usual = USUAL_UNITS.iter().find(|(usual, ..)| *usual == unit);
    value * usual.map_or(1.0, |(.., factor)| factor.unwrap_or(g))
}

impl Limit {
    /// The limit `value` > 0 of the measure called `name`, in the unit of [`MEASURES`].
    pub fn peak(name: &str, value: f64) -> Result<Limit, Refused> {
        let (measure, unit) = measure(name)?;
        Limit::checked(measure, value, unit)
    }

    /// Refuses a peak that no structure with a base of this `half_width` (m) reaches without overturning: for such a limit the
    /// curve would silently be the curve of overturning.
    pub fn check(&self, half_width: f64) -> Result<(), Refused> {
        let Limit::Peak { measure, value, unit } = *self else { return Ok(()) };
        let (most, shown) = match MEASURES[measure].0 {
            "theta" => (FRAC_PI_2, "pi/2 rad"),
            "uplift" => (2.0 * half_width, &*format!("2 B = {} m", short(2.0 * half_width))),
            _ => return Ok(()),
        };
        let is_reached = in_own_unit(value, unit, 1.0) < most;
        ensure(is_reached, || {
            format!("{self} is out of range: a structure that stands stays below {shown}; use overturned")
        })
    }

    fn checked(measure: usize, value: f64, unit: &'static str) -> Result<Limit, Refused> {
        let shown = || format!("{} = {}", MEASURES[measure].0, with_unit(value, unit));
        let is_possible = value > 0.0 && value.is_finite();
        ensure(is_possible, || format!("{} is out of range: a finite number greater than 0 is needed", shown()))?;
        Ok(Limit::Peak { measure, value, unit })
    }
}

/// The names of [`MEASURES`].
fn known() -> String {
    MEASURES.map(|(name, _)| name).join(", ")
}

/// The position of the measure called `name` among [`MEASURES`], and its unit.
fn measure(name: &str) -> Result<(usize, &'static str), Refused> {
    let found = MEASURES.iter().position(|(measure, _)| *measure == name).map(|at| (at, MEASURES[at].1));
    found.ok_or_else(|| Refused(format!("{name:?} is unknown; these are known: {}", known())))
}

impl FromStr for Limit {
    type Err = Refused;

    /// Reads `overturned`, or a measure and a value such as `theta/alpha_cg >= 0.5` or `theta >= 3 deg`, as a limit is shown.
    fn from_str(text: &str) -> Result<Limit, Refused> {
        if text == Limit::Overturning.to_string() {
            return Ok(Limit::Overturning);
        }
        let (name, given) = text.split_once(">=").map_or((text, ""), |(name, given)| (name.trim(), given.trim()));
        if given.is_empty() {
            let needed = format!("overturned or MEASURE >= VALUE is needed, with a measure of {}", known());
            return Err(Refused(format!("limit = {text:?}: {needed}")));
        }
        let (measure, own) = measure(name)?;
        let usual = USUAL_UNITS.into_iter().filter_map(|(usual, of, _)| (of == own).then_some(usual));
        let units: Vec<_> = [own].into_iter().chain(usual).filter(|unit| *unit != "1").collect();
        let in_unit = |unit: &'static str| Some((given.strip_suffix(unit)?.trim_end().parse().ok()?, unit));
        let value = given.parse().ok().map(|value| (value, own)).or(units.iter().copied().find_map(in_unit));
        let (value, unit) = value.ok_or_else(|| {
            let possible = if units.is_empty() { "no unit".into() } else { units.join(", ") };
            Refused(format!("limit = {text:?}: a number is needed, in {possible}"))
        })?;
        Limit::checked(measure, value, unit)
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Limit::Overturning => write!(out, "overturned"),
            Limit::Peak { measure, value, unit } => match (MEASURES[measure].0, unit) {
                (name, "1") => write!(out, "{name} >= {value}"),
                (name, unit) => write!(out, "{name} >= {value} {unit}"),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_read_as_it_is_shown() {
        for limit in
            [Limit::Overturning, Limit::peak("theta/alpha_cg", 0.5).unwrap(), Limit::peak("uplift", 2e-3).unwrap()]
        {
            assert_eq!(limit.to_string().parse(), Ok(limit));
        }
        for text in ["theta >= 3 deg", "a_t >= 0.3 g", "M_t >= 1.5 kN.m"] {
            assert_eq!(text.parse::<Limit>().unwrap().to_string(), text);
        }
        assert_eq!("a_t >= 3".parse(), Limit::peak("a_t", 3.0));
        assert_eq!("uplift>=1cm".parse::<Limit>(), "uplift >= 1 cm".parse());
        let refused = |text: &str| text.parse::<Limit>().unwrap_err().to_string();
        assert!(refused("fallen").starts_with("limit = \"fallen\": overturned or MEASURE >= VALUE is needed"));
        let unknown = "limit = \"a_t >= 3 kN\": a number is needed, in m/s2, g, cm/s2";
        assert_eq!(refused("a_t >= 3 kN"), unknown);
        assert_eq!(
            refused("theta/alpha_cg >= 3 deg"),
            "limit = \"theta/alpha_cg >= 3 deg\": a number is needed, in no unit"
        );
        assert_eq!(
            refused("theta >= -3 deg"),
            "theta = -3 deg is out of range: a finite number greater than 0 is needed"
        );
        let out_of_reach =
            |limit: &str| limit.parse::<Limit>().unwrap().check(0.5).map_err(|refused| refused.to_string());
        let stays =
            |below: &str| format!(" is out of range: a structure that stands stays below {below}; use overturned");
        assert_eq!(out_of_reach("theta >= 90 deg"), Err("theta >= 90 deg".to_owned() + &stays("pi/2 rad")));
        assert_eq!(out_of_reach("uplift >= 101 cm"), Err("uplift >= 101 cm".to_owned() + &stays("2 B = 1 m")));
        for limit in ["overturned", "theta >= 89 deg", "uplift >= 99 cm", "u >= 3"] {
            assert_eq!(out_of_reach(limit), Ok(()), "{limit}");
        }
        assert!(refused("phi >= 3").starts_with("\"phi\" is unknown; these are known: theta, "));
    }

    /// 0.3 g are 2.943 m/s² on the earth, and 0.486 m/s² on the moon.
    #[test]
    fn a_limit_in_a_usual_unit_is_the_same_in_the_measures_own() {
        for (limit, value, g) in [
            ("theta >= 3 deg", 0.052_359_877_559_829_89, 9.81),
            ("uplift >= 1 cm", 0.01, 9.81),
            ("a_t >= 0.3 g", 2.943, 9.81),
            ("a_t >= 0.3 g", 0.486, 1.62),
            ("V_t >= 2 kN", 2e3, 9.81),
        ] {
            let exceeds = |of| Outcome::ended(Ending::AtRest, of * value).exceeds(&limit.parse().unwrap(), g);
            assert_eq!([0.999, 1.001, f64::NAN].map(exceeds), [Some(false), Some(true), None], "{limit}");
        }
    }

    #[test]
    fn what_is_not_known_is_neither_exceeded_nor_not() {
        let (limit, ended) = (Limit::peak("theta", 0.1).unwrap(), Outcome::ended);
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
