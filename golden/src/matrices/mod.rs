//! The 13 matrices of the method, unfiltered.

mod factor;

use std::borrow::Cow;

use nalgebra::DMatrix;

use crate::design::Design;
use crate::kernel::{self, Kernel};
pub use crate::names::MatrixName;
use crate::parity::{FoldedMatrix, Orbits};
use crate::sensor::Sensor;
use factor::{Factors, Spectrum};

/// Why the matrices of a sensor cannot be computed, in words.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct MatrixError(String);

/// C31, C32, C33 and the 13 matrices of a sensor, each `m` by `m`.
///
/// `C` matrices are in Pa/N, `C33inv` and `A` in N/Pa, `D` without unit. All have mirror symmetry and are kept as
/// blocks; the products D are made when asked for, so that a sensor of thousands of taxels needs no more memory than
/// seven matrices of a quarter of `m^2`.
#[derive(Clone, Debug)]
pub struct Matrices {
    /// Stress for forces along x.
    pub c31: FoldedMatrix,
    /// Stress for forces along y.
    pub c32: FoldedMatrix,
    /// Stress for forces along z.
    pub c33: FoldedMatrix,
    c33inv: FoldedMatrix,
    a: [FoldedMatrix; 3],
    condition_c33: f64,
    condition_aat: f64,
    sensor: Sensor,
}

/// Largest condition number that leaves a digit of the result, `1 / f64::EPSILON`.
const SINGULAR: f64 = 1.0 / f64::EPSILON;

/// Condition number of `A A^T` beyond which 0.2 % of noise, as good as tactile sensors are, makes forces of several
/// times the true ones: between depths of 3 and 4 pitches.
const ILL_CONDITIONED: f64 = 1e9;

impl Matrices {
    /// Computes all matrices of a sensor for a load kernel (Pinto-Salamanca et al., Sensors 2024, Eqs. 4, 7 and 14).
    ///
    /// # Errors
    ///
    /// [`MatrixError`] when C33 or `A A^T` is singular to working precision.
    pub fn new(sensor: &Sensor, kernel: Kernel) -> Result<Self, MatrixError> {
        Self::regularised(sensor, kernel, 0.0)
    }

    /// As [`Matrices::new`], by the kernel and the regularisation of a design, fit for frames of a real sensor.
    ///
    /// # Errors
    ///
    /// As [`Matrices::new`], and [`MatrixError`] where the inverses multiply the faintest noise beyond reason.
    pub fn of(design: &Design) -> Result<Self, MatrixError> {
        let sensor = &design.sensor;
        let matrices = Self::regularised(sensor, design.algorithm.kernel, design.algorithm.regularisation.factor())?;
        let condition = matrices.condition_aat;
        if condition > ILL_CONDITIONED {
            let Sensor { depth_mm, pitch_mm: [x, y], .. } = sensor;
            return Err(MatrixError(format!(
                "A A^T has the condition number {condition:.1e}: at a depth of {depth_mm} mm and a pitch of {x} x {y} mm the \
                 noise of any sensor becomes a wild force; write regularisation = {{ noise = 0.002 }} under [algorithm], with \
                 the noise of the sensor, or use a smaller depth or a larger pitch"
            )));
        }
        Ok(matrices)
    }

    /// As [`Matrices::new`], with `factor` times the largest singular value of C33 added to its diagonal; see
    /// [`crate::design::Regularisation`].
    ///
    /// # Errors
    ///
    /// As [`Matrices::new`].
    pub fn regularised(sensor: &Sensor, kernel: Kernel, factor: f64) -> Result<Self, MatrixError> {
        let singular = |matrix: &str, condition: f64| {
            let Sensor { depth_mm, pitch_mm: [x, y], .. } = sensor;
            MatrixError(format!(
                "{matrix} is singular to working precision (condition number {condition:.1e}): a depth of {depth_mm} mm blurs \
                 a pitch of {x} x {y} mm beyond recovery; use a smaller depth or a larger pitch, depth/pitch below about 3, or \
                 write regularisation = 0.01 under [algorithm]"
            ))
        };
        let orbits = Orbits::new(sensor.columns, sensor.rows);
        let mut c = kernel::folded(sensor, kernel);
        let spectrum = Spectrum::new(&orbits, &c[2]);
        let share = factor * spectrum.largest();
        if factor > 0.0 {
            let diagonal = FoldedMatrix::from_fn(0, &orbits, |row, column| if row == column { share } else { 0.0 });
            c[2].blocks.iter_mut().zip(&diagonal.blocks).for_each(|(block, diagonal)| *block += diagonal);
        }
        let factors = Factors::new(&orbits, &c);
        let condition_c33 = spectrum.condition(share);
        let condition_a = factors.condition_a();
        let condition_aat = condition_a * condition_a;
        if is_singular(condition_c33) {
            return Err(singular("C33", condition_c33));
        }
        if is_singular(condition_aat) {
            return Err(singular("A A^T", condition_aat));
        }
        let [c33inv, a1, a2, a3] = factors.inverses(&orbits).ok_or_else(|| singular("A A^T", f64::INFINITY))?;
        let [c31, c32, c33] = c;
        Ok(Self { c31, c32, c33, c33inv, a: [a1, a2, a3], condition_c33, condition_aat, sensor: sensor.clone() })
    }

    /// The sensor that they are of.
    pub fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// The orbits of the sensor.
    pub fn orbits(&self) -> &Orbits {
        &self.c33.orbits
    }

    /// One of the 13 matrices as blocks; the products D are computed here, a quarter of the work of whole matrices.
    pub fn folded(&self, name: MatrixName) -> Cow<'_, FoldedMatrix> {
        match (name, name.product()) {
            (_, Some((p, q))) => Cow::Owned(-self.a[p - 1].times([&self.c33, &self.c31, &self.c32][q])),
            (MatrixName::A1, _) => Cow::Borrowed(&self.a[0]),
            (MatrixName::A2, _) => Cow::Borrowed(&self.a[1]),
            (MatrixName::A3, _) => Cow::Borrowed(&self.a[2]),
            _ => Cow::Borrowed(&self.c33inv),
        }
    }

    /// One of the 13 matrices whole, `m` by `m`. Made anew at each call; on a large sensor ask for one at a time.
    pub fn dense(&self, name: MatrixName) -> DMatrix<f64> {
        self.folded(name).dense()
    }

    /// Condition number of C33 in the 2-norm.
    pub fn condition_c33(&self) -> f64 {
        self.condition_c33
    }

    /// Condition number of `A A^T` in the 2-norm, the square of that of `A`.
    pub fn condition_aat(&self) -> f64 {
        self.condition_aat
    }
}

/// A NaN, from zero over zero, counts as singular.
fn is_singular(condition: f64) -> bool {
    condition.is_nan() || condition >= SINGULAR
}
