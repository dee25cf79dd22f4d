//! Many runs, several of which step together: a register of the processor has one number of each.
//!
//! Runs that rock by Eqs 5 and 6 expand their motion order by order together, each as far as it would go by itself, in their records
//! and after them. If a series proves that no guard closes, it is the whole step. If its bounds prove that it passes no peak, no search looks at it. Contact,
//! transitions and the search for peaks go run by run. The operations on the numbers of a run are those of the run by itself, in
//! the same order, so that all results have the same bits. The bounds are a little wider: what they prove, the run by itself
//! proves too.

use super::fall::{FallWatch, Falling, Found};
use super::ground_motion::Segment;
use super::peaks::{Peaks, ThetaWatch};
use super::{Ending, Finish, Follower, LONGEST_REST, Run, RunError, Runs, error};
use crate::Progress;
use crate::engine::Advance;
use crate::engine::lanes::Passes;
use crate::levels::nonlinear::lanes::{RockingStep, Steps};
use crate::numbers::lanes::MOST;
use pulp::{Arch, Simd, WithSimd};
use std::collections::VecDeque;

/// Runs on their way at a time: so many that those in a record, or those after theirs, fill a register.
const ON_THE_WAY: usize = 2 * MOST;

/// Fewer runs than these are faster one by one.
const LEAST: usize = 3;

/// Follows `runs` to their ends and finds the exact peaks of each, as [`Run::found`] does. Tells `done` each result, with the
/// run's position, as the run ends; once `done` says no, the rest is left undone.
pub fn found_each(runs: &[Run], done: &mut dyn FnMut(usize, Result<Found, RunError>) -> bool) {
    let mut peaks = peaks_of(runs);
    let watches = peaks.iter_mut().map(Falling::watch);
    follow_each(runs, watches, |number, finish, watch| done(number, found(&runs[number], finish, watch)));
}

/// The rotation of a run.
#[derive(Clone, Copy, Debug)]
pub struct Rocked {
    /// The largest |θ|, rad, that of a fall included.
    pub theta: f64,
    /// Number of impacts and landings.
    pub impacts: u64,
}

/// Follows `runs` to their ends like [`found_each`], and tells `done` of each how it ended and how far it has rocked by then.
pub fn rocked_each(runs: &[Run], done: &mut dyn FnMut(usize, Result<Finish, RunError>, Rocked) -> bool) {
    let since = |run: &Run| Peaks::since(run.ground.start(), &run.structure, run.detail);
    let mut peaks: Vec<_> = runs.iter().map(since).collect();
    follow_each(runs, peaks.iter_mut().map(Peaks::watch_theta), |number, finish, watch| {
        let ThetaWatch { peaks, impacts } = watch;
        done(number, finish, Rocked { theta: peaks.theta().magnitude, impacts })
    });
}

impl<Q: Runs> Run<'_, Q> {
    /// Follows the motion to its end, and finds how it ended and how far it has rocked by then.
    pub fn rocked(&self) -> (Result<Finish<Q>, RunError>, Rocked) {
        let mut peaks = Peaks::since(self.ground.start(), &self.structure, self.detail);
        let mut watch = peaks.watch_theta();
        let finish = self.follow(&mut watch);
        let ThetaWatch { peaks, impacts } = watch;
        (finish, Rocked { theta: peaks.theta().magnitude, impacts })
    }
}

/// The peaks of `runs` before any motion.
fn peaks_of(runs: &[Run]) -> Vec<Falling> {
    runs.iter().map(|run| Falling::since(run.ground.start(), &run.structure, run.detail)).collect()
}

/// Result of a `run` with this `finish`, all of which `watch` has seen.
fn found(run: &Run, finish: Result<Finish, RunError>, watch: FallWatch) -> Result<Found, RunError> {
    let peaks = watch.end();
    finish.map(|finish| run.found_of(peaks.peaks().clone(), peaks.fall(), finish))
}

/// Follows `runs` to their ends, each seen by one of `watches`. Tells `done` of each how it ended, as [`found_each`] does.
fn follow_each<W: Passes>(
    runs: &[Run],
    watches: impl Iterator<Item = W>,
    done: impl FnMut(usize, Result<Finish, RunError>, W) -> bool,
) {
    Arch::new().dispatch(FollowEach { runs, watches, done });
}

/// The runs of [`follow_each`].
struct FollowEach<'a, Watches, Done> {
    runs: &'a [Run<'a>],
    watches: Watches,
    done: Done,
}

impl<W: Passes, Watches, Done> WithSimd for FollowEach<'_, Watches, Done>
where
    Watches: Iterator<Item = W>,
    Done: FnMut(usize, Result<Finish, RunError>, W) -> bool,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let FollowEach { runs, watches, mut done } = self;
        if S::F64_LANES < LEAST || runs.len() < LEAST {
            runs.iter().zip(watches).enumerate().all(|(number, (run, mut watch))| {
                let finish = run.follow(&mut watch);
                done(number, finish, watch)
            });
        } else {
            follow(simd, runs, watches, done);
        }
    }
}

/// A run on its way.
struct Lane<Segments, W> {
    number: usize,
    follower: Follower<f64, Segments>,
    watch: W,
    /// The end of the present segment, s, and the ending of the run there, if the run ends there.
    until: f64,
    ending: Option<Ending>,
    /// The advance over the segment, and its next step of rocking.
    advance: Option<Advance<f64>>,
    step: RockingStep,
}

impl<Segments: Iterator<Item = Segment>, W: Passes> Lane<Segments, W> {
    /// Takes the step in hand as `steps` have it in `lane`, and goes on.
    #[inline]
    fn take<S: Simd>(&mut self, steps: &Steps<S>, lane: usize) -> Result<Option<Ending>, RunError> {
        let Lane { follower: Follower { engine, .. }, advance, step, watch, .. } = self;
        let Some(advance) = advance else { return self.go_on() };
        let taken = engine.take(&steps.of(lane), |arc| steps.write(lane, arc), advance, step, watch);
        let Some(made) = taken.map_err(|cause| error(engine, cause))? else { return Ok(None) };
        let ending = self.arrive(made);
        if ending.is_some() { Ok(ending) } else { self.go_on() }
    }

    /// Follows the run, whose segment is over, by itself to its next step of rocking. Returns the ending of the run if the run ends
    /// before.
    fn go_on(&mut self) -> Result<Option<Ending>, RunError> {
        loop {
            let (Segment { duration, until, ground, .. }, ending) = match self.follower.next()? {
                Ok(next) => next,
                Err(ending) => return Ok(Some(ending)),
            };
            (self.until, self.ending) = (until, ending);
            let Lane { follower: Follower { engine, .. }, advance, step, watch, .. } = self;
            let mut made = Progress::Complete;
            if !engine.leaps(duration, ground, watch) {
                let begun = engine.begin(duration, ground).map_err(|cause| error(engine, cause))?;
                let went_on = engine.go_on(advance.insert(begun), false, Some(step), watch);
                made = match went_on.map_err(|cause| error(engine, cause))? {
                    Some(made) => made,
                    None => return Ok(None),
                };
            }
            let ending = self.arrive(made);
            if ending.is_some() {
                return Ok(ending);
            }
        }
    }

    /// Follows the run by itself to its end.
    fn finish(&mut self) -> Result<Option<Ending>, RunError> {
        let Lane { follower: Follower { engine, .. }, advance, watch, .. } = self;
        let made = advance.as_mut().and_then(|advance| engine.go_on(advance, false, None, watch).transpose());
        let made = made.transpose().map_err(|cause| error(engine, cause))?;
        let mut ending = self.arrive(made.unwrap_or(Progress::Complete));
        while ending.is_none() {
            ending = self.follower.go_on(&mut self.watch)?;
        }
        Ok(ending)
    }

    /// The ending of the run, which has `made` this progress over its segment, if the run has ended.
    #[inline(always)]
    fn arrive(&mut self, made: Progress) -> Option<Ending> {
        if made == Progress::Overturned {
            return Some(Ending::Overturned);
        }
        self.follower.engine.set_time(self.until);
        self.ending
    }
}

/// Follows the `runs` of [`follow_each`]. Returns how many steps have been taken together.
#[inline(never)] // what is of one run alone needs no wide registers
fn follow<S: Simd, W: Passes>(
    simd: S,
    runs: &[Run],
    watches: impl Iterator<Item = W>,
    mut done: impl FnMut(usize, Result<Finish, RunError>, W) -> bool,
) -> u64 {
    let mut taken = 0;
    let mut waiting = runs.iter().zip(watches).enumerate();
    // in the record, and after it, where steps are longer
    let mut rocking = [const { VecDeque::new() }; 2];
    let mut steps = Steps::new(simd);
    loop {
        while rocking.iter().map(VecDeque::len).sum::<usize>() < ON_THE_WAY
            && let Some((number, (run, mut watch))) = waiting.next()
        {
            let is_wanted = match run.course() {
                Ok(follower) if follower.engine.is_for_lanes() => {
                    let (until, step) = (follower.engine.motion().time, RockingStep::default());
                    let mut lane = Lane { number, follower, watch, until, ending: None, advance: None, step };
                    let went_on = lane.go_on();
                    goes_on(Box::new(lane), went_on, &mut rocking, &mut done)
                }
                Ok(follower) => {
                    let finish = follower.finish(&mut watch);
                    let finish = finish.map(|(ending, engine)| Finish { ending, motion: *engine.motion() });
                    done(number, finish, watch)
                }
                Err(error) => done(number, Err(error), watch),
            };
            if !is_wanted {
                return taken;
            }
        }
        if rocking.iter().map(VecDeque::len).sum::<usize>() < LEAST {
            for mut lane in rocking.iter_mut().flat_map(std::mem::take) {
                let ended = lane.finish();
                if !goes_on(lane, ended, &mut Default::default(), &mut done) {
                    return taken;
                }
            }
            return taken;
        }
        let most = usize::from(rocking[1].len() > rocking[0].len());
        let mut group: [Option<Box<Lane<_, W>>>; MOST] = [const { None }; MOST];
        for lane in 0..S::F64_LANES {
            group[lane] = rocking[most].pop_front().or_else(|| rocking[1 - most].pop_front());
            let Some(of_lane) = group[lane].as_ref().or(group[0].as_ref()) else { return taken };
            steps.put(lane, &of_lane.step);
        }
        steps.take();
        taken += group.iter().flatten().count() as u64;
        for (place, lane) in group.into_iter().enumerate() {
            let Some(mut lane) = lane else { break };
            let went_on = lane.take(&steps, place);
            if !goes_on(lane, went_on, &mut rocking, &mut done) {
                return taken;
            }
        }
    }
}

/// Puts the run of `lane`, which went on to its next step of rocking, to the others; or tells `done` how the run ended.
fn goes_on<Segments, W>(
    lane: Box<Lane<Segments, W>>,
    went_on: Result<Option<Ending>, RunError>,
    rocking: &mut [VecDeque<Box<Lane<Segments, W>>>; 2],
    done: &mut impl FnMut(usize, Result<Finish, RunError>, W) -> bool,
) -> bool {
    let finish = match went_on {
        Ok(None) => {
            let is_after_record = lane.follower.rest < LONGEST_REST;
            rocking[usize::from(is_after_record)].push_back(lane);
            return true;
        }
        Ok(Some(ending)) => Ok(Finish { ending, motion: *lane.follower.engine.motion() }),
        Err(error) => Err(error),
    };
    let Lane { number, watch, .. } = *lane;
    done(number, finish, watch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::End;
    use crate::run::record::Record;
    use crate::{Detail, OneMass, Parameters, Phase, Piece, Watch};
    use std::f64::consts::PI;

    /// A ground motion of filtered noise.
    fn ground(random: &mut fastrand::Rng) -> Record {
        let (step, scale) = ([0.005, 0.01, 0.02][random.usize(..3)], 12.0 * random.f64());
        let mut a_g = 0.0;
        let noise = (0..300).map(|_| {
            a_g = 0.8 * a_g + scale * (random.f64() - 0.5);
            a_g
        });
        let acceleration: Vec<_> = noise.collect();
        let times: Vec<_> = (0..300).map(|i| f64::from(i) * step).collect();
        let record = Record::from_samples("", times, acceleration).unwrap();
        if random.u8(..) < 16 { record.clone().with_vertical(&record.multiplied(0.3)).unwrap() } else { record }
    }

    /// A structure about as slender as a specimen, now and then with a tendon or without a foundation's inertia.
    fn structure(random: &mut fastrand::Rng) -> OneMass {
        let usual = [Parameters::MCMANUS, Parameters::EVISON][random.usize(..2)];
        let mut vary = |number: f64| number * (0.5 + random.f64());
        let [H, B, f_fc, zeta_fc] = [usual.H, usual.B, usual.f_fc, usual.zeta_fc].map(&mut vary);
        let varied = Parameters { H, B, f_fc, zeta_fc, ..usual };
        OneMass::new(match random.u8(..) {
            0..16 => Parameters { k_t: 1e4, P_0: 300.0, ..varied },
            16..32 => Parameters { m0: 0.0, J0: 0.0, f_fc: 0.2, ..varied },
            _ => varied,
        })
        .unwrap()
    }

    fn together<S: Simd>(simd: S, runs: &[Run]) -> Vec<String> {
        let mut results = vec![String::new(); runs.len()];
        let mut peaks = peaks_of(runs);
        follow(simd, runs, peaks.iter_mut().map(Falling::watch), |number, finish, watch| {
            results[number] = format!("{:?}", found(&runs[number], finish, watch));
            true
        });
        results
    }

    /// Structures of all kinds at all levels of detail, of every fate, each beside others, in as many lanes as this processor has
    /// and in those that every processor imitates.
    #[test]
    fn each_of_2000_runs_has_the_bits_that_it_has_by_itself() {
        let random = &mut fastrand::Rng::with_seed(1);
        let made: Vec<_> = (0..2000).map(|_| (structure(random), ground(random))).collect();
        let mut runs = Vec::new();
        for (structure, ground) in &made {
            let detail = if random.u8(..) < 224 { Detail::Auto } else { Detail::ALL[random.usize(..6)] };
            let tolerance = [1e-9, 1e-9, 1e-6, 1e-12][random.usize(..4)];
            let end = if random.bool() { End::AtRest } else { End::At(3.0 * random.f64()) };
            runs.push(Run { detail, tolerance, end, ..Run::new(*structure, ground) });
        }
        let alone: Vec<_> = runs.iter().map(|run| run.found(&mut ())).collect();
        let count = |is_so: fn(&Found) -> bool| alone.iter().flatten().filter(|found| is_so(found)).count();
        let overturned = count(|found| found.finish.ending == Ending::Overturned);
        let rocked = count(|found| found.finish.motion.transitions > 9);
        let steps: u64 = alone.iter().flatten().map(|found| found.finish.motion.work.steps).sum();
        let failed = alone.iter().filter(|found| found.is_err()).count();
        assert!(overturned > 400 && rocked > 800 && failed > 20 && steps > 700_000);
        let alone: Vec<_> = alone.iter().map(|result| format!("{result:?}")).collect();
        assert!(together(pulp::Scalar256b, &runs) == alone);
        #[cfg(target_arch = "x86_64")]
        {
            use pulp::x86::{V3, V4};
            assert!(V3::try_new().is_none_or(|simd| together(simd, &runs) == alone));
            assert!(V4::try_new().is_none_or(|simd| together(simd, &runs) == alone));
        }
    }

    /// Counts steps of rocking.
    struct Rocking(u64);

    impl Watch for Rocking {
        fn piece(&mut self, piece: &Piece) {
            self.0 += u64::from(matches!(piece.before.phase, Phase::Rocking(_)));
        }
    }

    /// A half sine after which piers rock for long: in the record and after it, from sample to sample and from impact to impact.
    #[test]
    fn all_steps_of_rocking_are_taken_together_but_those_of_the_last_runs() {
        let times: Vec<_> = (0..=100).map(|i| f64::from(i) * 0.005).collect();
        let sine = times.iter().map(|time| 6.0 * f64::sin(time * PI / 0.5)).collect();
        let ground = Record::from_samples("", times, sine).unwrap();
        let pier = |i| OneMass::new(Parameters { H: 1.2 + 0.01 * f64::from(i), ..Parameters::MCMANUS }).unwrap();
        let runs: Vec<_> = (0..40).map(|i| Run::new(pier(i), &ground)).collect();
        let count = |run: &Run| {
            let mut rocking = Rocking(0);
            run.follow(&mut rocking).unwrap();
            rocking.0
        };
        let mut alone: Vec<_> = runs.iter().map(count).collect();
        alone.sort_unstable();
        let (all, of_last): (u64, u64) = (alone.iter().sum(), alone[runs.len() + 1 - LEAST..].iter().sum());
        let mut peaks = peaks_of(&runs);
        let taken = follow(pulp::Scalar256b, &runs, peaks.iter_mut().map(Falling::watch), |_, _, _| true);
        assert!(all > 4000 && (all - of_last..=all).contains(&taken), "{taken} of {all}, {of_last}");
    }
}
