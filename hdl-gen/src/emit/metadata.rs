//! `metadata.json`: what reports, documentation and drivers read instead of the Verilog.

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::plan::energy::Energy;
use crate::plan::luts::logic;
use crate::plan::product::{Product, Vector};
use crate::plan::schedule::Window;
use crate::plan::streams::WORD_BITS;
use crate::plan::{Plan, words};
use crate::timing::latency;

use super::{FileMap, VERSION, registers};

/// The predicted figures, under the names that `sptfra inspect --json` uses too.
pub fn predicted(plan: &Plan) -> Value {
    json!({
        "latency_cycles": plan.timeline.latency_cycles,
        "interval_cycles": plan.timeline.interval_cycles,
        "spmv_cycles": plan.timeline.spmv_cycles,
        "search_cycles": plan.timeline.search_cycles,
        "lanes_busy": plan.schedule.busy_fraction(),
        "dsp": plan.resources.dsp,
        "bram36": plan.resources.bram36,
        "rom_bits": plan.resources.rom_bits,
        "blocks": plan.resources.blocks,
        "logic_estimate": logic(plan),
        "energy_estimate": Energy::of(plan),
    })
}

/// Nnz of the 13 matrices by name, in the order of the paper's Table 1.
pub fn nnz(plan: &Plan) -> Map<String, Value> {
    plan.nnz.0.iter().map(|&(name, count)| (name.to_string(), json!(count))).collect()
}

/// A product of the plan as `metadata.json` and `sptfra inspect` show it.
#[derive(Serialize)]
pub struct ProductEntry<'a> {
    /// The stored matrix.
    pub matrix: &'a str,
    /// What it multiplies; of several vectors the first.
    pub operand: String,
    /// What comes out.
    pub result: String,
    /// We, Co or Op.
    pub block: String,
    /// Entries of the stored matrix that are not 0; of a folded one, words of four.
    pub nnz: usize,
    /// Exponent of the coefficients' step.
    pub coefficient_lsb: i32,
    /// Bits dropped from the accumulator.
    pub shift: u32,
    /// Cycle in its program.
    pub first_issue: u64,
    /// Cycles from there to its last issue.
    pub issue_cycles: u64,
    /// Share of the lanes' cycles that multiply, 0 to 1.
    pub busy: f64,
}

/// The products in the order in which the lanes compute them.
pub fn products(plan: &Plan) -> Vec<ProductEntry<'_>> {
    let pes = plan.pes() as u64;
    let entry = |(product, window): (&Product, &Window)| {
        let matrix = &plan.matrices[product.matrix];
        ProductEntry {
            matrix: &matrix.name,
            operand: product.operand().name(),
            result: product.result.name(),
            block: format!("{:?}", product.block),
            nnz: matrix.nnz(),
            coefficient_lsb: matrix.lsb,
            shift: product.shift,
            first_issue: window.start,
            issue_cycles: window.length,
            busy: window.macs as f64 / (window.length * pes) as f64,
        }
    };
    plan.products.iter().zip(&plan.schedule.windows).map(entry).collect()
}

/// Edition of the file and of the streams that it describes.
const FORMAT: u32 = 3;

/// The words of an output frame: values by name, then the taxels' forces, `count` words from
/// `index` on.
fn output(plan: &Plan) -> Value {
    let mut output: Vec<Value> = words::SUMMARY.iter().map(|word| json!(word)).collect();
    if plan.field_words() > 0 {
        output.push(json!({
            "name": "field",
            "index": plan.words_out() - plan.field_words(),
            "count": plan.field_words(),
            "of_each_taxel": ["f_x", "f_y", "f_z"],
            "type": words::Kind::Float32,
            "unit": "N",
        }));
    }
    json!(output)
}

/// Adds what only some designs have, under the names that `sptfra inspect --json` uses too.
pub fn insert_options(plan: &Plan, value: &mut Value) {
    let design = &plan.design;
    if plan.scales_frames() {
        value["scaling"] = json!(design.hardware.scaling);
    }
    if design.algorithm.count_contacts {
        value["count_contacts"] = json!({ "cycles": latency::count_contacts(&design.sensor) });
    }
    if let Some(expected) = design.expected_error() {
        value["expected_error"] = json!(expected);
    }
    if let Some((key, own)) = plan.estimator.block().metadata().own {
        value[key] = own;
    }
}

/// The file's text. `files` are the others of the folder.
pub fn metadata(plan: &Plan, hash: &str, files: &FileMap) -> String {
    let slots: Vec<Value> = plan
        .operands
        .slots()
        .into_iter()
        .map(|(first_word, vectors)| {
            let names: Vec<String> = vectors.into_iter().map(Vector::name).collect();
            json!({ "first_word": first_word, "vectors": names })
        })
        .collect();
    let (estimator, streams) = (plan.estimator.block().metadata(), plan.streams());
    let mut value = json!({
        "format": FORMAT,
        "name": plan.design.name,
        "generator": format!("sptfra {VERSION}"),
        "design_hash": hash,
        "taxels": plan.taxels(),
        "columns": plan.design.sensor.columns,
        "rows": plan.design.sensor.rows,
        "stream_bits": streams.bits,
        "samples": streams.sample,
        "overrun": plan.design.hardware.overrun,
        "beats_in": streams.beats_in(),
        "beats_out": streams.beats_out(),
        "bytes_in": streams.words_in() * WORD_BITS / 8,
        "bytes_out": streams.words_out * WORD_BITS / 8,
        "output": output(plan),
        "status_bits": words::status_bits().map(|(bit, name)| (name.to_owned(), json!(bit))).collect::<Map<_, _>>(),
        "clock_mhz": plan.design.hardware.clock_mhz,
        "part": plan.design.hardware.part,
        "condition": plan.condition,
        "nnz": nnz(plan),
        "formats": {
            "coefficient_bits": plan.design.hardware.coefficient_bits,
            "accumulator_bits": crate::cores::ACCUMULATOR_BITS,
            "stress_pa": plan.formats.stress,
            "weight_n": plan.formats.weight,
            "g_n": plan.formats.g,
            "u_pa": plan.formats.u,
            "thresholds": plan.thresholds,
        },
        "products": products(plan),
        "operand_memory": slots,
        "search": estimator.search,
        "direction": estimator.direction,
        "memories": plan.resources.memories,
        "predicted": predicted(plan),
        "top": plan.design.name,
        "files": files.keys().collect::<Vec<_>>(),
    });
    if plan.factors().is_wide() {
        value["formats"]["dropped_bits"] = json!(plan.factors().dropped());
    }
    if plan.design.hardware.control {
        value["registers"] = json!(registers::map_path(plan));
    }
    if let Some(dead) = &plan.dead {
        value["dead_taxels"] = json!({ "taxels": dead.taxels, "weight_lsb": -i64::from(dead.shift) });
    }
    if let Some(map) = plan.calibration.as_ref().map(|of| &of.power_up.dead).filter(|map| map.room > 0) {
        let weight_lsb = -i64::from(map.dead.shift);
        value["dead_taxels"] = json!({ "taxels": map.dead.taxels, "weight_lsb": weight_lsb, "replaceable": map.room });
    }
    insert_options(plan, &mut value);
    format!("{value:#}\n")
}
