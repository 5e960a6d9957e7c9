//! What is proved of which designs, and the broken copies whose proofs must fail.

use golden::design::{CalibrationIn, Design, Estimator, Optimise, Outputs, Overrun, PlanKind};

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
