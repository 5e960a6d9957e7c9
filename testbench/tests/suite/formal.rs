//! Proofs by Yosys and z3 on the generated Verilog: the rules of the streams, and the handshake between the blocks.
//!
//! Each harness in `formal/` states properties and, under `INVARIANTS`, what makes them inductive. A proof holds if the
//! first cycles after reset satisfy both and no cycle can break them. Each has broken copies, whose proof must fail.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::support::{in_parallel, planned, shipped, workspace};
use golden::design::{Design, Estimator, Optimise, Outputs, PlanKind};
use hdl_gen::emit::{FileMap, emit};
use tempfile::TempDir;
use testbench::tools;

/// Cycles after reset that are checked: more than the longest induction assumes.
const FIRST_CYCLES: &str = "6";

/// A module, a text in it, and what takes its place.
type Broken = (&'static str, &'static str, &'static str);

/// What is proved of which part of which design.
struct Proof {
    name: &'static str,
    harness: &'static str,
    /// The 4 × 3 design, changed.
    design: fn(&mut Design),
    /// What is defined for the harness, which may have other ways for other designs.
    defines: &'static [&'static str],
    /// The module that the harness instantiates, and its parameters, as `chparam` takes them.
    top: &'static str,
    parameters: &'static str,
    /// Files of `formal/` that take the place of generated modules.
    models: &'static [(&'static str, &'static str)],
    /// Whose outputs may be anything in any cycle: instances by the pattern of their module, then wires by name.
    free: &'static [&'static str],
    free_wires: &'static [&'static str],
    /// Cycles that an induction step assumes to be right, at most.
    induction: &'static str,
    /// Copies that break a property.
    broken: &'static [Broken],
}

fn paper(design: &mut Design) {
    design.algorithm.plan = PlanKind::Paper;
    design.hardware.lanes = 2;
}

fn reduced(design: &mut Design) {
    design.algorithm.plan = PlanKind::Reduced;
}

fn reduced_for_latency(design: &mut Design) {
    reduced(design);
    design.hardware.optimise = Optimise::Latency;
}

fn reduced_with_zeros_skipped(design: &mut Design) {
    reduced(design);
    design.hardware.skip_zeros = true;
}

fn joint(design: &mut Design) {
    reduced(design);
    design.algorithm.estimator = Estimator::Joint;
}

fn resultants(design: &mut Design) {
    reduced(design);
    design.algorithm.outputs = Outputs::Resultants;
}

/// The leaf cores that the handshake does not need, and the blocks of arithmetic.
const FREE: &[&str] = &[
    "*sptfra_axis_skid*",
    "*sptfra_timestamp*",
    "*sptfra_fixed_to_float*",
    "*sptfra_divider*",
    "*sptfra_mac*",
    "*sptfra_leading_bit*",
    "*sptfra_bz*",
    "*sptfra_cean*",
    "*sptfra_search*",
    "*sptfra_plane*",
    "*sptfra_level_set*",
    "*sptfra_friction*",
    "*sptfra_summary*",
    "*sptfra_we*",
    "*sptfra_co",
    "*sptfra_field*",
    "*sptfra_unfold*",
];
const REDUCED_BROKEN: &[Broken] = &[
    ("turns", "field_waits = residual_due || (", "field_waits = ("),
    ("turns", "field_due && residual_there && friction_known", "field_due && residual_there"),
    ("turns", "friction_known && (fields", "friction_known && frame_ready && (fields"),
    ("sptfra_estimator_line", "(u_waiting != 2'd0) && !searching", "(u_waiting != 2'd0)"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
    ("sptfra_op", "summary_there && output_idle && ", "summary_there && "),
];
const LATENCY_BROKEN: &[Broken] = &[
    ("turns", "(INTERVAL == 0) && field_due", "1'b0"),
    ("turns", "field_due && residual_there && friction_known", "field_due && friction_known"),
    ("sptfra_estimator_line", "(u_waiting != 2'd0) && !searching", "(u_waiting != 2'd0)"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
    ("sptfra_op", "output_idle && ((FIELD == 0) || (fields_there != 2'd0))", "output_idle"),
    ("sptfra_output", "issued && issued_last && advance", "issued && issued_last"),
];
const JOINT_BROKEN: &[Broken] = &[
    ("turns", "field_due && residual_there && friction_known", "field_due && residual_there"),
    ("sptfra_estimator_joint", "assign sums_take = search_start;", "assign sums_take = answer_take;"),
    ("sptfra_estimator_joint", "(u_waiting != 2'd0) && !searching", "!searching"),
    ("sptfra_estimator_joint", "(level_done || centroid_waits) && !correcting", "(level_done || centroid_waits)"),
    (
        "sptfra_estimator_joint",
        "            search_bank <= !search_bank;\n            correcting",
        "            correcting",
    ),
    (
        "sptfra_estimator_joint",
        "            centroid_waits <= 1'b0;\n            search_bank",
        "            search_bank",
    ),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
];
const PAPER_BROKEN: &[Broken] = &[
    ("turns", "(PLACES == 0) || (frames_held != PLACES)", "1'b1"),
    ("turns", "wire free = !busy || issued;", "wire free = 1'b1;"),
    ("sptfra_estimator_line", "(u_waiting != 2'd0) && !searching", "(u_waiting != 2'd0)"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
    ("sptfra_op", "summary_there && output_idle && ", "summary_there && "),
    // The place is given back before the last component has left the memory.
    ("sptfra_output", "issued && issued_last && advance", "issued && issued_last"),
];
const RESULTANTS_BROKEN: &[Broken] = &[
    ("turns", "frame_ready && (searches_due != 2'd2)", "frame_ready"),
    ("turns", "wire free = !busy || issued;", "wire free = 1'b1;"),
    ("sptfra_estimator_line", "(u_waiting != 2'd0) && !searching", "(u_waiting != 2'd0)"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
    ("sptfra_op", "summary_there && output_idle && ", "summary_there && "),
];

const PROOFS: &[Proof] = &[
    Proof {
        name: "stream rules of the skid buffer",
        harness: "skid",
        design: reduced,
        defines: &[],
        top: "sptfra_axis_skid",
        parameters: "",
        models: &[],
        free: &[],
        free_wires: &[],
        induction: "3",
        broken: &[
            ("sptfra_axis_skid", "blocked && (spare_full || taken)", "blocked && taken"),
            ("sptfra_axis_skid", "if (spare_full) begin", "if (!spare_full) begin"),
            ("sptfra_axis_skid", "taken = s_tvalid && ready", "taken = s_tvalid"),
            ("sptfra_axis_skid", "                last <= spare_last;", "                last <= s_tlast;"),
            ("sptfra_axis_skid", "if (!blocked) begin", "if (m_tready) begin"),
            ("sptfra_axis_skid", "if (!blocked) begin", "if (1'b1) begin"),
            ("sptfra_axis_skid", "!(spare_needed || reset)", "!reset"),
            ("sptfra_axis_skid", "if (ready) begin", "if (!blocked) begin"),
        ],
    },
    Proof {
        name: "frame checker",
        harness: "bz",
        design: reduced,
        defines: &[],
        top: "sptfra_bz",
        parameters: "-set COLUMNS 4 -set ROWS 3",
        models: &[("sptfra_float_to_fixed", "float_model")],
        free: &["*sptfra_ram*"],
        free_wires: &[],
        induction: "3",
        broken: &[
            ("bz", "index != TAXELS - ", "index < TAXELS - "),
            ("bz", "(banks_taken != 2'd2)", "(banks_taken != 2'd3)"),
            ("bz", "if (reset || frame_done)", "if (reset)"),
            ("bz", "wire store = (index != TAXELS);", "wire store = 1'b1;"),
            ("bz", "in_frame <= !s_tlast;", "in_frame <= 1'b1;"),
            ("bz", "advance && (in_frame || may_open)", "(in_frame || may_open)"),
            ("bz", "index <= s_tlast ? ", "index <= (s_tlast && !store) ? "),
            ("bz", "frame_not_finite = seen_not_finite || ", "frame_not_finite = "),
            ("bz", "wire advance = write_ready;", "wire advance = 1'b1;"),
            ("fold", "assign frame_written = lasts[3] && advance;", "assign frame_written = lasts[3];"),
        ],
    },
    Proof {
        name: "frame checker, paper plan",
        harness: "bz",
        design: paper,
        defines: &["PAPER"],
        top: "sptfra_bz",
        parameters: "-set COLUMNS 4 -set ROWS 3 -set WAYS 1",
        models: &[("sptfra_float_to_fixed", "float_model")],
        free: &[],
        free_wires: &[],
        induction: "3",
        broken: &[
            ("bz", "(banks_taken != 2'd2)", "(banks_taken != 2'd3)"),
            ("bz", "wire advance = write_ready;", "wire advance = 1'b1;"),
            ("bz", "bank <= !bank;", "bank <= frame_ready;"),
            ("bz", "assign stress_valid = taxel_valid && advance;", "assign stress_valid = taxel_valid;"),
            ("bz", "if (reset || frame_done)", "if (reset)"),
        ],
    },
    Proof {
        name: "frame handshake, paper plan",
        harness: "resultants",
        design: paper,
        defines: &["FIELD"],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "resultants_lanes")],
        free: FREE,
        free_wires: &[],
        induction: "5",
        broken: PAPER_BROKEN,
    },
    Proof {
        name: "frame handshake, reduced plan, for the interval",
        harness: "reduced",
        design: reduced,
        defines: &[],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "reduced_lanes")],
        free: FREE,
        free_wires: &["turns.residual_written"],
        induction: "5",
        broken: REDUCED_BROKEN,
    },
    Proof {
        name: "frame handshake, reduced plan, for the latency",
        harness: "reduced",
        design: reduced_for_latency,
        defines: &["LATENCY"],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "reduced_lanes")],
        free: FREE,
        free_wires: &["turns.residual_written"],
        induction: "5",
        broken: LATENCY_BROKEN,
    },
    Proof {
        name: "frame handshake, reduced plan, zeros skipped",
        harness: "reduced",
        design: reduced_with_zeros_skipped,
        defines: &[],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "reduced_lanes")],
        free: FREE,
        free_wires: &["turns.residual_written"],
        induction: "5",
        broken: &[("turns", "residual_there && friction_known", "friction_known")],
    },
    Proof {
        name: "frame handshake, joint estimator",
        harness: "reduced",
        design: joint,
        defines: &["JOINT"],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "reduced_lanes")],
        free: FREE,
        free_wires: &["turns.residual_written"],
        induction: "5",
        broken: JOINT_BROKEN,
    },
    Proof {
        name: "frame handshake, resultants only",
        harness: "resultants",
        design: resultants,
        defines: &[],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "resultants_lanes")],
        free: FREE,
        free_wires: &[],
        induction: "5",
        broken: RESULTANTS_BROKEN,
    },
];

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
        let mut read = vec!["read_verilog -formal -defer".to_owned()];
        for (path, contents) in files {
            // Modules of arithmetic read theirs before they are set free.
            if let Some(name) = path.strip_prefix("rom/") {
                fs::write(folder.path().join(name), contents).expect("writable");
            }
            let Some(module) = path.strip_prefix("rtl/").and_then(|name| name.strip_suffix(".v")) else { continue };
            if self.models.iter().any(|&(replaced, _)| replaced == module) {
                continue;
            }
            let mut text = String::from_utf8(contents.clone()).expect("UTF-8");
            if let Some((_, from, to)) =
                broken.filter(|(place, ..)| module == *place || module == format!("sptfra_{place}"))
            {
                assert_eq!(text.matches(from).count(), 1, "{module}: {from:?} stands there once");
                text = text.replace(from, to);
            }
            fs::write(folder.path().join(format!("{module}.v")), text).expect("writable");
            read.push(format!("{module}.v"));
        }
        for file in self.models.iter().map(|&(_, model)| model).chain([self.harness]) {
            let name = format!("{file}.sv");
            fs::copy(workspace("testbench/formal").join(&name), folder.path().join(&name)).expect("a file of formal/");
            if file != self.harness {
                read.push(name);
            }
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
        let parts: [&[&str]; 2] = [&["-t", FIRST_CYCLES], &["-i", "-t", self.induction]];
        for part in parts {
            let mut solver = tools::yosys_smtbmc().expect("installed");
            let said = run(solver.args(["-s", "z3"]).args(part).arg("proof.smt2"), folder.path());
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
    names.map(|name| format!("w:{}", name.trim_start_matches('\\'))).collect::<Vec<_>>().join(" ")
}

fn run(command: &mut Command, folder: &Path) -> String {
    let output = command.current_dir(folder).output().expect("starts");
    (String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr)).into_owned()
}

#[test]
fn every_proof_holds_and_every_broken_copy_is_found() {
    let cases: Vec<(&Proof, Option<&Broken>)> = PROOFS
        .iter()
        .flat_map(|proof| {
            std::iter::once((proof, None)).chain(proof.broken.iter().map(move |copy| (proof, Some(copy))))
        })
        .collect();
    let files: Vec<(&str, FileMap)> = PROOFS.iter().map(|proof| (proof.name, proof.files())).collect();
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
