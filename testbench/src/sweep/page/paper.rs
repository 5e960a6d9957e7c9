//! What the paper prints (Pinto-Salamanca et al., Sensors 2024), as printed.

/// A row of Table 1: the entries that a filter keeps of each matrix, and the mean friction coefficient.
#[derive(Clone, Copy, Debug)]
pub struct Table1Row {
    /// Number of the sensor.
    pub sensor: usize,
    /// The filter as the paper names it.
    pub name: &'static str,
    /// The filter as [`crate::sweep::point::Point::filter`] has it whose counts these are.
    pub filter: &'static str,
    /// Entries in the order of [`golden::matrices::MatrixName::ALL`].
    pub nnz: [usize; 13],
    /// Mean of the friction coefficients; the true one is 0.5.
    pub mean_mu: f64,
}

const fn row(sensor: usize, name: &'static str, filter: &'static str, nnz: [usize; 13], mean_mu: f64) -> Table1Row {
    Table1Row { sensor, name, filter, nnz, mean_mu }
}

/// Table 1. Sensor 2's counts for p = 30 are those of p = 20, and the 7395 of its F3 belongs to no filter.
pub const TABLE_1: [Table1Row; 12] = [
    row(1, "none", "none", [10_000; 13], 0.56),
    row(1, "F1 L = 40", "f1 l=40", [8360; 13], 0.59),
    row(1, "F1 L = 50", "f1 l=50", [7450; 13], 0.60),
    row(
        1,
        "F2 p = 30",
        "f2 p=30",
        [4512, 9462, 7966, 6876, 9548, 10_000, 9400, 8938, 9400, 9412, 10_000, 9550, 8934],
        0.59,
    ),
    row(
        1,
        "F2 p = 50",
        "f2 p=50",
        [5180, 9522, 8552, 7684, 9568, 10_000, 9502, 9320, 9490, 9676, 10_000, 9568, 9326],
        0.59,
    ),
    row(1, "F3", "f3", [4512, 8360, 8360, 6876, 8360, 8360, 8360, 8360, 8360, 8360, 8360, 8360, 8360], 0.49),
    row(2, "none", "none", [10_000; 13], 0.49),
    row(2, "F1 L = 40", "f1 l=40", [8360; 13], 0.50),
    row(2, "F1 L = 50", "f1 l=50", [7450; 13], 0.50),
    row(
        2,
        "F2 p = 30 (they are those of p = 20)",
        "f2 p=20",
        [4036, 9294, 9294, 5388, 9360, 9932, 9146, 9360, 9146, 9932, 10_000, 9362, 9362],
        0.51,
    ),
    row(
        2,
        "F2 p = 50",
        "f2 p=50",
        [5348, 9430, 9430, 7588, 9440, 9968, 9196, 9440, 9196, 9968, 10_000, 9442, 9442],
        0.50,
    ),
    row(2, "F3", "f3", [5732, 8360, 8360, 8360, 8360, 8360, 7395, 8360, 8360, 8360, 8360, 8360, 8360], 0.50),
];

/// A row of Table 3.
#[derive(Clone, Copy, Debug)]
pub struct Table3Row {
    /// Number of the sensor.
    pub sensor: usize,
    /// The paper's name of it.
    pub name: &'static str,
    /// The filter as [`crate::sweep::point::Point::filter`] has it.
    pub filter: &'static str,
    /// Whether it is software on a laptop.
    pub software: bool,
    /// Largest errors in percent, in the order of [`golden::metrics::ERROR_NAMES`].
    pub max: [f64; 5],
    /// Standard errors in percent.
    pub standard_error: [f64; 5],
    /// Average response time in milliseconds.
    pub milliseconds: f64,
}

const fn errors(
    sensor: usize,
    (name, filter, software): (&'static str, &'static str, bool),
    max: [f64; 5],
    standard_error: [f64; 5],
    milliseconds: f64,
) -> Table3Row {
    Table3Row { sensor, name, filter, software, max, standard_error, milliseconds }
}

/// Table 3.
pub const TABLE_3: [Table3Row; 8] = [
    errors(1, ("SW 1", "none", true), [5.94, 3.44, 10.93, 9.41, 1.64], [2.04, 1.13, 1.35, 3.64, 0.50], 28.56),
    errors(1, ("HW 1", "none", false), [5.95, 3.45, 11.87, 9.42, 1.93], [2.03, 1.13, 1.35, 2.75, 0.50], 28.76),
    errors(1, ("HW 1F1L40", "f1 l=40", false), [7.45, 4.79, 10.83, 12.15, 1.93], [1.93, 1.07, 1.27, 2.77, 0.50], 51.27),
    errors(1, ("HW 1F3", "f3", false), [7.70, 4.17, 12.57, 14.67, 1.93], [1.81, 0.85, 1.30, 3.59, 0.50], 51.49),
    errors(2, ("SW 2", "none", true), [7.84, 5.44, 2.69, 4.46, 3.16], [1.73, 1.84, 1.02, 2.82, 0.69], 21.53),
    errors(2, ("HW 2", "none", false), [6.12, 5.90, 3.66, 8.97, 2.20], [1.69, 1.83, 1.02, 2.21, 0.68], 25.96),
    errors(2, ("HW 2F2p50", "f2 p=50", false), [5.51, 5.92, 3.37, 9.01, 2.20], [1.60, 1.88, 1.05, 2.23, 0.68], 58.52),
    errors(2, ("HW 2F3", "f3", false), [6.12, 5.91, 3.67, 8.99, 2.20], [1.68, 1.84, 1.04, 2.19, 0.68], 58.68),
];
