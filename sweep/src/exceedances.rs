//! How often the structures of a plan overturn or exceed limits, and their fragility curves, against the intensity of
//! the single run.

use crate::Refused;
use crate::fragility::{FragilityCurve, Trials};
use crate::outcome::{Limit, Outcome};
use crate::plan::{Case, Plan, Population};
use rocking::estimates::intensity::IntensityMeasure;
use rocking::run::Ending;
use serde::Serialize;

/// More bins than this are not made, however many runs there are.
const MOST_BINS: usize = 20;

/// Intensities with fewer runs than this each, on average, share bins.
const FEWEST_RUNS: usize = 3;

#[derive(Clone, Debug)]
pub struct Exceedances {
    pub population: String,
    /// Runs of about the same intensity, by intensity, without the failed runs.
    pub bins: Vec<Bin>,
    /// Fragilities of overturning, then of the limits.
    pub fragilities: Vec<Fragility>,
    pub failed: usize,
    pub still_rocking: usize,
}

/// Runs of about the same intensity: the smallest, the geometric mean and the largest of their intensities, and how many there are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bin {
    pub lowest: f64,
    pub mean: f64,
    pub highest: f64,
    pub runs: usize,
}

/// How often one limit is exceeded.
#[derive(Clone, Debug)]
pub struct Fragility {
    pub limit: Limit,
    pub tallies: Vec<Tally>,
    /// Against the intensity of the single run.
    pub curve: Result<FragilityCurve, Refused>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Number of runs that certainly exceed the limit, or certainly do not.
    pub known: usize,
    pub exceedances: usize,
}

impl Tally {
    /// The part that exceeds the limit, if anything is known.
    pub fn part(&self) -> Option<f64> {
        (self.known > 0).then(|| self.exceedances as f64 / self.known as f64)
    }
}

/// A run's group, its intensity, and what it came to: an outcome, or whether a limit was exceeded, if that is known.
type CountedRun<T> = (usize, f64, T);

/// The outcome of a run under g (m/s²).
type RunOutcome<'a> = (&'a Outcome, f64);

/// Counts the `outcomes` of all runs of `plan`, in their order, population by population: against intensities in
/// `measure`, how many overturn and how many exceed each of `limits`.
pub fn count(plan: &Plan, measure: IntensityMeasure, limits: &[Limit], outcomes: &[Outcome]) -> Vec<Exceedances> {
    let mut runs = plan.cases().zip(outcomes).peekable();
    let mut next_of = |name: &str| runs.next_if(|(case, _)| case.population.name == name);
    let counted =
        |(case, outcome): (Case, _)| (case.group, case.intensity(measure), (outcome, case.structure.base().g));
    let of = |population: &Population| {
        let runs: Vec<_> = std::iter::from_fn(|| next_of(&population.name).map(counted)).collect();
        of_population(&population.name, limits, &runs)
    };
    plan.populations.iter().map(of).collect()
}

fn of_population(name: &str, limits: &[Limit], runs: &[CountedRun<RunOutcome>]) -> Exceedances {
    let (ended, failed): (Vec<_>, Vec<_>) =
        runs.iter().copied().partition(|(.., of)| matches!(of.0, Outcome::Ended(_)));
    let still_rocks =
        |run: &&CountedRun<RunOutcome>| matches!(run.2.0, Outcome::Ended(of) if of.ending == Ending::StillRocking);
    let still_rocking = ended.iter().filter(still_rocks).count();
    let bins = bins(ended);
    Exceedances {
        population: name.into(),
        fragilities: [Limit::Overturning].iter().chain(limits).map(|limit| fragility(limit.clone(), &bins)).collect(),
        bins: bins.iter().map(|runs| Bin::of(runs)).collect(),
        failed: failed.len(),
        still_rocking,
    }
}

fn fragility(limit: Limit, bins: &[Vec<CountedRun<RunOutcome>>]) -> Fragility {
    let exceeds =
        |&(group, intensity, (outcome, g)): &CountedRun<RunOutcome>| (group, intensity, outcome.exceeds(&limit, g));
    let bins: Vec<Vec<_>> = bins.iter().map(|runs| runs.iter().map(exceeds).collect()).collect();
    let (tallies, curve) = fit(&bins);
    Fragility { limit, tallies, curve }
}

/// Counts how often the runs in each of `bins` exceed a limit, and fits the curve to the single runs.
fn fit(bins: &[Vec<CountedRun<Option<bool>>>]) -> (Vec<Tally>, Result<FragilityCurve, Refused>) {
    let tally = |runs: &Vec<CountedRun<Option<bool>>>| {
        runs.iter().filter_map(|run| run.2).fold(Tally::default(), |Tally { known, exceedances }, exceeds| Tally {
            known: known + 1,
            exceedances: exceedances + usize::from(exceeds),
        })
    };
    (bins.iter().map(tally).collect(), FragilityCurve::fit(&Trials::count(bins.iter().flatten().copied())))
}

/// The curve of `runs`, each with its group, its intensity and whether the limit was exceeded, if that is known, and how often
/// it is in runs of about the same intensity.
pub fn of_runs(runs: Vec<(usize, f64, Option<bool>)>) -> Result<(FragilityCurve, Vec<(Bin, Tally)>), Refused> {
    let bins = bins(runs);
    let (tallies, curve) = fit(&bins);
    Ok((curve?, bins.iter().map(|runs| Bin::of(runs)).zip(tallies).collect()))
}

/// `runs` in bins of about the same number, by intensity: √n of them, at most [`MOST_BINS`]. Runs of the same intensity
/// are in the same bin; where there are few intensities with many runs each, each has a bin of its own.
fn bins<T: Copy>(mut runs: Vec<CountedRun<T>>) -> Vec<Vec<CountedRun<T>>> {
    let all = runs.len();
    runs.sort_by(|a, b| a.1.total_cmp(&b.1));
    let of_one_intensity: Vec<_> = runs.chunk_by(|a, b| a.1 == b.1).collect();
    if of_one_intensity.len() <= MOST_BINS && FEWEST_RUNS * of_one_intensity.len() <= all {
        return of_one_intensity.into_iter().map(<[_]>::to_vec).collect();
    }
    let count = MOST_BINS.min((all as f64).sqrt().ceil() as usize);
    let (mut bins, mut before) = (vec![Vec::new(); count], 0);
    for runs in of_one_intensity {
        let middle = 2 * before + runs.len();
        bins[count * middle / (2 * all)].extend_from_slice(runs);
        before += runs.len();
    }
    bins.retain(|runs| !runs.is_empty());
    bins
}

impl Bin {
    /// Of `runs`, one or more, by intensity.
    fn of<T>(runs: &[CountedRun<T>]) -> Bin {
        let logarithms: f64 = runs.iter().map(|(_, intensity, _)| intensity.ln()).sum();
        let [lowest, highest] = [runs[0].1, runs[runs.len() - 1].1];
        let mean = (logarithms / runs.len() as f64).exp();
        Bin { lowest, mean: mean.clamp(lowest, highest), highest, runs: runs.len() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Two scale factors as they come from two records of different strength.
    #[test]
    fn dots_stand_at_the_intensity_of_their_own_runs() {
        let ended = |ending| Outcome::ended(ending, 0.5);
        let [stands, falls, rocks] = [Ending::AtRest, Ending::Overturned, Ending::StillRocking].map(ended);
        let failed = Outcome::Failed { time: 1.0, reason: "chatter".into() };
        let runs = [
            (0, 4.0, &falls),
            (1, 1.0, &stands),
            (0, 2.0, &falls),
            (1, 0.5, &stands),
            (1, 0.5, &rocks),
            (1, 0.5, &stands),
            (1, 1.0, &falls),
            (0, 2.0, &stands),
            (1, 1.0, &stands),
            (0, 2.0, &falls),
            (0, 4.0, &falls),
            (0, 4.0, &falls),
            (0, 8.0, &failed),
        ];
        let limit = Limit::read("theta >= 0.5", &[("theta".into(), "rad".into())]).unwrap();
        let runs = runs.map(|(group, intensity, outcome)| (group, intensity, (outcome, 9.81)));
        let Exceedances { bins, fragilities, failed, still_rocking, .. } = of_population("piers", &[limit], &runs);
        assert_eq!((failed, still_rocking), (1, 1));
        let at = |intensity, runs| Bin { lowest: intensity, mean: intensity, highest: intensity, runs };
        assert_eq!(bins, [at(0.5, 3), at(1.0, 3), at(2.0, 3), at(4.0, 3)]);
        let tallies = |of: usize| fragilities[of].tallies.iter().map(|t| (t.exceedances, t.known)).collect::<Vec<_>>();
        assert_eq!(tallies(0), [(0, 2), (1, 3), (2, 3), (3, 3)]);
        assert_eq!(tallies(1), [(3, 3); 4]);
        let by_hand = [(0.5, 2, 0), (1.0, 3, 1), (2.0, 3, 2), (4.0, 3, 3)];
        let trials = by_hand.map(|(intensity, runs, exceedances)| Trials { group: 0, intensity, runs, exceedances });
        let (found, expected) =
            (fragilities[0].curve.as_ref().unwrap().median, FragilityCurve::fit(&trials).unwrap().median);
        assert!((found - expected).abs() < 1e-9 * expected, "{found} {expected}");
        assert!(fragilities[1].curve.is_err());
    }

    proptest! {
        /// Every run is in one bin, bins do not overlap, and hold about as many runs each.
        #[test]
        fn bins_share_out_the_runs(intensities in prop::collection::vec(1..1000_u32, 1..2000)) {
            let bins = bins(intensities.iter().map(|x| (0, f64::from(*x), ())).collect());
            let mut sorted = intensities.clone();
            sorted.sort_unstable();
            let found: Vec<_> = bins.iter().flatten().map(|(_, intensity, _)| *intensity as u32).collect();
            prop_assert_eq!(&found, &sorted);
            for pair in bins.windows(2) {
                prop_assert!(Bin::of(&pair[0]).highest < Bin::of(&pair[1]).lowest);
            }
            let mut most_of_one = 1;
            sorted.chunk_by(|a, b| a == b).for_each(|same| most_of_one = most_of_one.max(same.len()));
            sorted.dedup();
            if sorted.len() > MOST_BINS || 3 * sorted.len() > intensities.len() {
                let share = intensities.len() as f64 / MOST_BINS.min((intensities.len() as f64).sqrt().ceil() as usize) as f64;
                prop_assert!(bins.iter().all(|runs| runs.len() as f64 <= share + most_of_one as f64));
            } else {
                prop_assert_eq!(bins.len(), sorted.len());
            }
        }
    }
}
