//! A model for tests: an input that must stay in its range, an output, and a variable whose value panics.

use crate::{Causality, Failure, Logger, Model, Progress, Step, Update, Value, Variable};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

pub const PANICS: u32 = 2;

thread_local! {
    /// How many models this thread has dropped.
    pub static DROPPED: Cell<u32> = const { Cell::new(0) };
}

#[derive(serde::Serialize, serde::Deserialize)]
pub struct Touchy {
    pub x: f64,
}

impl Drop for Touchy {
    fn drop(&mut self) {
        DROPPED.set(DROPPED.get() + 1);
    }
}

impl Model for Touchy {
    fn open(_: &Path) -> Result<Box<dyn Model>, Failure> {
        Ok(Box::new(Touchy { x: 0.0 }))
    }

    fn variables(&self) -> Arc<[Variable]> {
        Arc::new([
            Variable::real(Causality::Input, "x", "1", "input").between(0.0, 1.0, 0.0),
            Variable::real(Causality::Output, "y", "1", "output").from(["x"]),
            Variable::real(Causality::Local, "z", "1", "panic"),
            Variable::time(),
        ])
    }

    fn get(&mut self, reference: u32) -> Result<Value, Failure> {
        assert_ne!(reference, PANICS, "on purpose");
        Ok(Value::Real([self.x, 2.0 * self.x * self.x, 0.0, 0.0][reference as usize]))
    }

    fn set(&mut self, _: u32, value: Value) {
        let Value::Real(x) = value else { panic!("x is real") };
        assert!((0.0..=1.0).contains(&x), "x = {x}");
        self.x = x;
    }

    fn advance(&mut self, _: Step, _: &Logger) -> Result<Progress, Failure> {
        Ok(Progress::Complete)
    }

    fn update(&mut self, _: &Logger) -> Result<Update, Failure> {
        Ok(Update::default())
    }

    crate::state_by_serde!();
}
