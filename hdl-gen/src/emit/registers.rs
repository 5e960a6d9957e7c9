//! The register bank on AXI4-Lite around a core: its Verilog, and its map in `SystemRDL`.

use serde::Serialize;
use serde_json::{Value, json};
use tera::{Context, context};

use crate::blocks::registers::Field;
use crate::blocks::{calibration, registers};
use crate::plan::Plan;
use crate::plan::calibration::CalibrationPlan;

use super::instance::verilog;
use super::template::{design_module, one};
use super::{EmitError, FileMap};

const MAP: &str = include_str!("../../templates/control/registers.rdl.tera");

/// The top around the bank and the core.
const TOP: &str = include_str!("../../templates/rtl/control/top.v.tera");

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

/// Fields of read-only registers that the register map's template has as hexadecimal digits.
const HEXADECIMAL: [&str; 3] = ["hash_low", "hash_high", "full_scale"];

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

/// The data of the templates.
fn context(plan: &Plan, hash: &str) -> Context {
    let port = |&(signal, output, bits): &(&'static str, bool, u32)| AxiPort {
        signal,
        bus: signal.to_uppercase(),
        direction: if output { "output" } else { "input " },
        range: format!("{:6}", if bits == 1 { String::new() } else { format!("[{}:0]", bits - 1) }),
        used: !signal.ends_with("prot"),
    };
    let constants = registers::constants(plan, hash);
    let mut context = context! {
        name => &plan.design.name,
        axi_ports => &AXI_SIGNALS.iter().map(port).collect::<Vec<_>>(),
        // Bits and 32-bit words of a beat.
        stream_bits => &plan.streams().bits,
        words => &plan.streams().words(),
        // Whether frames that find no room are dropped.
        overrun => &plan.streams().drops,
        // The design's rate of averages; 0 where frames are not averaged.
        smoothing => &plan.smoothing.as_ref().map_or(0, |of| of.rate),
        // Parameters of the bank.
        registers => &verilog(&registers::parameters(plan, &constants)),
        calibration => &plan.calibration.as_ref().map(of_calibration),
    };
    for Field { name, value, .. } in constants {
        let text = if HEXADECIMAL.contains(&name) { format!("{value:08x}") } else { value.to_string() };
        context.insert(name, &text);
    }
    context
}

/// What the templates say of a calibration in RAM.
fn of_calibration(of: &CalibrationPlan) -> Value {
    let steps = of.count_steps.to_bits();
    let first = of.power_up.gain_words().next().unwrap_or_default();
    let [command_bits, words_bits] = calibration::bank_bits(of);
    json!({
        "control": verilog(&calibration::control(of)),
        "registers": verilog(&calibration::registers(of)),
        // Bits of what goes between the banks and their control.
        "command_bits": command_bits,
        "words_bits": words_bits,
        "tare_bits": calibration::tare_bits(of.taxels),
        // Reset values of the map.
        "words": of.words(),
        "shift": of.shift,
        "lsb": calibration::lsb(of),
        "offset_limit": of.offset_limit,
        "steps_low": format!("{:08x}", steps as u32),
        "steps_high": format!("{:08x}", steps >> 32),
        "first_word": format!("{first:08x}"),
        "crc": format!("{:08x}", of.power_up.crc()),
        // Dead taxels that a bank has room for.
        "replaceable": of.power_up.dead.room,
        // What `CALIBRATION_CURVE` says, where banks hold a curve.
        "curve": calibration::curve_register(of),
    })
}

/// Module of the core: the top itself, unless the register bank is around it.
pub(super) fn core_module(plan: &Plan) -> String {
    let name = &plan.design.name;
    if plan.design.hardware.control { format!("{name}_core") } else { name.clone() }
}

/// `(module, text)` of the top around the bank and the core; none without a bank.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit its data.
pub(super) fn render(plan: &Plan, hash: &str) -> Result<Vec<(String, String)>, EmitError> {
    if !plan.design.hardware.control {
        return Ok(Vec::new());
    }
    let module = plan.design.name.clone();
    let text = design_module(&module, TOP, &context(plan, hash))?;
    Ok(vec![(module, text)])
}

/// Adds the register map, where there is a bank.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit its data.
pub(super) fn insert(plan: &Plan, hash: &str, files: &mut FileMap) -> Result<(), EmitError> {
    if plan.design.hardware.control {
        let path = map_path(plan);
        let text = one(&path, MAP, &context(plan, hash))?;
        files.insert(path, text.into_bytes());
    }
    Ok(())
}

/// Path of the register map in the generated folder.
pub(super) fn map_path(plan: &Plan) -> String {
    format!("control/{}.rdl", plan.design.name)
}
