//! Leaps in full contact of several runs, from sample to sample. The operations on the numbers of a run are those of its level, in the
//! same order.

use super::number::{Answers, Lanes, MOST, PerRun, load, put};
use super::rocking::{SegmentEnds, by_equations_5_and_6};
use super::sought::{Bend, MOST_MODES, Passes, Sought, StepOfRuns, Turned};
use crate::engine::Engine;
use crate::levels::Elastic;
use crate::levels::full_contact::ExactContact;
use crate::levels::level::{Level, off_chord};
use crate::levels::modes::ManyModes;
use crate::levels::oscillator::{Flow, Oscillator};
use crate::levels::start::Start;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::Dissipators;
use crate::numbers::Real;
use crate::series::taylor::LONGEST_SPAN;
use crate::{Mode, Ramp, State};
use pulp::{Simd, WithSimd};
use std::any::Any;
use std::slice::from_ref;

/// How leaps in full contact are found: while Σ |M_j| |u_j| stays below `hold`, the M_j the moments of the modes for a unit of u, or
/// while |Σ M_j u_j| certainly does.
pub(super) struct Leaping<'a> {
    modes: &'a [ExactContact],
    moment: fn(&Mode) -> f64,
    hold: f64,
}

/// How leaps of this `level` with these `dissipators` are found, if they are found like this.
pub(super) fn leaping<'a, Q: Coordinates>(level: &'a dyn Level<Q>, dissipators: &Dissipators) -> Option<Leaping<'a>> {
    if let Some(Elastic { one, contact, .. }) = by_equations_5_and_6(level) {
        return Some(Leaping { modes: from_ref(contact.as_ref()?), moment: |_| 1.0, hold: one.u_cr });
    }
    let of: &ManyModes<Q> = (level as &dyn Any).downcast_ref()?;
    let (structure, modes) = (level.structure(), of.contact.as_ref()?);
    let has_rest = of.rigid.is_some() || of.base.S_res != 0.0 || structure.gauges().has_feedthrough;
    let hold = level.liftable()?.least_hold(&Start::<Q> { dissipators, ..Start::default() });
    let moment = |mode: &Mode| mode.height * mode.stiffness;
    (!has_rest && structure.foundation().is_none()).then_some(Leaping { modes, moment, hold })
}

/// How many leaps are looked at to find the two durations of most of them.
const LOOKED_AHEAD: usize = 4;

/// Leaps in full contact of several runs, from sample to sample.
#[derive(Debug, Default)]
#[repr(align(64))]
pub(crate) struct ContactLeaps<'a, Q> {
    sought: Sought<Q>,
    samples: [SegmentEnds<'a>; MOST],
    entered: [usize; MOST],
    /// 1 where there is a run.
    is_there: PerRun,
    /// The modes of the run that is there, or was there last.
    exact: [Vec<ExactContact>; MOST],
    /// A state of the run that is there, for the count of its modes.
    state: [State<Q>; MOST],
    modes: Vec<ModeOfRuns>,
    /// The moment that holds the base down, in the unit of the moments of the modes.
    hold: PerRun,
    /// The longest leap that may be put off, s: a watcher looks at a longer one piece by piece.
    longest: PerRun,
    age: PerRun,
    /// Two durations (s), which each mode has the [`Flow`] over, and which of them is the newer one. Between two powers of 2 the times
    /// i dt of a record differ by one of two numbers.
    durations: [PerRun; 2],
    newer: [usize; MOST],
    /// The time of a sample and the ground acceleration there. A sample is written number by number a leap before it is read as rows,
    /// since the processor would otherwise wait for the numbers.
    ends: [[PerRun; 2]; 2],
    /// 1 where the last leap has been taken.
    is_taken: PerRun,
}

/// A mode of each run in full contact. A run with fewer modes has modes without motion.
#[derive(Debug, Default)]
#[repr(align(64))]
struct ModeOfRuns {
    /// ω, ζ, the part of the ground acceleration that the mode feels, and the moment on the base for a unit of u.
    numbers: [PerRun; 4],
    motion: [PerRun; 2],
    flows: [[PerRun; 6]; 2],
}

impl<'a, Q: Coordinates> ContactLeaps<'a, Q> {
    /// Puts the run of `engine`, which has come to these samples, into `lane`.
    pub(crate) fn enter<W: Passes<Q>>(&mut self, lane: usize, engine: &Engine<Q>, samples: SegmentEnds<'a>, watch: &W) {
        let (structure, motion) = (engine.structure(), engine.motion());
        watch.seek(engine, lane, &mut self.sought);
        (self.samples[lane], self.entered[lane], self.is_there[lane]) = (samples, samples.next, 1.0);
        (self.state[lane], self.age[lane]) = (motion.state, motion.chatter.age);
        let Leaping { modes, moment, hold } = leaping(&*engine.level, &motion.dissipators).expect("it may leap");
        (self.hold[lane], self.longest[lane]) = (hold, LONGEST_SPAN / structure.vibration().rocking[1]);
        let of = |exact: &ExactContact| exact.oscillator;
        let is_other = !self.exact[lane].iter().map(of).eq(modes.iter().map(of));
        if is_other {
            self.durations.iter_mut().for_each(|duration| duration[lane] = 0.0);
            self.exact[lane] = modes.to_vec();
            self.modes.resize_with(self.modes.len().max(modes.len()), ModeOfRuns::default);
        }
        for (j, mode) in self.modes.iter_mut().enumerate() {
            let (numbers, motion) = match structure.modes().get(j).zip(modes.get(j)) {
                Some((of, ExactContact { oscillator: Oscillator { omega, zeta, .. }, .. })) => {
                    ([*omega, *zeta, of.part(1.0), moment(of)], [motion.state.u.of(j), motion.state.u_dot.of(j)])
                }
                None => ([1.0, 0.0, 0.0, 0.0], [0.0; 2]),
            };
            put(&mut mode.numbers, lane, numbers);
            put(&mut mode.motion, lane, motion);
        }
        self.prepare(lane);
    }

    /// Keeps the flows of the next leaps of the run in `lane`.
    #[inline]
    fn prepare(&mut self, lane: usize) {
        let SegmentEnds { times, next, last, .. } = self.samples[lane];
        for ends in times[next - 1..last.min(next + LOOKED_AHEAD)].windows(2).rev() {
            let duration = ends[1] - ends[0];
            if self.durations.iter().all(|kept| kept[lane] != duration) {
                self.newer[lane] = 1 - self.newer[lane];
                let newer = self.newer[lane];
                self.durations[newer][lane] = duration;
                for (mode, exact) in self.modes.iter_mut().zip(&self.exact[lane]) {
                    let Flow { free: [m11, m12, m21, m22], step, ramp } = *exact.flow(duration);
                    put(&mut mode.flows[newer], lane, [m11, m12, m21, m22, step, ramp]);
                }
            }
        }
    }

    /// Leaps as often as all runs do: while the bases certainly stay down and the watchers need not see it at once.
    pub(crate) fn step<S: Simd>(&mut self, simd: S) {
        let is_there = self.is_there;
        let lanes = || (0..S::F64_LANES).filter(|lane| is_there[*lane] == 1.0);
        let left = |samples: &SegmentEnds| samples.last.saturating_sub(samples.next);
        loop {
            let most = lanes().map(|lane| left(&self.samples[lane])).min().unwrap_or(0);
            match Q::IS_ONE {
                true => simd.vectorize(Leapt::<S, Q, 1>(simd, self, most)),
                false => simd.vectorize(Leapt::<S, Q, MOST_MODES>(simd, self, most)),
            }
            if !lanes().all(|lane| self.goes_on(lane)) {
                return;
            }
            lanes().for_each(|lane| self.prepare(lane)); // a duration is new
        }
    }

    /// Whether the run in `lane` has leapt and may do so again.
    #[inline]
    pub(crate) fn goes_on(&self, lane: usize) -> bool {
        self.is_taken[lane] == 1.0 && self.samples[lane].next < self.samples[lane].last
    }

    /// Takes the run in `lane` out. Returns the next sample.
    pub(crate) fn leave<W: Passes<Q>>(&mut self, lane: usize, engine: &mut Engine<Q>, watch: &mut W) -> usize {
        self.is_there[lane] = 0.0;
        let SegmentEnds { times, next, .. } = self.samples[lane];
        if next > self.entered[lane] {
            self.sought.show(lane, engine, watch);
            let motion = &mut engine.motion;
            motion.state = self.state_of(lane, |j| self.modes[j].motion.map(|of| of[lane]));
            (motion.chatter.age, motion.time) = (self.age[lane], times[next - 1]);
            motion.work.steps += (next - self.entered[lane]) as u64;
            watch.pass();
        }
        next
    }

    /// The state of the run in `lane` with these u and u̇.
    fn state_of(&self, lane: usize, motion: impl Fn(usize) -> [f64; 2]) -> State<Q> {
        let mut state = State { theta: 0.0, theta_dot: 0.0, ..self.state[lane] };
        for j in 0..self.exact[lane].len() {
            let [u, u_dot] = motion(j);
            state.u.set(j, u);
            state.u_dot.set(j, u_dot);
        }
        state
    }

    /// Puts off the leap over a `stretch` that is `ahead` of the next one of each run, where it is taken and not passed. Returns whether
    /// all runs may put off another one.
    #[inline(always)]
    fn put_off<S: Simd, const N: usize>(
        &mut self,
        simd: S,
        (stretch, bend): (&StepOfRuns<S, N>, &Bend<S, N>),
        ahead: usize,
        is_taken: Answers<S>,
        is_passed: Answers<S>,
    ) -> bool {
        self.sought.bound(simd, (stretch, bend), is_taken);
        let (one, zero) = (Lanes::splat(simd, 1.0), Lanes::splat(simd, 0.0));
        let is_put_off = is_passed.choose(zero, is_taken.choose(one, zero));
        let mut may_go_on = true;
        for lane in (0..S::F64_LANES).filter(|lane| self.is_there[*lane] == 1.0 && is_put_off.of(*lane) == 1.0) {
            let SegmentEnds { times, a_g, next, .. } = self.samples[lane];
            let sample = next + ahead;
            let duration = times[sample] - times[sample - 1];
            let a_g = Ramp::between(a_g[sample - 1], a_g[sample], duration);
            let states = stretch.ends.map(|of| self.state_of(lane, |j| [of.u[j].of(lane), of.u_dot[j].of(lane)]));
            if !self.sought.put_off(lane, (times[sample - 1], duration, a_g), states) {
                self.samples[lane].last = self.samples[lane].last.min(sample + 1);
                may_go_on = false;
            }
        }
        may_go_on
    }

    /// Writes the sample that is `ahead` of the next one of each run.
    #[inline(always)]
    fn write(&mut self, ahead: usize) {
        let end = &mut self.ends[ahead % 2];
        for (lane, samples) in self.samples.iter().enumerate() {
            samples.at((samples.next + ahead).wrapping_sub(1)).into_iter().for_each(|at| put(end, lane, at));
        }
    }
}

/// Leaping, at most as often as this.
struct Leapt<'c, 'a, S: Simd, Q, const N: usize>(S, &'c mut ContactLeaps<'a, Q>, usize);

impl<S: Simd, Q: Coordinates, const N: usize> WithSimd for Leapt<'_, '_, S, Q, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _simd: T) {
        let Leapt(simd, of, left) = self;
        let row = |row: &PerRun| Lanes::load(simd, row);
        let (mut age, hold, none) = (row(&of.age), row(&of.hold), Lanes::splat(simd, 0.0));
        let (one, largest) = (none.like(1.0), none.like(f64::MAX));
        let mut start = Turned { u: [none; N], u_dot: [none; N], theta: none };
        let mut numbers = [[none; 4]; N];
        for (j, mode) in of.modes.iter().take(N).enumerate() {
            [start.u[j], start.u_dot[j]] = load(simd, &mode.motion);
            numbers[j] = load(simd, &mode.numbers);
        }
        let is_absent = row(&of.is_there).is_less(one);
        let (mut is_taken, mut leaps) = (none.is_less(one), 0);
        of.write(0);
        of.write(1);
        let [mut time, mut a] = load(simd, &of.ends[0]);
        let mut may_go_on = true;
        while leaps < left && may_go_on {
            of.write(leaps + 2);
            let [time_next, a_next] = load(simd, &of.ends[(leaps + 1) % 2]);
            let duration = time_next - time;
            let is_first = duration.is_equal(row(&of.durations[0]));
            if !(is_first | duration.is_equal(row(&of.durations[1])) | is_absent).all() {
                break;
            }
            let (slope, per_bend) = ((a_next - a) / duration, duration * duration / none.like(8.0));
            let (mut end, mut off) = (start, start);
            // as each level leaps
            let (mut farthest, mut bend, mut springs, mut sum) = (none, none, [none; 2], none);
            for (j, mode) in of.modes.iter().take(N).enumerate() {
                let mut flow = [none; 6];
                for ((number, first), second) in flow.iter_mut().zip(&mode.flows[0]).zip(&mode.flows[1]) {
                    *number = is_first.choose(row(first), row(second));
                }
                let [m11, m12, m21, m22, step, ramp] = flow;
                let ([omega, zeta, share, moment], from) = (numbers[j], [start.u[j], start.u_dot[j]]);
                let oscillator = Oscillator::new(omega, zeta);
                let (value, slope) = (a * share, slope * share);
                let to = Flow { free: [m11, m12, m21, m22], step, ramp }.driven(from, value, slope);
                let swing = oscillator.swing(from, value, slope, duration);
                let [amplitude, velocity, acceleration, jerk] = oscillator.swings(&swing);
                farthest = farthest + moment.abs() * swing.farthest();
                bend = bend + moment.abs() * acceleration;
                springs = [springs[0] + moment * from[0], springs[1] + moment * to[0]];
                sum = sum + (to[0] + to[1]);
                [end.u[j], end.u_dot[j]] = to;
                off.u[j] = off_chord(amplitude, [acceleration, per_bend]);
                off.u_dot[j] = off_chord(velocity, [jerk, per_bend]);
            }
            let near = springs[0].abs().max(springs[1].abs()) + bend * duration * duration / none.like(8.0);
            let is_low = farthest.is_less(hold) | near.is_less(hold);
            let stretch = StepOfRuns { ends: [start, end], off };
            is_taken = is_low & sum.abs().is_at_most(largest) & (a + slope * duration).abs().is_at_most(largest);
            let is_passed = of.sought.are_passed(simd, &stretch.most());
            if !(is_passed | is_absent).all() {
                is_taken = is_taken & (is_passed | duration.is_at_most(row(&of.longest)));
                let mut bend = Bend { slopes: [start, end], off_cubic: start };
                for (j, [omega, zeta, share, _]) in numbers.into_iter().take(of.modes.len()).enumerate() {
                    let oscillator = Oscillator::new(omega, zeta);
                    let swing = oscillator.swing([start.u[j], start.u_dot[j]], a * share, slope * share, duration);
                    let [_, _, acceleration, jerk] = oscillator.swings(&swing);
                    let (damping, stiffness) = (none.like(2.0) * zeta * omega, omega * omega);
                    for (of, a) in bend.slopes.iter_mut().zip([a, a_next]) {
                        let u_ddot = -(a * share + damping * of.u_dot[j] + stiffness * of.u[j]);
                        (of.u[j], of.u_dot[j]) = (of.u_dot[j] * duration, u_ddot * duration);
                    }
                    let fourth = damping * jerk + stiffness * acceleration;
                    let per = per_bend * per_bend / none.like(6.0); // h⁴/384
                    (bend.off_cubic.u[j], bend.off_cubic.u_dot[j]) =
                        (fourth * per, (damping * fourth + stiffness * jerk) * per);
                }
                may_go_on = of.put_off(simd, (&stretch, &bend), leaps, is_taken, is_passed);
            }
            leaps += 1;
            if !(is_taken | is_absent).all() {
                for j in 0..N {
                    start.u[j] = is_taken.choose(end.u[j], start.u[j]);
                    start.u_dot[j] = is_taken.choose(end.u_dot[j], start.u_dot[j]);
                }
                age = is_taken.choose(age + duration, age);
                break;
            }
            (start, age, time, a) = (end, age + duration, time_next, a_next);
        }
        is_taken.choose(one, none).store(&mut of.is_taken);
        age.store(&mut of.age);
        for (j, mode) in of.modes.iter_mut().take(N).enumerate() {
            start.u[j].store(&mut mode.motion[0]);
            start.u_dot[j].store(&mut mode.motion[1]);
        }
        for (SegmentEnds { next, .. }, is_taken) in of.samples.iter_mut().zip(of.is_taken) {
            *next += leaps - usize::from(is_taken == 0.0);
        }
    }
}
