//! Many runs, several of which step together: a register of the processor has one number of each.
//!
//! Runs that rock by Eqs 5 and 6 expand their motion order by order together, each as far as it would go by itself. If a series
//! proves that no guard closes, it is the whole step. If its bounds prove that it passes no peak, no search looks at it. Contact,
//! transitions and the search for peaks go run by run. The operations on the numbers of a run are those of the run by itself, in
//! the same order, so that all results have the same bits. The bounds are a little wider: what they prove, the run by itself
//! proves too.

use super::fall::{FallWatch, FallingPeaks, Found};
use super::ground_motion::Segment;
use super::{Ending, Finish, Follower, Run, RunError, ending, error};
use crate::levels::nonlinear::lanes::{RockingStep, Steps};
use crate::numbers::lanes::MOST;
use crate::series::taylor::Arc;
use crate::{LinearLoad, State};
use pulp::{Arch, Simd, WithSimd};
use std::collections::VecDeque;

/// Runs on their way at a time.
const ON_THE_WAY: usize = 2 * MOST;

/// Fewer runs than these are faster one by one.
const LEAST: usize = 3;

/// Follows `runs` to their ends and finds the exact peaks of each, as [`Run::found`] does. Tells `done` each result, with the
/// run's position, as the run ends; once `done` says no, the rest is left undone.
pub fn found_each(runs: &[Run], done: impl FnMut(usize, Result<Found, RunError>) -> bool) {
    Arch::new().dispatch(FoundEach { runs, done });
}

/// The runs of [`found_each`].
struct FoundEach<'a, Done> {
    runs: &'a [Run<'a>],
    done: Done,
}

impl<Done: FnMut(usize, Result<Found, RunError>) -> bool> WithSimd for FoundEach<'_, Done> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let FoundEach { runs, mut done } = self;
        if S::F64_LANES < LEAST {
            runs.iter().enumerate().all(|(number, run)| done(number, run.found(&mut ())));
        } else {
            follow(simd, runs, done);
        }
    }
}

/// A run on its way.
struct Lane<'a, Segments> {
    number: usize,
    run: &'a Run<'a>,
    follower: Follower<f64, Segments>,
    watch: FallWatch<'a>,
    /// The next segment; none after the last one.
    segment: Option<Segment>,
    /// The step of rocking over the next segment.
    step: Option<RockingStep>,
}

impl<Segments: Iterator<Item = Segment>> Lane<'_, Segments> {
    /// Follows the run, by itself, to its next step of rocking. Returns the ending of the run if the run ends before.
    fn go_on(&mut self) -> Result<Option<Ending>, RunError> {
        loop {
            let mut segment = None;
            if let Some(Segment { since, duration, until, ground }) = self.follower.segments.next() {
                if let Some((end, most)) = self.follower.engine.contact_leap(duration, ground) {
                    if self.passes(duration, ground, &end, &most) {
                        self.follower.engine.leap_to(end, (duration, until));
                        continue;
                    }
                } else {
                    self.step = self.follower.engine.rocking_step(duration, ground);
                    if self.step.is_some() {
                        self.segment = Some(Segment { since, duration, until, ground });
                        return Ok(None);
                    }
                }
                segment = Some(Segment { since, duration, until, ground });
            }
            if let Some(ending) = self.follower.go_over(segment, &mut self.watch)? {
                return Ok(Some(ending));
            }
        }
    }

    /// Whether a step of `duration` (s) under `ground` to the state `end`, within the bounds `most`, certainly changes no peak.
    #[inline(always)]
    fn passes(&mut self, duration: f64, ground: LinearLoad, end: &State, most: &State) -> bool {
        let engine = &self.follower.engine;
        let bounds = engine.bounds(duration, ground, most);
        let start = engine.motion().time;
        let ends = [0.0, duration].map(|tau| (start + tau, ground.at(tau).a_g));
        self.watch.passes(end.theta, &bounds, ends)
    }

    /// Takes the step in hand as `steps` have it in `lane`, or by itself.
    #[inline]
    fn take<S: Simd>(&mut self, steps: &Steps<S>, lane: usize) -> Result<Option<Ending>, RunError> {
        let (Some(segment), Some(stepped)) = (self.segment, steps.of(lane)) else {
            return self.follower.go_over(self.segment, &mut self.watch);
        };
        let Segment { duration, until, ground, .. } = segment;
        let (times, write) = ((duration, until), |arc: &mut Arc| steps.write(lane, stepped.order, duration, arc));
        if !stepped.stays {
            let engine = &mut self.follower.engine;
            let progress = engine.advance_by(times, ground, &mut self.watch, write);
            return progress.map(ending).map_err(|cause| error(engine, cause));
        }
        if self.passes(duration, ground, &stepped.end, &stepped.most) {
            self.follower.engine.step_to(&stepped, times, ground, &mut (), write);
        } else {
            self.follower.engine.step_to(&stepped, times, ground, &mut self.watch, write);
        }
        Ok(None)
    }
}

/// Follows the `runs` of [`found_each`].
#[inline(never)] // what is of one run alone needs no wide registers
fn follow<S: Simd>(simd: S, runs: &[Run], mut done: impl FnMut(usize, Result<Found, RunError>) -> bool) {
    let since = |run: &Run| FallingPeaks::since(run.ground.start(), &run.structure, run.detail);
    let mut peaks: Vec<_> = runs.iter().map(since).collect();
    let mut waiting = runs.iter().zip(&mut peaks).enumerate();
    let mut rocking = VecDeque::with_capacity(ON_THE_WAY);
    let mut steps = Steps::new(simd);
    loop {
        while rocking.len() < ON_THE_WAY
            && let Some((number, (run, peaks))) = waiting.next()
        {
            let is_wanted = match run.course() {
                Ok(follower) => {
                    let lane = Lane { number, run, follower, watch: peaks.watch(), segment: None, step: None };
                    goes_on(Box::new(lane), Ok(None), &mut rocking, &mut done)
                }
                Err(error) => done(number, Err(error)),
            };
            if !is_wanted {
                return;
            }
        }
        let group = rocking.len().min(S::F64_LANES);
        for lane in 0..S::F64_LANES {
            let of_lane: Option<&Box<Lane<_>>> = rocking.get(if lane < group { lane } else { 0 });
            let Some(step) = of_lane.and_then(|lane| lane.step.as_ref()) else { return };
            steps.put(lane, step);
        }
        steps.take();
        for place in 0..group {
            let Some(mut lane) = rocking.pop_front() else { return };
            let taken = lane.take(&steps, place);
            if !goes_on(lane, taken, &mut rocking, &mut done) {
                return;
            }
        }
    }
}

/// Follows the run of `lane`, which has gone as far as `went_on` says, to its next step of `rocking` or to its end.
fn goes_on<'a, Segments: Iterator<Item = Segment>>(
    mut lane: Box<Lane<'a, Segments>>,
    went_on: Result<Option<Ending>, RunError>,
    rocking: &mut VecDeque<Box<Lane<'a, Segments>>>,
    done: &mut impl FnMut(usize, Result<Found, RunError>) -> bool,
) -> bool {
    let went_on = match went_on {
        Ok(None) => lane.go_on(),
        ended => ended,
    };
    let Lane { number, run, .. } = *lane;
    match went_on {
        Ok(None) => {
            rocking.push_back(lane);
            true
        }
        Ok(Some(ending)) => {
            let finish = Finish { ending, motion: *lane.follower.engine.motion() };
            let peaks = lane.watch.end();
            done(number, Ok(run.found_of(*peaks.peaks(), peaks.fall(), finish)))
        }
        Err(error) => done(number, Err(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::End;
    use crate::run::record::Record;
    use crate::{Detail, Parameters, Structure};

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
    fn structure(random: &mut fastrand::Rng) -> Structure {
        let usual = [Parameters::MCMANUS, Parameters::EVISON][random.usize(..2)];
        let mut vary = |number: f64| number * (0.5 + random.f64());
        let [H, B, f_fc, zeta_fc] = [usual.H, usual.B, usual.f_fc, usual.zeta_fc].map(&mut vary);
        let varied = Parameters { H, B, f_fc, zeta_fc, ..usual };
        Structure::new(match random.u8(..) {
            0..16 => Parameters { k_t: 1e4, P_0: 300.0, ..varied },
            16..32 => Parameters { m0: 0.0, J0: 0.0, f_fc: 0.2, ..varied },
            _ => varied,
        })
        .unwrap()
    }

    fn together<S: Simd>(simd: S, runs: &[Run]) -> Vec<String> {
        let mut found = vec![String::new(); runs.len()];
        follow(simd, runs, |number, result| {
            found[number] = format!("{result:?}");
            true
        });
        found
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
}
