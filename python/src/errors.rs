//! Errors as exceptions, with the text of the command line.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

pyo3::create_exception!(
    sptfra,
    Error,
    PyValueError,
    "What is wrong with a design, with frames, or with a file: what, where, and what to do."
);

/// An error as an exception, in the words of the command line.
pub fn raised(error: impl std::fmt::Display) -> PyErr {
    Error::new_err(error.to_string())
}

/// Does long work without the interpreter's lock. A panic in it is a fault of this package and becomes an exception
/// that says so.
///
/// # Errors
///
/// Those of the work, a `RuntimeError` after a panic, and what Python's signals raised if the work gave up by
/// [`Interrupted`].
pub fn without_lock<T: Send, E: std::fmt::Display + Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, E> + Send,
) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(work))) {
        Ok(result) => result.map_err(raised),
        Err(panic) => match panic.downcast::<Interrupted>() {
            Ok(interrupted) => Err(interrupted.0),
            Err(panic) => Err(PyRuntimeError::new_err(format!(
                "sptfra has failed inside, which is a fault of the package, not of your data: {}",
                words(panic.as_ref())
            ))),
        },
    }
}

/// Why work that cannot be ended otherwise was unwound.
pub struct Interrupted(PyErr);

/// Gives up the work around it if Python has a signal, such as Ctrl-C, or if `report` raises. To be called in the work of
/// [`without_lock`], on its own thread.
pub fn look_up(report: impl FnOnce(Python<'_>) -> PyResult<()>) {
    let asked = Python::attach(|py| py.check_signals().and_then(|()| report(py)));
    if let Err(error) = asked {
        // Not a panic: nothing is printed.
        std::panic::resume_unwind(Box::new(Interrupted(error)));
    }
}

fn words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no reason given")
}
