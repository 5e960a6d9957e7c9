//! What the correction sees of a contact: the stress that the normal forces alone would cause, in a window that moves with
//! the contact, and where between the taxels its centre lies.

use crate::numbers::centre;

/// The middle between two taxels, in pitches, is taken for this much more: a contact right between them, as every even
/// grid has one in its middle, would else be given to one of them by the last digit. The calibration's contacts lie
/// anywhere, and there no tie is broken.
pub const TIE: f64 = 1.0 / 1024.0;
/// Stress in the window is taken as a share of `sum |b|`, times this.
pub const STRESS_SCALE: f64 = 16.0;

/// What the network sees of a contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Features {
    pub(super) half_window: [usize; 2],
    /// The window row by row, then `mu_x, mu_y`, the centre's distance from the middle of the window in pitches, and 1.
    pub(crate) values: Vec<f64>,
}

impl Features {
    /// Takes the stress `normal` (pascals, taxel order, `columns` to a row) around the centre of its compression.
    ///
    /// The window is centred at the taxel next to the centroid of the compressed taxels, and is 0 beyond the grid. A
    /// centroid up to `tie` of a pitch from the middle between two taxels belongs to the second one.
    pub(crate) fn take(
        &mut self,
        normal: &[f64],
        columns: usize,
        half_window: [usize; 2],
        stress_sum: f64,
        mu: [f64; 2],
        tie: f64,
    ) {
        let places = (0..).map(|taxel: usize| [taxel % columns, taxel / columns].map(|at| at as f64));
        let pressed = normal.iter().map(|stress| (-stress).max(0.0)).zip(places);
        // Without compression any place does: there is nothing to see.
        let centroid = centre(pressed).unwrap_or_default();
        let centre = centroid.map(|at| (at + (0.5 + tie)).floor());
        let [half_x, half_y] = half_window.map(|half| half as i64);
        let [centre_x, centre_y] = centre.map(|at| at as i64);
        let rows = (normal.len() / columns) as i64;
        let scale = if stress_sum > 0.0 { STRESS_SCALE / stress_sum } else { 0.0 };
        self.half_window = half_window;
        self.values.clear();
        for y in centre_y - half_y..=centre_y + half_y {
            for x in centre_x - half_x..=centre_x + half_x {
                let inside = (0..columns as i64).contains(&x) && (0..rows).contains(&y);
                self.values.push(if inside { scale * normal[y as usize * columns + x as usize] } else { 0.0 });
            }
        }
        self.values.extend([mu[0], mu[1], centroid[0] - centre[0], centroid[1] - centre[1], 1.0]);
    }

    /// Writes the features, mirrored where a sign is negative, to `into`, of the same length.
    #[cfg(test)]
    pub(super) fn mirrored(&self, [sign_x, sign_y]: [f64; 2], into: &mut [f64]) {
        let [width, height] = self.half_window.map(|half| 2 * half + 1);
        for (index, value) in into.iter_mut().enumerate().take(width * height) {
            let (x, y) = (index % width, index / width);
            let x = if sign_x < 0.0 { width - 1 - x } else { x };
            let y = if sign_y < 0.0 { height - 1 - y } else { y };
            *value = self.values[y * width + x];
        }
        let signs = [sign_x, sign_y, sign_x, sign_y, 1.0];
        for (offset, sign) in signs.into_iter().enumerate() {
            into[width * height + offset] = sign * self.values[width * height + offset];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_moves_with_the_contact_and_ends_at_the_grid() {
        // Compression at column 2 of row 0, in a grid of 4 by 3.
        let mut normal = vec![0.0; 12];
        (normal[2], normal[1], normal[3], normal[6]) = (-4.0, -1.0, -1.0, -0.5);
        let mut seen = Features::default();
        seen.take(&normal, 4, [1, 1], 16.0, [0.3, -0.2], 0.0);
        let window = [0.0, 0.0, 0.0, -1.0, -4.0, -1.0, 0.0, -0.5, 0.0];
        assert_eq!(seen.values[..9], window);
        assert_eq!(seen.values[9..11], [0.3, -0.2]);
        assert!(seen.values[11].abs() < 1e-15 && (seen.values[12] - 0.5 / 6.5).abs() < 1e-15);
        assert_eq!(seen.values[13].to_bits(), 1.0_f64.to_bits());
    }
}
