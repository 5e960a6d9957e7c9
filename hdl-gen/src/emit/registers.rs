//! The register bank on AXI4-Lite around a core: its Verilog, and its map in `SystemRDL`.

use serde::Serialize;
use tera::Context;

use crate::plan::Plan;

use super::verilog::{design_module, framed, one};
use super::{EmitError, FileMap, VERSION};

/// Version of the register map: one more whenever a register moves or changes its meaning.
const MAP_VERSION: u8 = 1;

const MAP: &str = include_str!("../../templates/control/registers.rdl.tera");

/// `(suffix, template)` of the modules that carry the design's name.
const DESIGN_MODULES: [(&str, &str); 2] = [
    ("", include_str!("../../templates/rtl/control/top.v.tera")),
    ("_registers", include_str!("../../templates/rtl/control/registers.v.tera")),
];

/// `(module, template)` of those that are the same in every design.
const SHARED_MODULES: [(&str, &str); 3] = [
    ("sptfra_axi_lite", include_str!("../../templates/rtl/control/axi_lite.v.tera")),
    ("sptfra_stream_gate", include_str!("../../templates/rtl/control/stream_gate.v.tera")),
    ("sptfra_frame_meter", include_str!("../../templates/rtl/control/frame_meter.v.tera")),
];

/// `(signal, output, bits)` of the AXI4-Lite port, in the order of the bus standard.
const AXI_SIGNALS: [(&str, bool, u32); 19] = [
    ("awaddr", false, 12),
    ("awprot", false, 3),
    ("awvalid", false, 1),
    ("awready", true, 1),
    ("wdata", false, 32),
    ("wstrb", false, 4),
    ("wvalid", false, 1),
    ("wready", true, 1),
    ("bresp", true, 2),
    ("bvalid", true, 1),
    ("bready", false, 1),
    ("araddr", false, 12),
    ("arprot", false, 3),
    ("arvalid", false, 1),
    ("arready", true, 1),
    ("rdata", true, 32),
    ("rresp", true, 2),
    ("rvalid", true, 1),
    ("rready", false, 1),
];

/// A port of the bus.
#[derive(Serialize)]
struct AxiPort {
    signal: &'static str,
    /// In Vivado's names.
    bus: String,
    direction: &'static str,
    /// `[11:0]`, or nothing for one bit; as wide as the widest.
    range: String,
    used: bool,
}

/// The data of the templates. Truths are 0 or 1: they are reset values.
#[derive(Serialize)]
struct View<'a> {
    name: &'a str,
    version: &'static str,
    hash: &'a str,
    map_version: u8,
    major: &'static str,
    minor: &'static str,
    patch: &'static str,
    hash_high: &'a str,
    hash_low: &'a str,
    columns: usize,
    rows: usize,
    lanes: usize,
    words_in: usize,
    words_out: usize,
    has_field: u8,
    is_reduced: u8,
    has_counts: u8,
    skips_zeros: u8,
    clock_khz: u64,
    /// Hexadecimal digits of a float32.
    full_scale: String,
    latency_cycles: u64,
    interval_cycles: u64,
    axi_ports: Vec<AxiPort>,
}

impl<'a> View<'a> {
    fn new(plan: &'a Plan, hash: &'a str) -> Self {
        let (design, hardware) = (&plan.design, &plan.design.hardware);
        let (hash_high, hash_low) = hash.split_at(8);
        let port = |&(signal, output, bits): &(&'static str, bool, u32)| AxiPort {
            signal,
            bus: signal.to_uppercase(),
            direction: if output { "output" } else { "input " },
            range: format!("{:6}", if bits == 1 { String::new() } else { format!("[{}:0]", bits - 1) }),
            used: !signal.ends_with("prot"),
        };
        Self {
            name: &design.name,
            version: VERSION,
            hash,
            map_version: MAP_VERSION,
            major: env!("CARGO_PKG_VERSION_MAJOR"),
            minor: env!("CARGO_PKG_VERSION_MINOR"),
            patch: env!("CARGO_PKG_VERSION_PATCH"),
            hash_high,
            hash_low,
            columns: design.sensor.columns,
            rows: design.sensor.rows,
            lanes: hardware.lanes,
            words_in: plan.taxels(),
            words_out: plan.beats_out(),
            has_field: u8::from(plan.field_words() > 0),
            is_reduced: u8::from(plan.ways() > 1),
            has_counts: u8::from(plan.counts.is_some()),
            skips_zeros: u8::from(hardware.skip_zeros),
            clock_khz: (hardware.clock_mhz * 1e3).round() as u64,
            full_scale: format!("{:08x}", (hardware.full_scale_pa as f32).to_bits()),
            latency_cycles: plan.timeline.latency_cycles,
            interval_cycles: plan.timeline.interval_cycles,
            axi_ports: AXI_SIGNALS.iter().map(port).collect(),
        }
    }

    fn context(&self) -> Result<Context, EmitError> {
        Context::from_serialize(self).map_err(|source| EmitError::Template { template: "registers".to_owned(), source })
    }
}

/// Module of the core: the top itself, unless the register bank is around it.
pub(super) fn core_module(plan: &Plan) -> String {
    let name = &plan.design.name;
    if plan.design.hardware.control { format!("{name}_core") } else { name.clone() }
}

/// `(module, text)` of the bank and of the top around it and the core; none without a bank.
///
/// # Errors
/// [`EmitError::Template`] if a template does not fit the view.
pub(super) fn render(plan: &Plan, hash: &str) -> Result<Vec<(String, String)>, EmitError> {
    if !plan.design.hardware.control {
        return Ok(Vec::new());
    }
    let context = View::new(plan, hash).context()?;
    let mut modules = Vec::new();
    for (suffix, template) in DESIGN_MODULES {
        let module = format!("{}{suffix}", plan.design.name);
        let text = design_module(plan, hash, &module, template, &context)?;
        modules.push((module, text));
    }
    for (module, template) in SHARED_MODULES {
        let origin = format!("// Generated by hdl-gen {VERSION}. Do not edit.\n");
        modules.push((module.to_owned(), framed(&origin, &one(module, template, &context)?)));
    }
    Ok(modules)
}

/// Adds the register map, where there is a bank.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit the view.
pub(super) fn insert(plan: &Plan, hash: &str, files: &mut FileMap) -> Result<(), EmitError> {
    if plan.design.hardware.control {
        let path = map_path(plan);
        let text = one(&path, MAP, &View::new(plan, hash).context()?)?;
        files.insert(path, text.into_bytes());
    }
    Ok(())
}

/// Path of the register map in the generated folder.
pub(super) fn map_path(plan: &Plan) -> String {
    format!("control/{}.rdl", plan.design.name)
}
