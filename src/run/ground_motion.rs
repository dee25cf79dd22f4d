//! A ground motion as a structure meets it: a record, scaled and placed in time, followed from sample to sample however
//! time is cut into steps.
//!
//! Where a step is in the record follows from the time elapsed since the start, a compensated sum of the steps, and not
//! from a clock: the same steps give the same bits at every start time. Hosts whose steps are those of the record meet
//! its samples but for rounding: what is that close to a sample counts as there, and no sliver of a step is made of it.

use crate::engine::{AdvanceError, MAX_STEPS_PER_ADVANCE};
use crate::run::record::Record;
use crate::structure::quantity::{Quantity, quantity};
use crate::{Engine, LinearLoad, Progress, Ramp, Watch};
use serde::{Deserialize, Serialize};

/// Part of the time between two samples over which a kink between them makes no difference: with the slope of the other side
/// the ground's velocity is off by its square.
const SAME_INSTANT: f64 = 1e-9;

/// Part of the times involved by which steps that are to meet a sample may miss it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// How a record is scaled, and when it comes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placement {
    /// Multiplies its accelerations.
    pub scale: f64,
    /// Multiplies its times.
    pub time_scale: f64,
    /// When its first sample comes, s after the start.
    pub start: f64,
}

impl Default for Placement {
    fn default() -> Placement {
        Placement { scale: 1.0, time_scale: 1.0, start: 0.0 }
    }
}

/// The numbers of a placement, with ranges.
pub const PLACEMENT: [Quantity<Placement>; 3] = [
    quantity!("record_scale", scale["1"] - 1e6, 1e6, "multiplies the record's accelerations"),
    quantity!("record_time_scale", time_scale["1"] 1e-6, 1e6, "multiplies the record's times"),
    quantity!("record_start", start["s"] - 1e9, 1e9, "when the record's first sample comes, counted from startTime"),
];

/// Seconds since a start: the exact sum of the steps, but for the last digit of its rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Elapsed {
    sum: f64,
    rounding: f64,
}

impl Elapsed {
    /// After another `step` (s).
    pub fn and(self, step: f64) -> Elapsed {
        let sum = (self.sum + step).min(f64::MAX);
        let part = sum - self.sum;
        Elapsed { sum, rounding: self.rounding + ((self.sum - (sum - part)) + (step - part)) }
    }

    /// In one number, s.
    pub fn seconds(self) -> f64 {
        self.sum + self.rounding
    }
}

/// A record as it acts.
#[derive(Clone, Copy, Debug)]
pub struct GroundMotion<'a> {
    /// The record.
    pub record: &'a Record,
    /// What its accelerations are given in, m/s²: 1, or g.
    pub unit: f64,
    /// The same of its vertical component.
    pub vertical_unit: f64,
    /// How it is scaled, and when it comes.
    pub placement: Placement,
}

/// A part of an interval over which the ground's accelerations are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stretch {
    /// From the start of the interval, s.
    start: f64,
    duration: f64,
    /// From the start of the stretch on.
    ground: LinearLoad,
}

impl GroundMotion<'_> {
    /// From its first to its last sample, s.
    pub fn duration(&self) -> f64 {
        self.time(self.record.times().len() - 1) - self.time(0)
    }

    /// Peak ground acceleration, m/s².
    pub fn pga(&self) -> f64 {
        self.record.pga() * self.unit * self.placement.scale.abs()
    }

    /// Largest vertical ground acceleration, m/s²; 0 where the ground moves horizontally alone.
    pub fn vertical_peak(&self) -> f64 {
        (0..self.record.times().len()).fold(0.0, |peak, i| peak.max(self.vertical(i).abs()))
    }

    /// The ground accelerations as they are given from `elapsed` on; 0 before the first sample and from the last one on.
    pub fn at(&self, elapsed: Elapsed) -> LinearLoad {
        self.ramp_from(self.reached(elapsed, |i| self.same_instant(i)), elapsed)
    }

    /// What it is for an integrator at `elapsed` that has dealt with all samples up to `dealt_with`: a later one that it has just
    /// arrived at is still to come, so that the ground acceleration is the one that led there.
    pub fn since(&self, dealt_with: Elapsed, elapsed: Elapsed) -> LinearLoad {
        let reached = |at: Elapsed| self.reached(at, |i| self.same_instant(i));
        let here = reached(elapsed);
        let passed = (0..here).rfind(|i| self.ahead(*i, elapsed) < -self.same_instant(*i)).map_or(0, |last| last + 1);
        self.ramp_from(reached(dealt_with).clamp(passed, here), elapsed)
    }

    /// `elapsed`, or that of the sample which a clock that is right to `resolution` (s) cannot tell from it.
    pub fn by_clock(&self, elapsed: Elapsed, resolution: f64) -> Elapsed {
        let next = self.reached(elapsed, |i| self.same_instant(i));
        let mut near = next.saturating_sub(1)..self.record.times().len().min(next + 1);
        let sample = near.find(|i| self.ahead(*i, elapsed).abs() <= resolution);
        sample.map_or(elapsed, |i| Elapsed::default().and(self.instant(i)))
    }

    /// The next instant after `elapsed` at which the ground acceleration jumps, by a first or last sample that is not 0, s
    /// after the start.
    pub fn next_jump(&self, elapsed: Elapsed) -> Option<f64> {
        let ends = [0, self.record.times().len() - 1].into_iter().filter(|i| self.is_moved(*i));
        self.first_ahead(ends, elapsed)
    }

    /// The instant of the next sample after `elapsed`, where the ground acceleration has a kink, s after the start.
    pub fn next_sample(&self, elapsed: Elapsed) -> Option<f64> {
        self.first_ahead(self.reached(elapsed, |i| self.same_instant(i))..self.record.times().len(), elapsed)
    }

    /// The instant of the first of `samples`, which follow each other, that is still to come. It is the sample's own,
    /// wherever `elapsed` is.
    fn first_ahead(&self, mut samples: impl Iterator<Item = usize>, elapsed: Elapsed) -> Option<f64> {
        samples.find(|i| self.ahead(*i, elapsed) > self.same_instant(*i)).map(|i| self.instant(i))
    }

    /// Advances `engine`, which is at `elapsed`, by `interval` (s) under the record and `load`, as one advance: the
    /// bound on its work is for all samples together, and if it fails the motion is as it was before.
    pub fn advance<W: Watch>(
        &self,
        engine: &mut Engine,
        elapsed: Elapsed,
        interval: f64,
        load: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        engine.check(interval, &load)?;
        let before = *engine.motion();
        let last_step = before.work.steps + MAX_STEPS_PER_ADVANCE;
        for Stretch { start, duration, ground } in self.stretches(elapsed, interval) {
            engine.set_time(before.time + start);
            match engine.advance_within(last_step, duration, load.from(start).on_ground(ground), watch) {
                Ok(Progress::Complete) => (),
                Ok(progress @ (Progress::Overturned | Progress::Transition)) => return Ok(progress),
                Err(mut error) => {
                    engine.set_motion(before);
                    if let AdvanceError::TooLong { until, .. } = &mut error {
                        *until = before.time + interval;
                    }
                    return Err(error);
                }
            }
        }
        engine.set_time(before.time + interval);
        Ok(Progress::Complete)
    }

    /// `interval` (s) from `elapsed` on, cut at the samples.
    fn stretches(&self, elapsed: Elapsed, interval: f64) -> impl Iterator<Item = Stretch> {
        let (this, samples) = (*self, self.record.times().len());
        let mut next = this.reached(elapsed, |i| this.uncut(i, elapsed));
        let mut ground = this.ramp_from(next, elapsed);
        let (mut start, mut is_first) = (0.0, true);
        std::iter::from_fn(move || {
            if start >= interval {
                return None;
            }
            let ahead = |i: usize| if i < samples { this.ahead(i, elapsed) } else { f64::INFINITY };
            let mut end = ahead(next);
            while end <= start {
                next += 1; // times that are the same once they are scaled
                (end, ground) = (ahead(next), this.ramp(next));
            }
            let is_close = || end >= interval - this.same_instant(next) && end >= interval - this.uncut(next, elapsed);
            let is_last = end >= interval || is_close();
            let duration = if is_last {
                interval - start
            } else if is_first {
                end
            } else {
                this.time(next) - this.time(next - 1)
            };
            let stretch = Stretch { start, duration, ground };
            start = if is_last { interval } else { end };
            next += usize::from(!is_last);
            (ground, is_first) = (this.ramp(next), false);
            Some(stretch)
        })
    }

    /// Time of sample `i` in the record, s.
    fn time(&self, i: usize) -> f64 {
        self.record.times()[i] * self.placement.time_scale
    }

    fn acceleration(&self, i: usize) -> f64 {
        self.record.acceleration()[i] * self.unit * self.placement.scale
    }

    /// Vertical acceleration of sample `i`, if there is any, m/s².
    fn vertical(&self, i: usize) -> f64 {
        self.record.vertical().map_or(0.0, |vertical| vertical[i] * self.vertical_unit * self.placement.scale)
    }

    /// Whether the ground accelerates at sample `i`.
    fn is_moved(&self, i: usize) -> bool {
        self.acceleration(i) != 0.0 || self.vertical(i) != 0.0
    }

    /// When sample `i` comes, s after the start.
    fn instant(&self, i: usize) -> f64 {
        self.placement.start + (self.time(i) - self.time(0))
    }

    /// Seconds from `elapsed` to sample `i`.
    fn ahead(&self, i: usize, elapsed: Elapsed) -> f64 {
        self.instant(i) - elapsed.sum - elapsed.rounding
    }

    /// How close to sample `i` an instant before it is not told from it, s.
    fn same_instant(&self, i: usize) -> f64 {
        let i = i.clamp(1, self.record.times().len() - 1);
        SAME_INSTANT * (self.time(i) - self.time(i - 1))
    }

    /// How close to sample `i` a step is not cut there, s: as long as its kink makes no difference, or it is met but for
    /// rounding. Where the ground jumps the latter alone counts.
    fn uncut(&self, i: usize, elapsed: Elapsed) -> f64 {
        let samples = self.record.times().len();
        let beyond = |end: usize| if self.is_moved(end) { 0.0 } else { f64::INFINITY };
        let before = if i == 0 { beyond(0) } else { self.time(i) - self.time(i - 1) };
        let after = if i + 1 == samples { beyond(i) } else { self.time(i + 1) - self.time(i) };
        (SAME_INSTANT * before.min(after)).max(self.rounding(i, elapsed))
    }

    /// By how much steps may miss sample `i` for rounding alone, s.
    fn rounding(&self, i: usize, elapsed: Elapsed) -> f64 {
        let times = [elapsed.sum, self.placement.start, self.time(i), self.time(0)];
        let most = times.into_iter().fold(0.0, |most: f64, time| most.max(time.abs()));
        (ROUNDING * most).min(self.same_instant(i))
    }

    /// How many samples have come, with those that are no farther ahead than `near`, s, of each.
    fn reached(&self, elapsed: Elapsed, near: impl Fn(usize) -> f64) -> usize {
        let times = self.record.times();
        let time = (elapsed.sum - self.placement.start + elapsed.rounding) + self.time(0);
        let reached = times.partition_point(|of_sample| of_sample * self.placement.time_scale <= time);
        let is_next_here = reached < times.len() && self.ahead(reached, elapsed) <= near(reached);
        reached + usize::from(is_next_here)
    }

    /// The ground accelerations from the last of `reached` samples to the next.
    #[inline(always)]
    pub(super) fn ramp(&self, reached: usize) -> LinearLoad {
        if reached == 0 || reached >= self.record.times().len() {
            return LinearLoad::default();
        }
        let last = reached - 1;
        let step = self.time(reached) - self.time(last);
        let ground: LinearLoad = Ramp::between(self.acceleration(last), self.acceleration(reached), step).into();
        if self.record.vertical().is_none() {
            return ground;
        }
        ground.and_upwards(Ramp::between(self.vertical(last), self.vertical(reached), step))
    }

    /// The ground accelerations from the last of `reached` samples to the next, as they are given from `elapsed` on.
    fn ramp_from(&self, reached: usize, elapsed: Elapsed) -> LinearLoad {
        let ramp = self.ramp(reached);
        let Some(last) = reached.checked_sub(1) else { return ramp };
        let passed = -self.ahead(last, elapsed);
        if passed.abs() <= self.rounding(last, elapsed) { ramp } else { ramp.from(passed) }
    }
}

impl<'a> From<&'a Record> for GroundMotion<'a> {
    fn from(record: &'a Record) -> GroundMotion<'a> {
        GroundMotion { record, unit: 1.0, vertical_unit: 1.0, placement: Placement::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Detail, Parameters, State, Structure};

    fn after(steps: impl IntoIterator<Item = f64>) -> Elapsed {
        steps.into_iter().fold(Elapsed::default(), Elapsed::and)
    }

    fn record(times: &[f64], acceleration: &[f64]) -> Record {
        Record::from_samples("", times.into(), acceleration.into()).unwrap()
    }

    #[test]
    fn a_sum_of_steps_keeps_what_rounding_takes() {
        let elapsed = after((0..1_000_000).map(|_| 0.01));
        assert_eq!(elapsed.sum + elapsed.rounding, 1e6 * 0.01);
        assert!((elapsed.sum - 1e4).abs() > 1e-9, "there was nothing to compensate");
    }

    #[test]
    fn an_interval_is_cut_at_the_samples() {
        let record = record(&[1.0, 1.5, 2.5], &[2.0, 4.0, -4.0]);
        let stretches = |placement, from: f64, interval| {
            let ground = GroundMotion { placement, unit: 10.0, ..GroundMotion::from(&record) };
            ground.stretches(after([from]), interval).collect::<Vec<_>>()
        };
        let stretch = |start, duration, value, slope| {
            let ground = Ramp { value, slope }.into();
            Stretch { start, duration, ground }
        };
        let as_it_is = Placement::default();
        let all = [stretch(0.0, 0.5, 20.0, 40.0), stretch(0.5, 1.0, 40.0, -80.0), stretch(1.5, 0.5, 0.0, 0.0)];
        assert_eq!(stretches(as_it_is, 0.0, 2.0), all);
        assert_eq!(stretches(as_it_is, 0.0, 1.5), all[..2]);
        assert_eq!(stretches(as_it_is, 0.25, 0.125), [stretch(0.0, 0.125, 30.0, 40.0)]);
        assert_eq!(stretches(as_it_is, 0.25, 0.5), [stretch(0.0, 0.25, 30.0, 40.0), stretch(0.25, 0.25, 40.0, -80.0)]);
        assert_eq!(stretches(as_it_is, 7.0, 1.0), [stretch(0.0, 1.0, 0.0, 0.0)]);
        let late = Placement { scale: -0.5, time_scale: 2.0, start: 3.0 };
        assert_eq!(
            stretches(late, 1.0, 4.0),
            [stretch(0.0, 2.0, 0.0, 0.0), stretch(2.0, 1.0, -10.0, -10.0), stretch(3.0, 1.0, -20.0, 20.0)]
        );
        let early = Placement { start: -1.0, ..as_it_is };
        assert_eq!(stretches(early, 0.0, 0.25), [stretch(0.0, 0.25, 0.0, -80.0)]);
    }

    #[test]
    fn samples_that_scaling_makes_one_are_passed() {
        let record = record(&[0.0, 5e-324, 1e-323, 1.0], &[1.0, 2.0, 3.0, 4.0]);
        let placement = Placement { time_scale: 0.25, ..Placement::default() };
        let ground = GroundMotion { placement, ..GroundMotion::from(&record) };
        let stretches: Vec<_> = ground.stretches(Elapsed::default(), 1.0).collect();
        let ground = Ramp { value: 3.0, slope: 4.0 }.into();
        let rest = Stretch { start: 0.25, duration: 0.75, ground: LinearLoad::default() };
        assert_eq!(stretches, [Stretch { start: 0.0, duration: 0.25, ground }, rest]);
    }

    /// A host's steps add up to the record's times but for rounding: each is then one stretch, whatever the start.
    #[test]
    fn steps_of_the_records_own_are_not_cut() {
        let times: Vec<_> = (0..5000).map(|i| f64::from(i) * 0.01).collect();
        let record = record(&times, &times);
        for start in [0.0, 0.03, 1234.56] {
            let ground =
                GroundMotion { placement: Placement { start, ..Placement::default() }, ..GroundMotion::from(&record) };
            let mut elapsed = Elapsed::default().and(start);
            for i in 0..4999 {
                let stretches: Vec<_> = ground.stretches(elapsed, 0.01).collect();
                let [Stretch { start: 0.0, duration: 0.01, ground: here }] = stretches[..] else {
                    panic!("{i}: {stretches:?}")
                };
                assert_eq!(here, ground.ramp(i + 1), "sample {i} from {start} s");
                elapsed = elapsed.and(0.01);
            }
            assert_eq!(ground.at(elapsed), LinearLoad::default());
        }
    }

    /// Steps that end a little before a sample, or after it, move nothing: neither a kink, nor a jump, nor what is as steep as a
    /// jump beside the time before it. The motion is that of steps that end at the samples, at the same instant.
    #[test]
    fn steps_that_miss_the_samples_by_little_shift_nothing() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let shaken: Vec<_> = (0..=200).map(|i| 3.0 * f64::from(i * i % 17) - 20.0).collect();
        let even: Vec<_> = (0..=200).map(|i| f64::from(i) * 0.01).collect();
        let steep = [vec![0.0; 100], vec![5.0; 101]].concat();
        let uneven: Vec<_> = even.iter().map(|t| if *t < 0.995 { *t } else { t - 0.01 + 1e-13 }).collect();
        for record in [record(&even, &shaken), record(&uneven, &steep)] {
            let ground = GroundMotion::from(&record);
            let after = |miss: f64| {
                let mut engine =
                    Engine::with_detail(structure, State::default(), 0.0, 1e-9, Detail::FixedBase).unwrap();
                let mut elapsed = Elapsed::default();
                let first = record.times()[1] + miss;
                for step in std::iter::once(first).chain((1..210).map(|_| 0.01)).chain([0.01 - miss]) {
                    ground.advance(&mut engine, elapsed, step, LinearLoad::default(), &mut ()).unwrap();
                    elapsed = elapsed.and(step);
                }
                engine.motion().state
            };
            let met = after(0.0);
            for miss in [-9e-12, 9e-12, -1e-13, 1e-13] {
                let State { u, u_dot, .. } = after(miss);
                let (off, off_dot) = ((u - met.u).abs(), (u_dot - met.u_dot).abs());
                assert!(off < 1e-15 && off_dot < 3e-14, "{miss}: {off:e}, {off_dot:e}");
            }
        }
    }

    /// The bound on the work of a step holds for all samples within it, and a step that is refused changes nothing.
    #[test]
    fn one_bound_holds_for_all_samples() {
        let samples = MAX_STEPS_PER_ADVANCE as usize + 2;
        let times: Vec<_> = (0..samples).map(|i| i as f64 * 1e-3).collect();
        let record = Record::from_samples("", times, vec![1e-3; samples]).unwrap();
        let ground = GroundMotion::from(&record);
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let mut engine = Engine::new(structure, State::default(), 5.0, 1e-9).unwrap();
        let before = *engine.motion();
        let mut advance = |interval| {
            let done = ground.advance(&mut engine, Elapsed::default(), interval, LinearLoad::default(), &mut ());
            (done, *engine.motion())
        };
        let (refused, motion) = advance(ground.duration());
        let until = 5.0 + ground.duration();
        assert!(matches!(refused, Err(AdvanceError::TooLong { until: told, .. }) if told == until), "{refused:?}");
        assert_eq!(motion, before);
        for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(advance(none).0, Err(AdvanceError::NotAhead { .. })), "{none}");
        }
        let (done, motion) = advance(1.0);
        assert_eq!((done, motion.time, motion.work.steps), (Ok(Progress::Complete), 6.0, 1000));
    }
}
