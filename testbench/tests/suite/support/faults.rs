//! Copies of the hardware with a fault, which tests must notice.

use std::fs;

use hdl_gen::plan::Plan;
use testbench::co_simulation::rtl_sources;
use testbench::verilate::{Built, Verilate};

use super::effort::some_of;
use super::library_file;

/// Some faults of modules of the library. The text of each is looked for, also of those that only `make test-long`
/// tries. `place` gives a fault's module and that text.
pub fn some_faults<T>(faults: impl IntoIterator<Item = T>, place: impl Fn(&T) -> (&str, &str)) -> Vec<T> {
    let faults: Vec<T> = faults.into_iter().collect();
    for (module, from) in faults.iter().map(place) {
        replaced(module, &fs::read_to_string(library_file(module)).expect("readable"), from, "");
    }
    some_of(faults)
}

/// The same of faults of a driver.
pub fn some_faults_of<'a, const N: usize>(text: &str, faults: [(&'a str, &'a str); N]) -> Vec<(&'a str, &'a str)> {
    for (from, to) in faults {
        replaced("the driver", text, from, to);
    }
    some_of(faults)
}

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
