//! Work without the GIL, which Ctrl-C interrupts. Other threads of Python run meanwhile.

use crate::arguments::refused;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rocking::run::Runs;
use rocking::{Piece, Watch};
use rocking_report::run::Watcher;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How long a signal, such as Ctrl-C, may have to wait.
pub const MOMENT: Duration = Duration::from_millis(50);

/// Message of the error that stands for a panic. The standard error has the message of the panic itself.
pub const FAULT: &str = "a fault of flexible_rocking itself, which is printed above: please report it";

/// Tells the work that nobody waits for its result any more. As the watcher of a run, ends the run then.
#[derive(Clone, Default)]
pub struct Abandoned(Arc<AtomicBool>);

impl Watcher for Abandoned {
    fn check(&self) {
        if self.0.load(Ordering::Relaxed) {
            resume_unwind(Box::new("abandoned")); // which prints nothing
        }
    }
}

impl<Q: Runs> Watch<Q> for Abandoned {
    fn piece(&mut self, _: &Piece<Q>) {
        self.check();
    }
}

/// Does `work` on a thread of its own and returns its result. A signal ends the wait for the result at once, and ends the work at
/// the next check. A panic of the work is an error.
pub fn interruptible<T: Send + 'static, E: Into<anyhow::Error> + Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&mut Abandoned) -> Result<T, E> + Send + 'static,
) -> PyResult<T> {
    let (done, result) = mpsc::channel();
    let abandoned = Abandoned::default();
    let mut watching = abandoned.clone();
    thread::Builder::new().spawn(move || done.send(work(&mut watching)))?;
    py.detach(move || {
        loop {
            match result.recv_timeout(MOMENT) {
                Ok(result) => return result.map_err(refused),
                Err(RecvTimeoutError::Timeout) => {
                    if let Some(Err(signal)) = Python::try_attach(|py| py.check_signals()) {
                        abandoned.0.store(true, Ordering::Relaxed);
                        return Err(signal);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err(FAULT));
                }
            }
        }
    })
}
