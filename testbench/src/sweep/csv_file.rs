//! The points as CSV.

use golden::metrics::ERROR_NAMES;

use super::SweepError;
use super::point::Point;

/// One line a point, numbers as in the JSON: every key of a point but the counts of its matrices and statuses.
///
/// # Errors
/// [`SweepError::Io`] never happens in memory, but the writer may say so.
pub fn csv(points: &[Point]) -> Result<String, SweepError> {
    let failed = |source: std::io::Error| SweepError::Io { action: "write", path: "sweep.csv".into(), source };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header()).map_err(|error| failed(error.into()))?;
    for point in points {
        writer.write_record(row(point)).map_err(|error| failed(error.into()))?;
    }
    let bytes = writer.into_inner().map_err(|error| failed(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn header() -> Vec<String> {
    let fixed = "key scene columns rows pitch_x_mm pitch_y_mm depth_mm plan kernel filter estimator joint_units joint_training_set \
                 coefficient_bits data_bits lanes verified latency_cycles interval_cycles latency_us interval_us \
                 dsp bram36 rom_bits macs nnz_total frames mean_mu";
    let mut names: Vec<String> = fixed.split_whitespace().map(str::to_owned).collect();
    for kind in ["max", "standard_error"] {
        names.extend(ERROR_NAMES.iter().map(|name| format!("{name}_{kind}")));
    }
    names.extend(ERROR_NAMES.iter().map(|name| format!("f64_{name}_max")));
    names.extend(["resultant_max", "field_max", "refusal"].map(str::to_owned));
    names
}

fn row(point: &Point) -> Vec<String> {
    let [pitch_x, pitch_y] = point.sensor.pitch_mm;
    let hardware = point.hardware.as_ref();
    let of = |value: Option<String>| value.unwrap_or_default();
    let mut row = vec![
        point.key.clone(),
        point.scene.clone(),
        point.sensor.columns.to_string(),
        point.sensor.rows.to_string(),
        pitch_x.to_string(),
        pitch_y.to_string(),
        point.sensor.depth_mm.to_string(),
        point.plan.to_string(),
        point.kernel.to_string(),
        point.filter.clone(),
        point.estimator.to_string(),
        of(point.calibration.map(|joint| joint.units.to_string())),
        of(point.calibration.map(|joint| joint.training_set.to_string())),
        point.coefficient_bits.to_string(),
        point.data_bits.to_string(),
        point.lanes.to_string(),
        format!("{:?}", point.verified).to_lowercase(),
        of(hardware.map(|hardware| hardware.latency_cycles.to_string())),
        of(hardware.map(|hardware| hardware.interval_cycles.to_string())),
        of(hardware.map(|hardware| hardware.latency_us.to_string())),
        of(hardware.map(|hardware| hardware.interval_us.to_string())),
        of(hardware.map(|hardware| hardware.dsp.to_string())),
        of(hardware.map(|hardware| hardware.bram36.to_string())),
        of(hardware.map(|hardware| hardware.rom_bits.to_string())),
        of(hardware.map(|hardware| hardware.macs.to_string())),
        point.nnz_total.to_string(),
        point.frames.to_string(),
        point.mean_mu.to_string(),
    ];
    row.extend(point.errors.spreads().map(|spread| spread.max.to_string()));
    row.extend(point.errors.spreads().map(|spread| spread.standard_error.to_string()));
    row.extend(point.solver_errors.spreads().map(|spread| spread.max.to_string()));
    let against = point.against_solver.as_ref();
    row.push(of(against.and_then(|error| error.resultant_max).map(|value| value.to_string())));
    row.push(of(against.and_then(|error| error.field_max).map(|value| value.to_string())));
    row.push(of(point.refusal.clone()));
    row
}
