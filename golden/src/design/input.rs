//! What the values of a frame are: pascals, or the counts of a real sensor.

use super::DesignError;
use super::calibration::Calibration;
use super::checks::Check;
use super::curve::Curve;
use super::files::FileSource;
use super::hardware::Hardware;
use super::keys::{DeadKey, SensorKeys};
use super::readings::{DEFAULT_NOISE, MeasuredNoise, Tension};
use super::rules;
use crate::creep::Creep;

/// From the values of a frame to stress: `Pa = (gain_i * count + offset_i) * pa_per_count`, or, with a curve,
/// `Pa = gain_i * curve(count) + offset_i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Pascals of one count, with the sign that makes compression negative; `None` where frames are in pascals.
    pub pa_per_count: Option<f64>,
    /// From counts to pascals, in place of `pa_per_count`, where the sensor is not linear.
    pub curve: Option<Curve>,
    /// Gain and offset of each taxel; only with counts.
    pub calibration: Option<Calibration>,
    /// Taxels whose readings mean nothing, in ascending order: others take their place. Those of gain 0 are among them.
    pub dead: Vec<usize>,
    /// Dead taxels for which a bank of a calibration in RAM has room, 0, 1, 2, 4 or 8; 0: those of the design, for good.
    pub room: usize,
    /// Whether the sensor reads what pulls.
    pub tension: Tension,
    /// Standard deviation of a reading's noise, as a share of the frame's largest reading: `sptfra calibrate` trains at up to
    /// 1.5 times this noise, or of what `smoothing` leaves of it. Where it was measured, the share in a typical contact.
    pub noise: f64,
    /// The noise as measured, alike in every frame; `None`: each frame's is the share of its own largest reading.
    pub measured_noise: Option<MeasuredNoise>,
    /// Share of the sums of its row and of its column that a taxel reads beside its own stress; 0: none.
    pub crosstalk: f64,
    /// Creep that is removed, if any.
    pub creep: Option<Creep>,
    /// Frames are averaged with the weight `2^-k`; 0: they are not.
    pub smoothing: u32,
}

impl Default for Input {
    fn default() -> Self {
        Self {
            pa_per_count: None,
            curve: None,
            calibration: None,
            dead: Vec::new(),
            room: 0,
            tension: Tension::default(),
            noise: DEFAULT_NOISE,
            measured_noise: None,
            crosstalk: 0.0,
            creep: None,
            smoothing: 0,
        }
    }
}

impl Input {
    /// Stress in pascals of a taxel whose value in the frame is `value`, with crosstalk in it; of a dead one 0.
    pub fn to_pa(&self, taxel: usize, value: f64) -> f64 {
        if self.dead.contains(&taxel) {
            return 0.0;
        }
        if let Some(curve) = &self.curve {
            let (gain, offset) = self.of_taxel(taxel);
            return gain * curve.at(value) + offset;
        }
        let Some(pa_per_count) = self.pa_per_count else { return value };
        match &self.calibration {
            Some(Calibration { gain, offset }) => (gain[taxel] * value + offset[taxel]) * pa_per_count,
            None => value * pa_per_count,
        }
    }

    /// The value in a frame, not rounded, of a taxel under a stress in pascals: undoes [`Input::to_pa`]. A dead taxel
    /// reads 0.
    pub fn from_pa(&self, taxel: usize, stress: f64) -> f64 {
        if self.dead.contains(&taxel) {
            return 0.0;
        }
        if let Some(curve) = &self.curve {
            let (gain, offset) = self.of_taxel(taxel);
            return curve.count((stress - offset) / gain);
        }
        let Some(pa_per_count) = self.pa_per_count else { return stress };
        match &self.calibration {
            Some(Calibration { gain, offset }) => (stress / pa_per_count - offset[taxel]) / gain[taxel],
            None => stress / pa_per_count,
        }
    }

    /// The input of the same sensor whose frames are in pascals, one by one: what gains and curve have made of counts.
    pub(crate) fn of_pascals(&self) -> Self {
        let Self { ref dead, tension, noise, crosstalk, .. } = *self;
        Self { dead: dead.clone(), tension, noise, measured_noise: self.noise_pa(), crosstalk, ..Self::default() }
    }

    /// The largest stress of a typical contact in pascals, whose share `noise` every frame has; `None`: a share of its own.
    pub fn typical_pa(&self) -> Option<f64> {
        self.noise_pa().map(|noise| noise.largest)
    }

    /// The noise as measured, in pascals.
    fn noise_pa(&self) -> Option<MeasuredNoise> {
        self.measured_noise.map(|noise| noise.times(self.pa_per_count.unwrap_or(1.0).abs()))
    }

    /// Gain and offset of a taxel.
    pub(crate) fn of_taxel(&self, taxel: usize) -> (f64, f64) {
        self.calibration.as_ref().map_or((1.0, 0.0), |Calibration { gain, offset }| (gain[taxel], offset[taxel]))
    }

    /// Whether frames are in counts.
    pub fn counts(&self) -> bool {
        self.pa_per_count.is_some() || self.curve.is_some()
    }

    /// Whether a value is so large that the sensor's curve ends before it.
    pub(crate) fn is_beyond(&self, value: f64) -> bool {
        self.curve.as_ref().is_some_and(|curve| value.abs() >= curve.largest_count())
    }

    /// From the keys of `[sensor]`; a calibration is one of the files `beside` the design.
    pub(super) fn new(
        check: &Check,
        keys: SensorKeys,
        beside: FileSource<'_>,
        taxels: usize,
        hardware: &Hardware,
    ) -> Result<Self, DesignError> {
        rules::counts(check, &keys)?;
        let SensorKeys { tension, noise, crosstalk, creep, smoothing, pa_per_count, curve, calibration, dead, .. } =
            keys;
        let (crosstalk, smoothing) = (crosstalk.unwrap_or(0.0), smoothing.unwrap_or(0));
        let curve = curve.map(|curve| Curve::new(check, curve, beside, hardware)).transpose()?;
        let (dead, room) = match dead {
            None => (Vec::new(), 0),
            Some(DeadKey::Taxels(taxels)) => (taxels, 0),
            Some(DeadKey::Room { taxels, room }) => (taxels, room),
        };
        let named = dead.iter().enumerate().map(|(index, &taxel)| {
            let key = format!("sensor.dead[{index}]");
            check.integer(&key, taxel, 0, taxels as i64 - 1).map(|taxel| taxel as usize)
        });
        let mut dead = named.collect::<Result<Vec<_>, _>>()?;
        let calibration =
            calibration.map(|file| Calibration::load(&file, beside, taxels, curve.as_ref())).transpose()?;
        let gains = calibration.iter().flat_map(|calibration| calibration.gain.iter().enumerate());
        dead.extend(gains.filter(|&(_, &gain)| gain == 0.0).map(|(taxel, _)| taxel));
        dead.sort_unstable();
        dead.dedup();
        let (noise, measured_noise) = (noise.share(), noise.measured());
        Ok(Self {
            pa_per_count,
            curve,
            calibration,
            dead,
            room,
            tension,
            noise,
            measured_noise,
            crosstalk,
            creep,
            smoothing,
        })
    }
}
