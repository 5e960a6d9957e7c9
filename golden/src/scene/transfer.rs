//! What becomes of a wave of load on its way from the surface down to the taxels.
//!
//! For a wave vector k the normal stress at depth h is `-H_P(kh) p + i H_Q(kh) (k . q / |k|)`, where p presses and q
//! is the tangential load. The inverse length k and the depth appear only as their product.

/// The elastic layer between surface and taxels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Medium {
    /// A half-space; its stress on a plane parallel to the surface does not depend on Poisson's ratio.
    HalfSpace,
    /// A layer with the taxels at its base, bonded to a rigid ground.
    BondedLayer {
        /// Poisson's ratio, 0 to 0.5.
        poisson: f64,
    },
}

impl Medium {
    /// `[H_P, H_Q]` for `kh = |k| h >= 0`.
    ///
    /// The layer is in plane strain along k. Its stress function `A cosh + B z cosh + C sinh + D z sinh` meets the load
    /// at the surface and has no displacement at the base; elimination gives the quotients below. All hyperbolic
    /// functions are scaled by `exp(-kh)`, so that nothing overflows.
    pub fn transfer(self, kh: f64) -> [f64; 2] {
        let decay = (-kh).exp();
        match self {
            Self::HalfSpace => [(1.0 + kh) * decay, kh * decay],
            Self::BondedLayer { poisson } => {
                let n = 1.0 - 2.0 * poisson;
                let g = 2.0 - 2.0 * poisson;
                let square = decay * decay;
                let cosh = 0.5 * (1.0 + square);
                let sinh = 0.5 * (1.0 - square);
                let determinant = kh * kh * square + (g * cosh).powi(2) - (n * sinh).powi(2);
                let scale = g * decay / determinant;
                [scale * (g * cosh + kh * sinh), scale * (kh * cosh + n * sinh)]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layer_matches_independent_values() {
        let table = [
            (0.49, 0.5, 0.91489, 0.37241),
            (0.49, 1.0, 0.80654, 0.45960),
            (0.49, 2.0, 0.60430, 0.41392),
            (0.49, 4.0, 0.17655, 0.14146),
            (0.45, 1.0, 0.81706, 0.47233),
        ];
        for (poisson, kh, normal, tangential) in table {
            let [h_p, h_q] = Medium::BondedLayer { poisson }.transfer(kh);
            assert!((h_p - normal).abs() < 5.1e-6, "nu {poisson} kh {kh}: {h_p}");
            assert!((h_q - tangential).abs() < 5.1e-6, "nu {poisson} kh {kh}: {h_q}");
        }
    }

    #[test]
    fn long_waves_press_through_and_short_waves_die_out() {
        for medium in [Medium::HalfSpace, Medium::BondedLayer { poisson: 0.3 }, Medium::BondedLayer { poisson: 0.5 }] {
            let [h_p, h_q] = medium.transfer(0.0);
            assert!((h_p - 1.0).abs() < 1e-15 && h_q.abs() < 1e-15);
            assert!(medium.transfer(1000.0).iter().all(|h| *h == 0.0));
        }
    }
}
