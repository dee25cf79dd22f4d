//! The inputs: what the host sets at communication points, and the line that each of them follows over a step.

use rocking::engine::Moves;
use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::{Engine, Frame, LinearLoad, Load, Modes, OutOfRange};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// The inputs of structures with the lateral coordinates `Q`, by their places.
pub trait InputsOf<Q: Moves>: Clone + Debug + Serialize + DeserializeOwned {
    /// The lines that the inputs follow over a step.
    type Lines;

    /// The values at an instant of a step.
    type Values;

    /// The place of a_v.
    const VERTICAL: usize;

    /// Makes the inputs act as the setup says. Until then, and where no steps are made, they act at once.
    fn start(&mut self, between: [Between; LOADS.len()]);

    /// As many inputs, all 0, that act at once.
    fn at_rest(&self) -> Self;

    /// Whether an input acts as soon as it is set.
    fn acts_at_once(&self, which: usize) -> bool;

    /// The value that the host reads: what it has set, or what the last step led to.
    fn shown(&self, which: usize) -> f64;

    /// Sets a value.
    fn set(&mut self, which: usize, value: f64);

    /// Sets a slope over the next step, from what has been set of the input or else from what acts.
    fn set_slope(&mut self, which: usize, slope: f64);

    /// Sets the value that an input leads to over the next step, which lasts `step` (s), in a straight line.
    fn lead(&mut self, which: usize, value: f64, step: f64);

    /// The loads that act now on the structure of `engine`.
    fn values(&self, engine: &Engine<Q>) -> Load<Q>;

    /// The loads that act now on the structure of `engine`, with the slopes of the next step, or of the last step if none are set.
    fn now(&self, engine: &Engine<Q>) -> LinearLoad<Q>;

    /// The lines that the inputs follow over a step of `duration` (s). An input of which only the value is set is held
    /// if its line would lead out of its range.
    fn over(&self, duration: f64, engine: &Engine<Q>) -> Self::Lines;

    /// The loads along `lines`.
    fn load(lines: &Self::Lines) -> &LinearLoad<Q>;

    /// The values on `lines` after `tau` seconds.
    fn at(lines: &Self::Lines, tau: f64) -> Self::Values;

    /// Checks that `values` are in range. Returns the place of the input that is not.
    fn check(values: &Self::Values) -> Result<(), (usize, OutOfRange)>;

    /// Goes on after `duration` (s) of a step along `lines` to `values`, which ended early or at the next communication
    /// point.
    fn pass(&mut self, lines: &Self::Lines, duration: f64, values: Self::Values, ended_early: bool);

    /// Whether the values of a ground acceleration come as samples of a motion and are held from step to step.
    fn makes_stairs(&self) -> bool;
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

/// The inputs. An input follows its slope for one step, and then holds the value that it has reached. After a step that ended
/// early, the next step continues along the same lines.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Inputs {
    /// How they act, in the order of [`LOADS`].
    between: [Between; LOADS.len()],
    /// Whether some are not held, so that more than that is asked.
    is_any_led: bool,
    /// The inputs that act now, and the slopes of the next step, except for late ones.
    next: LinearLoad,
    /// The values that the host has set, or that the last step led to.
    set: Load,
    /// The settings of each input since the last step, in the same order.
    given: [Given; LOADS.len()],
    /// The values at the end of the last step, and the slopes that the step followed.
    followed: LinearLoad,
    /// The inputs at the last communication point that a step began at, and the time since then, s; 0 before the
    /// first.
    before: (Load, f64),
    /// Whether the last step ended before the next communication point.
    ended_early: bool,
    /// Over how many steps in a row, up to [`STAIRS`], a ground acceleration was held at another value each.
    stairs: u8,
}

/// Steps in a row over which a ground acceleration is held, each at another value, before it counts as samples of a motion. A
/// push begins and ends with one such step.
const STAIRS: u8 = 3;

/// The setting of an input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum Given {
    /// Nothing, or what was set before a step that ended early.
    #[default]
    Nothing,
    /// Its value alone.
    Value,
    /// Its slope, too.
    Slope,
}

impl InputsOf<f64> for Inputs {
    type Lines = LinearLoad;
    type Values = Load;

    const VERTICAL: usize = VERTICAL;

    fn start(&mut self, between: [Between; LOADS.len()]) {
        (self.between, self.is_any_led) = (between, between != [Between::Held; LOADS.len()]);
    }

    fn at_rest(&self) -> Inputs {
        Inputs::default()
    }

    #[inline]
    fn acts_at_once(&self, which: usize) -> bool {
        self.between[which] != Between::Late || self.given[which] == Given::Slope
    }

    fn shown(&self, which: usize) -> f64 {
        self.set[which]
    }

    #[inline]
    fn set(&mut self, which: usize, value: f64) {
        self.set[which] = value;
        let mut acts = value;
        if self.given[which] != Given::Slope {
            self.given[which] = Given::Value;
            (acts, self.next.slope[which]) = match self.between[which] {
                Between::Held => (value, 0.0),
                Between::Late => return,
                Between::Extrapolated => self.extrapolated(which, value),
            };
        }
        self.next.value[which] = acts;
    }

    #[inline]
    fn set_slope(&mut self, which: usize, slope: f64) {
        let Inputs { next, set, given, .. } = self;
        if given[which] == Given::Nothing {
            set[which] = next.value[which];
        } else {
            next.value[which] = set[which];
        }
        next.slope[which] = slope;
        given[which] = Given::Slope;
    }

    fn lead(&mut self, which: usize, value: f64, step: f64) {
        self.set_slope(which, 0.0);
        self.set_slope(which, (value - self.set[which]) / step);
    }

    #[inline(always)]
    fn values(&self, _: &Engine) -> Load {
        self.next.value
    }

    fn now(&self, _: &Engine) -> LinearLoad {
        self.with_slopes()
    }

    #[inline]
    fn over(&self, duration: f64, _: &Engine) -> LinearLoad {
        self.line(duration)
    }

    #[inline(always)]
    fn load(lines: &LinearLoad) -> &LinearLoad {
        lines
    }

    #[inline]
    fn at(lines: &LinearLoad, tau: f64) -> Load {
        lines.at(tau)
    }

    #[inline]
    fn check(values: &Load) -> Result<(), (usize, OutOfRange)> {
        values.check().map_err(place)
    }

    #[inline(always)]
    fn pass(&mut self, load: &LinearLoad, duration: f64, value: Load, ended_early: bool) {
        if !self.ended_early {
            let is_stair = |which: usize| {
                let is_held = self.given[which] == Given::Value && self.between[which] == Between::Held;
                is_held && load.value[which] != self.before.0[which]
            };
            let is_stair = is_stair(0) || is_stair(VERTICAL);
            self.stairs = if is_stair { (self.stairs + 1).min(STAIRS) } else { 0 };
            self.before = (load.value, 0.0);
        }
        self.before.1 += duration;
        let slope = if ended_early { load.slope } else { Load::default() };
        (self.next, self.ended_early) = (LinearLoad { value, slope }, ended_early);
        if self.is_any_led {
            self.arrive();
        } else {
            self.set = value;
        }
        (self.followed.value, self.followed.slope) = (self.next.value, load.slope);
        self.given = [Given::Nothing; LOADS.len()];
    }

    #[inline]
    fn makes_stairs(&self) -> bool {
        self.stairs == STAIRS
    }
}

impl Inputs {
    /// The inputs that act now, with the slopes of the next step, or of the last step if none are set.
    pub(crate) fn with_slopes(&self) -> LinearLoad {
        let mut load = self.next;
        for which in 0..LOADS.len() {
            if self.given[which] == Given::Nothing || !self.acts_at_once(which) {
                load.slope[which] = self.followed.slope[which];
            }
        }
        load
    }

    /// The value that acts and its slope where `value` alone is set of an input that goes on.
    #[cold]
    #[inline(never)]
    fn extrapolated(&mut self, which: usize, value: f64) -> (f64, f64) {
        let Inputs { given, followed, before: (before, ago), ended_early, .. } = self;
        if *ended_early && value == before[which] {
            given[which] = Given::Nothing;
            return (followed.value[which], followed.slope[which]);
        }
        let slope = if *ago > 0.0 { (value - before[which]) / *ago } else { 0.0 };
        (value, if slope.is_finite() { slope } else { 0.0 })
    }

    #[inline]
    fn line(&self, duration: f64) -> LinearLoad {
        if self.is_any_led { self.lines(duration) } else { self.next }
    }

    #[cold]
    #[inline(never)]
    fn lines(&self, duration: f64) -> LinearLoad {
        let mut load = self.next;
        for (which, between) in self.between.into_iter().enumerate() {
            if between == Between::Held || self.given[which] == Given::Slope {
                continue;
            }
            let value = load.value[which];
            let slope = match between {
                Between::Late => (self.set[which] - value) / duration,
                _ => load.slope[which],
            };
            let leads_there = slope.is_finite() && LOADS[which].check(value + slope * duration).is_ok();
            load.slope[which] = if leads_there { slope } else { 0.0 };
        }
        load
    }

    /// Sets the inputs that act at once to where the step has led. Late inputs go to their set values, whatever the rounding,
    /// unless the step has ended early.
    #[cold]
    #[inline(never)]
    fn arrive(&mut self) {
        for which in 0..LOADS.len() {
            if self.acts_at_once(which) {
                self.set[which] = self.next.value[which];
            } else if !self.ended_early {
                self.next.value[which] = self.set[which];
            }
        }
    }
}

/// The inputs of many masses: a_g, a_v, then a force on each floor. Each item has a force, the first also the ground.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FloorInputs(Vec<Inputs>);

/// The place of F_t in [`LOADS`].
const FORCE: usize = 1;

impl FloorInputs {
    /// Inputs that are 0, for `floors` floors.
    pub fn new(floors: usize) -> FloorInputs {
        FloorInputs(vec![Inputs::default(); floors.max(1)])
    }

    /// The item that has an input, and the place of the input there.
    fn at(which: usize) -> (usize, usize) {
        match which {
            0 => (0, 0),
            <FloorInputs as InputsOf<Modes>>::VERTICAL => (0, VERTICAL),
            _ => (which - 2, FORCE),
        }
    }

    fn of(&mut self, which: usize) -> (&mut Inputs, usize) {
        let (item, place) = FloorInputs::at(which);
        (&mut self.0[item], place)
    }
}

/// The place in [`LOADS`] of a load that is out of range.
#[cold]
fn place(of: OutOfRange) -> (usize, OutOfRange) {
    (LOADS.iter().position(|load| load.name == of.name).expect("it is one of them"), of)
}

/// The load of these `parts` on the `frame`.
fn together(frame: &Frame, parts: impl Iterator<Item = Load>) -> Load<Modes> {
    let parts: Vec<_> = parts.collect();
    let forces: Vec<_> = parts.iter().take(frame.floors().len()).map(|part| part.F_t).collect();
    frame.load(parts[0].a_g, parts[0].a_v, &forces).expect("each floor has a force")
}

fn together_over(frame: &Frame, parts: &[LinearLoad]) -> LinearLoad<Modes> {
    let [value, slope] = [|part: &LinearLoad| part.value, |part: &LinearLoad| part.slope]
        .map(|of| together(frame, parts.iter().map(of)));
    LinearLoad { value, slope }
}

/// The lines of [`FloorInputs`], and the loads along them.
pub struct FloorLines {
    parts: Vec<LinearLoad>,
    load: LinearLoad<Modes>,
}

impl InputsOf<Modes> for FloorInputs {
    type Lines = FloorLines;
    type Values = Vec<Load>;

    const VERTICAL: usize = 1;

    fn start(&mut self, between: [Between; LOADS.len()]) {
        self.0.iter_mut().for_each(|item| item.start(between));
    }

    fn at_rest(&self) -> FloorInputs {
        FloorInputs::new(self.0.len())
    }

    fn acts_at_once(&self, which: usize) -> bool {
        let (item, place) = FloorInputs::at(which);
        self.0[item].acts_at_once(place)
    }

    fn shown(&self, which: usize) -> f64 {
        let (item, place) = FloorInputs::at(which);
        self.0[item].shown(place)
    }

    fn set(&mut self, which: usize, value: f64) {
        let (item, place) = self.of(which);
        item.set(place, value);
    }

    fn set_slope(&mut self, which: usize, slope: f64) {
        let (item, place) = self.of(which);
        item.set_slope(place, slope);
    }

    fn lead(&mut self, which: usize, value: f64, step: f64) {
        let (item, place) = self.of(which);
        item.lead(place, value, step);
    }

    fn values(&self, engine: &Engine<Modes>) -> Load<Modes> {
        together(engine.structure(), self.0.iter().map(|item| item.next.value))
    }

    fn now(&self, engine: &Engine<Modes>) -> LinearLoad<Modes> {
        together_over(engine.structure(), &self.0.iter().map(Inputs::with_slopes).collect::<Vec<_>>())
    }

    fn over(&self, duration: f64, engine: &Engine<Modes>) -> FloorLines {
        let parts: Vec<_> = self.0.iter().map(|item| item.line(duration)).collect();
        FloorLines { load: together_over(engine.structure(), &parts), parts }
    }

    fn load(lines: &FloorLines) -> &LinearLoad<Modes> {
        &lines.load
    }

    fn at(lines: &FloorLines, tau: f64) -> Vec<Load> {
        lines.parts.iter().map(|part| part.at(tau)).collect()
    }

    fn check(values: &Vec<Load>) -> Result<(), (usize, OutOfRange)> {
        values.iter().enumerate().try_for_each(|(item, values)| {
            values.check().map_err(place).map_err(|(place, of)| match place {
                FORCE => (item + 2, of),
                VERTICAL => (Self::VERTICAL, of),
                place => (place, of),
            })
        })
    }

    fn pass(&mut self, lines: &FloorLines, duration: f64, values: Vec<Load>, ended_early: bool) {
        let parts = self.0.iter_mut().zip(&lines.parts).zip(values);
        parts.for_each(|((item, line), value)| item.pass(line, duration, value, ended_early));
    }

    fn makes_stairs(&self) -> bool {
        self.0[0].makes_stairs()
    }
}
