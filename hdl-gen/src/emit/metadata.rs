//! `metadata.json`: what reports, documentation and drivers read instead of the Verilog.

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::plan::Plan;
use crate::plan::product::Vector;

use super::{EmitError, FileMap, VERSION};

/// The predicted figures, under the names that `hdl-gen inspect --json` uses too.
pub fn predicted(plan: &Plan) -> Value {
    json!({
        "latency_cycles": plan.timeline.latency_cycles,
        "interval_cycles": plan.timeline.interval_cycles,
        "worst_case": plan.design.hardware.skip_zeros,
        "spmv_cycles": plan.timeline.spmv_cycles,
        "search_cycles": plan.timeline.search_cycles,
        "lanes_busy": plan.schedule.busy_fraction(),
        "dsp": plan.resources.dsp,
        "bram36": plan.resources.bram36,
        "rom_bits": plan.resources.rom_bits,
        "blocks": plan.resources.blocks,
    })
}

/// Nnz of the 13 matrices by name, in the order of the paper's Table 1.
pub fn nnz(plan: &Plan) -> Map<String, Value> {
    plan.nnz.0.iter().map(|&(name, count)| (name.as_str().to_owned(), json!(count))).collect()
}

#[derive(Serialize)]
struct ProductEntry<'a> {
    matrix: &'a str,
    operand: String,
    result: String,
    block: String,
    nnz: usize,
    coefficient_lsb: i32,
    shift: u32,
    first_issue: u64,
    issue_cycles: u64,
    busy: f64,
}

/// The file's bytes. `files` are the others of the folder.
///
/// # Errors
/// [`EmitError::Metadata`] if a value has no JSON form.
pub fn metadata(plan: &Plan, hash: &str, files: &FileMap) -> Result<Vec<u8>, EmitError> {
    let lanes = plan.walkers() as u64;
    let products: Vec<ProductEntry> = plan
        .products
        .iter()
        .zip(&plan.schedule.windows)
        .map(|(product, window)| {
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
                busy: window.macs as f64 / (window.length * lanes) as f64,
            }
        })
        .collect();
    let slots: Vec<Value> = plan
        .operands
        .slots()
        .into_iter()
        .map(|(first_word, vectors)| {
            let names: Vec<String> = vectors.into_iter().map(Vector::name).collect();
            json!({ "first_word": first_word, "vectors": names })
        })
        .collect();
    let value = json!({
        "name": plan.design.name,
        "generator": format!("hdl-gen {VERSION}"),
        "design_hash": hash,
        "taxels": plan.taxels(),
        "columns": plan.design.sensor.columns,
        "rows": plan.design.sensor.rows,
        "beats_in": plan.taxels(),
        "beats_out": plan.beats_out(),
        "clock_mhz": plan.design.hardware.clock_mhz,
        "part": plan.design.hardware.part,
        "condition": plan.condition,
        "nnz": nnz(plan),
        "formats": {
            "coefficient_bits": plan.design.hardware.coefficient_bits,
            "accumulator_bits": crate::plan::format::ACCUMULATOR_BITS,
            "stress_pa": plan.formats.stress,
            "weight_n": plan.formats.weight,
            "g_n": plan.formats.g,
            "u_pa": plan.formats.u,
            "thresholds": plan.thresholds,
        },
        "products": products,
        "operand_memory": slots,
        "search": plan.optimum,
        "direction": plan.direction,
        "memories": plan.resources.memories,
        "predicted": predicted(plan),
        "top": plan.design.name,
        "files": files.keys().collect::<Vec<_>>(),
    });
    let mut text = serde_json::to_vec_pretty(&value)?;
    text.push(b'\n');
    Ok(text)
}
