//! Runs beside the interpreter: it goes on meanwhile, shows progress, and can stop them.

use crate::refusal::raised;
use crosscap_backends::interrupt::Interrupt;
use crosscap_core::Error;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// How often the interpreter is asked whether a signal has come, Ctrl-C for one.
const SIGNALS: Duration = Duration::from_millis(50);

/// A run and what may end it early: a signal, or an exception in a plug-in.
#[derive(Clone, Default)]
pub struct Run {
    interrupt: Interrupt,
    exception: Arc<Mutex<Option<PyErr>>>,
}

impl Run {
    /// What the run has to heed.
    pub fn interrupt(&self) -> Interrupt {
        self.interrupt.clone()
    }

    /// Keeps the first exception, and asks the run to stop.
    pub fn stop_with(&self, exception: PyErr) {
        if let Ok(mut first) = self.exception.lock() {
            first.get_or_insert(exception);
        }
        self.interrupt.request();
    }

    /// Does `work` with the interpreter; an exception becomes that of the run.
    ///
    /// # Errors
    /// [`Error::Interrupted`] for an exception.
    pub fn attached<T>(&self, work: impl FnOnce(Python<'_>) -> PyResult<T>) -> Result<T, Error> {
        Python::attach(work).map_err(|exception| {
            self.stop_with(exception);
            Error::Interrupted
        })
    }

    /// Keeps the first exception, and leaves the run.
    pub fn leave_with(&self, exception: PyErr) {
        self.stop_with(exception);
        self.interrupt.heed();
    }

    /// The exception that stopped the run.
    pub fn take_exception(&self) -> Option<PyErr> {
        self.exception.lock().ok()?.take()
    }

    /// Does `work` in a thread of its own, without the interpreter, and calls `told` with what it sends
    /// through its channel. `work` has to be guarded by [`Run::interrupt`].
    pub fn wait<T: Send>(
        &self,
        py: Python<'_>,
        mut told: impl FnMut(String) -> PyResult<()>,
        work: impl FnOnce(Sender<String>) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let (send, receive) = channel();
        let result = std::thread::scope(|scope| {
            let worker = scope.spawn(move || work(send));
            self.watch(py, receive, &mut told);
            py.detach(|| worker.join())
        });
        let result = result.unwrap_or_else(|panic| resume_unwind(panic));
        if let Some(exception) = self.take_exception() {
            return Err(exception);
        }
        result.map_err(|error| match error {
            Error::Interrupted => PyKeyboardInterrupt::new_err(error.to_string()),
            other => raised(py, other),
        })
    }

    /// Until the sender is gone.
    fn watch(
        &self,
        py: Python<'_>,
        mut receive: Receiver<String>,
        told: &mut dyn FnMut(String) -> PyResult<()>,
    ) {
        loop {
            let next;
            (receive, next) = py.detach(move || {
                let next = receive.recv_timeout(SIGNALS);
                (receive, next)
            });
            let shown = match next {
                Ok(text) => told(text),
                Err(RecvTimeoutError::Timeout) => Ok(()),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            if let Err(exception) = shown.and_then(|()| py.check_signals()) {
                self.stop_with(exception);
            }
        }
    }
}
