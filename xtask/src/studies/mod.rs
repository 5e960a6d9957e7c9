//! Tables of errors, each of a file under `results`.

mod clipped;
mod confidence;
mod contact_kinds;
mod contact_sets;
mod counted_contacts;
mod dead_taxels;
mod drift;
mod finite_elements;
mod layers;
mod noise;
mod recordings;
mod several_contacts;
mod thin_layers;
mod torques;

#[allow(dead_code, reason = "shared with the tests of the solver, which use all of it")]
#[path = "../../../golden/tests/suite/contacts.rs"]
mod contacts;
#[allow(dead_code, reason = "shared with the tests of the other crates")]
#[path = "../../../golden/tests/suite/designs.rs"]
mod designs;
#[allow(dead_code, reason = "shared with the tests of the solver, which use all of it")]
#[path = "../../../golden/tests/suite/separate/kinds.rs"]
mod kinds;
#[allow(dead_code, reason = "shared with the tests of the solver, which use all of it")]
#[path = "../../../golden/tests/suite/recorded/simulated.rs"]
mod simulated;

use std::error::Error;

use golden::design::Design;
use golden::metrics::Quantiles;
use golden::scene::SceneFrame;
use golden::solver::{Solver, SolverError};

use designs::design;

/// What errors depend on: the name of a table.
#[derive(Clone, Copy, clap::ValueEnum)]
pub enum Study {
    /// Noise of a reading, on round sliding contacts.
    Noise,
    /// Frames averaged by sensor.smoothing, on the same contacts.
    Smoothing,
    /// Shares of errors within the standard error, by noise and kind of contact.
    Confidence,
    /// Creep and drift, by correction and time since the touch.
    Drift,
    /// Kinds of contact.
    ContactKinds,
    /// The standard sets of contacts.
    ContactSets,
    /// Layers that differ from the design.
    Layers,
    /// Layers thinner than a pitch (half an hour).
    ThinLayers,
    /// Torques, by kind of contact.
    Torques,
    /// Sensors that read no tension.
    Clipped,
    /// The same, by kind of contact.
    ClippedKinds,
    /// Several contacts, separated.
    SeveralContacts,
    /// Contacts counted by the hardware.
    CountedContacts,
    /// Dead taxels and what replaces them.
    DeadTaxels,
    /// Frames of finite elements, by case.
    FiniteElements,
    /// Frames of finite elements, all cases together.
    FiniteElementsSummary,
    /// Calibrations by recordings with weights.
    Recordings,
}

/// What can fail on any thread, for any reason.
type Fallible<T> = Result<T, Box<dyn Error + Send + Sync>>;
/// The rows of a table.
type Rows = Fallible<String>;

/// The line search and both training sets on the paper's two sensors.
const ESTIMATORS: [&str; 6] =
    ["sensor1-none", "sensor1-fast", "sensor1-wide", "sensor2-none", "sensor2-fast", "sensor2-wide"];

/// A measured table.
pub struct Table {
    /// The designs that it is of, by name.
    pub designs: Vec<(String, Design)>,
    /// Names of its columns.
    pub columns: &'static str,
    /// Its rows, a line each.
    pub rows: String,
}

impl Study {
    /// Whether the caller chooses the designs.
    pub fn takes_designs(self) -> bool {
        matches!(self, Self::Noise | Self::Smoothing | Self::Confidence | Self::Drift)
    }

    /// The table: of these designs, which go by the names of their files, or of its own.
    ///
    /// # Errors
    ///
    /// A sensor without matrices, plan or scenes, or a file that cannot be read.
    pub fn table(self, designs: Vec<(String, Design)>) -> Result<Table, Box<dyn Error + Send + Sync>> {
        let (names, columns, rows): (&[&str], _, _) = match self {
            Self::Noise => (&[], noise::COLUMNS, noise::rows(&designs)),
            Self::Smoothing => (&[], noise::SMOOTHING_COLUMNS, noise::smoothing_rows(&designs)),
            Self::Confidence => (&[], confidence::COLUMNS, confidence::rows(&designs)),
            Self::Drift => (&[], drift::COLUMNS, drift::rows(&designs)),
            Self::ContactKinds => (&ESTIMATORS, contact_kinds::COLUMNS, contact_kinds::rows()),
            Self::ContactSets => (&contact_sets::DESIGNS, contact_sets::COLUMNS, contact_sets::rows()),
            Self::Layers => (&ESTIMATORS, layers::COLUMNS, layers::rows()),
            Self::ThinLayers => (&[], thin_layers::COLUMNS, thin_layers::rows()),
            Self::Torques => (&torques::DESIGNS, torques::COLUMNS, torques::rows()),
            Self::Clipped => (&clipped::DESIGNS, clipped::COLUMNS, clipped::rows()),
            Self::ClippedKinds => (&clipped::KINDS_DESIGNS, clipped::KINDS_COLUMNS, clipped::kinds_rows()),
            Self::SeveralContacts => (&several_contacts::DESIGNS, several_contacts::COLUMNS, several_contacts::rows()),
            Self::CountedContacts => (&counted_contacts::DESIGNS, counted_contacts::COLUMNS, counted_contacts::rows()),
            Self::DeadTaxels => (&dead_taxels::DESIGNS, dead_taxels::COLUMNS, dead_taxels::rows()),
            Self::FiniteElements => (&ESTIMATORS, finite_elements::COLUMNS, finite_elements::rows()),
            Self::FiniteElementsSummary => {
                (&ESTIMATORS, finite_elements::SUMMARY_COLUMNS, finite_elements::summary_rows())
            }
            Self::Recordings => (&[], recordings::COLUMNS, Ok(recordings::rows())),
        };
        let own = names.iter().map(|&name| (name.to_owned(), design(name)));
        Ok(Table { designs: designs.into_iter().chain(own).collect(), columns, rows: rows? })
    }
}

/// The solvers of a sensor, each with what a table calls it.
fn estimators(sensor: &str) -> Result<Vec<(&'static str, Solver)>, SolverError> {
    let estimators = [("none", "line"), ("fast", "sliding"), ("wide", "general")];
    estimators.map(|(kind, name)| Ok((name, Solver::new(&design(&format!("{sensor}-{kind}")))?))).into_iter().collect()
}

/// Length of the error of a tangential force in percent of the normal force.
fn shear_error(found: [f64; 3], truth: [f64; 3]) -> f64 {
    let [x, y] = [0, 1].map(|axis| found[axis] - truth[axis]);
    100.0 * x.hypot(y) / truth[2].abs()
}

/// The same of each frame.
fn shear_errors(solver: &Solver, frames: &[SceneFrame]) -> Result<Vec<f64>, SolverError> {
    frames.iter().map(|frame| Ok(shear_error(solver.solve(&frame.stress)?.resultant, frame.force))).collect()
}

/// Median, 95 % and worst, as cells of a CSV file.
fn cells(errors: Vec<f64>) -> String {
    let Quantiles { median, most, worst } = Quantiles::of(errors);
    format!("{median:.1},{most:.1},{worst:.1}")
}

/// The frames as a sensor reads them that knows no pull.
fn without_tension<'a>(frames: impl Iterator<Item = &'a mut Vec<f64>>) {
    for stress in frames.flatten() {
        *stress = stress.min(0.0);
    }
}
