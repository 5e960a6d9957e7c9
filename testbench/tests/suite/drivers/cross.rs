//! The C driver, the program for Linux and the example without a system, compiled for the processors of the boards.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{CALIBRATION, DRIVER, FILES, FORCES};
use crate::support::workspace;

/// For the processors of the boards, where their compilers are: the driver, the program for Linux linked, and the barriers
/// that only these processors have.
#[test]
fn the_c_driver_compiles_for_the_boards_and_has_their_barriers() {
    let folder = tempfile::tempdir().expect("a folder");
    let sources: Vec<PathBuf> =
        DRIVER.into_iter().chain(CALIBRATION).chain(FILES).chain(FORCES).map(workspace).collect();
    for target in ["aarch64-linux-gnu", "arm-linux-gnueabihf"] {
        let Ok(found) = Command::new(format!("{target}-gcc")).arg("--version").output() else {
            eprintln!("no {target}-gcc: not looked at (make tools)");
            continue;
        };
        assert!(found.status.success(), "{target}");
        let program = folder.path().join(target);
        let mut compiler = Command::new(format!("{target}-gcc"));
        compiler.args(["-std=c11", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-D_POSIX_C_SOURCE=200809L"]);
        compiler.arg("-I").arg(workspace("drivers/c")).arg("-I").arg(workspace("drivers/c/examples"));
        compiler.args(&sources).arg(workspace("drivers/c/examples/linux.c")).arg("-o").arg(&program).arg("-lm");
        let made = compiler.output().expect("starts");
        assert!(made.status.success() && made.stderr.is_empty(), "{}", String::from_utf8_lossy(&made.stderr));
        let shown = Command::new(format!("{target}-objdump")).arg("-d").arg(&program).output().expect("starts");
        let text = String::from_utf8_lossy(&shown.stdout).into_owned();
        // In the code of what orders buffers and registers: before a transfer, behind an answer, around descriptors.
        let functions: Vec<&str> = text.split("\n\n").filter(|function| function.contains("\tdsb\t")).collect();
        for name in ["<hand_over", "<sptfra_wait>:", "<sptfra_queue_take>:", "<send>:"] {
            assert!(functions.iter().any(|function| function.contains(name)), "{target}: no dsb in {name}");
        }
        bare_metal(target, folder.path());
    }
}

/// The example without a system with the board's side of it, above headers that declare what it takes of AMD's platform.
fn bare_metal(target: &str, folder: &Path) {
    let cache = "#include <stdint.h>\ntypedef intptr_t INTPTR;\nvoid Xil_DCacheFlushRange(INTPTR start, INTPTR bytes);\n\
                 void Xil_DCacheInvalidateRange(INTPTR start, INTPTR bytes);\n";
    fs::write(folder.join("xil_cache.h"), cache).expect("written");
    fs::write(folder.join("xil_printf.h"), "void xil_printf(const char *format, ...);\n").expect("written");
    let mut compiler = Command::new(format!("{target}-gcc"));
    compiler.args(["-std=c11", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-c"]);
    compiler.args(["-DSPTFRA_NO_UIO", "-DBOARD_H=\"zynq.h\"", "-I"]).arg(workspace("drivers/c")).arg("-I").arg(folder);
    compiler.arg(workspace("drivers/c/examples/bare_metal.c")).args(DRIVER.map(workspace)).current_dir(folder);
    let made = compiler.output().expect("starts");
    assert!(made.status.success() && made.stderr.is_empty(), "{}", String::from_utf8_lossy(&made.stderr));
}
