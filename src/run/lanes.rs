//! Many runs, several of which step together: a register of the processor has one number of each.
//!
//! Runs leap in full contact together, from sample to sample, each at its own place in its record. Runs of one mass that rock by Eqs 5
//! and 6 expand their motion order by order together, each as far as it would go by itself ([`engine::lanes`](crate::engine)). If the
//! bounds of a leap or a step prove that no guard closes, that is all: a step that may hold a peak is put off. Otherwise the run goes
//! on by itself, with transitions and searches, until it does again what others do.

mod watches;

use super::course::{Ending, Finish, Follower, LONGEST_REST, MOST_STEPS, Run, RunError, Starts, error, load_of};
use super::fall::{FallPeaks, FallWatch, RunResult};
use super::ground_motion::{Segment, Segments};
use super::peaks::Peaks;
use crate::Progress;
use crate::engine::Advance;
use crate::engine::lanes::leaps::ContactLeaps;
use crate::engine::lanes::number::MOST;
use crate::engine::lanes::rocking::RockingLanes;
use crate::mechanics::lateral::Coordinates;
use pulp::{Arch, Simd, WithSimd};
use std::collections::VecDeque;

/// Runs on their way at a time: so many that those in contact, those that rock in a record, or those after theirs fill a register.
const ON_THE_WAY: usize = 4 * MOST;

/// Fewer runs than these are faster one by one.
const LEAST: usize = 3;

/// Sees the result of a run, with the run's position, and says whether to go on.
pub type OnResult<'a, T> = &'a mut dyn FnMut(usize, T) -> bool;

/// Follows runs and shows the result of each.
type ShowEach<Q, T> = fn(&[Run<Q>], OnResult<T>);

/// How runs are followed to their peaks, and to their rotation alone.
pub(super) type Each<Q> =
    (ShowEach<Q, Result<RunResult<Q>, RunError>>, ShowEach<Q, (Result<Finish<Q>, RunError>, FallPeaks)>);

pub(super) fn find_each<Q: Starts>(runs: &[Run<Q>], done: OnResult<Result<RunResult<Q>, RunError>>) {
    let done = &mut |number: usize, finish, watch| done(number, found(&runs[number], finish, watch));
    Arch::new().dispatch(Following { runs, watch: Run::watch_falling, done });
}

pub(super) fn rock_each<Q: Starts>(runs: &[Run<Q>], done: OnResult<(Result<Finish<Q>, RunError>, FallPeaks)>) {
    let done = &mut |number, finish, watch: FallWatch<Q>| done(number, (finish, watch.end()));
    Arch::new().dispatch(Following { runs, watch: watch_rocking, done });
}

/// The watcher of the peak of θ alone of `run`, before any motion.
fn watch_rocking<Q: Starts>(run: &Run<Q>) -> FallWatch<Q> {
    let all = Peaks::since(run.ground.start(), &run.structure, run.detail).of_theta().watch();
    FallWatch { all, no_return: None, fall: None, has_overturned: false, impacts: 0 }
}

/// Result of a `run` with this `finish`, all of which `watch` has seen.
fn found<Q: Starts>(
    run: &Run<Q>,
    finish: Result<Finish<Q>, RunError>,
    watch: FallWatch<Q>,
) -> Result<RunResult<Q>, RunError> {
    // the peaks of a fall are not looked for
    let (peaks, fall) = match watch.fall.filter(|_| watch.has_overturned) {
        Some((instant, before)) => (before, Some(instant)),
        None => (watch.all.end(), None),
    };
    finish.map(|finish| run.found_of(peaks, fall, finish))
}

/// Sees how a run ended, with the run's position and its watcher, and says whether to go on.
type Seen<'a, Q> = &'a mut dyn FnMut(usize, Result<Finish<Q>, RunError>, FallWatch<Q>) -> bool;

/// Following runs to their ends, each seen by a watcher of its own.
struct Following<'a, Q: Coordinates> {
    runs: &'a [Run<'a, Q>],
    watch: fn(&Run<'a, Q>) -> FallWatch<Q>,
    done: Seen<'a, Q>,
}

impl<Q: Starts> WithSimd for Following<'_, Q> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.follow(simd);
    }
}

/// A run on its way.
struct Lane<'a, Q: Coordinates> {
    number: usize,
    follower: Follower<Q, Segments<'a>>,
    watch: FallWatch<Q>,
    /// The end of the present segment, s, and the ending of the run there, if the run ends there.
    until: f64,
    ending: Option<Ending>,
    /// The advance over the segment, until the segment is over.
    advance: Option<Advance<Q>>,
}

/// The next action of a run.
enum Next {
    /// Something that other runs do too, by its place among the [`KINDS`].
    Kind(usize),
    /// Nothing: it has ended.
    End(Ending),
}

/// Kinds of steps that runs take together: leaps in full contact, and steps of rocking in a record and after it, which are longer.
const KINDS: usize = 3;
const LEAPS: usize = 0;
const ROCKS: usize = 1;
const ROCKS_ON: usize = 2;

impl<Q: Starts> Lane<'_, Q> {
    /// Goes on to where the run in `slot` of `steps` has come without a transition.
    fn catch_up<S: Simd>(&mut self, steps: &mut RockingLanes<S, Q>, slot: usize) -> Result<(), RunError> {
        let Lane { follower: Follower { engine, segments, .. }, watch, .. } = self;
        let Some((next, elapsed)) = steps.catch_up(slot, engine, watch) else { return Ok(()) };
        if let Some(next) = next {
            segments.next = next;
            self.go_on()?; // to the next step
        }
        let Lane { follower: Follower { engine, .. }, advance, .. } = self;
        advance.iter_mut().for_each(|advance| engine.come_to(elapsed, advance));
        Ok(())
    }

    /// Takes the step of rocking that was taken in `slot` of `steps`, and goes on.
    #[inline]
    fn take<S: Simd>(&mut self, steps: &mut RockingLanes<S, Q>, slot: usize) -> Result<Next, RunError> {
        self.catch_up(steps, slot)?;
        let Lane { follower: Follower { engine, .. }, advance, watch, .. } = self;
        let Some(advance) = advance else { return self.go_on() };
        let taken = engine.take(steps, slot, advance, watch).map_err(|cause| error(engine, cause))?;
        self.arrive(taken).map_or_else(|| self.go_on(), Ok)
    }

    /// Follows the run, whose segment is over, by itself until other runs do the same.
    fn go_on(&mut self) -> Result<Next, RunError> {
        loop {
            let (Segment { duration, until, ground, .. }, ending) = match self.follower.next()? {
                Ok(next) => next,
                Err(ending) => return Ok(Next::End(ending)),
            };
            (self.until, self.ending) = (until, ending);
            let Lane { follower: Follower { engine, .. }, advance, watch, .. } = self;
            let load = load_of(engine.structure(), ground);
            let made = engine.begin(duration, load, advance, watch).map_err(|cause| error(engine, cause))?;
            if let Some(next) = self.arrive(made) {
                return Ok(next);
            }
        }
    }

    /// The next action of the run, which has `made` this progress over its segment, if others do the same or the run has ended.
    #[inline(always)]
    fn arrive(&mut self, made: Option<Progress>) -> Option<Next> {
        let Follower { engine, segments, rest, .. } = &mut self.follower;
        match made {
            None => return Some(Next::Kind(if *rest < LONGEST_REST { ROCKS_ON } else { ROCKS })),
            Some(Progress::Overturned) => return Some(Next::End(Ending::Overturned)),
            Some(_) => engine.set_time(self.until),
        }
        self.advance = None;
        let may_leap = || engine.may_leap() && engine.motion().work.steps <= MOST_STEPS && segments.samples().is_some();
        self.ending.map(Next::End).or_else(|| may_leap().then_some(Next::Kind(LEAPS)))
    }

    /// Follows the run by itself to its end.
    fn finish(&mut self) -> Result<Ending, RunError> {
        let Lane { follower: Follower { engine, .. }, advance, watch, .. } = self;
        let made =
            advance.as_mut().map_or(Ok(Some(Progress::Complete)), |advance| engine.go_on(advance, false, false, watch));
        let made = made.map_err(|cause| error(engine, cause))?;
        if let Some(Next::End(ending)) = self.arrive(made) {
            return Ok(ending);
        }
        loop {
            if let Some(ending) = self.follower.go_on(&mut self.watch)? {
                return Ok(ending);
            }
        }
    }
}

/// Steps of several runs, each in a slot, that are taken together.
struct Together<'a, S: Simd, Q> {
    simd: S,
    contacts: ContactLeaps<'a, Q>,
    rocking: RockingLanes<'a, S, Q>,
}

impl<'a, S: Simd, Q: Starts> Together<'a, S, Q> {
    /// Puts `lane`, whose next step is of this `kind`, into a `slot`.
    #[inline]
    fn enter(&mut self, kind: usize, slot: usize, lane: &Lane<'a, Q>) {
        let Lane { follower: Follower { engine, segments, .. }, advance, watch, .. } = lane;
        let mut samples = segments.samples().unwrap_or_default();
        if kind != LEAPS {
            let advance = advance.as_ref().expect("it is on its way");
            return self.rocking.enter((slot, MOST_STEPS), engine, advance, samples, watch);
        }
        let left = (MOST_STEPS + 1).saturating_sub(engine.motion().work.steps) as usize;
        samples.last = samples.last.min(samples.next.saturating_add(left));
        self.contacts.enter(slot, engine, samples, watch);
    }

    /// Takes steps of this `kind`, each of which is of `count` runs. Returns how many.
    fn step(&mut self, kind: usize, count: usize) -> u64 {
        if kind == LEAPS {
            self.contacts.step(self.simd);
            return 0;
        }
        // buildings rock one by one
        if Q::IS_ONE { self.rocking.step() * count as u64 } else { 0 }
    }

    /// The action of the lane in a `slot` after its step; none if it takes another step of this `kind` there.
    #[inline]
    fn take(&mut self, kind: usize, slot: usize, lane: &mut Lane<'a, Q>) -> Option<Result<Next, RunError>> {
        if kind == LEAPS {
            return (!self.contacts.goes_on(slot)).then(|| {
                self.leave(kind, slot, lane)?;
                lane.go_on()
            });
        }
        if self.rocking.has_gone_on(slot) {
            return None;
        }
        let next = lane.take(&mut self.rocking, slot);
        if matches!(next, Ok(Next::Kind(next)) if next == kind) {
            self.enter(kind, slot, lane);
            return None;
        }
        self.rocking.leave(slot);
        Some(next)
    }

    /// Takes the lane out of a `slot`.
    fn leave(&mut self, kind: usize, slot: usize, lane: &mut Lane<'a, Q>) -> Result<(), RunError> {
        if kind != LEAPS {
            let caught_up = lane.catch_up(&mut self.rocking, slot);
            self.rocking.leave(slot);
            return caught_up;
        }
        let Follower { engine, segments, .. } = &mut lane.follower;
        segments.next = self.contacts.leave(slot, engine, &mut lane.watch);
        lane.until = engine.motion().time;
        Ok(())
    }
}

type Ended<'a, Q> = (Box<Lane<'a, Q>>, Result<Ending, RunError>);

/// The runs on their way, by what they do next, and those that have ended.
struct RunQueues<'a, Q: Coordinates> {
    of_kind: [VecDeque<Box<Lane<'a, Q>>>; KINDS],
    ended: Vec<Ended<'a, Q>>,
}

impl<'a, Q: Starts> RunQueues<'a, Q> {
    fn count(&self) -> usize {
        self.of_kind.iter().map(VecDeque::len).sum()
    }

    /// Sorts a lane by what it does next.
    fn goes_on(&mut self, lane: Box<Lane<'a, Q>>, next: Result<Next, RunError>) {
        match next {
            Ok(Next::Kind(kind)) => self.of_kind[kind].push_back(lane),
            Ok(Next::End(ending)) => self.ended.push((lane, Ok(ending))),
            Err(error) => self.ended.push((lane, Err(error))),
        }
    }

    /// Takes steps of this `kind` until a run ends or another kind has more to do. Returns how many.
    fn step<S: Simd>(&mut self, kind: usize, steps: &mut Together<'a, S, Q>) -> u64 {
        let mut taken = 0;
        let mut lanes: [Option<Box<Lane<'a, Q>>>; MOST] = [const { None }; MOST];
        let lanes = &mut lanes[..S::F64_LANES];
        loop {
            let mut count = 0;
            for (slot, place) in lanes.iter_mut().enumerate() {
                if place.is_none() {
                    // rather a longer step than none
                    let of_kinds = if kind == LEAPS { [LEAPS; 2] } else { [kind, ROCKS + ROCKS_ON - kind] };
                    *place = of_kinds.into_iter().find_map(|kind| self.of_kind[kind].pop_front());
                    place.iter().for_each(|lane| steps.enter(kind, slot, lane));
                }
                count += usize::from(place.is_some());
            }
            let others = self.of_kind.iter().map(VecDeque::len).max().unwrap_or(0);
            if count < S::F64_LANES && others > count || count == 0 || !self.ended.is_empty() {
                break;
            }
            taken += steps.step(kind, count);
            for (slot, place) in lanes.iter_mut().enumerate() {
                let next = place.as_mut().and_then(|lane| steps.take(kind, slot, lane));
                next.into_iter().for_each(|next| self.goes_on(place.take().expect("it is there"), next));
            }
        }
        for (slot, place) in lanes.iter_mut().enumerate() {
            let Some(mut lane) = place.take() else { continue };
            let next = steps.leave(kind, slot, &mut lane).map(|()| Next::Kind(kind));
            self.goes_on(lane, next);
        }
        taken
    }
}

impl<Q: Starts> Following<'_, Q> {
    /// Follows the runs. Returns how many steps of rocking have been taken together.
    #[inline(never)] // what is of one run alone needs no wide registers
    fn follow<S: Simd>(self, simd: S) -> u64 {
        let Following { runs, watch, done } = self;
        let (mut taken, has_lanes) = (0, S::F64_LANES.min(runs.len()) >= LEAST);
        let mut waiting = runs.iter().enumerate();
        let mut lanes = RunQueues { of_kind: [const { VecDeque::new() }; KINDS], ended: Vec::new() };
        let mut together = Together { simd, contacts: ContactLeaps::default(), rocking: RockingLanes::new(simd) };
        loop {
            while lanes.count() < ON_THE_WAY
                && let Some((number, run)) = waiting.next()
            {
                let mut watch = watch(run);
                match run.course() {
                    Ok(follower) if has_lanes && follower.engine.is_for_lanes() && run.ground.force().is_none() => {
                        let until = follower.engine.motion().time;
                        let mut lane = Box::new(Lane { number, follower, watch, until, ending: None, advance: None });
                        let next = lane.go_on();
                        lanes.goes_on(lane, next);
                    }
                    course => {
                        let finish = course.and_then(|follower| follower.finish(&mut watch));
                        let finish = finish.map(|(ending, engine)| Finish { ending, motion: *engine.motion() });
                        if !done(number, finish, watch) {
                            return taken;
                        }
                    }
                }
            }
            if lanes.count() < LEAST {
                for mut lane in lanes.of_kind.iter_mut().flat_map(std::mem::take) {
                    let ending = lane.finish();
                    lanes.ended.push((lane, ending));
                }
            }
            for (lane, ending) in lanes.ended.drain(..) {
                let Lane { number, follower, watch, .. } = *lane;
                let finish = ending.map(|ending| Finish { ending, motion: *follower.engine.motion() });
                if !done(number, finish, watch) {
                    return taken;
                }
            }
            if lanes.count() == 0 {
                return taken;
            }
            let kind = (0..KINDS).max_by_key(|kind| lanes.of_kind[*kind].len()).unwrap_or(LEAPS);
            taken += lanes.step(kind, &mut together);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::course::End;
    use crate::run::record::Record;
    use crate::structure::description::tests::usual;
    use crate::structure::description::{Damping, Storey};
    use crate::{Body, Detail, OneMass, Parameters, Piece, Structure, Watch};
    use std::f64::consts::{PI, TAU};

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
        let record =
            if random.u8(..) < 16 { record.with_force(&[0.0, 1.0], &[300.0, -200.0]).unwrap() } else { record };
        if random.u8(..) < 16 { record.clone().with_vertical(&record.multiplied(0.3)).unwrap() } else { record }
    }

    /// A structure about as slender as a specimen, now and then with a tendon or without a foundation's inertia, or made of one storey,
    /// or of one mode without floors and r.
    fn structure(random: &mut fastrand::Rng) -> Structure {
        let specimen = [Parameters::MCMANUS, Parameters::EVISON][random.usize(..2)];
        let mut vary = |number: f64| number * (0.5 + random.f64());
        let [H, B, f_fc, zeta_fc] = [specimen.H, specimen.B, specimen.f_fc, specimen.zeta_fc].map(&mut vary);
        let (varied, storey) =
            (Parameters { H, B, f_fc, zeta_fc, ..specimen }, Storey { m: 4e4, h: 7.0, k: vary(4e7) });
        let building = Structure::from_storeys(&usual(), &Damping::All(zeta_fc), &[storey]).unwrap();
        let of_mode = |of: &Structure| Structure::of_body(Body { r: None, ..*of.body() }, of.modes(), &[]).unwrap();
        let parameters = match random.u8(..) {
            0..16 => Parameters { k_t: 1e4, P_0: 300.0, ..varied },
            16..32 => Parameters { m0: 0.0, J0: 0.0, f_fc: 0.2, ..varied },
            32..48 => return building.of_one_mode().unwrap(),
            48..64 => return of_mode(&building).of_one_mode().unwrap(),
            _ => varied,
        };
        Structure::new(parameters).unwrap()
    }

    /// A result in words, all but the work of the search for peaks, in which runs that step together put more off.
    fn told<Q: Starts>(mut result: Result<RunResult<Q>, RunError>) -> String {
        result.iter_mut().for_each(|found| found.peaks.evaluations = 0);
        format!("{result:?}")
    }

    fn together<S: Simd, Q: Starts>(simd: S, runs: &[Run<Q>]) -> Vec<String> {
        let mut results = vec![String::new(); runs.len()];
        let done = &mut |number: usize, finish, watch| {
            results[number] = told(found(&runs[number], finish, watch));
            true
        };
        Following { runs, watch: Run::watch_falling, done }.follow(simd);
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
            runs.push(Run { detail, tolerance, end, ..Run::new(structure.clone(), ground) });
        }
        let alone: Vec<_> = runs.iter().map(|run| run.found(&mut ())).collect();
        let count = |is_so: fn(&RunResult) -> bool| alone.iter().flatten().filter(|found| is_so(found)).count();
        let overturned = count(|found| found.finish.ending == Ending::Overturned);
        let rocked = count(|found| found.finish.motion.transitions > 9);
        let steps: u64 = alone.iter().flatten().map(|found| found.finish.motion.work.steps).sum();
        let failed = alone.iter().filter(|found| found.is_err()).count();
        assert!(overturned > 400 && rocked > 800 && failed > 20 && steps > 700_000);
        assert_same(&runs, &alone.into_iter().map(told).collect::<Vec<_>>());
    }

    /// Whether `runs` together have the results of each `alone`, in as many lanes as this processor has and in those that every
    /// processor imitates.
    fn assert_same<Q: Starts>(runs: &[Run<Q>], alone: &[String]) {
        let same = |found: Vec<String>| {
            let other = (0..runs.len()).find(|i| found[*i] != alone[*i]);
            assert!(other.is_none(), "{other:?}: {} instead of {}", found[other.unwrap()], alone[other.unwrap()]);
        };
        same(together(pulp::Scalar256b, runs));
        #[cfg(target_arch = "x86_64")]
        {
            use pulp::x86::{V3, V4};
            V3::try_new().into_iter().for_each(|simd| same(together(simd, runs)));
            V4::try_new().into_iter().for_each(|simd| same(together(simd, runs)));
        }
        rock_each(runs, &mut |number, (finish, rocked)| {
            let (run, of) = (&runs[number], |of: FallPeaks| (of.all().theta(), of.impacts));
            let found = (finish, of(rocked));
            let mut watch = watch_rocking(run);
            let finish = run.end(&mut watch).map(|(ending, engine)| Finish { ending, motion: *engine.motion() });
            assert_eq!(format!("{found:?}"), format!("{:?}", (finish, of(watch.end()))));
            true
        });
    }

    /// Buildings of two to nine storeys at all levels, each beside others: with all modes or fewer, so that mass is left that no mode carries.
    #[test]
    fn each_building_has_the_bits_that_it_has_by_itself() {
        let random = &mut fastrand::Rng::with_seed(1);
        let made: Vec<_> = (0..300)
            .map(|_| {
                let storeys: Vec<_> = (1..=random.usize(2..10))
                    .map(|i| Storey { m: 2e4, h: 3.0 * i as f64, k: 4e7 * (0.5 + random.f64()) })
                    .collect();
                let building = Structure::from_storeys(&usual(), &Damping::All(0.05 * random.f64()), &storeys).unwrap();
                let kept = building.modes().len() - usize::from(random.u8(..) < 32);
                (building.keeping(kept).unwrap(), ground(random).multiplied(0.2 + random.f64()))
            })
            .collect();
        let runs = made.iter().map(|(building, ground)| Run::of_modes(building.clone(), ground));
        let detail = |i: usize| Detail::ALL[(i % 18).saturating_sub(12)];
        let runs: Vec<_> = runs.enumerate().map(|(i, run)| Run { detail: detail(i), ..run }).collect();
        let alone: Vec<_> = runs.iter().map(|run| run.found(&mut ())).collect();
        let rocked = alone.iter().flatten().filter(|found| found.finish.motion.transitions > 9).count();
        let for_lanes = runs.iter().filter(|run| run.course().is_ok_and(|of| of.engine.is_for_lanes())).count();
        assert!(rocked > 50 && for_lanes > 150, "{rocked} {for_lanes}");
        let alone: Vec<_> = alone.into_iter().map(told).collect();
        assert_same(&runs, &alone);
        // without any of many modes among them
        let of_few = |run: &Run<_>| run.structure.modes().len() < 4;
        let few = runs.iter().zip(alone).filter(|(run, _)| of_few(run)).map(|(run, alone)| (run.clone(), alone));
        let (runs, alone): (Vec<_>, Vec<_>) = few.unzip();
        assert_same(&runs, &alone);
    }

    /// Near a steady state each cycle is larger than the one before by a part that vanishes: the same cycle has the peak.
    #[test]
    fn piers_at_resonance_have_the_peaks_that_they_have_by_themselves() {
        let random = &mut fastrand::Rng::with_seed(1);
        let mut made = || {
            let (zeta_fc, per, phase) =
                ([0.01, 0.05, 0.3][random.usize(..3)], [8.0, 9.7, 16.0][random.usize(..3)], random.f64());
            let ground = |i| 0.5 * zeta_fc * f64::sin(TAU * (f64::from(i) / per + phase));
            let times = (0..10_000).map(|i| f64::from(i) * 0.01).collect();
            let ground = Record::from_samples("", times, (0..10_000).map(ground).collect()).unwrap();
            (OneMass::new(Parameters { f_fc: 100.0 / per, zeta_fc, ..Parameters::MCMANUS }).unwrap(), ground)
        };
        let made: Vec<_> = (0..50).map(|_| made()).collect();
        let runs: Vec<_> = made.iter().map(|(pier, ground)| Run::new(*pier, ground)).collect();
        assert_same(&runs, &runs.iter().map(|run| told(run.found(&mut ()))).collect::<Vec<_>>());
    }

    /// A stiff structure takes several parts of an advance from one of these samples to the next.
    #[test]
    fn the_end_of_a_part_is_no_sample() {
        let (random, times) = (&mut fastrand::Rng::with_seed(1), (0..40).map(|i| 3.0 * f64::from(i)));
        let mut ground = || {
            let acceleration = (0..40).map(|_| 4.0 * (random.f64() - 0.5)).collect();
            Record::from_samples("", times.clone().collect(), acceleration).unwrap()
        };
        let grounds: Vec<_> = (0..200).map(|_| ground()).collect();
        let stiff = OneMass::new(Parameters { H: 3.0, f_fc: 60.0, ..Parameters::MCMANUS }).unwrap();
        let runs: Vec<_> = grounds.iter().map(|ground| Run::new(stiff, ground)).collect();
        let alone: Vec<_> = runs.iter().map(|run| told(run.found(&mut ()))).collect();
        assert!(together(pulp::Scalar256b, &runs) == alone);
    }

    /// Counts steps of rocking.
    struct RockingLanes(u64);

    impl Watch for RockingLanes {
        fn piece(&mut self, piece: &Piece) {
            self.0 += u64::from(piece.before.phase.properties().rotates);
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
            let mut rocking = RockingLanes(0);
            run.follow(&mut rocking).unwrap();
            rocking.0
        };
        let mut alone: Vec<_> = runs.iter().map(count).collect();
        alone.sort_unstable();
        let (all, of_last): (u64, u64) = (alone.iter().sum(), alone[runs.len() + 1 - LEAST..].iter().sum());
        let taken =
            Following { runs: &runs, watch: Run::watch_falling, done: &mut |_, _, _| true }.follow(pulp::Scalar256b);
        assert!(all > 4000 && (all - of_last..=all).contains(&taken), "{taken} of {all}, {of_last}");
    }
}
