//! `README.md` of a generated folder: what it is, its ports and words, where to begin.

use golden::design::Samples;
use serde::Serialize;
use tera::{Context, Tera};

use crate::plan::Plan;
use crate::plan::luts::{Logic, logic};
use crate::plan::words::{SUMMARY, SUMMARY_WORDS, Word, status_bits};

use super::flows::vlnv;
use super::{EmitError, FileMap, VERSION};

const TEMPLATE: &str = include_str!("../../templates/README.md.tera");
const NAME: &str = "README.md";

/// The data of the template.
#[derive(Serialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a question that the template asks")]
struct View {
    name: String,
    version: &'static str,
    hash: String,
    columns: usize,
    rows: usize,
    taxels: usize,
    part: String,
    vendor: String,
    library: String,
    clock_mhz: f64,
    latency_cycles: u64,
    latency_us: String,
    interval_cycles: u64,
    frames_per_second: u64,
    dsp_block: &'static str,
    dsp: usize,
    bram36: f64,
    logic: Option<Logic>,
    stream_bits: usize,
    beats_in: usize,
    beats_out: usize,
    /// Type and unit of the values of a frame.
    samples: String,
    /// How many of them a beat has.
    beat: String,
    drops: bool,
    control: bool,
    field: bool,
    words: Vec<Word>,
    summary_words: usize,
    status: Vec<(u32, &'static str)>,
    testbench: bool,
    expected_error: Option<String>,
}

impl View {
    fn new(plan: &Plan, hash: &str, files: &FileMap) -> Self {
        let (design, hardware) = (&plan.design, &plan.design.hardware);
        let (streams, timeline) = (plan.streams(), &plan.timeline);
        let unit = if design.input.counts() { "counts" } else { "pascals, compression negative," };
        let kind = if streams.sample == Samples::Float32 { "float32".to_owned() } else { streams.sample.to_string() };
        let [vendor, library, _] = vlnv(design);
        Self {
            name: design.name.clone(),
            version: VERSION,
            hash: hash.to_owned(),
            columns: design.sensor.columns,
            rows: design.sensor.rows,
            taxels: plan.taxels(),
            part: hardware.part.clone(),
            vendor,
            library,
            clock_mhz: hardware.clock_mhz,
            latency_cycles: timeline.latency_cycles,
            latency_us: format!("{:.2}", timeline.latency_cycles as f64 / hardware.clock_mhz),
            interval_cycles: timeline.interval_cycles,
            frames_per_second: (hardware.clock_mhz * 1e6 / timeline.interval_cycles as f64).round() as u64,
            dsp_block: plan.resources.dsp_block.name(),
            dsp: plan.resources.dsp,
            bram36: plan.resources.bram36,
            logic: logic(plan),
            stream_bits: streams.bits,
            beats_in: streams.beats_in(),
            beats_out: streams.beats_out(),
            samples: format!("{kind} {unit}"),
            beat: match streams.samples() {
                1 => "A beat has one sample.".to_owned(),
                many => format!("A beat has {many} samples, the first in the lowest bits."),
            },
            drops: streams.drops,
            control: hardware.control,
            field: plan.has_field(),
            words: SUMMARY.to_vec(),
            summary_words: SUMMARY_WORDS,
            status: status_bits().collect(),
            testbench: files.contains_key(&format!("sim/{}_tb.v", design.name)),
            expected_error: design.expected_error().map(|expected| expected.to_string()),
        }
    }
}

/// Adds the page; `files` holds what it names.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit the view.
pub fn insert(plan: &Plan, hash: &str, files: &mut FileMap) -> Result<(), EmitError> {
    let failed = |source| EmitError::Template { template: NAME.to_owned(), source };
    let context = Context::from_serialize(&View::new(plan, hash, files)).map_err(failed)?;
    let text = Tera::one_off(TEMPLATE, &context, false).map_err(failed)?;
    files.insert(NAME.to_owned(), text.into_bytes());
    Ok(())
}
