//! Errors of Crosscap as exceptions of Python.

use crosscap::refusal::{Fault, Refusal};
use crosscap_algorithms::certificate::Violation;
use crosscap_core::Error;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::fmt::Display;

/// What is wrong with an argument or a file: `ValueError`.
pub fn bad_value(error: &impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// `ValueError` for bad input, `crosscap.Refusal` for a method that failed on this data.
pub fn raised(py: Python<'_>, error: Error) -> PyErr {
    if error.is_input() {
        return bad_value(&error);
    }
    let refusal = told(&Refusal::of(Err(error), None, None)).to_string();
    let made = || -> PyResult<PyErr> {
        let make = py.import("crosscap._refusal")?.getattr("refusal")?;
        make.call1((refusal,)).map(PyErr::from_value)
    };
    made().unwrap_or_else(|error| error)
}

/// A refusal: its reasons, the advice, what was tried.
pub fn told(refusal: &Refusal) -> Value {
    json!({
        "reasons": refusal.faults.iter().map(fault).collect::<Value>(),
        "advice": refusal.advice.to_string(),
        "attempts": refusal.attempts,
    })
}

fn fault(fault: &Fault) -> Value {
    let places = fault.rows.iter().map(|row| json!({ "point": row }));
    json!({
        "kind": fault.kind,
        "text": fault.to_string(),
        "count": fault.count,
        "places": places.collect::<Value>(),
        "coordinates": fault.worst.as_ref().map(|worst| &worst.coordinates),
        "measure": fault.measure,
    })
}

/// A violation of the certificate as a reason.
pub fn violation(violation: &Violation) -> Value {
    let mut all = json!(violation);
    all["level"] = json!(violation.kind.level());
    all["text"] = violation.to_string().into();
    all
}
