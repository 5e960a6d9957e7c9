//! The hardware: planned, written, simulated.

use std::error::Error;
use std::path::{Path, PathBuf};

use hdl_gen::emit::emit;
use hdl_gen::inspection::{figures, warnings};
use hdl_gen::plan::{Plan, PlanError};
use hdl_gen::write::{check_folder, write_folder};
use pyo3::prelude::*;
use serde_json::json;
use testbench::co_simulation::{CoSimulation, planned};
use testbench::stream_words::{decode, packets};

use crate::arrays::{Forces, Frames};
use crate::design::Design;
use crate::errors::without_lock;

/// The figures of `sptfra inspect --json`, and what to warn of, as JSON.
#[pyfunction]
pub fn inspect(py: Python<'_>, design: &Design) -> PyResult<String> {
    let design = &design.inner;
    let plan = without_lock(py, || Plan::new(design).map_err(|error| named(design, &error)))?;
    Ok(json!({ "figures": figures(&plan), "warnings": warnings(&plan), "clock_mhz": design.hardware.clock_mhz })
        .to_string())
}

/// Writes the folder of the hardware; returns it and what to warn of.
#[pyfunction]
#[pyo3(signature = (design, folder = None))]
pub fn generate(py: Python<'_>, design: &Design, folder: Option<PathBuf>) -> PyResult<(PathBuf, Vec<String>)> {
    let design = &design.inner;
    let folder = folder.unwrap_or_else(|| Path::new("rtl-out").join(&design.name));
    let warnings = without_lock(py, || {
        let said = |error: &dyn Error| error.to_string();
        // Before the work rather than after it.
        check_folder(&folder).map_err(|error| said(&error))?;
        let plan = Plan::new(design).map_err(|error| named(design, &error))?;
        write_folder(&folder, &emit(&plan).map_err(|error| said(&error))?).map_err(|error| said(&error))?;
        Ok::<_, String>(warnings(&plan))
    })?;
    Ok((folder, warnings))
}

/// Builds the core with Verilator and sends frames through it in all stream modes; returns the core's forces and, as
/// JSON, whether every word was the model's, and the cycles.
#[pyfunction]
#[pyo3(signature = (design, frames, *, seed = 1))]
pub fn simulate<'py>(
    py: Python<'py>,
    design: &Design,
    frames: &Bound<'py, PyAny>,
    seed: u32,
) -> PyResult<(Bound<'py, PyAny>, String)> {
    let design = &design.inner;
    let frames = Frames::of(design, frames)?;
    let (forces, report) = without_lock(py, || {
        let said = |error: &dyn Error| error.to_string();
        let plan = planned(design).map_err(|error| said(&error))?;
        let co_simulation = CoSimulation::new(&plan, packets(plan.streams(), &frames.rows()), seed);
        let verdict = co_simulation.run().map_err(|error| said(&error))?;
        let report = json!({
            "bit_exact": verdict.simulation.is_exact(),
            "latency_cycles": verdict.simulation.cycles.latency,
            "interval_cycles": verdict.simulation.cycles.interval,
            "predicted_latency_cycles": verdict.predicted.latency,
            "predicted_interval_cycles": verdict.predicted.interval,
            "clock_mhz": design.hardware.clock_mhz,
            "faults": verdict.faults(),
        });
        let mut forces = Forces::zeros(&design.sensor, frames.count(), 0, plan.field_words() > 0);
        let mut places = forces.pieces();
        for (index, words) in verdict.simulation.answers.iter().enumerate() {
            // An answer of another length is a fault already; its forces stay zeros.
            if let Some(answer) = decode(words) {
                let place = (index / golden::solver::PIECE, index % golden::solver::PIECE);
                places[place.0].put(place.1, &answer);
            }
        }
        drop(places);
        Ok::<_, String>((forces, report.to_string()))
    })?;
    Ok((forces.into_python(py)?, report))
}

fn named(design: &golden::design::Design, error: &PlanError) -> String {
    format!("{}: {error}", design.name)
}
