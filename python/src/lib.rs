//! The Python package's native part: thin calls of the crates `golden`, `hdl-gen`, `testbench` and `sptfra`.
//!
//! Long work runs without the interpreter's lock. Arrays are copied on their way in, so that nobody changes them
//! meanwhile; those on the way out are made here and handed over. The package's other half, with the classes that hold
//! results, is Python: `sptfra/`.

#![allow(clippy::needless_pass_by_value, reason = "pyo3 makes arguments and hands them over")]

mod arrays;
mod calibrate;
mod command;
mod design;
mod errors;
mod hardware;
mod inputs;
mod recorded;
mod solver;

/// The module `sptfra._native`.
#[pyo3::pymodule(name = "_native")]
mod native {
    #[pymodule_export]
    use super::calibrate::calibrate;
    #[pymodule_export]
    use super::command::command;
    #[pymodule_export]
    use super::design::Design;
    #[pymodule_export]
    use super::errors::Error;
    #[pymodule_export]
    use super::hardware::{generate, inspect, simulate};
    #[pymodule_export]
    use super::inputs::{FrameLines, beyond, check, errors, load_frames, scene, unloaded};
    #[pymodule_export]
    use super::recorded::calibrate_recorded;
    #[pymodule_export]
    use super::solver::{Past, Solver};
}
