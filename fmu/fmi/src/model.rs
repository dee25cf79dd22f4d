//! The model: the one trait that an author writes.

use crate::failure::Failure;
use crate::interface::Interface;
use crate::logger::Logger;
use crate::sensitivity;
use crate::variables::{Role, Value, Variable, references, state_references};
use std::path::Path;
use std::sync::Arc;
use uuid::Uuid;

/// A model behind the interfaces of FMI. One value of the type is one instance.
///
/// The unit checks a call before the model sees it: stage, references, types, ranges, counts. A call that the model refuses
/// must leave the model as it was. A host may call an instance from any thread, one call after another.
pub trait Model: Send + 'static {
    /// The model of the FMU whose folder `resources` is this one; the error is a message to the user.
    fn open(resources: &Path) -> Result<Box<dyn Model>, Failure>
    where
        Self: Sized;

    /// The GUID of the FMU, FMI 3.0's instantiation token. FMUs that differ in anything must differ in it: here in the type of
    /// the model and its table of variables.
    fn token(&self) -> String {
        let path = std::any::type_name::<Self>(); // with the name of the crate, which may be a program's or a library's
        let content = format!("{} {:?}", path.rsplit("::").next().unwrap_or(path), self.variables());
        Uuid::new_v5(&Uuid::NAMESPACE_OID, content.as_bytes()).braced().to_string()
    }

    /// The name of FMU states: only states that were written under this name are read. FMUs with other start values
    /// may have the same.
    fn build(&self) -> String {
        self.token()
    }

    /// The table of variables, which stays the same; value references are its positions.
    fn variables(&self) -> Arc<[Variable]>;

    /// The value of a variable; before the start it follows from the values set so far.
    fn get(&mut self, reference: u32) -> Result<Value, Failure>;

    /// The values of real variables: those of [`Model::get`], unless there is a faster way.
    fn get_reals(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Failure> {
        for (reference, value) in references.iter().zip(values) {
            let Value::Real(real) = self.get(*reference)? else { unreachable!("the table says that it is real") };
            *value = real;
        }
        Ok(())
    }

    /// Sets a parameter or an input, within its range, or what the host's integrator has come to: a state or time.
    fn set(&mut self, reference: u32, value: Value);

    /// Sets inputs, real numbers within their ranges: as [`Model::set`], unless there is a faster way.
    fn set_inputs(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        references.iter().zip(values).for_each(|(reference, value)| self.set(*reference, Value::Real(*value)));
        Ok(())
    }

    /// Sets the slopes of inputs over the next step, finite numbers. Without it inputs are held.
    fn set_slopes(&mut self, references: &[u32], _slopes: &[f64]) -> Result<(), Failure> {
        let first = references.first().map(|reference| self.name(*reference));
        first.map_or(Ok(()), |name| Err(Failure::NoInput { name }))
    }

    /// Sets the value that an input has at the end of the step that begins now and lasts `step` (s).
    fn lead(&mut self, reference: u32, value: f64, _step: f64) -> Result<(), Failure> {
        self.set_inputs(&[reference], &[value])
    }

    /// Takes tolerance and times, before the start.
    fn set_up(&mut self, experiment: &Experiment) {
        self.set_time(experiment.start_time, false);
    }

    /// Starts the simulation: what cannot be is refused now.
    fn start(&mut self, _interface: Interface, _log: &Logger) -> Result<(), Failure> {
        Ok(())
    }

    /// The time of the simulation, s: the value of the last variable.
    fn time(&mut self) -> Result<f64, Failure> {
        let last = self.variables().len() as u32 - 1;
        Ok(self.values(&[last])?[0])
    }

    /// Values of real variables.
    fn values(&mut self, references: &[u32]) -> Result<Vec<f64>, Failure> {
        let mut values = vec![0.0; references.len()];
        self.get_reals(references, &mut values)?;
        Ok(values)
    }

    /// Advances over a step of a co-simulation, which begins at `step.start` but for rounding of [`Model::time`].
    fn advance(&mut self, step: StepRequest, log: &Logger) -> Result<StepEnd, Failure>;

    /// Applies what an event brings: the one that a step has ended at, or those up to where the host's integrator is.
    fn update(&mut self, log: &Logger) -> Result<Update, Failure>;

    /// Why the simulation is over, if it is, as a sentence of a message.
    fn ending(&mut self) -> Result<Option<String>, Failure> {
        Ok(None)
    }

    /// Writes all that the future of the simulation depends on at the end of `bytes`.
    fn state(&self, bytes: &mut Vec<u8>);

    /// Goes to a state of [`Model::state`], of a simulation that `has_started` or not. The bytes may be anybody's.
    fn restore(&mut self, bytes: &[u8], has_started: bool) -> Result<(), Failure>;

    /// Rates of real variables by time.
    fn rates(&mut self, references: &[u32], _rates: &mut [f64]) -> Result<(), Failure> {
        Err(Failure::NoOutput { name: self.name(references[0]) })
    }

    /// Derivatives of variables along a direction, given by changes of others.
    fn derivatives(&mut self, of: &[u32], direction: &[(u32, f64)], has_started: bool) -> Result<Vec<f64>, Failure> {
        sensitivity::along(self, of, direction, has_started)
    }

    /// Goes to the `time` (s) of the host's integrator, also at an event.
    fn set_time(&mut self, time: f64, _is_at_event: bool) {
        let last = self.variables().len() as u32 - 1;
        self.set(last, Value::Real(time));
    }

    /// The continuous states, in the order of the table.
    fn states(&mut self) -> Result<Vec<f64>, Failure> {
        self.values(&state_references(&self.variables()).collect::<Vec<_>>())
    }

    /// Goes to the states of the host's integrator.
    fn set_states(&mut self, states: &[f64]) -> Result<(), Failure> {
        let variables = self.variables();
        let references = state_references(&variables);
        references.zip(states).for_each(|(reference, state)| self.set(reference, Value::Real(*state)));
        Ok(())
    }

    /// Usual magnitudes of the states.
    fn nominals(&mut self) -> Result<Vec<f64>, Failure> {
        let variables = self.variables();
        let nominal = |state: u32| variables[state as usize].nominal.unwrap_or(1.0);
        Ok(state_references(&variables).map(nominal).collect())
    }

    /// Derivatives of the states, in their order.
    fn state_rates(&mut self) -> Result<Vec<f64>, Failure> {
        self.values(&references(&self.variables(), |role| matches!(role, Role::RateOf(_))))
    }

    /// The event indicators, in the order of the table.
    fn indicators(&mut self) -> Result<Vec<f64>, Failure> {
        self.values(&references(&self.variables(), |role| *role == Role::Indicator))
    }

    /// The host's integrator has completed a step to where it is.
    fn complete_step(&mut self, _log: &Logger) -> Result<Completed, Failure> {
        Ok(Completed::default())
    }

    /// The host's integrator enters event mode.
    fn arrive_at_event(&mut self) -> Result<(), Failure> {
        Ok(())
    }

    /// The name of a variable.
    fn name(&self, reference: u32) -> String {
        self.variables()[reference as usize].name.to_string()
    }
}

/// Tolerance and times that a host gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Experiment {
    /// Relative tolerance.
    pub tolerance: Option<f64>,
    /// Start time, s.
    pub start_time: f64,
    /// Time that is not exceeded, s.
    pub stop_time: Option<f64>,
}

/// A step of a co-simulation.
#[derive(Clone, Copy, Debug)]
pub struct StepRequest {
    /// The start of the step by the host's clock, s.
    pub start: f64,
    /// The duration of the step, s.
    pub duration: f64,
    /// Whether it ends at the first event on it, which [`Model::update`] then applies.
    pub stops_at_events: bool,
}

/// How a step has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepEnd {
    /// At its end.
    Complete,
    /// With the simulation: [`Model::ending`] says why.
    Ended,
    /// At an event.
    Event,
}

/// The result of an event.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Update {
    /// Whether the simulation is over.
    pub has_ended: bool,
    /// Whether the states differ from those that the host set.
    pub has_new_states: bool,
    /// The instant of the next event that can be foreseen, s.
    pub next_event: Option<f64>,
}

/// The result of a complete step of the host's integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Completed {
    /// Whether there is an event to be dealt with.
    pub needs_event_mode: bool,
    /// Whether the simulation is over.
    pub has_ended: bool,
}
