//! `hdl-gen inspect`: what a design will be, before anything is written.

use std::error::Error;
use std::fmt::Write;

use hdl_gen::emit::{nnz, predicted};
use hdl_gen::plan::Plan;
use serde_json::json;

/// The report, as text or as JSON.
pub fn report(plan: &Plan, as_json: bool) -> Result<String, Box<dyn Error>> {
    if as_json { json_report(plan) } else { Ok(text_report(plan)?) }
}

fn json_report(plan: &Plan) -> Result<String, Box<dyn Error>> {
    let sensor = &plan.design.sensor;
    let value = json!({
        "name": plan.design.name,
        "geometry": {
            "columns": sensor.columns,
            "rows": sensor.rows,
            "taxels": plan.taxels(),
            "pitch_mm": sensor.pitch_mm,
            "depth_mm": sensor.depth_mm,
        },
        "nnz": nnz(plan),
        "condition": plan.condition,
        "rom_bits": plan.resources.rom_bits,
        "predicted": predicted(plan),
    });
    Ok(serde_json::to_string_pretty(&value)? + "\n")
}

fn text_report(plan: &Plan) -> Result<String, std::fmt::Error> {
    let design = &plan.design;
    let sensor = &design.sensor;
    let hardware = &design.hardware;
    let timeline = &plan.timeline;
    let microseconds = |cycles: u64| cycles as f64 / hardware.clock_mhz;
    let mut text = String::new();
    let out = &mut text;
    writeln!(out, "{}", design.name)?;
    writeln!(
        out,
        "  sensor      {} x {} taxels, pitch {} x {} mm, depth {} mm",
        sensor.columns, sensor.rows, sensor.pitch_mm[0], sensor.pitch_mm[1], sensor.depth_mm
    )?;
    writeln!(out, "  condition   C33 {:.3}, A A^T {:.3}", plan.condition.c33, plan.condition.aat)?;
    writeln!(out, "  Nnz of {}", plan.taxels() * plan.taxels())?;
    for chunk in plan.nnz.0.chunks(7) {
        let names: String = chunk.iter().map(|(name, _)| format!("{:>9}", name.as_str())).collect();
        let counts: String = chunk.iter().map(|(_, count)| format!("{count:>9}")).collect();
        writeln!(out, "            {names}\n            {counts}")?;
    }
    writeln!(
        out,
        "  lanes       {}, {}-bit coefficients, {}-bit vectors, busy {:.1} % of the products' time",
        hardware.lanes,
        hardware.coefficient_bits,
        hardware.data_bits,
        100.0 * plan.schedule.busy_fraction()
    )?;
    for (what, cycles) in [("latency", timeline.latency_cycles), ("interval", timeline.interval_cycles)] {
        writeln!(out, "  {what:<11} {cycles} cycles = {:.2} us at {} MHz", microseconds(cycles), hardware.clock_mhz)?;
    }
    writeln!(out, "              products {}, search {}", timeline.spmv_cycles, timeline.search_cycles)?;
    writeln!(
        out,
        "  resources   {} DSP48E2, {} RAMB36, {} kbit of ROM",
        plan.resources.dsp,
        plan.resources.bram36,
        plan.resources.rom_bits / 1000
    )?;
    for memory in &plan.resources.memories {
        writeln!(
            out,
            "              {:<13} {:>3} x {} words of {} bits, {} RAMB36 each",
            memory.name, memory.count, memory.depth, memory.width, memory.bram36
        )?;
    }
    for (what, unit, format) in [
        ("stress", "Pa", plan.formats.stress),
        ("weights", "N", plan.formats.weight),
        ("g", "N", plan.formats.g),
        ("u", "Pa", plan.formats.u),
    ] {
        writeln!(
            out,
            "  format      {what:<8} {} bits, one step 2^{} {unit}, worst case {:.4} {unit}",
            format.bits,
            format.lsb,
            format.bound as f64 * format.step()
        )?;
    }
    Ok(text)
}
