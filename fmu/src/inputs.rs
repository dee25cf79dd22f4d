//! The inputs: values, slopes, and how an input goes on of which nothing but a value is set.

use rocking::load::LOADS;
use rocking::{LinearLoad, Load};
use serde::{Deserialize, Serialize};

/// The inputs. A slope is followed for one step, after which the value that it led to is held.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Inputs {
    /// Now, with the slopes set for the next step.
    next: LinearLoad,
    /// What has been set of each since the last step, in the order of [`LOADS`].
    given: [Given; 2],
    /// The slopes that the last step followed, which count for inputs of which nothing has been set since.
    followed: Load,
    /// Values when the last step began, and its duration, s; 0 before the first.
    before: (Load, f64),
}

/// What has been set of an input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum Given {
    #[default]
    Nothing,
    /// Its value alone.
    Value,
    /// Its slope, too.
    Slope,
}

impl Inputs {
    /// The present values.
    pub(crate) fn values(&self) -> Load {
        self.next.value
    }

    /// Sets the value of the input `which` of [`LOADS`], which ends its slope.
    pub(crate) fn set(&mut self, which: usize, value: f64) {
        (LOADS[which].set)(&mut self.next.value, value);
        if self.given[which] == Given::Nothing {
            self.given[which] = Given::Value;
        }
    }

    /// Sets the slope of the same over the next step.
    pub(crate) fn set_slope(&mut self, which: usize, slope: f64) {
        (LOADS[which].set)(&mut self.next.slope, slope);
        self.given[which] = Given::Slope;
    }

    /// Sets the value that the same leads to over the next step, which lasts `step` (s), in a straight line.
    pub(crate) fn lead(&mut self, which: usize, value: f64, step: f64) {
        self.set_slope(which, (value - (LOADS[which].get)(&self.next.value)) / step);
    }

    /// What they are over a step of `duration` (s). With `extrapolate`, one of which only the value is set goes on with
    /// the slope from its value at the last communication point to the present one, unless that leads out of its range.
    pub(crate) fn over(&self, duration: f64, extrapolate: bool) -> LinearLoad {
        let (mut load, (before, passed)) = (self.next, &self.before);
        if extrapolate && *passed > 0.0 {
            for (input, _) in LOADS.iter().zip(self.given).filter(|(_, given)| *given == Given::Value) {
                let value = (input.get)(&load.value);
                let slope = (value - (input.get)(before)) / passed;
                if slope.is_finite() && input.check(value + slope * duration).is_ok() {
                    (input.set)(&mut load.slope, slope);
                }
            }
        }
        load
    }

    /// What they are now and how they change: as they are about to, or as they just did.
    pub(crate) fn now(&self, extrapolate: bool) -> LinearLoad {
        let mut load = self.over(0.0, extrapolate);
        for (input, _) in LOADS.iter().zip(self.given).filter(|(_, given)| *given == Given::Nothing) {
            (input.set)(&mut load.slope, (input.get)(&self.followed));
        }
        load
    }

    /// Goes on after a step of `duration` (s) that followed `load`.
    pub(crate) fn pass(&mut self, load: LinearLoad, duration: f64) {
        self.next = LinearLoad { value: load.at(duration), slope: Load::default() };
        self.given = [Given::Nothing; 2];
        self.followed = load.slope;
        self.before = (load.value, duration);
    }

    /// Whether calls can lead here.
    pub(crate) fn are_possible(&self) -> bool {
        let Inputs { next: LinearLoad { value, slope }, followed, before: (before, passed), .. } = self;
        (0.0..f64::INFINITY).contains(passed)
            && LOADS.iter().all(|input| {
                [value, before].iter().all(|load| input.check((input.get)(load)).is_ok())
                    && [slope, followed].iter().all(|slopes| (input.get)(slopes).is_finite())
            })
    }
}
