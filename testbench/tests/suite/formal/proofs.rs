//! What is proved of which designs, and the broken copies whose proofs must fail.

use golden::design::{CalibrationIn, Correction, Design, Estimator, Optimise, Outputs, Overrun, PlanKind};
use golden::estimators::joint::Grid;

/// A module, a text in it, and what takes its place.
pub type Broken = (&'static str, &'static str, &'static str);

/// What is proved of which part of which design.
pub struct Proof {
    pub name: &'static str,
    pub harness: &'static str,
    /// The 4 × 3 design, changed.
    pub design: fn(&mut Design),
    /// What is defined for the harness, which may have other ways for other designs.
    pub defines: &'static [&'static str],
    /// The module that the harness instantiates, and its parameters, as `chparam` takes them.
    pub top: &'static str,
    pub parameters: &'static str,
    /// Files of `formal/` that take the place of generated modules.
    pub models: &'static [(&'static str, &'static str)],
    /// Whose outputs may be anything in any cycle: instances by the pattern of their module, then wires by name.
    pub free: &'static [&'static str],
    pub free_wires: &'static [&'static str],
    /// Cycles that an induction step assumes to be right, at most.
    pub induction: &'static str,
    /// Texts that are others here than in the generated design.
    pub altered: &'static [Broken],
    /// Copies that break a property.
    pub broken: &'static [Broken],
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

fn calibrated(design: &mut Design) {
    reduced(design);
    design.hardware.control = true;
    design.hardware.calibration = CalibrationIn::Ram;
    design.input.pa_per_count = Some(-12.5);
}

fn mapped(design: &mut Design) {
    calibrated(design);
    design.hardware.replaceable = 1;
}

fn scanned(design: &mut Design) {
    reduced(design);
    design.hardware.overrun = Overrun::Drop;
}

fn joint(design: &mut Design) {
    reduced(design);
    design.algorithm.estimator = Estimator::Joint;
}

/// One hidden unit that sees one taxel.
fn corrected(design: &mut Design) {
    joint(design);
    let inputs = Correction::inputs([0, 0]);
    design.algorithm.joint.correction = Some(Correction {
        half_window: [0, 0],
        hidden: vec![vec![1; inputs]],
        output: [vec![1], vec![1]],
        doubt: None,
    });
}

fn corrected_after_points(design: &mut Design) {
    corrected(design);
    design.algorithm.joint.grid = Grid::COARSE;
}

fn corrected_resultants(design: &mut Design) {
    corrected_after_points(design);
    design.algorithm.outputs = Outputs::Resultants;
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
    "*sptfra_correction*",
    "*sptfra_friction*",
    "*sptfra_summary*",
    "*sptfra_we*",
    "*sptfra_co",
    "*sptfra_field*",
    "*sptfra_unfold*",
];
const REDUCED_BROKEN: &[Broken] = &[
    ("turns", "(fields_due != RESIDUALS[1:0])", "1'b1"),
    ("turns", "                    next_field_bank <= !next_field_bank;\n", ""),
    ("turns", "(residuals_there != 2'd0) && friction_known", "(residuals_there != 2'd0)"),
    ("turns", "friction_known && (fields", "friction_known && frame_ready && (fields"),
    ("sptfra_estimator_line", "(u_waiting != 2'd0) && !searching", "(u_waiting != 2'd0)"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
    ("sptfra_op", "summary_there && output_idle && ", "summary_there && "),
];
const LATENCY_BROKEN: &[Broken] = &[
    ("turns", "(INTERVAL == 0) && (fields_due != 2'd0)", "1'b0"),
    ("turns", "(residuals_there != 2'd0) && friction_known", "(fields_due != 2'd0) && friction_known"),
    ("sptfra_estimator_line", "(u_waiting != 2'd0) && !searching", "(u_waiting != 2'd0)"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
    ("sptfra_op", "output_idle && ((FIELD == 0) || (fields_there != 2'd0))", "output_idle"),
    ("sptfra_output", "issued && issued_last && advance", "issued && issued_last"),
];
const JOINT_BROKEN: &[Broken] = &[
    // The line has no third frame whose residual could wait for a place.
    ("turns", "field_waits = residual_due || (", "field_waits = ("),
    ("turns", "(residuals_there != 2'd0) && friction_known", "(residuals_there != 2'd0)"),
    ("sptfra_estimator_joint", "assign sums_take = search_start;", "assign sums_take = answer_take;"),
    ("sptfra_joint_stages", "(u_waiting != 2'd0) && !searching", "!searching"),
    ("sptfra_joint_stages", "!looking && !showing : !correcting", "!looking && !showing : 1'b1"),
    ("sptfra_joint_stages", "            search_bank <= !search_bank;\n", ""),
    ("sptfra_joint_stages", "            centroid_waits <= 1'b0;\n            search_bank", "            search_bank"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
];
const LOOK_BROKEN: &[Broken] = &[
    ("sptfra_joint_stages", "centre_waits) && !correcting : look_start", "centre_waits) : look_start"),
    ("sptfra_joint_stages", "!looking && !showing : !correcting", "!showing : !correcting"),
    ("sptfra_joint_stages", "!looking && !showing : !correcting", "!looking : !correcting"),
    ("sptfra_joint_stages", "            centre_waits <= 1'b0;\n            look_bank", "            look_bank"),
    (
        "sptfra_joint_stages",
        "            showing <= 1'b0;\n        end\n        if (correction_start)",
        "        end\n        if (correction_start)",
    ),
];
/// The memory that is filled is the look's, too.
const KEPT_BROKEN: &[Broken] = &[
    ("sptfra_joint_stages", "            look_bank <= !look_bank;\n", ""),
    (
        "sptfra_joint_stages",
        "? look_start : correction_start;\n\n    always",
        "? look_start : look_start;\n\n    always",
    ),
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
    ("turns", "(u_held != 2'd2) && ", ""),
    ("turns", "wire free = !busy || issued;", "wire free = 1'b1;"),
    ("sptfra_estimator_line", "(u_waiting != 2'd0) && !searching", "(u_waiting != 2'd0)"),
    ("sptfra_op", "answer_valid && !summary_busy", "answer_valid"),
    ("sptfra_op", "summary_there && output_idle && ", "summary_there && "),
];

pub const PROOFS: &[Proof] = &[
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
        altered: &[],
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
        name: "door that drops frames",
        harness: "overrun",
        design: scanned,
        defines: &[],
        top: "sptfra_overrun",
        parameters: "-set BEATS 2",
        models: &[("sptfra_ram", "ram_model")],
        free: &[],
        free_wires: &[],
        induction: "2",
        altered: &[],
        broken: &[
            ("whole_frames", "in_frame ? keeps : room", "room"),
            ("overrun", "(frames != FRAMES)", "(1'b1)"),
            ("overrun", "((index != END) || s_tlast)", "(index != END)"),
            ("overrun", " && (!valid || m_tready)", ""),
            ("overrun", "marks[oldest] && !in_answer", "marks[oldest]"),
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
        altered: &[],
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
        altered: &[],
        broken: &[
            ("bz", "(banks_taken != 2'd2)", "(banks_taken != 2'd3)"),
            ("bz", "wire advance = write_ready;", "wire advance = 1'b1;"),
            ("bz", "bank <= !bank;", "bank <= frame_ready;"),
            ("bz", "assign stress_valid = taxel_valid && advance;", "assign stress_valid = taxel_valid;"),
            ("bz", "if (reset || frame_done)", "if (reset)"),
        ],
    },
    Proof {
        name: "banks of a calibration in RAM",
        harness: "calibrate",
        design: calibrated,
        defines: &[],
        top: "sptfra_calibrate",
        parameters: "-set TAXELS 12",
        models: &[("sptfra_float_to_fixed", "float_model")],
        free: &["*sptfra_bank*", "*sptfra_multiply*", "*sptfra_fixed_to_float*", "*sptfra_axis_skid*"],
        free_wires: &[],
        induction: "3",
        altered: &[],
        broken: &[
            ("calibrate", "in_frame ? bank_held : active", "active"),
            ("calibrate", "in_frame ? marked_held : tare_run", "tare_run"),
            ("calibrate", "if (!tare_run) begin\n            marked_held", "if (1'b0) begin\n            marked_held"),
            ("calibrate", "in_frame <= !s_tlast;", "in_frame <= 1'b1;"),
            ("calibrate", "(in_frame || hold) && (bank_held != active)", "in_frame && (bank_held != active)"),
            ("calibrate", "(in_frame || hold) && (bank_held != active)", "1'b0"),
            ("calibrate", "!hold && ", ""),
            ("calibrate", "(ends_inside != 2'd3)", "1'b1"),
        ],
    },
    Proof {
        name: "dead taxels of a bank's map",
        harness: "replace",
        design: mapped,
        defines: &[],
        top: "sptfra_replace",
        parameters: "-set TAXELS 4 -set REPLACEABLE 1",
        models: &[],
        free: &["*sptfra_mac*", "*sptfra_ram*"],
        free_wires: &[],
        induction: "3",
        altered: &[],
        broken: &[
            ("replace", "takes ? place + 1 : place", "place + 1"),
            ("replace", "pending <= complete && !start;", "pending <= 1'b0;"),
            ("replace", "hold <= 1'b1;", "hold <= 1'b0;"),
            ("replace", "(!replays || replays_last)", "1'b1"),
            ("replace", "ends_at <= place;", "ends_at <= place - 1;"),
            ("replace", "if (advance && out_valid && out_last)", "if (out_valid && out_last)"),
            ("replace", "if (holds) begin\n                hold <=", "if (start) begin\n                hold <="),
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
        altered: &[],
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
        altered: &[],
        broken: REDUCED_BROKEN,
    },
    Proof {
        name: "frame handshake, reduced plan, a place for one residual",
        harness: "reduced",
        design: reduced,
        defines: &["ONE_RESIDUAL"],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "reduced_lanes")],
        free: FREE,
        free_wires: &["turns.residual_written"],
        induction: "5",
        altered: &[("subject", ".RESIDUALS (2)", ".RESIDUALS (1)")],
        broken: &[
            ("turns", "(fields_due != RESIDUALS[1:0])", "1'b1"),
            ("turns", "field_waits = residual_due || (", "field_waits = ("),
        ],
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
        altered: &[],
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
        altered: &[],
        broken: &[("turns", "(residuals_there != 2'd0) && friction_known", "(fields_due != 2'd0) && friction_known")],
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
        altered: &[],
        broken: JOINT_BROKEN,
    },
    Proof {
        name: "frame handshake, joint estimator with a correction after a walk",
        harness: "reduced",
        design: corrected,
        defines: &["JOINT", "LOOK"],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "reduced_lanes")],
        free: FREE,
        free_wires: &["turns.residual_written"],
        induction: "5",
        altered: &[],
        broken: KEPT_BROKEN,
    },
    Proof {
        name: "frame handshake, joint estimator with a correction after points",
        harness: "reduced",
        design: corrected_after_points,
        defines: &["JOINT", "LOOK", "HANDED_ON"],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "reduced_lanes")],
        free: FREE,
        free_wires: &["turns.residual_written"],
        induction: "5",
        altered: &[],
        broken: &[("sptfra_joint_stages", "(LOOK == 0) || (HANDED_ON != 0)", "(LOOK == 0)")],
    },
    Proof {
        name: "frame handshake, resultants only by the joint estimator with a correction",
        harness: "resultants",
        design: corrected_resultants,
        defines: &["JOINT"],
        top: "subject",
        parameters: "",
        models: &[("sptfra_spmv_array", "resultants_lanes")],
        free: FREE,
        free_wires: &[],
        induction: "5",
        altered: &[],
        broken: LOOK_BROKEN,
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
        altered: &[],
        broken: RESULTANTS_BROKEN,
    },
];
