//! `README.md` of a generated folder: what it is, its ports and words, where to begin.

use golden::design::Samples;
use tera::{Context, context};

use crate::plan::Plan;
use crate::plan::luts::logic;
use crate::plan::words::{SUMMARY, SUMMARY_WORDS, status_bits};

use super::flows::vlnv;
use super::{EmitError, FileMap, VERSION, template};

const TEMPLATE: &str = include_str!("../../templates/README.md.tera");
const NAME: &str = "README.md";

/// The data of the template.
fn context(plan: &Plan, hash: &str, files: &FileMap) -> Context {
    let (design, hardware) = (&plan.design, &plan.design.hardware);
    let (streams, timeline) = (plan.streams(), &plan.timeline);
    let unit = if design.input.counts() { "counts" } else { "pascals, compression negative," };
    let kind = if streams.sample == Samples::Float32 { "float32".to_owned() } else { streams.sample.to_string() };
    let [vendor, library, _] = vlnv(design);
    context! {
        name => &design.name,
        version => VERSION,
        hash => hash,
        columns => &design.sensor.columns,
        rows => &design.sensor.rows,
        taxels => &plan.taxels(),
        part => &hardware.part,
        vendor,
        library,
        clock_mhz => &hardware.clock_mhz,
        latency_cycles => &timeline.latency_cycles,
        latency_us => &format!("{:.2}", timeline.latency_cycles as f64 / hardware.clock_mhz),
        interval_cycles => &timeline.interval_cycles,
        frames_per_second => &((hardware.clock_mhz * 1e6 / timeline.interval_cycles as f64).round() as u64),
        dsp_block => plan.resources.dsp_block.name(),
        dsp => &plan.resources.dsp,
        bram36 => &plan.resources.bram36,
        logic => &logic(plan),
        stream_bits => &streams.bits,
        beats_in => &streams.beats_in(),
        beats_out => &streams.beats_out(),
        // Type and unit of the values of a frame.
        samples => &format!("{kind} {unit}"),
        // How many of them a beat has.
        beat => &match streams.samples() {
            1 => "A beat has one sample.".to_owned(),
            many => format!("A beat has {many} samples, the first in the lowest bits."),
        },
        drops => &streams.drops,
        control => &hardware.control,
        field => &plan.has_field(),
        words => &SUMMARY,
        summary_words => &SUMMARY_WORDS,
        status => &status_bits().collect::<Vec<_>>(),
        testbench => &files.contains_key(&format!("sim/{}_tb.v", design.name)),
        expected_error => &design.expected_error().map(|expected| expected.to_string()),
    }
}

/// Adds the page; `files` holds what it names.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit its data.
pub fn insert(plan: &Plan, hash: &str, files: &mut FileMap) -> Result<(), EmitError> {
    let text = template::one(NAME, TEMPLATE, &context(plan, hash, files))?;
    files.insert(NAME.to_owned(), text.into_bytes());
    Ok(())
}
