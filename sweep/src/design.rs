//! Values of one number of a structure at which limits hold in a share of the runs.
//!
//! The runs of a value are those of the structure with this value, under every ground motion at every scale factor. The
//! limits hold at the value if the share of its runs, or more, is within all of them. A run that failed or still rocks
//! within the limits is unknown and counts as beyond. Rocking is not monotone in most numbers: every pair of neighbours of
//! which one holds is refined, and between two neighbours that agree nothing is known beyond the curve.

use crate::outcome::{Limit, Outcome};
use crate::plan::{Conditions, NamedRecord, Plan, Population};
use crate::row_file::do_runs;
use crate::rows::check_records;
use crate::{Refused, ensure};
use rocking::Structure;
use rocking::digits::with_unit;
use rocking::structure::description::Description;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Most times that the step between neighbours is divided.
pub const MAX_REFINEMENTS: u32 = 8;

/// Parts of the step between two neighbours that do not agree.
const PARTS: usize = 8;

#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Goal {
    /// Name of the number, as in [`Population::vary`].
    pub vary: String,
    pub between: [f64; 2],
    /// Such as `theta <= 0.5 %`, or `stands`; all of them must hold.
    pub limit: Vec<String>,
    /// Least part of the runs that is within all limits.
    pub share: f64,
    /// Number of values of the first pass.
    pub count: usize,
    /// Whether values are spaced evenly in their logarithms.
    pub log: bool,
    /// Times that the step is divided at each crossing.
    pub refine: u32,
}

impl Default for Goal {
    fn default() -> Goal {
        let (vary, limit, between) = (String::new(), Vec::new(), [0.0; 2]);
        Goal { vary, between, limit, share: 0.84, count: 25, log: false, refine: 3 }
    }
}

/// What is sought of a structure, and under which runs.
#[derive(Clone, Debug)]
pub struct Design {
    pub sought: Goal,
    /// The structure, whose own value of the number does not matter.
    pub structure: Structure,
    pub motions: Vec<NamedRecord>,
    pub scales: Vec<f64>,
    pub conditions: Conditions,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignPoint {
    pub value: f64,
    pub holds: bool,
    /// Part of the runs that is within all limits.
    pub within: f64,
    /// Runs that failed, or still rock and have not exceeded a limit: they count as beyond.
    pub unknown: usize,
    /// Of each limit the demand that the share of the runs does not exceed, as a fraction of the limit: infinite if it is that of a
    /// run that overturned or is unknown.
    pub demands: Vec<f64>,
}

/// What a curve says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Designed {
    /// The value from which on, or up to which, the limits hold at every value that was run; none if they hold at both ends or at neither.
    pub value: Option<f64>,
    /// First and last value of each stretch at which the limits hold.
    pub holds: Vec<[f64; 2]>,
    /// Neighbours of which one holds.
    pub crossings: Vec<[f64; 2]>,
    pub sentence: String,
}

impl Design {
    /// The curve, by rising value. The runs of each pass are done on all threads; after each run `tell` hears how many are done,
    /// and of how many so far.
    pub fn complete(&self, tell: impl Fn(usize, usize) + Sync) -> anyhow::Result<Vec<DesignPoint>> {
        let &Goal { ref vary, between: [low, high], ref limit, share, count, log, refine } = &self.sought;
        ensure(low < high && high.is_finite() && (low > 0.0 || !log && low.is_finite()), || {
            format!("between = {low:?}, {high:?}: {vary} needs two rising numbers, greater than 0 if log is true")
        })?;
        ensure((3..=1000).contains(&count), || format!("count = {count} is out of range: 3 to 1000 are possible"))?;
        ensure(refine <= MAX_REFINEMENTS, || {
            format!("refine = {refine} is out of range: 0 to {MAX_REFINEMENTS} are possible")
        })?;
        ensure(share > 0.0 && share <= 1.0, || {
            format!("share = {share:?} is out of range: a part of the runs greater than 0, up to 1, is needed")
        })?;
        ensure(vary != "g", || "g cannot vary: all runs have one g".into())?;
        ensure(!limit.is_empty(), || "limit is empty: give one or more".into())?;
        check_records(&self.motions)?;
        let done = AtomicUsize::new(0);
        let inside = self.spaced([low, high], count - 1);
        let mut points = self.points([vec![low], inside, vec![high]].concat(), &done, &tell)?;
        for _ in 0..refine {
            let new = points.windows(2).filter(|pair| pair[0].holds != pair[1].holds);
            let new: Vec<_> = new.flat_map(|pair| self.spaced([pair[0].value, pair[1].value], PARTS)).collect();
            if new.is_empty() {
                break;
            }
            points.extend(self.points(new, &done, &tell)?);
            points.sort_by(|a, b| a.value.total_cmp(&b.value));
        }
        Ok(points)
    }

    /// The values between two others that divide their step in so many `parts`.
    fn spaced(&self, [low, high]: [f64; 2], parts: usize) -> Vec<f64> {
        let at = |part: usize| match part as f64 / parts as f64 {
            part if self.sought.log => low * (high / low).powf(part),
            part => low + part * (high - low),
        };
        let mut inside = Vec::from_iter((1..parts).map(at).filter(|value| low < *value && *value < high));
        inside.dedup();
        inside
    }

    fn points(
        &self,
        values: Vec<f64>,
        done: &AtomicUsize,
        tell: &(impl Fn(usize, usize) + Sync),
    ) -> anyhow::Result<Vec<DesignPoint>> {
        let varied = Population::new("design", self.structure.clone()).vary(&self.sought.vary, values.clone())?;
        let plan = Plan::new(vec![varied], self.motions.clone(), self.scales.clone(), self.conditions.clone())?;
        let read = |text: &String| {
            let exceeded = match &**text {
                "stands" => Limit::Overturning.to_string(),
                text => text.replacen("<=", ">=", 1),
            };
            ensure(exceeded != *text, || format!("limit = {text:?}: MEASURE <= VALUE or stands is needed"))?;
            let limit = Limit::read(&exceeded, &plan.measures)?;
            limit.check(plan.widest)?;
            Ok(limit)
        };
        let limits = self.sought.limit.iter().map(read).collect::<Result<Vec<_>, Refused>>()?;
        let all = done.load(Ordering::Relaxed) + plan.len();
        let outcomes = Vec::from_iter((0..plan.len()).map(|_| OnceLock::new()));
        let run = |runs: &[usize], hand_out: &mut dyn FnMut(_, &[u8]) -> bool| {
            plan.each_outcome(runs, false, |case, outcome, _| hand_out((case.index, outcome), &[]));
        };
        do_runs(&Vec::from_iter(0..plan.len()), None, run, |(index, outcome): (usize, Outcome)| {
            outcomes[index].set(outcome).expect("each run is done once");
            tell(done.fetch_add(1, Ordering::Relaxed) + 1, all);
            Ok(())
        })?;
        let outcomes: Vec<_> = outcomes.into_iter().filter_map(OnceLock::into_inner).collect();
        let g = self.structure.base().g;
        let of_value = |(value, outcomes): (f64, &[Outcome])| {
            let demands = |limit| Vec::from_iter(outcomes.iter().map(|outcome| outcome.demand(limit, g)));
            let mut demands: Vec<_> = limits.iter().map(demands).collect();
            let is_within = |run: &usize| demands.iter().all(|of_limit| of_limit[*run] < 1.0);
            let within = (0..outcomes.len()).filter(is_within).count();
            let is_unknown = |of: &&Outcome| limits.iter().any(|limit| of.exceeds(limit, g).is_none());
            let needed = ((self.sought.share * outcomes.len() as f64 - 1e-9).ceil() as usize).max(1);
            demands.iter_mut().for_each(|of_limit| of_limit.sort_by(f64::total_cmp));
            DesignPoint {
                value,
                holds: within >= needed,
                within: within as f64 / outcomes.len() as f64,
                unknown: outcomes.iter().filter(is_unknown).count(),
                demands: demands.iter().map(|of_limit| of_limit[needed - 1]).collect(),
            }
        };
        let runs = outcomes.chunks(outcomes.len() / values.len());
        Ok(values.into_iter().zip(runs).map(of_value).collect())
    }

    pub fn unit(&self) -> &'static str {
        let all = self.structure.description().map_or_else(Vec::new, Description::numbers);
        all.iter().find(|of| of.name == self.sought.vary).map_or("1", |of| of.unit)
    }

    /// What `points` of [`Design::complete`] say.
    pub fn found(&self, points: &[DesignPoint]) -> Designed {
        let (vary, shown) = (&self.sought.vary, |value| with_unit(value, self.unit()));
        let [first, last] = [&points[0], &points[points.len() - 1]];
        let stretches = points.chunk_by(|a, b| a.holds == b.holds).filter(|of| of[0].holds);
        let holds: Vec<_> = stretches.map(|of| [of[0].value, of[of.len() - 1].value]).collect();
        let crossings = points.windows(2).filter(|pair| pair[0].holds != pair[1].holds);
        let crossings: Vec<_> = crossings.map(|pair| [pair[0].value, pair[1].value]).collect();
        let value = match (first.holds, last.holds) {
            (false, true) => holds.last().map(|of| of[0]),
            (true, false) => holds.first().map(|of| of[1]),
            _ => None,
        };
        let range = format!("{vary} from {} to {}", shown(first.value), shown(last.value));
        let found = match (value, &crossings[..]) {
            (Some(value), [[before, _]]) if last.holds => {
                format!("from {vary} = {} on, and not at {}", shown(value), shown(*before))
            }
            (Some(value), [[_, after]]) => format!("up to {vary} = {}, and not at {}", shown(value), shown(*after)),
            (_, []) if first.holds => format!("at every {range}"),
            (_, []) => {
                let best = points.iter().rev().max_by(|a, b| a.within.total_cmp(&b.within)).unwrap_or(first);
                format!("at no {range}; at most in {} of the runs, at {}", percent(best.within), shown(best.value))
            }
            (_, many) => {
                let stretches = holds.iter().map(|[from, to]| format!("from {} to {}", shown(*from), shown(*to)));
                let stretches = stretches.collect::<Vec<_>>().join(", ");
                let reason = if self.sought.limit.len() == 1 { ": the demand is not monotone" } else { "" };
                format!("for {vary} {stretches}, {} crossings{reason}", many.len())
            }
        };
        let sentence =
            format!("{} in {} of the runs: {found}", self.sought.limit.join(" and "), percent(self.sought.share));
        Designed { value, holds, crossings, sentence }
    }
}

fn percent(part: f64) -> String {
    format!("{} %", rocking::digits::short(100.0 * part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::run::fall::RunResult;
    use rocking::run::record::Record;
    use rocking::run::{Ending, Run};
    use rocking::{OneMass, Output, Parameters};
    use std::f64::consts::TAU;

    fn sine(name: &str, period: f64, amplitude: f64) -> NamedRecord {
        let times = Vec::from_iter((0..=200).map(|i| f64::from(i) * period / 200.0));
        let a_g = times.iter().map(|time| amplitude * 9.81 * (TAU * time / period).sin()).collect();
        NamedRecord::new(name, Record::from_samples("", times, a_g).unwrap(), 1.0).unwrap()
    }

    fn design(vary: &str, between: [f64; 2], limits: &[&str], share: f64) -> Design {
        let records = [("a", 0.5, 0.5), ("b", 0.7, 0.6), ("c", 1.0, 0.45), ("d", 0.4, 0.9), ("e", 1.2, 0.5)];
        let (vary, limit) = (vary.into(), limits.iter().map(|of| (*of).to_owned()).collect());
        Design {
            sought: Goal { vary, between, limit, share, count: 9, refine: 2, ..Goal::default() },
            structure: Structure::new(Parameters::MCMANUS).unwrap(),
            motions: records.map(|(name, period, amplitude)| sine(name, period, amplitude)).into(),
            scales: vec![1.0],
            conditions: Conditions::default(),
        }
    }

    /// The brute sweep has every value that the refinements can have, and counts on its own.
    #[test]
    fn the_value_is_that_of_a_brute_sweep() {
        let of_two = design("P_0", [0.0, 2e4], &["theta <= 50 mrad", "a_t <= 1.2 g"], 0.8);
        let points = of_two.complete(|_, _| ()).unwrap();
        let is_within = |P_0: f64, NamedRecord { record, .. }: &NamedRecord| {
            let run = Run::new(OneMass::new(Parameters { P_0, ..Parameters::MCMANUS }).unwrap(), record);
            let RunResult { finish, peaks, .. } = run.found(&mut ()).unwrap();
            let is_low = |of, most| peaks.of(of).unwrap().magnitude < most;
            finish.ending != Ending::Overturned && is_low(Output::theta, 0.05) && is_low(Output::a_t(0), 1.2 * 9.81)
        };
        let count = |P_0| of_two.motions.iter().filter(|motion| is_within(P_0, motion)).count();
        let brute: Vec<_> = (0..=512).map(|i| 2e4 / 512.0 * f64::from(i)).map(|P_0| (P_0, count(P_0))).collect();
        let crossings = brute.windows(2).filter(|pair| (pair[0].1 >= 4) != (pair[1].1 >= 4));
        let crossings: Vec<_> = crossings.map(|pair| [pair[0].0, pair[1].0]).collect();
        let found = of_two.found(&points);
        assert_eq!((found.crossings.len(), &found.crossings), (1, &crossings));
        assert_eq!(found.value, Some(crossings[0][1]));
        assert!(found.sentence.starts_with("theta <= 50 mrad and a_t <= 1.2 g in 80 % of the runs: from P_0 = "));
        for DesignPoint { value, holds, within, demands, .. } in points {
            let count = count(value);
            assert_eq!((within, holds), (count as f64 / 5.0, count >= 4), "{value}");
            assert!(!holds || demands.iter().all(|demand| *demand < 1.0));
        }
    }

    /// Narrow, it is too quick to fall over; wide, too stout.
    #[test]
    fn all_crossings_of_a_demand_that_is_not_monotone_are_said() {
        let all = design("B", [0.1, 0.4], &["stands"], 1.0);
        let one = Design { motions: vec![all.motions[3].clone()], sought: Goal { refine: 3, ..all.sought }, ..all };
        let points = one.complete(|_, _| ()).unwrap();
        let Designed { value, holds, crossings, sentence } = one.found(&points);
        assert_eq!((value, holds.len(), crossings.len()), (None, 2, 2), "{sentence}");
        assert!(sentence.ends_with(", 2 crossings: the demand is not monotone"), "{sentence}");
        for [before, after] in crossings {
            let falls = |B| {
                let run = OneMass::new(Parameters { B, ..Parameters::MCMANUS }).unwrap();
                Run::new(run, &one.motions[0].record).found(&mut ()).unwrap().finish.ending == Ending::Overturned
            };
            assert!(falls(before) != falls(after) && after - before < 0.3 / 8.0 / 400.0);
        }
    }

    #[test]
    fn what_no_value_reaches_is_said_and_what_has_no_meaning_is_refused() {
        let far = design("P_0", [0.0, 1e4], &["theta <= 1e-9"], 1.0);
        let points = far.complete(|_, _| ()).unwrap();
        let Designed { value, holds, sentence, .. } = far.found(&points);
        assert_eq!((value, holds.len(), points.len()), (None, 0, 9));
        let expected =
            "theta <= 1e-9 in 100 % of the runs: at no P_0 from 0 N to 10000 N; at most in 80 % of the runs, at 5000 N";
        assert_eq!(sentence, expected);
        let with = |sought| Design { sought, ..far.clone() };
        let refused = |of: Design| of.complete(|_, _| ()).unwrap_err().to_string();
        for (of, starts) in [
            (with(Goal { share: 84.0, ..far.sought.clone() }), "share = 84.0 is out of range"),
            (
                with(Goal { between: [2.0, 1.0], ..far.sought.clone() }),
                "between = 2.0, 1.0: P_0 needs two rising numbers",
            ),
            (with(Goal { log: true, ..far.sought.clone() }), "between = 0.0, 10000.0: P_0 needs two rising numbers"),
            (design("P_0", [0.0, 1.0], &["theta >= 3 deg"], 0.5), "limit = \"theta >= 3 deg\": MEASURE <= VALUE"),
            (design("P_1", [0.0, 1.0], &["stands"], 0.5), "\"P_1\" cannot vary: these can: m, "),
        ] {
            assert!(refused(of.clone()).starts_with(starts), "{}", refused(of));
        }
    }
}
