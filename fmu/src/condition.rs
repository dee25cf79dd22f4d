//! Where an instance stands: everything that its future depends on.

use crate::failure::Failure;
use crate::state_machine::Stage;
use crate::variables::{Source, VARIABLES, Variable};
use rocking::engine::{DEFAULT_TOLERANCE, Motion};
use rocking::quantity::Quantity;
use rocking::{Detail, Engine, Impulse, LinearLoad, Load, Parameters, State, Structure};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Largest |θ| of a structure in motion, rad: that of overturning and its rounding.
const MAX_ANGLE: f64 = FRAC_PI_2 + 1e-9;

/// More than any other number of the motion (SI units) but its time can be, and small enough to be squared.
const BOUND: f64 = 1e100;

/// A few dozen numbers from which an instance goes on to the same bits: what an FMU state holds.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Condition {
    /// State of FMI's state machine.
    pub stage: Stage,
    /// What was set before the start.
    pub setup: Setup,
    /// What acts from the present time on.
    pub inputs: Inputs,
    /// The motion, once it has started: until then it follows from the setup.
    pub motion: Option<Motion>,
}

/// What is set before a simulation starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setup {
    pub(crate) parameters: Parameters,
    pub(crate) initial: State,
    pub(crate) detail: Detail,
    pub(crate) tolerance: f64,
    pub(crate) start_time: f64,
    pub(crate) stop_time: Option<f64>,
}

/// The inputs. A slope is followed for one step, after which the value that it led to is held.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Inputs {
    /// Now, with the slopes that the next step follows.
    pub next: LinearLoad,
    /// The slopes that the last step followed, of inputs of which nothing has been set since.
    pub followed: Load,
}

/// A condition with the engine that it is the condition of.
pub(crate) struct Present {
    pub stage: Stage,
    pub setup: Setup,
    pub inputs: Inputs,
    /// Until initialization ends it is built when an output is asked for, and dropped when what it was built from is
    /// set anew.
    pub engine: Option<Engine>,
}

impl Setup {
    /// The structure at the start time.
    pub(crate) fn start(&self) -> Result<Engine, Failure> {
        let structure = Structure::new(self.parameters)?;
        Ok(Engine::with_detail(structure, self.initial, self.start_time, self.tolerance, self.detail)?)
    }

    /// The parameter or initial value of `source`.
    pub(crate) fn get(&self, source: &Source) -> f64 {
        match source {
            Source::Parameter(quantity) => (quantity.get)(&self.parameters),
            Source::InitialValue(quantity) => (quantity.get)(&self.initial),
            _ => f64::NAN,
        }
    }

    /// The same but for the parameter or initial value of `source`.
    pub(crate) fn with(mut self, source: &Source, value: f64) -> Setup {
        match source {
            Source::Parameter(quantity) => (quantity.set)(&mut self.parameters, value),
            Source::InitialValue(quantity) => (quantity.set)(&mut self.initial, value),
            _ => (),
        }
        self
    }

    /// Whether tolerance, start and stop time can be.
    pub(crate) fn check_experiment(&self) -> Result<(), Failure> {
        let &Setup { tolerance, start_time, stop_time, .. } = self;
        let refuse = |name, value, limit: &str| Failure::Experiment { name, value, limit: limit.to_owned() };
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(refuse("tolerance", tolerance, "between 0 and 1, such as 1e-9"));
        }
        if !start_time.is_finite() {
            return Err(refuse("startTime", start_time, "finite"));
        }
        match stop_time.filter(|stop_time| !(*stop_time >= start_time && stop_time.is_finite())) {
            Some(stop_time) => {
                Err(refuse("stopTime", stop_time, &format!("finite and not before startTime = {start_time} s")))
            }
            None => Ok(()),
        }
    }
}

impl Inputs {
    /// Sets the value of one, which ends its slope.
    pub(crate) fn set(&mut self, input: &Quantity<Load>, value: f64) {
        (input.set)(&mut self.next.value, value);
        (input.set)(&mut self.followed, 0.0);
    }

    /// Sets the slope of one over the next step.
    pub(crate) fn set_slope(&mut self, input: &Quantity<Load>, slope: f64) {
        (input.set)(&mut self.next.slope, slope);
        (input.set)(&mut self.followed, 0.0);
    }

    /// What they are now and how they change: as they are about to, or as they just did.
    pub(crate) fn now(&self) -> LinearLoad {
        let LinearLoad { value, slope } = self.next;
        let Load { a_g, F_t } = self.followed;
        LinearLoad { value, slope: Load { a_g: slope.a_g + a_g, F_t: slope.F_t + F_t } }
    }

    /// After a step of `duration` (s).
    pub(crate) fn after(&self, duration: f64) -> Inputs {
        let next = LinearLoad { value: self.next.at(duration), slope: Load::default() };
        Inputs { next, followed: self.next.slope }
    }
}

impl Condition {
    /// Whether calls can lead here. What is read from bytes need not have come about by calls.
    pub fn is_possible(&self) -> bool {
        let Setup { parameters, initial, .. } = &self.setup;
        let Inputs { next: LinearLoad { value, slope }, followed } = &self.inputs;
        let fits = |variable: &Variable| match variable.source {
            Source::Input(quantity) => {
                let slopes = (quantity.get)(slope) + (quantity.get)(followed);
                quantity.check((quantity.get)(value)).is_ok() && slopes.is_finite()
            }
            Source::Parameter(quantity) => quantity.check((quantity.get)(parameters)).is_ok(),
            Source::InitialValue(quantity) => quantity.check((quantity.get)(initial)).is_ok(),
            _ => true,
        };
        let moves = |motion: &Motion| {
            let &Motion { time, state: State { u, u_dot, theta, theta_dot }, impulse, .. } = motion;
            let Impulse { I_h, I_v, I_m } = impulse;
            let is_bounded = [u, u_dot, theta_dot, I_h, I_v, I_m].iter().all(|x| x.abs() <= BOUND);
            is_bounded && time.is_finite() && theta.abs() <= MAX_ANGLE
        };
        VARIABLES.iter().all(fits)
            && self.setup.check_experiment().is_ok()
            && self.motion.is_some() == self.stage.has_started()
            && self.motion.as_ref().is_none_or(|motion| moves(motion) && self.setup.start().is_ok())
    }
}

impl Present {
    /// As instantiated, with the parameters that the archive carries.
    pub fn new(parameters: Parameters) -> Present {
        Present {
            stage: Stage::Instantiated,
            setup: Setup {
                parameters,
                initial: State::default(),
                detail: Detail::default(),
                tolerance: DEFAULT_TOLERANCE,
                start_time: 0.0,
                stop_time: None,
            },
            inputs: Inputs::default(),
            engine: None,
        }
    }

    /// The structure in motion, or at its start with what has been set so far.
    pub fn engine(&mut self) -> Result<&mut Engine, Failure> {
        match &mut self.engine {
            Some(engine) => Ok(engine),
            none => Ok(none.insert(self.setup.start()?)),
        }
    }

    /// Its condition.
    pub fn condition(&self) -> Condition {
        let &Present { stage, setup, inputs, .. } = self;
        let motion = self.engine.as_ref().filter(|_| stage.has_started()).map(|engine| *engine.motion());
        Condition { stage, setup, inputs, motion }
    }

    /// Goes to `condition`. The engine is built anew only for another setup.
    pub fn go_to(&mut self, condition: &Condition) -> Result<(), Failure> {
        let &Condition { stage, setup, inputs, motion } = condition;
        let engine = match motion {
            Some(motion) => {
                let kept = self.engine.take_if(|_| self.setup == setup);
                let mut engine = kept.map_or_else(|| setup.start(), Ok)?;
                engine.set_motion(motion);
                Some(engine)
            }
            None => None,
        };
        *self = Present { stage, setup, inputs, engine };
        Ok(())
    }
}
