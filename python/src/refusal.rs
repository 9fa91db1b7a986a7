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
    PyValueError::new_err(in_python(&error.to_string()))
}

/// Values of options that may stand behind one in a text.
const VALUES: [&str; 4] = ["all", "auto", "no", "yes"];

/// A text that names options as the command line spells them, with the parameters of Python instead: `--tri-eps`
/// becomes `tri_eps=`, and `--models auto` becomes `models="auto"`.
pub fn in_python(text: &str) -> String {
    let mut parts = text.split("--");
    let mut told = parts.next().unwrap_or_default().to_string();
    for part in parts {
        let is_name = |c: char| c.is_ascii_lowercase() || c == '-';
        let end = part.find(|c| !is_name(c)).unwrap_or(part.len());
        let (name, rest) = part.split_at(end);
        if name.is_empty() {
            told.push_str("--");
        } else {
            told.push_str(&name.replace('-', "_"));
            told.push('=');
        }
        let word = rest.strip_prefix(' ').unwrap_or_default();
        let value = word.split(|c: char| !c.is_alphanumeric()).next();
        match value.filter(|value| !name.is_empty() && VALUES.contains(value)) {
            Some(value) => {
                told.push_str(&format!("{value:?}"));
                told.push_str(&word[value.len()..]);
            }
            None => told.push_str(rest),
        }
    }
    told
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
        "advice": in_python(&refusal.advice.to_string()),
        "attempts": refusal.attempts,
    })
}

fn fault(fault: &Fault) -> Value {
    let places = fault.rows.iter().map(|row| json!({ "point": row }));
    json!({
        "kind": fault.kind,
        "text": in_python(&fault.to_string()),
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
    all["text"] = in_python(&violation.to_string()).into();
    all["advice"] = in_python(violation.advice).into();
    all
}
