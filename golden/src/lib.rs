//! Physics and reference solver of a tactile sensor that finds three-axis forces from normal stress alone.
//!
//! The method is that of Pinto-Salamanca et al., Sensors 2024, 24, 7829. Everything here is computed in `f64`:
//! `[hardware]` of a design is checked, and no bit width in it changes a result. A sensor geometry gives the 13
//! matrices of the method, a filter makes them sparse, and the solver turns one frame of normal stress into a force
//! for each taxel, the resultant, and the friction state. Scenes with known forces give frames to check the result
//! against.
//!
//! ```
//! use golden::{design::Design, solver::Solver};
//!
//! let text = "format = 3\nname = \"pad\"\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
//!             [algorithm]\nestimator = \"line\"\n";
//! let design = Design::from_toml(text, "pad.toml")?;
//! let solver = Solver::new(&design)?;
//! let frame = vec![-1000.0; 12];
//! let solution = solver.solve(&frame)?;
//! assert!(solution.resultant[2] < 0.0, "compression means that the object presses");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Conventions, everywhere: taxel `i = iy * columns + ix` lies at `(ix * pitch_x, iy * pitch_y)`; SI units
//! (millimetres only in files); stress is positive in tension and **negative in compression**; `f_z < 0`
//! presses on the sensor and `(f_x, f_y)` is the force the object exerts along the surface.

pub mod bank;
pub mod calibrate;
pub mod check;
pub mod contacts;
pub mod creep;
pub mod crosstalk;
pub mod dead_taxels;
pub mod design;
pub mod estimators;
pub mod filter;
pub mod float;
pub mod forces;
pub mod frames;
pub mod geometry;
pub mod half_space;
pub mod kernel;
pub mod matrices;
pub mod metrics;
pub mod missing_file;
pub mod names;
pub mod numbers;
pub mod output;
pub mod parity;
pub mod products;
pub mod progress;
pub mod reduced;
pub mod resolved;
pub mod scene;
pub mod sensor;
mod separator;
pub mod smoothing;
pub mod solver;
pub mod status;
mod sums;
pub mod table;
pub mod tune_filter;
mod units;
pub mod unloaded;
pub mod words;
