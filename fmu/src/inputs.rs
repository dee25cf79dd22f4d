//! The inputs: values, slopes, and how an input goes on of which nothing but a value is set.

use rocking::load::LOADS;
use rocking::quantity::Quantity;
use rocking::{LinearLoad, Load};
use serde::{Deserialize, Serialize};

/// The inputs. A slope is followed for one step, after which the value that it led to is held.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Inputs {
    /// Now, with the slopes set for the next step.
    next: LinearLoad,
    /// What has been set of each since the last step, in the order of [`LOADS`].
    given: [Given; 2],
    /// The slopes that the last step followed, of inputs of which nothing has been set since.
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

    /// Sets the value of one, which ends its slope.
    pub(crate) fn set(&mut self, input: &Quantity<Load>, value: f64) {
        (input.set)(&mut self.next.value, value);
        (input.set)(&mut self.followed, 0.0);
        let given = self.given(input);
        if *given == Given::Nothing {
            *given = Given::Value;
        }
    }

    /// Sets the slope of one over the next step.
    pub(crate) fn set_slope(&mut self, input: &Quantity<Load>, slope: f64) {
        (input.set)(&mut self.next.slope, slope);
        (input.set)(&mut self.followed, 0.0);
        *self.given(input) = Given::Slope;
    }

    fn given(&mut self, input: &Quantity<Load>) -> &mut Given {
        let at = const { &LOADS }.iter().position(|load| load.name == input.name);
        &mut self.given[at.expect("there are no other inputs")]
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
        let LinearLoad { value, slope } = self.over(0.0, extrapolate);
        let Load { a_g, F_t } = self.followed;
        LinearLoad { value, slope: Load { a_g: slope.a_g + a_g, F_t: slope.F_t + F_t } }
    }

    /// After a step of `duration` (s) that followed `load`.
    pub(crate) fn after(load: LinearLoad, duration: f64) -> Inputs {
        Inputs {
            next: LinearLoad { value: load.at(duration), slope: Load::default() },
            given: [Given::Nothing; 2],
            followed: load.slope,
            before: (load.value, duration),
        }
    }

    /// Whether calls can lead here.
    pub(crate) fn are_possible(&self) -> bool {
        let Inputs { next: LinearLoad { value, slope }, followed, before: (before, passed), .. } = self;
        (0.0..f64::INFINITY).contains(passed)
            && LOADS.iter().all(|input| {
                let slopes = (input.get)(slope) + (input.get)(followed);
                [value, before].iter().all(|load| input.check((input.get)(load)).is_ok()) && slopes.is_finite()
            })
    }
}
