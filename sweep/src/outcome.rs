//! What a run came to, in a few numbers, and whether a limit was exceeded.

use crate::{Refused, ensure};
use rocking::Watch;
use rocking::run::fall::Found;
use rocking::run::peaks::PEAKS;
use rocking::run::{Ending, Run};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// What a run came to.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It was followed to its end.
    Ended(Summary),
    /// It could not be continued: nothing is known of the structure.
    Failed {
        /// From this instant on, s.
        time: f64,
        /// Why.
        reason: String,
    },
}

/// A run that was followed to its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// How it ended.
    pub ending: Ending,
    /// When, s.
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

/// What a run is measured by, with units: [`PEAKS`], and the largest rotation over the slenderness angle.
pub const MEASURES: [(&str, &str); PEAKS.len() + 1] = {
    let mut measures = [("theta/alpha_cg", "1"); PEAKS.len() + 1];
    let mut i = 0;
    while i < PEAKS.len() {
        measures[i] = (PEAKS[i].name, PEAKS[i].unit);
        i += 1;
    }
    measures
};

/// What may be exceeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The structure stands.
    Overturning,
    /// A peak stays below a value; a structure that overturned has exceeded every value.
    Peak {
        /// Which of [`MEASURES`].
        measure: usize,
        /// In the measure's unit.
        value: f64,
    },
}

impl Outcome {
    /// Does `run`, which `watch` sees go by.
    pub fn of(run: &Run, watch: &mut impl Watch) -> Outcome {
        let Found { peaks, finish, .. } = match run.found(watch) {
            Ok(found) => found,
            Err(error) => {
                let time = error.time().unwrap_or(run.ground.start());
                return Outcome::Failed { time, reason: error.to_string() };
            }
        };
        let mut magnitudes = [peaks.theta().magnitude / libm::atan(run.structure.tan_alpha_cg); MEASURES.len()];
        for (magnitude, peaking) in magnitudes.iter_mut().zip(&PEAKS) {
            *magnitude = peaking.of(&peaks).magnitude;
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

    /// Whether `limit` was exceeded, where that is known: of a failed run it is not, nor of a structure that still rocks
    /// and has stayed within the limit so far.
    pub fn exceeds(&self, limit: &Limit) -> Option<bool> {
        let Outcome::Ended(summary) = self else { return None };
        let has_exceeded = match *limit {
            _ if summary.ending == Ending::Overturned => true,
            Limit::Overturning => false,
            Limit::Peak { measure, value } => summary.peaks[measure] >= value,
        };
        Some(has_exceeded).filter(|has_exceeded| *has_exceeded || summary.ending != Ending::StillRocking)
    }
}

impl Limit {
    /// That the peak of the measure called `name` stays below `value` > 0.
    pub fn peak(name: &str, value: f64) -> Result<Limit, Refused> {
        let known = || MEASURES.map(|(name, _)| name).join(", ");
        let measure = MEASURES.iter().position(|(measure, _)| *measure == name);
        let measure = measure.ok_or_else(|| Refused(format!("{name:?} is unknown; these are known: {}", known())))?;
        let out_of_range = || format!("{name} = {value} is out of range: a finite number greater than 0 is needed");
        ensure(value > 0.0 && value.is_finite(), out_of_range)?;
        Ok(Limit::Peak { measure, value })
    }
}

impl FromStr for Limit {
    type Err = Refused;

    /// `overturned`, or a measure and a value such as `theta/alpha_cg >= 0.5`, as a limit is shown.
    fn from_str(text: &str) -> Result<Limit, Refused> {
        if text == Limit::Overturning.to_string() {
            return Ok(Limit::Overturning);
        }
        let (name, value) = text.split_once(" >= ").unwrap_or((text, ""));
        let unit = MEASURES.iter().find(|(measure, _)| *measure == name).map_or("1", |(_, unit)| unit);
        let value = value.strip_suffix(unit).filter(|_| unit != "1").unwrap_or(value).trim();
        let value = value.parse().map_err(|_| {
            let known = MEASURES.map(|(name, _)| name).join(", ");
            Refused(format!("limit = {text:?}: overturned or MEASURE >= VALUE is needed, with a measure of {known}"))
        })?;
        Limit::peak(name, value)
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Limit::Overturning => write!(out, "overturned"),
            Limit::Peak { measure, value } => match MEASURES[measure] {
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
        assert_eq!("a_t >= 3".parse(), Limit::peak("a_t", 3.0));
        let refused = |text: &str| text.parse::<Limit>().unwrap_err().to_string();
        assert!(refused("fallen").starts_with("limit = \"fallen\": overturned or MEASURE >= VALUE is needed"));
        assert!(refused("a_t >= 3 g").starts_with("limit = \"a_t >= 3 g\""));
        assert!(refused("phi >= 3").starts_with("\"phi\" is unknown; these are known: theta, "));
    }

    #[test]
    fn what_is_not_known_is_neither_exceeded_nor_not() {
        let ended = |ending, theta| {
            let peaks = MEASURES.map(|(name, _)| if name == "theta" { theta } else { 0.0 });
            Outcome::Ended(Summary { ending, end: 1.0, peaks, transitions: 0, steps: 0, evaluations: 0 })
        };
        let limit = Limit::peak("theta", 0.1).unwrap();
        for (outcome, overturned, exceeded) in [
            (ended(Ending::AtRest, 0.2), Some(false), Some(true)),
            (ended(Ending::AtRest, 0.05), Some(false), Some(false)),
            (ended(Ending::Overturned, 0.0), Some(true), Some(true)),
            (ended(Ending::StillRocking, 0.2), None, Some(true)),
            (ended(Ending::StillRocking, 0.05), None, None),
            (Outcome::Failed { time: 1.0, reason: "chatter".into() }, None, None),
        ] {
            assert_eq!(outcome.exceeds(&Limit::Overturning), overturned, "{outcome:?}");
            assert_eq!(outcome.exceeds(&limit), exceeded, "{outcome:?}");
        }
    }
}
