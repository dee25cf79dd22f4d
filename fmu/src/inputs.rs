//! The inputs: what the host sets at communication points, and the line that each of them follows over a step.

use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::run::Runs;
use rocking::{LinearLoad, Load, OutOfRange, Ramp, Structure};
use serde::{Deserialize, Serialize};
use std::slice;

/// The place of F_t in [`LOADS`].
pub(crate) const FORCE: usize = 1;

/// The places in [`LOADS`] of the inputs of `structure`: a_g, F_t and a_v of one mass, or a_g, a_v and a force on each floor.
pub(crate) fn loads(structure: &Structure) -> Vec<usize> {
    match structure.is_one_mass() {
        true => (0..LOADS.len()).collect(),
        false => [0, VERTICAL].into_iter().chain(structure.floors().iter().map(|_| FORCE)).collect(),
    }
}

/// How an input acts between communication points if nothing but its value is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Between {
    /// At once, and held over the step.
    #[default]
    Held,
    /// One step late: in a line from the value of the last communication point to that of the present one.
    Late,
    /// At once, and on with the slope of its values at the last two communication points.
    Extrapolated,
}

/// The inputs by their places. An input follows its slope for one step, and then holds the value that it has reached. After a step
/// that ended early, the next step continues along the same lines.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Inputs {
    each: Vec<Input>,
    /// Time since the last communication point that a step began at, s; 0 before the first.
    since: f64,
    /// Whether the last step ended before the next communication point.
    ended_early: bool,
    /// Over how many steps in a row, up to [`STAIRS`], a ground acceleration was held at another value each.
    stairs: u8,
}

/// Steps in a row over which a ground acceleration is held, each at another value, before it counts as samples of a motion. A
/// push begins and ends with one such step.
const STAIRS: u8 = 3;

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Input {
    /// Its place in [`LOADS`].
    #[serde(skip)]
    load: usize,
    between: Between,
    /// The value that acts now, and the slope of the next step, unless the input is late.
    next: Ramp,
    /// The value that the host has set, or that the last step led to.
    set: f64,
    /// The values that the host has set since the last step.
    given: InputSetting,
    /// The value at the end of the last step, and the slope that the step followed.
    followed: Ramp,
    /// The value at the last communication point that a step began at.
    before: f64,
    /// The line over the present step.
    #[serde(skip)]
    line: Ramp,
    /// Whether the last step has left it as it was, as most inputs of most hosts: until it is set, steps have the same line.
    #[serde(skip)]
    rests: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum InputSetting {
    /// Nothing, or what was set before a step that ended early.
    #[default]
    Nothing,
    /// Its value alone.
    Value,
    /// Its slope, too.
    Slope,
}

impl Input {
    fn acts_at_once(&self) -> bool {
        self.between != Between::Late || self.given == InputSetting::Slope
    }

    #[inline]
    fn set(&mut self, value: f64, since: f64, ended_early: bool) {
        (self.set, self.rests) = (value, false);
        let mut acts = value;
        if self.given != InputSetting::Slope {
            self.given = InputSetting::Value;
            (acts, self.next.slope) = match self.between {
                Between::Held => (value, 0.0),
                Between::Late => return,
                Between::Extrapolated => self.extrapolated(value, since, ended_early),
            };
        }
        self.next.value = acts;
    }

    /// The value that acts and its slope where `value` alone is set of an input that goes on.
    #[cold]
    fn extrapolated(&mut self, value: f64, since: f64, ended_early: bool) -> (f64, f64) {
        if ended_early && value == self.before {
            self.given = InputSetting::Nothing;
            return (self.followed.value, self.followed.slope);
        }
        let slope = if since > 0.0 { (value - self.before) / since } else { 0.0 };
        (value, if slope.is_finite() { slope } else { 0.0 })
    }

    #[inline]
    fn set_slope(&mut self, slope: f64) {
        if self.given == InputSetting::Nothing {
            self.set = self.next.value;
        } else {
            self.next.value = self.set;
        }
        (self.next.slope, self.given, self.rests) = (slope, InputSetting::Slope, false);
    }

    /// The line over a step of `duration` (s). An input of which only the value is set is held if its line would lead out of its
    /// range.
    #[inline]
    fn over(&self, duration: f64) -> Ramp {
        let Ramp { value, mut slope } = self.next;
        if self.between == Between::Held || self.given == InputSetting::Slope {
            return self.next;
        }
        if self.between == Between::Late {
            slope = (self.set - value) / duration;
        }
        let leads_there = slope.is_finite() && LOADS[self.load].check(value + slope * duration).is_ok();
        Ramp { value, slope: if leads_there { slope } else { 0.0 } }
    }

    /// Goes on after `duration` (s) along the line. Inputs that act at once are now where the line has led. Late inputs go to their
    /// set values, whatever the rounding, unless the step has ended early.
    #[inline]
    fn pass(&mut self, duration: f64, ended_early: bool) {
        let Ramp { slope, .. } = self.line;
        self.next = Ramp { value: self.line.at(duration), slope: if ended_early { slope } else { 0.0 } };
        if self.acts_at_once() {
            self.set = self.next.value;
        } else if !ended_early {
            self.next.value = self.set;
        }
        self.followed = Ramp { value: self.next.value, slope };
        self.given = InputSetting::Nothing;
    }
}

impl Inputs {
    /// Inputs of `structure` that are 0 and act at once.
    pub fn new(structure: &Structure) -> Inputs {
        let each = loads(structure).into_iter().map(|load| Input { load, ..Input::default() }).collect();
        Inputs { each, since: 0.0, ended_early: false, stairs: 0 }
    }

    /// These inputs, read from bytes, in the places of the `present` ones; none if they are not as many.
    pub fn in_place_of(mut self, present: &Inputs) -> Option<Inputs> {
        self.each.iter_mut().zip(&present.each).for_each(|(input, of)| input.load = of.load);
        (self.each.len() == present.each.len() && self.stairs <= STAIRS).then_some(self)
    }

    /// Makes the inputs act as the setup says, in the order of [`LOADS`]. Until then, and where no steps are made, they act at once.
    pub fn start(&mut self, between: [Between; LOADS.len()]) {
        self.each.iter_mut().for_each(|input| input.between = between[input.load]);
    }

    #[inline]
    pub fn is_vertical(&self, which: usize) -> bool {
        self.each[which].load == VERTICAL
    }

    pub fn vertical(&self) -> usize {
        (0..self.each.len()).find(|which| self.is_vertical(*which)).expect("every structure has this input")
    }

    pub fn acts_at_once(&self, which: usize) -> bool {
        self.each[which].acts_at_once()
    }

    /// The value that the host reads: what it has set, or what the last step led to.
    pub fn shown(&self, which: usize) -> f64 {
        self.each[which].set
    }

    #[inline]
    pub fn set(&mut self, which: usize, value: f64) {
        self.each[which].set(value, self.since, self.ended_early);
    }

    /// Sets a slope over the next step, from what has been set of the input or else from what acts.
    #[inline]
    pub fn set_slope(&mut self, which: usize, slope: f64) {
        self.each[which].set_slope(slope);
    }

    /// Sets the value that an input leads to over the next step, which lasts `step` (s), in a straight line.
    pub fn lead(&mut self, which: usize, value: f64, step: f64) {
        let input = &mut self.each[which];
        input.set_slope(0.0);
        input.set_slope((value - input.set) / step);
    }

    /// The load on `structure`, given the value `of` each input.
    #[inline(always)] // several times at each step
    fn load<Q: Runs>(&self, structure: &Structure, of: impl Fn(&Input) -> f64) -> Load<Q> {
        let (a_g, forces, a_v) = match self.each.as_slice() {
            [a_g, force, a_v] if Q::IS_ONE || force.load == FORCE => (a_g, slice::from_ref(force), a_v),
            [a_g, a_v, forces @ ..] => (a_g, forces, a_v),
            _ => unreachable!("every structure has these inputs"),
        };
        Load { a_g: of(a_g), F_t: Q::of_forces(structure, forces.iter().map(&of)), a_v: of(a_v) }
    }

    /// The loads that act now on `structure`.
    #[inline]
    pub fn values<Q: Runs>(&self, structure: &Structure) -> Load<Q> {
        self.load(structure, |input| input.next.value)
    }

    /// The loads that act now on `structure`, with the slopes of the next step, or of the last step if none are set.
    pub fn now<Q: Runs>(&self, structure: &Structure) -> LinearLoad<Q> {
        let slope = |input: &Input| {
            let is_old = input.given == InputSetting::Nothing || !input.acts_at_once();
            if is_old { input.followed.slope } else { input.next.slope }
        };
        LinearLoad { value: self.values(structure), slope: self.load(structure, slope) }
    }

    /// Puts every input on its line over a step of `duration` (s), and returns the loads on `structure` along the lines. If a line leads
    /// out of its range, returns the place of the input.
    #[inline]
    pub fn over<Q: Runs>(
        &mut self,
        duration: f64,
        structure: &Structure,
    ) -> Result<LinearLoad<Q>, (usize, OutOfRange)> {
        for (which, input) in self.each.iter_mut().enumerate().filter(|(_, input)| !input.rests) {
            input.line = input.over(duration);
            LOADS[input.load].check(input.line.at(duration)).map_err(|out_of_range| (which, out_of_range))?;
        }
        let value = self.load(structure, |input| input.line.value);
        Ok(LinearLoad { value, slope: self.load(structure, |input| input.line.slope) })
    }

    /// Goes on after `duration` (s) of a step along the lines, which ended early or at the next communication point.
    #[inline]
    pub fn pass(&mut self, duration: f64, ended_early: bool) {
        let (begins, mut is_stair) = (!self.ended_early, false);
        for input in self.each.iter_mut().filter(|input| !input.rests) {
            let &mut Input { load, between, given, line, before, .. } = input;
            if begins {
                let (is_held, is_same) = (between == Between::Held, line == Ramp { value: before, slope: 0.0 });
                is_stair |= is_held && given == InputSetting::Value && line.value != before && load != FORCE;
                (input.rests, input.before) = (is_held && given == InputSetting::Nothing && is_same, line.value);
            }
            input.pass(duration, ended_early);
            if input.rests {
                input.line = input.next;
            }
        }
        if begins {
            self.stairs = if is_stair { (self.stairs + 1).min(STAIRS) } else { 0 };
            self.since = 0.0;
        }
        self.since += duration;
        self.ended_early = ended_early;
    }

    /// Whether the values of a ground acceleration come as samples of a motion and are held from step to step.
    pub fn makes_stairs(&self) -> bool {
        self.stairs == STAIRS
    }
}
