//! Simulates the emitted RTL and checks it: Verilator builds it, Rust drives its AXI-Streams, the integer model and
//! the f64 solver judge the result.

pub mod accuracy;
pub mod calibration_page;
pub mod co_simulation;
pub mod compare;
pub mod dut;
pub mod field_plot;
pub mod figures;
pub mod frame_set;
pub mod registers;
pub mod run;
pub mod simulate;
pub mod stream;
pub mod stream_words;
pub mod svg;
pub mod sweep;
pub mod tools;
pub mod verilate;
pub mod view;
pub mod waves;
