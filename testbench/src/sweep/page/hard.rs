//! The hard cases on the page: their table, and what regularisation does to deep sensors.

use serde::Serialize;

use super::matrices::Figure;
use crate::hard::cases::NOISE;
use crate::hard::judge::Row;
use crate::hard::plot::{self, FORCES};
use crate::hard::tables::{Group, groups};

/// The section.
#[derive(Clone, Debug, Serialize)]
pub struct Section {
    depths: Vec<Figure>,
    groups: Vec<Group>,
    refusals: Vec<String>,
}

/// The section of rows.
pub fn section(rows: &[Row]) -> Section {
    let groups = groups(rows);
    let refusals = groups.iter().flat_map(|group| group.refusals.clone()).collect();
    let depths = FORCES
        .iter()
        .map(|force| Figure {
            svg: plot::of(rows, force),
            caption: format!(
                "largest error of the {} in f64 over depth / pitch, with {} % of noise; a line ends where the design is \
                 refused, triangles are beyond the plot",
                force.name,
                100.0 * NOISE
            ),
        })
        .collect();
    Section { depths, groups, refusals }
}
