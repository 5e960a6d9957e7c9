//! Plays stimulus into modules on a bench of their own, `bench.v` with a port `clock`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use testbench::tools;
use testbench::verilate::{cxx_optimisation, one_unit, verilator_version};

use super::faults::replaced;
use super::{library_file, library_folders, look_in};

/// Verilator's runtime and its precompiled headers, once for all benches: with them a bench takes a fourth of the time.
static RUNTIME: LazyLock<PathBuf> = LazyLock::new(|| {
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let version = verilator_version().expect("installed").replace(' ', "-");
    let runtime = kept.join(format!("{version}{}", FLAGS.concat()));
    if !runtime.is_dir() {
        let folder = tempfile::tempdir_in(kept).expect("writable");
        let include = tools::verilator_root().expect("installed").join("include");
        let objects = ["verilated", "verilated_threads"].map(|name| {
            succeed(compiler().arg("-c").arg(include.join(format!("{name}.cpp"))).current_dir(&folder));
            format!("{name}.o")
        });
        succeed(Command::new("ar").args(["rcs", "runtime.a"]).args(objects).current_dir(&folder));
        fs::write(folder.path().join("runtime.h"), "#include \"verilated.h\"\n").expect("writable");
        succeed(compiler().args(["-x", "c++-header", "runtime.h"]).current_dir(&folder));
        // Whole or not at all: another process may look for it, or have been faster.
        if fs::rename(folder.path(), &runtime).is_ok() {
            let _ = folder.keep();
        }
    }
    runtime
});

/// A header is precompiled for the flags of whoever includes it.
static FLAGS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    let optimisation = cxx_optimisation().expect("installed");
    ["-std=c++17", "-w"].into_iter().chain(optimisation).collect()
});

fn compiler() -> Command {
    let include = tools::verilator_root().expect("installed").join("include");
    let mut compiler = tools::cxx().expect("installed");
    compiler.args(&*FLAGS).arg("-I").arg(&include).arg("-I").arg(include.join("vltstd"));
    compiler
}

/// A copy of one of the project's modules with a fault, in a bench's folder, where it goes ahead of the right one.
pub fn write_broken(folder: &Path, module: &str, from: &str, to: &str) {
    let name = format!("{module}.v");
    let text = fs::read_to_string(library_file(module)).expect("is there");
    fs::write(folder.join(name), replaced(module, &text, from, to)).expect("writable");
}

/// Runs `bench.v` and the modules of a folder, those of the project where it has none, for so many cycles. Registers
/// begin with bits at random, the same in each run: most of what is read before it is written shows.
///
/// # Errors
/// What is printed, where a check of a module stops the run.
pub fn verilator(folder: &Path, cycles: usize) -> Result<(), String> {
    let main = format!(
        "#include \"Vbench.h\"\nint main() {{\n    Verilated::randReset(2);\n    Vbench bench;\n    for (long edge = 0; edge < 2L * {cycles}; ++edge) {{\n        \
         bench.clock = edge & 1;\n        bench.eval();\n    }}\n    bench.final();\n}}\n"
    );
    // A main of its own turns the clock: no coroutines, which delays would need.
    let mut translate = tools::verilator().expect("installed");
    translate.args(["--cc", "--x-assign", "unique", "--x-initial", "unique", "-Wno-fatal", "-DSIMULATION"]);
    translate.args(["--no-decoration", "--top-module", "bench"]);
    translate.args(["--Mdir", "model", "-y", "."]).args(look_in(library_folders())).arg("bench.v");
    succeed(translate.current_dir(folder));
    let unit = one_unit(&folder.join("model"), &main).expect("readable");
    fs::write(folder.join("main.cpp"), unit).expect("writable");
    let mut build = compiler();
    build
        .arg("-include")
        .arg(RUNTIME.join("runtime.h"))
        .args(["-I", "model", "main.cpp"])
        .arg(RUNTIME.join("runtime.a"));
    succeed(build.args(["-o", "bench", "-lpthread"]).current_dir(folder));
    run(Command::new(folder.join("bench")).current_dir(folder))
}

fn succeed(command: &mut Command) {
    run(command).unwrap_or_else(|printed| panic!("{command:?}: {printed}"));
}

fn run(command: &mut Command) -> Result<(), String> {
    let output = command.output().expect("starts");
    let printed = || format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(()) } else { Err(printed()) }
}
