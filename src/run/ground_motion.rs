//! A ground motion followed from sample to sample, however time is cut into steps.
//!
//! The time elapsed since the start tells where a step is in the record. This time is a compensated sum of the steps and not
//! a clock, so that the same steps give the same bits at every start time. A host whose steps are those of the record meets
//! the samples only up to rounding. A step that ends as close to a sample as that is not cut there.

use crate::engine::{AdvanceError, MAX_STEPS_PER_ADVANCE};
use crate::mechanics::lateral::Coordinates;
use crate::run::record::Record;
use crate::structure::quantity::{Quantity, quantity};
use crate::{Engine, LinearLoad, Progress, Ramp, Watch};
use serde::{Deserialize, Serialize};

/// Part of the time between two samples over which a kink makes no difference. The slope of the other side changes the ground
/// velocity by the square of this part.
const SAME_INSTANT: f64 = 1e-9;

/// Part of the times involved by which rounding may take the end of a step away from a sample.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The scales of a record, and the instant of its first sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placement {
    /// Factor of the accelerations.
    pub scale: f64,
    /// Factor of the times.
    pub time_scale: f64,
    /// Instant of the first sample, s after the start.
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
    quantity!("record_start", start["s"] - 1e9, 1e9, "time of the record's first sample, counted from startTime"),
];

/// Seconds since a start: the exact sum of the steps, except for the last digit of its rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Elapsed {
    sum: f64,
    rounding: f64,
    /// The number of samples that had come after the last advance: the search for the present number begins here.
    reached: u32,
}

impl Elapsed {
    /// The time after another `step` (s).
    pub fn and(self, step: f64) -> Elapsed {
        let sum = (self.sum + step).clamp(-f64::MAX, f64::MAX); // unlike `min`, it keeps NaN
        let part = sum - self.sum;
        Elapsed { sum, rounding: self.rounding + ((self.sum - (sum - part)) + (step - part)), ..self }
    }

    /// The time in one number, s.
    pub fn seconds(self) -> f64 {
        self.sum + self.rounding
    }
}

/// A record that begins some time after a start. The ground rests before the first sample and after the last one.
#[derive(Clone, Copy, Debug)]
pub struct GroundMotion<'a> {
    /// The record.
    pub record: &'a Record,
    /// Instant of the first sample, s after the start.
    pub start: f64,
}

/// A part of an interval over which the ground accelerations are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Start of the segment, s after the start of the interval.
    pub since: f64,
    /// Duration, s.
    pub duration: f64,
    /// End of the segment by the times of the record, s.
    pub until: f64,
    /// Ground accelerations, and the force on the top floor, from the start of the segment on.
    pub ground: LinearLoad,
}

impl<'a> GroundMotion<'a> {
    /// The ground accelerations from `elapsed` on, until the next sample.
    pub fn at(&self, elapsed: Elapsed) -> LinearLoad {
        self.ramp_from(self.reached(elapsed, |i| self.same_instant(i)), elapsed)
    }

    /// The ground accelerations for an integrator at `elapsed` that has dealt with all samples up to `dealt_with`. A later
    /// sample at which the integrator has just arrived is still to come: the accelerations are those that lead to the sample.
    pub fn since(&self, dealt_with: Elapsed, elapsed: Elapsed) -> LinearLoad {
        let reached = |at: Elapsed| self.reached(at, |i| self.same_instant(i));
        let here = reached(elapsed);
        let passed = (0..here).rfind(|i| self.ahead(*i, elapsed) < -self.same_instant(*i)).map_or(0, |last| last + 1);
        self.ramp_from(reached(dealt_with).clamp(passed, here), elapsed)
    }

    /// `elapsed`, or the time of a sample if a clock that is right to `resolution` (s) cannot tell the two apart.
    pub fn by_clock(&self, elapsed: Elapsed, resolution: f64) -> Elapsed {
        let next = self.reached(elapsed, |i| self.same_instant(i));
        let mut near = next.saturating_sub(1)..self.record.times().len().min(next + 1);
        let sample = near.find(|i| self.ahead(*i, elapsed).abs() <= resolution);
        sample.map_or(elapsed, |i| Elapsed::default().and(self.instant(i)))
    }

    /// The next instant after `elapsed` at which the ground acceleration or the force jumps, s after the start.
    pub fn next_jump(&self, elapsed: Elapsed) -> Option<f64> {
        let ends = self.components().flat_map(|of| [0, of.len() - 1]).filter(|i| self.jumps(*i));
        ends.filter_map(|i| self.first_ahead([i].into_iter(), elapsed)).reduce(f64::min)
    }

    /// The instant of the next sample after `elapsed`, where the ground acceleration has a kink, s after the start.
    pub fn next_sample(&self, elapsed: Elapsed) -> Option<f64> {
        self.first_ahead(self.reached(elapsed, |i| self.same_instant(i))..self.record.times().len(), elapsed)
    }

    /// The instant of the first of `samples`, which follow each other, that is still to come after `elapsed`.
    fn first_ahead(&self, mut samples: impl Iterator<Item = usize>, elapsed: Elapsed) -> Option<f64> {
        samples.find(|i| self.ahead(*i, elapsed) > self.same_instant(*i)).map(|i| self.instant(i))
    }

    /// Advances `engine` and `elapsed` by `interval` (s), or to a transition that ends the advance, under the accelerations of the record,
    /// not its force, and `load`. One bound on the work holds for all samples together. If the advance fails, nothing has changed.
    pub fn advance<Q: Coordinates, W: Watch<Q>>(
        &self,
        engine: &mut Engine<Q>,
        elapsed: &mut Elapsed,
        interval: f64,
        load: LinearLoad<Q>,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        engine.check(interval, &load)?;
        let before = *engine.motion();
        let last_step = before.work.steps + MAX_STEPS_PER_ADVANCE;
        let clock = before.time - self.time(*elapsed);
        let mut segments = self.segments(*elapsed, interval);
        let (mut passed, mut progress) = (interval, Progress::Complete);
        for Segment { since, duration, until, ground } in &mut segments {
            match engine.advance_within(last_step, duration, load.from(since).on_ground(ground), watch) {
                Ok(Progress::Complete) => engine.set_time(clock + until),
                Ok(ended) => {
                    (passed, progress) = (engine.motion().time - before.time, ended);
                    break;
                }
                Err(mut error) => {
                    engine.set_motion(before);
                    if let AdvanceError::TooLong { until, .. } = &mut error {
                        *until = before.time + interval;
                    }
                    return Err(error);
                }
            }
        }
        if progress == Progress::Complete {
            engine.set_time(before.time + interval);
        }
        *elapsed = Elapsed { reached: segments.next as u32, ..elapsed.and(passed) };
        Ok(progress)
    }

    /// The segments of `interval` (s) from `elapsed` on.
    pub fn segments(&self, elapsed: Elapsed, interval: f64) -> Segments<'a> {
        let mut next = self.reached(elapsed, |i| self.uncut(i, elapsed));
        while self.ahead(next, elapsed) <= 0.0 {
            next += 1; // a late clock has one instant for several samples
        }
        Segments { motion: *self, elapsed, interval, first: self.ramp_from(next, elapsed), since: 0.0, next, last: 0 }
    }

    /// The time of the record at `elapsed`, s.
    fn time(&self, elapsed: Elapsed) -> f64 {
        (elapsed.sum - self.start + elapsed.rounding) + self.record.start()
    }

    /// Accelerations and force, each of which may end before the record.
    fn components(&self) -> impl Iterator<Item = &'a [f64]> {
        [Some(self.record.acceleration()), self.record.vertical(), self.record.force()].into_iter().flatten()
    }

    /// Whether an acceleration or the force jumps at sample `i`: its first or last sample, and not 0.
    fn jumps(&self, i: usize) -> bool {
        self.components().any(|of| (i == 0 || i + 1 == of.len()) && of[i] != 0.0)
    }

    /// Instant of sample `i`, s after the start.
    fn instant(&self, i: usize) -> f64 {
        self.start + (self.record.times()[i] - self.record.start())
    }

    /// Seconds from `elapsed` to sample `i`; ∞ after the last sample.
    fn ahead(&self, i: usize, elapsed: Elapsed) -> f64 {
        if i < self.record.times().len() { self.instant(i) - elapsed.sum - elapsed.rounding } else { f64::INFINITY }
    }

    /// The time before sample `i` that counts as the sample's own instant, s.
    #[inline]
    fn same_instant(&self, i: usize) -> f64 {
        let times = self.record.times();
        let i = i.max(1).min(times.len() - 1); // several times at each step: without the check of `clamp`
        SAME_INSTANT * (times[i] - times[i - 1])
    }

    /// The distance from sample `i`, s, within which the end of a step counts as the sample: the kink makes no difference, or
    /// rounding alone misses the sample. Only rounding counts if the ground acceleration jumps.
    #[inline]
    fn uncut(&self, i: usize, elapsed: Elapsed) -> f64 {
        let times = self.record.times();
        let before = if i == 0 { f64::INFINITY } else { times[i] - times[i - 1] };
        let after = if i + 1 == times.len() { f64::INFINITY } else { times[i + 1] - times[i] };
        let kink = if self.jumps(i) { 0.0 } else { SAME_INSTANT * before.min(after) };
        kink.max(self.rounding(i, elapsed))
    }

    /// The time by which rounding alone may miss sample `i`, s.
    #[inline]
    fn rounding(&self, i: usize, elapsed: Elapsed) -> f64 {
        let times = [elapsed.sum, self.start, self.record.times()[i], self.record.start()];
        let most = times.into_iter().fold(0.0, |most: f64, time| most.max(time.abs()));
        (ROUNDING * most).min(self.same_instant(i))
    }

    /// The number of samples that have come at `elapsed`. A sample that is no farther ahead than `near` (s) has come.
    fn reached(&self, elapsed: Elapsed, near: impl Fn(usize) -> f64) -> usize {
        let (times, time) = (self.record.times(), self.time(elapsed));
        let is_so = |reached: usize| {
            (reached == 0 || times[reached - 1] <= time) && times.get(reached).is_none_or(|next| *next > time)
        };
        let last = (elapsed.reached as usize).min(times.len());
        let known = [last, (last + 1).min(times.len())].into_iter().find(|reached| is_so(*reached));
        let reached = known.unwrap_or_else(|| times.partition_point(|of_sample| *of_sample <= time));
        let is_next_here = reached < times.len() && self.ahead(reached, elapsed) <= near(reached);
        reached + usize::from(is_next_here)
    }

    /// The ground accelerations and the force from the last of `reached` samples to the next.
    #[inline(always)]
    pub(super) fn ramp(&self, reached: usize) -> LinearLoad {
        let (times, record) = (self.record.times(), self.record);
        if reached == 0 || reached >= times.len() {
            return LinearLoad::default();
        }
        let last = reached - 1;
        let step = times[reached] - times[last];
        let ramp = |of: &[f64]| of.get(reached).map_or(Ramp::default(), |next| Ramp::between(of[last], *next, step));
        let ground: LinearLoad = ramp(record.acceleration()).into();
        match (record.force(), record.vertical()) {
            (None, None) => ground,
            others => ground.and(others.0.map(ramp).unwrap_or_default(), others.1.map(ramp).unwrap_or_default()),
        }
    }

    /// The ground accelerations from the last of `reached` samples to the next, as they are given from `elapsed` on.
    fn ramp_from(&self, reached: usize, elapsed: Elapsed) -> LinearLoad {
        let ramp = self.ramp(reached);
        let Some(last) = reached.checked_sub(1) else { return ramp };
        let passed = -self.ahead(last, elapsed);
        if passed.abs() <= self.rounding(last, elapsed) { ramp } else { ramp.from(passed) }
    }
}

impl Record {
    /// The ground motion segment by segment, over `duration` (s) from the first sample on. After the last sample the ground rests.
    pub fn segments(&self, duration: f64) -> Segments<'_> {
        GroundMotion::from(self).segments(Elapsed::default(), duration)
    }
}

impl<'a> From<&'a Record> for GroundMotion<'a> {
    fn from(record: &'a Record) -> GroundMotion<'a> {
        GroundMotion { record, start: 0.0 }
    }
}

/// The segments of an interval, one after the other ([`GroundMotion::segments`]).
#[derive(Clone, Debug)]
pub struct Segments<'a> {
    pub(super) motion: GroundMotion<'a>,
    /// Start of the interval.
    elapsed: Elapsed,
    /// Duration of the interval, s.
    interval: f64,
    /// Ground accelerations at the start of the interval.
    first: LinearLoad,
    /// Latest known end of a segment, s after the start of the interval.
    since: f64,
    /// The sample that ends the next segment.
    pub(super) next: usize,
    /// The last sample within the interval, once a segment has ended before the end of the interval.
    pub(super) last: usize,
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    #[inline(always)] // for each sample of a run
    fn next(&mut self) -> Option<Segment> {
        let &mut Segments { motion, elapsed, next, last, .. } = self;
        if next >= last {
            return self.first_or_last();
        }
        self.next = next + 1;
        let times = motion.record.times();
        let (since, duration) = (motion.ahead(next - 1, elapsed), times[next] - times[next - 1]);
        Some(Segment { since, duration, until: times[next], ground: motion.ramp(next) })
    }
}

impl<'a> Segments<'a> {
    /// The first segment of the interval, or a segment after which no whole one comes.
    #[cold]
    fn first_or_last(&mut self) -> Option<Segment> {
        let &mut Segments { motion, elapsed, interval, next, .. } = self;
        let times = motion.record.times();
        let is_first = self.since == 0.0;
        let reached = next.checked_sub(1).map_or(0.0, |last| motion.ahead(last, elapsed));
        let since = if is_first { 0.0 } else { self.since.max(reached) };
        if since >= interval || interval.is_nan() {
            return None;
        }
        let ground = if is_first { self.first } else { motion.ramp(next) };
        let end = motion.ahead(next, elapsed);
        let is_close = || end >= interval - motion.same_instant(next) && end >= interval - motion.uncut(next, elapsed);
        if end > interval || end < interval && is_close() {
            self.since = interval;
            let until = motion.time(elapsed) + interval;
            return Some(Segment { since, duration: interval - since, until, ground });
        }
        if end < interval && is_first {
            self.last = motion.reached(elapsed.and(interval), |_| 0.0).saturating_sub(1);
        }
        (self.since, self.next) = (end, next + 1);
        let duration = if is_first { end } else { times[next] - times[next - 1] };
        Some(Segment { since, duration, until: times[next], ground })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Settings;
    use crate::{Detail, OneMass, Parameters, State};

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
        assert!(after([f64::NAN]).sum.is_nan());
    }

    #[test]
    fn an_interval_is_cut_at_the_samples() {
        let record = record(&[1.0, 1.5, 2.5], &[20.0, 40.0, -40.0]);
        let segments = |start: f64, from: f64, interval| {
            let segments = GroundMotion { record: &record, start }.segments(after([from]), interval);
            segments.map(|of| (of.since, of.duration, of.until, of.ground)).collect::<Vec<_>>()
        };
        let ramp = |value, slope| -> LinearLoad { Ramp { value, slope }.into() };
        let (first, second, rest) = (ramp(20.0, 40.0), ramp(40.0, -80.0), ramp(0.0, 0.0));
        let all = [(0.0, 0.5, 1.5, first), (0.5, 1.0, 2.5, second), (1.5, 0.5, 3.0, rest)];
        assert_eq!(segments(0.0, 0.0, 2.0), all);
        assert_eq!(segments(0.0, 0.0, 1.5), all[..2]);
        let beside = 0.5 + 1e-10; // a sliver is not cut off
        assert_eq!(segments(0.0, 0.0, beside), [(0.0, beside, 1.0 + beside, first)]);
        assert_eq!(segments(0.0, 0.25, 0.125), [(0.0, 0.125, 1.375, ramp(30.0, 40.0))]);
        let cut = [(0.0, 0.25, 1.5, ramp(30.0, 40.0)), (0.25, 0.25, 1.75, second)];
        assert_eq!(segments(0.0, 0.25, 0.5), cut);
        assert_eq!(segments(0.0, 7.0, 1.0), [(0.0, 1.0, 9.0, rest)]);
        assert_eq!(segments(3.0, 1.0, 2.25), [(0.0, 2.0, 1.0, rest), (2.0, 0.25, 1.25, first)]);
        assert_eq!(segments(3.0, 0.0, 1.0), [(0.0, 1.0, -1.0, rest)]); // its first sample comes later
        assert_eq!(segments(-1.0, 0.0, 0.25), [(0.0, 0.25, 2.25, ramp(0.0, -80.0))]);
        assert_eq!((segments(0.0, 0.0, f64::NAN), segments(0.0, 0.0, 0.0)), (vec![], vec![]));
    }

    #[test]
    fn samples_at_one_instant_of_a_late_clock_are_passed() {
        let record = record(&[0.0, 1e-8, 2e-8, 1.0], &[1.0, 2.0, 3.0, 4.0]);
        let ground = GroundMotion { record: &record, start: 1e9 };
        let segments: Vec<_> = ground.segments(after([1e9]), 2.0).collect();
        let durations = segments.iter().map(|segment| segment.duration).collect::<Vec<_>>();
        assert_eq!(durations, [1.0, 1.0]);
    }

    /// The steps of a host add up to the times of the record up to rounding. Each step is one segment, whatever the start.
    #[test]
    fn steps_of_the_records_own_are_not_cut() {
        let times: Vec<_> = (0..5000).map(|i| f64::from(i) * 0.01).collect();
        let record = record(&times, &times);
        for start in [0.0, 0.03, 1234.56] {
            let ground = GroundMotion { record: &record, start };
            let mut elapsed = Elapsed::default().and(start);
            for i in 0..4999 {
                let segments: Vec<_> = ground.segments(elapsed, 0.01).collect();
                let [Segment { since: 0.0, duration: 0.01, ground: here, .. }] = segments[..] else {
                    panic!("{i}: {segments:?}")
                };
                assert_eq!(here, ground.ramp(i + 1), "sample {i} from {start} s");
                elapsed = elapsed.and(0.01);
            }
            assert_eq!(ground.at(elapsed), LinearLoad::default());
        }
    }

    /// Steps that end a little before or after a sample shift nothing: neither a kink, nor a jump, nor a slope as steep as a jump.
    /// The motion is the same as with steps that end at the samples.
    #[test]
    fn steps_that_miss_the_samples_by_little_shift_nothing() {
        let structure = OneMass::new(Parameters::MCMANUS).unwrap();
        let shaken: Vec<_> = (0..=200).map(|i| 3.0 * f64::from(i * i % 17) - 20.0).collect();
        let even: Vec<_> = (0..=200).map(|i| f64::from(i) * 0.01).collect();
        let steep = [vec![0.0; 100], vec![5.0; 101]].concat();
        let uneven: Vec<_> = even.iter().map(|t| if *t < 0.995 { *t } else { t - 0.01 + 1e-13 }).collect();
        let longer = record(&[0.0, 2.05], &[0.0, 1.0]);
        let ends_first = record(&even, &shaken).with_vertical(&longer).unwrap();
        for record in [record(&even, &shaken), record(&uneven, &steep), ends_first] {
            let ground = GroundMotion::from(&record);
            let end = record.times()[record.acceleration().len() - 1];
            assert_eq!(ground.next_jump(after([1.5])), Some(end));
            let after = |miss: f64| {
                let vertical = record.vertical().is_some();
                let settings = Settings { detail: Detail::FixedBase, vertical, ..Settings::default() };
                let mut engine = Engine::with(structure, State::default(), 0.0, settings).unwrap();
                let mut elapsed = Elapsed::default();
                let first = record.times()[1] + miss;
                for step in std::iter::once(first).chain((1..210).map(|_| 0.01)).chain([0.01 - miss]) {
                    ground.advance(&mut engine, &mut elapsed, step, LinearLoad::default(), &mut ()).unwrap();
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

    /// The bound on the work of a step holds for all samples within the step, and a refused step changes nothing.
    #[test]
    fn one_bound_holds_for_all_samples() {
        let samples = MAX_STEPS_PER_ADVANCE as usize + 2;
        let times: Vec<_> = (0..samples).map(|i| i as f64 * 1e-3).collect();
        let record = Record::from_samples("", times, vec![1e-3; samples]).unwrap();
        let ground = GroundMotion::from(&record);
        let structure = OneMass::new(Parameters::EVISON).unwrap();
        let mut engine = Engine::new(structure, State::default(), 5.0, 1e-9).unwrap();
        let before = *engine.motion();
        let mut advance = |interval| {
            let done = ground.advance(&mut engine, &mut Elapsed::default(), interval, LinearLoad::default(), &mut ());
            (done, *engine.motion())
        };
        let (refused, motion) = advance(record.end());
        let until = 5.0 + record.end();
        assert!(matches!(refused, Err(AdvanceError::TooLong { until: told, .. }) if told == until), "{refused:?}");
        assert_eq!(motion, before);
        for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(advance(none).0, Err(AdvanceError::Refused(_))), "{none}");
        }
        let (done, motion) = advance(1.0);
        assert_eq!((done, motion.time, motion.work.steps), (Ok(Progress::Complete), 6.0, 1000));
    }
}
