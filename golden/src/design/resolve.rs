//! From the keys of a design file to a checked [`Design`], and back.

use super::checks::{self, Check};
use super::files::{CALIBRATION_FILE, CURVE_FILE, FileSource, WEIGHTS_FILE};
use super::joint::Reads;
use super::keys::{AlgorithmKeys, CurveKey, DeadKey, DesignKeys, FORMAT, NoiseKey, SensorKeys, SlipKeys};
use super::{
    Algorithm, DEFAULT_MAX_STANDARD_ERROR, Design, DesignError, Estimator, Input, JointConstants, Kernel,
    NOISE_FLOOR_DIVISOR, Regularisation, Sensor, Slip, filter_keys, joint, rules,
};

/// `beside` are the files that the design names.
pub(super) fn design(keys: DesignKeys, origin: &str, beside: FileSource<'_>) -> Result<Design, DesignError> {
    let check = Check { origin };
    let DesignKeys { name, sensor: keys, algorithm, hardware, .. } = keys;
    checks::name(&check, &name)?;
    checks::part(&check, &hardware.part)?;
    checks::vlnv(&check, &hardware)?;
    let SensorKeys { columns, rows, pitch_mm, depth_mm, .. } = keys;
    let sensor = Sensor { columns, rows, pitch_mm, depth_mm };
    let correction = algorithm.correction.clone();
    let reads =
        Reads { tension: keys.tension, noise: keys.noise.share(), smoothing: keys.smoothing.unwrap_or_default() };
    let algorithm = self::algorithm(&check, algorithm, (&sensor, reads), hardware.full_scale_pa)?;
    rules::tables(&check, &sensor, &algorithm, &hardware)?;
    // Last, so that what is wrong with the design itself is said before its files are read.
    let input = Input::new(&check, keys, beside, sensor.taxels(), &hardware)?;
    let mut design = Design { name, sensor, input, algorithm, hardware };
    rules::input(&check, &design)?;
    design.algorithm.joint.correction =
        correction.map(|keys| joint::correction(&check, &keys, &design.sensor, beside)).transpose()?;
    Ok(design)
}

/// Keys without constants that were fitted to the sensor.
pub(super) fn unfitted(mut keys: DesignKeys) -> DesignKeys {
    (keys.algorithm.standard_error, keys.algorithm.expected_error) = (None, None);
    // Of another estimator they stay, to be refused.
    if keys.algorithm.estimator == Estimator::Joint {
        let AlgorithmKeys { gain, friction_correction, correction, calibrated_for, .. } = &mut keys.algorithm;
        let neutral = JointConstants::default();
        (*gain, *friction_correction) = (Some(neutral.gain), Some(neutral.friction_correction));
        (*correction, *calibrated_for) = (None, None);
    }
    keys
}

/// The table, without the correction, whose file is not read yet.
fn algorithm(
    check: &Check,
    keys: AlgorithmKeys,
    (sensor, reads): (&Sensor, Reads),
    full_scale_pa: f64,
) -> Result<Algorithm, DesignError> {
    let regularisation = match keys.regularisation {
        Some(Regularisation::Factor(0.0)) => Regularisation::None,
        Some(other) => other,
        // Of the whole noise: the frame that restarts an average has it, and constants of single frames serve averages.
        None => Regularisation::usual(sensor, reads.noise),
    };
    let kernel = keys.kernel.unwrap_or(Kernel::usual(sensor));
    let joint = match keys.estimator {
        Estimator::Joint => joint::constants(check, &keys, reads, |reads, training_set| {
            joint::conditions(sensor, reads, kernel, regularisation, training_set)
        })?,
        Estimator::Line => {
            joint::refuse(check, &keys)?;
            JointConstants::default()
        }
    };
    Ok(Algorithm {
        plan: keys.plan,
        kernel,
        regularisation,
        filter: filter_keys::filter(check, keys.filter, sensor)?,
        estimator: keys.estimator,
        joint: Box::new(joint),
        standard_error: keys.standard_error,
        max_standard_error: keys.max_standard_error.unwrap_or(DEFAULT_MAX_STANDARD_ERROR),
        expected_error: keys.expected_error.map(|errors| errors.check(check)).transpose()?,
        contacts: keys.contacts,
        count_contacts: keys.count_contacts,
        outputs: keys.outputs,
        noise_floor_pa: keys.noise_floor_pa.unwrap_or(full_scale_pa / NOISE_FLOOR_DIVISOR),
        slip: keys.slip.map(|keys| slip(check, &keys)).transpose()?,
    })
}

fn slip(check: &Check, keys: &SlipKeys) -> Result<Slip, DesignError> {
    let limit = keys.limit;
    let hysteresis = keys.hysteresis.unwrap_or(0.1 * limit);
    Ok(Slip { limit, hysteresis: check.real("algorithm.slip.hysteresis", hysteresis, 0.0, limit, "")? })
}

/// The keys of a design: every key that has a value, defaults too, so that the text means the same in every version.
pub(super) fn keys(design: &Design, named: impl Fn(&str) -> String) -> DesignKeys {
    let Design { name, sensor, input, algorithm, hardware } = design;
    let Sensor { columns, rows, pitch_mm, depth_mm } = *sensor;
    let curve = input.curve.as_ref().map(|curve| match curve.law {
        Some([power, scale]) => CurveKey::Law { power, scale },
        None => CurveKey::File(named(CURVE_FILE)),
    });
    let taxels: Vec<i64> = input.dead.iter().map(|&taxel| taxel as i64).collect();
    let dead = match (input.room, taxels.is_empty()) {
        (0, true) => None,
        (0, false) => Some(DeadKey::Taxels(taxels)),
        (room, _) => Some(DeadKey::Room { taxels, room }),
    };
    let regularisation = match algorithm.regularisation {
        none @ Regularisation::None if Regularisation::usual(sensor, input.noise) == none => None,
        Regularisation::None => Some(Regularisation::Factor(0.0)),
        other => Some(other),
    };
    let mut keys = AlgorithmKeys {
        plan: algorithm.plan,
        kernel: Some(algorithm.kernel),
        regularisation,
        filter: filter_keys::keys(&algorithm.filter),
        estimator: algorithm.estimator,
        standard_error: algorithm.standard_error,
        max_standard_error: algorithm.standard_error.map(|_| algorithm.max_standard_error),
        expected_error: algorithm.expected_error.clone(),
        contacts: algorithm.contacts,
        count_contacts: algorithm.count_contacts,
        outputs: algorithm.outputs,
        noise_floor_pa: Some(algorithm.noise_floor_pa),
        slip: algorithm.slip.map(|Slip { limit, hysteresis }| SlipKeys { limit, hysteresis: Some(hysteresis) }),
        ..AlgorithmKeys::default()
    };
    if let Some(constants) = algorithm.constants() {
        joint::state(constants, named(WEIGHTS_FILE), &mut keys);
    }
    DesignKeys {
        format: FORMAT,
        base: None,
        name: name.clone(),
        sensor: SensorKeys {
            columns,
            rows,
            pitch_mm,
            depth_mm,
            tension: input.tension,
            noise: input.measured_noise.map_or(NoiseKey::Share(input.noise), NoiseKey::Measured),
            crosstalk: Some(input.crosstalk).filter(|&share| share > 0.0),
            creep: input.creep,
            smoothing: Some(input.smoothing).filter(|&k| k > 0),
            pa_per_count: input.pa_per_count,
            curve,
            calibration: input.calibration.as_ref().map(|_| named(CALIBRATION_FILE)),
            dead,
        },
        algorithm: keys,
        hardware: hardware.clone(),
    }
}
