//! Copies of the hardware with a fault, which tests must notice.

use hdl_gen::plan::Plan;
use testbench::trial::rtl_sources;
use testbench::verilate::{Built, Verilate};

/// A text with `to` in place of `from`, which must stand in it once: nobody notices a fault that is nowhere. `place` names
/// the text for whoever moved it.
pub fn replaced(place: &str, text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{place}: {from:?} stands there once");
    text.replace(from, to)
}

/// The plan's RTL with a fault in one of its modules, compiled.
pub fn broken(plan: &Plan, module: &str, from: &str, to: &str) -> Built {
    let mut sources = rtl_sources(plan).expect("emitted");
    let file = sources.files.get_mut(&format!("rtl/{module}.v")).expect("a module of the design");
    let text = String::from_utf8_lossy(file);
    *file = replaced(module, &text, from, to).into_bytes();
    Verilate::default().build(&sources).expect("Verilator accepts it")
}
