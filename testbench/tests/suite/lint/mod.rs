//! What other tools say of the emitted Verilog: not one warning.

mod designs;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::iter;
use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;

use self::designs::designs;
use crate::support::effort::{self, some_of};
use crate::support::{icarus, random};
use crate::support::{in_parallel, library_folders, look_in, planned, shipped};
use golden::design::Design;
use hdl_gen::emit::{FileMap, Options, emit_for};
use tempfile::TempDir;
use testbench::tools;

const RANDOM_DESIGNS: u64 = 20;
/// Designs with nets marked for a logic analyser, one for every kind of core.
const MARKED: [&str; 5] = ["curved", "uncorrected", "unpacked", "wide_control", "dropping"];

/// The files of a design.
fn emitted(design: &Design) -> FileMap {
    let options = Options { debug: MARKED.contains(&design.name.as_str()), ..Options::default() };
    emit_for(&planned(design), &options).expect("emitted")
}

/// A design's folder, as `sptfra generate` writes it.
struct Written {
    name: String,
    folder: TempDir,
    /// The modules, one in a file of its name.
    modules: Vec<String>,
}

impl Written {
    fn new(design: &Design) -> Self {
        Self::of(&design.name, &emitted(design))
    }

    fn of(name: &str, files: &FileMap) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        for (path, contents) in files {
            let file = folder.path().join(path);
            fs::create_dir_all(file.parent().expect("a file has a folder")).expect("writable");
            fs::write(file, contents).expect("writable");
        }
        let module = |path: &String| Some(path.strip_prefix("rtl/")?.strip_suffix(".v")?.to_owned());
        Self { name: name.to_owned(), folder, modules: files.keys().filter_map(module).collect() }
    }

    fn read(&self, module: &str) -> String {
        fs::read_to_string(self.folder.path().join(format!("rtl/{module}.v"))).expect("written above")
    }

    fn sources(&self) -> impl Iterator<Item = String> {
        self.modules.iter().map(|module| format!("../rtl/{module}.v"))
    }

    /// Where a tool finds what a module instantiates: in the design, and where this does without a part, in the library.
    /// Nothing else is read.
    fn libraries(&self) -> Vec<PathBuf> {
        look_in(iter::once(self.folder.path().join("rtl")).chain(library_folders()))
    }

    /// Runs a tool beside the ROM files, where the parameter `ROM_DIR` looks for them unless it is set; what the tool
    /// had to say, or its complaint.
    fn run(&self, mut command: Command) -> String {
        let output = command.current_dir(self.folder.path().join("rom")).output().expect("the tool starts");
        let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        if output.status.success() { said.into_owned() } else { format!("{}\n{said}", output.status) }
    }
}

/// All of [`designs`], planned once for all their readers.
fn all() -> Vec<Written> {
    static ALL: LazyLock<Vec<(String, FileMap)>> =
        LazyLock::new(|| in_parallel(&designs(), |design| (design.name.clone(), emitted(design))));
    ALL.iter().map(|(name, files)| Written::of(name, files)).collect()
}

/// Designs that together have every module of the library; in the long tests all.
fn covering(all: &[Written]) -> Vec<&Written> {
    let mut seen = BTreeSet::new();
    let mut adds = |written: &Written| {
        let before = seen.len();
        seen.extend(written.modules.iter().filter(|module| module.starts_with("sptfra_")).cloned());
        seen.len() > before
    };
    all.iter().filter(|written| adds(written) || effort::all()).collect()
}

/// Asserts that the complaints of all designs are none.
fn assert_silent(complaints: Vec<Vec<String>>) {
    let all: Vec<String> = complaints.into_iter().flatten().filter(|text| !text.trim().is_empty()).collect();
    assert!(all.is_empty(), "{}", all.join("\n"));
}

/// Every module that any of the designs has, by a design that has it: in the long tests once for each way in which it
/// stands above other texts, otherwise once, and those of a design alone by its top.
fn tops(all: &[Written]) -> Vec<(&Written, Vec<&str>)> {
    let (mut seen, mut names) = (BTreeSet::new(), BTreeSet::new());
    let mut tops = Vec::new();
    for written in all {
        let mut own = Vec::new();
        let texts: BTreeMap<&str, String> =
            written.modules.iter().map(|module| (module.as_str(), written.read(module))).collect();
        assert!(texts.len() >= 20 && texts.contains_key(written.name.as_str()), "{:?}", written.modules);
        for &top in texts.keys() {
            let mut inside = BTreeMap::new();
            let mut open = vec![top];
            while let Some(module) = open.pop() {
                let text = &texts[module];
                if inside.insert(module, text.clone()).is_none() {
                    let words = text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
                    open.extend(words.filter_map(|word| texts.get_key_value(word)).map(|(&module, _)| module));
                }
            }
            let inside: Vec<(String, String)> =
                inside.into_iter().map(|(name, text)| (name.to_owned(), text)).collect();
            let is_new = seen.insert((top.to_owned(), inside));
            // A module comes in several forms, above modules that designs leave out.
            let is_first = names.insert(top);
            let is_below = !top.starts_with("sptfra_") && top != written.name;
            if is_new && (is_first && !is_below || effort::all()) {
                own.push(top);
            }
        }
        if !own.is_empty() {
            tops.push((written, own));
        }
    }
    let modules: BTreeSet<&str> = all.iter().flat_map(|written| &written.modules).map(String::as_str).collect();
    assert_eq!(names, modules, "every module is there");
    tops
}

#[test]
fn verilator_accepts_every_module_as_a_top() {
    let all = all();
    let tops = tops(&all).into_iter();
    let tops = tops.flat_map(|(written, modules)| modules.into_iter().map(move |module| (written, module)));
    // A design's top has the modules below it, if not with their default parameters.
    let (mut tops, alone): (Vec<_>, Vec<_>) = tops.partition(|(written, module)| written.name == *module);
    let covering: BTreeSet<&str> = covering(&all).into_iter().map(|written| written.name.as_str()).collect();
    tops.retain(|(written, _)| covering.contains(written.name.as_str()));
    tops.extend(some_of(alone));
    assert_silent(in_parallel(&tops, |(written, module)| {
        let mut verilator = tools::verilator().expect("installed");
        // Without its data-flow graph it finds the loops that old releases find.
        verilator.args(["--quiet-stats", "--lint-only", "-Wall", "-fno-dfg", "--top-module", module]);
        verilator.arg(format!("../rtl/{module}.v")).args(written.libraries());
        vec![written.run(verilator)]
    }));
}

/// The system's Verilator, in Debian 12 release 5.006, has no waiver either.
#[test]
fn the_systems_verilator_accepts_every_design() {
    assert_silent(in_parallel(&covering(&all()), |written| {
        let mut verilator = Command::new("verilator");
        verilator.args(["--lint-only", "-Wall", "--top-module", &written.name]).args(written.sources());
        vec![written.run(verilator)]
    }));
}

#[test]
fn icarus_accepts_every_module_as_a_top() {
    assert_silent(in_parallel(&tops(&all()), |(written, modules)| {
        let mut icarus = icarus();
        icarus.args(["-Wall", "-g2005", "-t", "null"]).args(modules.iter().flat_map(|module| ["-s", module]));
        icarus.args(modules.iter().map(|module| format!("../rtl/{module}.v"))).args(written.libraries());
        vec![written.run(icarus)]
    }));
}

#[test]
fn yosys_elaborates_the_top_without_latches_and_loose_wires() {
    assert_silent(in_parallel(&some_of(all()), |written| {
        let script = format!(
            "read_verilog -sv -defer {}; hierarchy -check -top {}; proc; check -assert; \
             select -assert-none t:$dlatch t:$adlatch t:$dlatchsr t:$sr; select -assert-min 1000 t:*",
            written.sources().collect::<Vec<_>>().join(" "),
            written.name
        );
        let mut yosys = tools::yosys().expect("installed");
        yosys.args(["-q", "-p", &script]);
        vec![written.run(yosys)]
    }));
}

/// Read without -defer, every module is elaborated with its default parameters, which name no file.
#[test]
fn yosys_elaborates_default_parameters() {
    let folders = ["axis", "common", "control", "estimator", "intake", "output", "spmv"];
    let files: Vec<String> = folders.iter().map(|folder| format!("rtl/{folder}/*.v")).collect();
    let mut yosys = tools::yosys().expect("installed");
    let script = format!("read_verilog {}; hierarchy -check", files.join(" "));
    yosys.current_dir(crate::support::workspace("hdl-gen")).args(["-q", "-p", &script]);
    let output = yosys.output().expect("runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Read without -defer, from a folder that is not that of the ROM files: the folder has every module that default
/// parameters ask for.
#[test]
fn yosys_reads_a_folder_without_options() {
    assert_silent(in_parallel(&some_of(all()), |written| {
        let mut yosys = tools::yosys().expect("installed");
        yosys.args(["-q", "-p", "read_verilog ../rtl/*.v; hierarchy -check"]);
        yosys.current_dir(written.folder.path().join("mcsr"));
        let output = yosys.output().expect("runs");
        vec![if output.status.success() { String::new() } else { String::from_utf8_lossy(&output.stderr).into_owned() }]
    }));
}

/// Rules of Verible that are not for this Verilog, each with its reason.
const WAIVED: [(&str, &str); 8] = [
    ("explicit-parameter-storage-type", "SystemVerilog: Verilog-2005 has no type of a parameter that is a string"),
    ("explicit-function-task-parameter-type", "SystemVerilog: an argument's type is reg in Verilog-2005"),
    ("explicit-function-lifetime", "the functions here have no state; `automatic` would add nothing"),
    ("always-comb", "SystemVerilog: always_comb"),
    ("unpacked-dimensions-range-ordering", "SystemVerilog: [0:N-1] is how Verilog-2005 declares a memory"),
    ("generate-label-prefix", "wants g_; the labels here begin with gen_"),
    ("parameter-name-style", "constants are in capitals with underscores, such as LAST_COLUMN"),
    ("line-length", "100 columns; the generator's own limit is wider, and widths decide how long a line becomes"),
];

#[test]
fn verible_has_nothing_to_say() {
    let rules: Vec<String> = WAIVED.iter().map(|(rule, _)| format!("-{rule}")).collect();
    // Its rules are of single files: each text once.
    let (all, mut seen) = (all(), BTreeSet::new());
    let of = |written: &Written| -> Vec<String> {
        let texts = written.modules.iter().map(|module| (module, written.read(module)));
        let unseen = texts.filter_map(|(module, text)| seen.insert(text).then(|| format!("../rtl/{module}.v")));
        unseen.collect()
    };
    let files: Vec<Vec<String>> = all.iter().map(of).collect();
    let cases: Vec<_> = all.iter().zip(files).filter(|(_, files)| !files.is_empty()).collect();
    assert_silent(in_parallel(&cases, |(written, files)| {
        let mut verible = tools::program("verible-verilog-lint").expect("installed");
        verible.arg(format!("--rules={}", rules.join(","))).args(files);
        vec![written.run(verible)]
    }));
}

/// slang reads the files as Verilog-2005, with its extra and pedantic warnings and without any waiver.
fn slang(written: &Written) -> String {
    let mut python = tools::program("python").expect("installed");
    python
        .arg(crate::support::workspace("testbench/tests/suite/lint/slang.py"))
        .arg(&written.name)
        .args(written.sources());
    written.run(python)
}

#[test]
fn slang_has_nothing_to_say() {
    assert_silent(in_parallel(&covering(&all()), |written| vec![slang(written)]));
}

/// Widths that no design above has: the whole hierarchy below the top, as it is instantiated, with the checks that only
/// simulations make.
#[test]
fn random_designs_are_clean() {
    let numbers = some_of(0..RANDOM_DESIGNS);
    assert_silent(in_parallel(&numbers, |&number| {
        let plan = random::plan(number).expect("a plan").0;
        let written = Written::new(&plan.design);
        let mut verilator = tools::verilator().expect("installed");
        verilator.args(["--quiet-stats", "--lint-only", "-Wall", "-fno-dfg", "-DSIMULATION"]);
        verilator.args(["--top-module", &written.name]);
        verilator.args(written.sources());
        let mut icarus = icarus();
        icarus.args(["-Wall", "-g2005", "-DSIMULATION", "-t", "null", "-s", &written.name]).args(written.sources());
        [verilator, icarus].map(|tool| written.run(tool)).into_iter().chain([slang(&written)]).collect()
    }));
}

/// The checks above can fail: each tool says something of a module with a latch and an unused input.
#[test]
fn a_latch_is_found() {
    let mut written = Written::new(&shipped("small"));
    let text = "module latch(input wire [1:0] a, output reg b);\n\
                \x20   always @(*) if (a[0]) b = 1'b1;\nendmodule\n";
    fs::write(written.folder.path().join("rtl").join("latch.v"), text).expect("writable");
    written.modules = vec!["latch".to_owned()];
    let mut verilator = tools::verilator().expect("installed");
    verilator.args(["--lint-only", "-Wall"]).args(written.sources());
    let said = written.run(verilator);
    assert!(said.contains("LATCH") && said.contains("UNUSED"), "{said}");
    let mut yosys = tools::yosys().expect("installed");
    yosys.args(["-q", "-p", "read_verilog -sv ../rtl/latch.v; proc; select -assert-none t:$dlatch"]);
    let said = written.run(yosys);
    assert!(said.contains("ERROR") || said.contains("Latch"), "{said}");
    written.name = "latch".to_owned();
    let text = "module latch(input wire a, output wire b);\n  assign b = later;\n  wire later = a;\t\nendmodule\n";
    fs::write(written.folder.path().join("rtl").join("latch.v"), text).expect("writable");
    let said = slang(&written);
    assert!(said.contains("used before its declaration"), "{said}");
    let mut verible = tools::program("verible-verilog-lint").expect("installed");
    verible.args(written.sources());
    let said = written.run(verible);
    assert!(said.contains("no-tabs"), "{said}");
}
