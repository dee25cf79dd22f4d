//! The inputs: what the host sets at communication points, and the line that each of them follows over a step.

use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::{LinearLoad, Load};
use serde::{Deserialize, Serialize};

/// How an input acts between communication points if nothing but its value is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Between {
    /// At once, and held over the step.
    #[default]
    Held,
    /// One step late: in a line from the value of the last communication point to that of the present one.
    Late,
    /// At once, and on with the slope of its values at the last two communication points.
    Extrapolated,
}

/// The inputs. A slope is followed for one step, after which the value that it led to is held; a step that ended early
/// goes on where it ended, along the same lines.
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

/// Steps in a row over which a ground acceleration is held, at another value each, before it is taken for samples of a
/// motion: a push begins and ends with one such step.
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

impl Inputs {
    /// The inputs that act now.
    pub(crate) fn values(&self) -> Load {
        self.next.value
    }

    /// The values that the host reads: those that it has set, or that the last step led to.
    pub(crate) fn shown(&self) -> Load {
        self.set
    }

    /// Whether the values of a ground acceleration come as samples of a motion and are held from step to step.
    #[inline]
    pub(crate) fn makes_stairs(&self) -> bool {
        self.stairs == STAIRS
    }

    /// Makes the inputs act as `between` says. Until then, and where no steps are made, they act at once.
    pub(crate) fn start(&mut self, between: [Between; LOADS.len()]) {
        (self.between, self.is_any_led) = (between, between != [Between::Held; LOADS.len()]);
    }

    /// Sets the value of the input `which` of [`LOADS`].
    #[inline]
    pub(crate) fn set(&mut self, which: usize, value: f64) {
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

    /// The value that acts and its slope where `value` alone is set of an input that goes on.
    #[cold]
    #[inline(never)]
    fn extrapolated(&mut self, which: usize, value: f64) -> (f64, f64) {
        let Inputs { given, followed, before: (before, ago), ended_early, .. } = self;
        if *ended_early && value == before[which] {
            given[which] = Given::Nothing;
            return (followed.value[which], followed.slope[which]);
        }
        let slope = (value - before[which]) / *ago;
        (value, if slope.is_finite() { slope } else { 0.0 })
    }

    /// Sets the slope of an input over the next step, from what has been set of it or else from what acts.
    #[inline]
    pub(crate) fn set_slope(&mut self, which: usize, slope: f64) {
        let Inputs { next, set, given, .. } = self;
        if given[which] == Given::Nothing {
            set[which] = next.value[which];
        } else {
            next.value[which] = set[which];
        }
        next.slope[which] = slope;
        given[which] = Given::Slope;
    }

    /// Sets the value that an input leads to over the next step, which lasts `step` (s), in a straight line.
    pub(crate) fn lead(&mut self, which: usize, value: f64, step: f64) {
        self.set_slope(which, 0.0);
        self.set_slope(which, (value - self.set[which]) / step);
    }

    /// Whether an input acts as soon as it is set.
    #[inline]
    pub(crate) fn acts_at_once(&self, which: usize) -> bool {
        self.between[which] != Between::Late || self.given[which] == Given::Slope
    }

    /// The lines that the inputs follow over a step of `duration` (s). An input of which only the value is set is held
    /// if its line would lead out of its range.
    #[inline]
    pub(crate) fn over(&self, duration: f64) -> LinearLoad {
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

    /// The inputs that act now, with the slopes of the next step, or of the last step if none are set.
    pub(crate) fn now(&self) -> LinearLoad {
        let mut load = self.next;
        for which in 0..LOADS.len() {
            if self.given[which] == Given::Nothing || !self.acts_at_once(which) {
                load.slope[which] = self.followed.slope[which];
            }
        }
        load
    }

    /// Goes on after `duration` (s) of a step that followed `load` to `value`, and that ended early or at the next
    /// communication point.
    #[inline]
    pub(crate) fn pass(&mut self, load: LinearLoad, duration: f64, value: Load, ended_early: bool) {
        if !self.ended_early {
            let is_stair = [0, VERTICAL].into_iter().any(|which| {
                let is_held = self.given[which] == Given::Value && self.between[which] == Between::Held;
                is_held && load.value[which] != self.before.0[which]
            });
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
