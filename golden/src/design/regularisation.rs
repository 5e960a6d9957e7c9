//! The key `regularisation`.

use toml::Value;

use super::DesignError;
use super::checks::Check;

/// Largest factor: beyond it the forces are those of the regularisation.
const MAX_FACTOR: f64 = 1.0;
/// Factor for each unit of noise, from the table of hard cases: least error over depths of 1 to 4 pitches.
const FACTOR_PER_NOISE: f64 = 4.0;

/// What is added to the diagonal of C33, as a share of its largest singular value (Tikhonov's regularisation in the
/// form of Lavrentiev, for a matrix that is symmetric and positive definite).
///
/// In effect each taxel is a little stiffer for a force straight above it than the layer says. Small singular values,
/// which would multiply noise, are lifted to this share of the largest; large ones stay as good as they are. Since it
/// is the same C33 everywhere, all of the method stays as it is: A f = b, the parities, the reduced plan.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Regularisation {
    /// Nothing.
    #[default]
    None,
    /// This share, up to 1.
    Factor(f64),
    /// A share that suits this noise: its standard deviation as a share of the largest stress of a frame.
    Noise(f64),
}

impl Regularisation {
    /// The share of the largest singular value; 0 for none.
    pub fn factor(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Factor(factor) => factor,
            Self::Noise(noise) => (FACTOR_PER_NOISE * noise).min(MAX_FACTOR),
        }
    }
}

pub(super) fn parse(check: &Check, raw: Option<&Value>) -> Result<Regularisation, DesignError> {
    const KEY: &str = "algorithm.regularisation";
    let number = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    let unknown = |found: &Value| {
        check.value(
            KEY,
            format!("is {found}"),
            "write a share of the largest singular value, such as 0.01, or the noise, such as { noise = 0.002 }"
                .to_owned(),
        )
    };
    let Some(value) = raw else { return Ok(Regularisation::None) };
    if let Some(factor) = number(value) {
        let factor = check.real(KEY, factor, 0.0, MAX_FACTOR, "")?;
        return Ok(if factor > 0.0 { Regularisation::Factor(factor) } else { Regularisation::None });
    }
    let table = value.as_table().filter(|table| table.len() == 1).ok_or_else(|| unknown(value))?;
    let noise = table.get("noise").and_then(number).ok_or_else(|| unknown(value))?;
    Ok(Regularisation::Noise(check.above_zero(
        "algorithm.regularisation.noise",
        noise,
        0.25,
        "of the largest stress",
    )?))
}

/// The line of the resolved design; nothing without regularisation.
pub(super) fn print(regularisation: Regularisation) -> String {
    match regularisation {
        Regularisation::None => String::new(),
        Regularisation::Factor(factor) => format!("regularisation = {factor:?}\n"),
        Regularisation::Noise(noise) => format!("regularisation = {{ noise = {noise:?} }}\n"),
    }
}
