//! The points as CSV.

use std::error::Error;

use golden::metrics::ERROR_NAMES;

use super::point::Point;

/// One line a point, numbers as in the JSON: every key of a point but the counts of its matrices and statuses.
///
/// # Errors
/// Those of the writer, of which none happens in memory.
pub fn csv(points: &[Point]) -> Result<String, Box<dyn Error>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // No sweep is without points.
    let names = points.first().map(|point| columns(point).into_iter().map(|(name, _)| name).collect::<Vec<_>>());
    let rows = points.iter().map(|point| columns(point).into_iter().map(|(_, value)| value).collect());
    for record in names.into_iter().chain(rows) {
        writer.write_record(record)?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// Names and values of a point's line.
fn columns(point: &Point) -> Vec<(String, String)> {
    let [pitch_x, pitch_y] = point.sensor.pitch_mm;
    let (joint, hardware, against) = (point.calibration, point.hardware, point.against_solver);
    let fixed = [
        ("key", point.key.clone()),
        ("scene", point.scene.clone()),
        ("columns", point.sensor.columns.to_string()),
        ("rows", point.sensor.rows.to_string()),
        ("pitch_x_mm", pitch_x.to_string()),
        ("pitch_y_mm", pitch_y.to_string()),
        ("depth_mm", point.sensor.depth_mm.to_string()),
        ("plan", point.plan.to_string()),
        ("kernel", point.kernel.to_string()),
        ("filter", point.filter.clone()),
        ("estimator", point.estimator.to_string()),
        ("joint_units", of(joint.map(|joint| joint.units))),
        ("joint_training_set", of(joint.map(|joint| joint.training_set))),
        ("coefficient_bits", point.coefficient_bits.to_string()),
        ("data_bits", point.data_bits.to_string()),
        ("lanes", point.lanes.to_string()),
        ("verified", format!("{:?}", point.verified).to_lowercase()),
        ("latency_cycles", of(hardware.map(|hardware| hardware.latency_cycles))),
        ("interval_cycles", of(hardware.map(|hardware| hardware.interval_cycles))),
        ("latency_us", of(hardware.map(|hardware| hardware.latency_us))),
        ("interval_us", of(hardware.map(|hardware| hardware.interval_us))),
        ("dsp", of(hardware.map(|hardware| hardware.dsp))),
        ("bram36", of(hardware.map(|hardware| hardware.bram36))),
        ("rom_bits", of(hardware.map(|hardware| hardware.rom_bits))),
        ("macs", of(hardware.map(|hardware| hardware.macs))),
        ("nnz_total", point.nnz_total.to_string()),
        ("frames", point.frames.to_string()),
        ("mean_mu", point.mean_mu.to_string()),
    ];
    let named = |(name, value): (&str, String)| (name.to_owned(), value);
    let mut columns: Vec<(String, String)> = fixed.map(named).into();
    let mut add = |front: &str, kind: &str, values: [f64; 5]| {
        let names = ERROR_NAMES.iter().map(|name| format!("{front}{name}_{kind}"));
        columns.extend(names.zip(values.map(|value| value.to_string())));
    };
    add("", "max", point.errors.spreads().map(|spread| spread.max));
    add("", "standard_error", point.errors.spreads().map(|spread| spread.standard_error));
    add("f64_", "max", point.solver_errors.spreads().map(|spread| spread.max));
    let last = [
        ("resultant_max", of(against.and_then(|error| error.resultant_max))),
        ("field_max", of(against.and_then(|error| error.field_max))),
        ("refusal", of(point.refusal.as_ref())),
    ];
    columns.extend(last.map(named));
    columns
}

fn of(value: Option<impl ToString>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}
