//! The page of an answer: a cell for each taxel, in colour where there is a terminal.

use std::fmt::Write;

use golden::solver::Solution;

/// Towards larger x, then a further eighth of a turn towards larger y each; y is up on the page.
const ARROWS: [char; 8] = ['→', '↗', '↑', '↖', '←', '↙', '↓', '↘'];
/// Shear below this share of the largest force has no direction worth an arrow.
const LEAST_SHEAR: f64 = 0.02;
/// Colours of the 256 of a terminal, from a small to a large normal force: pressing, pulling.
const PRESSING: [u8; 5] = [17, 18, 19, 20, 21];
const PULLING: [u8; 5] = [52, 88, 124, 160, 196];
/// Left of a row: its number.
const MARGIN: usize = 4;
/// Every so many columns have a number where a taxel is one character wide.
const NUMBERED: usize = 10;

/// How a page shows forces.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// With colours of a terminal.
    pub colour: bool,
    /// One character a taxel in place of four.
    pub compact: bool,
    /// The force that the digit 9 stands for, in newtons: the largest component of a force.
    pub largest: f64,
}

/// The largest component of a taxel's force, in newtons.
pub fn largest(answer: &Solution) -> f64 {
    answer.field.iter().flatten().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

/// Characters that the rows of a grid take, four a taxel.
pub fn width(columns: usize) -> usize {
    MARGIN + 4 * columns
}

/// The page of an answer.
pub fn render(title: &str, answer: &Solution, columns: usize, look: Look) -> String {
    let mut text = format!("{title}\n");
    let [x, y, z] = answer.resultant;
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "F = ({x:.3}, {y:.3}, {z:.3}) N   mu = {:.3}   phi = {:.1}°   {}",
        answer.mu,
        answer.phi.to_degrees(),
        answer.status
    );
    let [fx, fy, fz] = &answer.field;
    if fx.is_empty() {
        text.push_str("No field: the design puts out resultants only.\n");
        return text;
    }
    let Look { compact, largest, .. } = look;
    let legend = if compact {
        "arrow: shear; without shear a digit: |f_z|"
    } else {
        "arrow and first digit: shear; second digit: |f_z|"
    };
    let _ = writeln!(text, "{legend}; 9 is {largest:.4} N, · next to nothing\n");
    let rows = fx.len() / columns.max(1);
    for row in (0..rows).rev() {
        let _ = write!(text, "{row:>3} ");
        for taxel in row * columns..(row + 1) * columns {
            text.push_str(&cell([fx[taxel], fy[taxel], fz[taxel]], look));
        }
        text.push('\n');
    }
    text.push_str("    ");
    for column in 0..columns {
        let _ = match compact {
            false => write!(text, "{:>3} ", column % 100),
            true if column % NUMBERED == 0 => write!(text, "{column:<width$}", width = NUMBERED.min(columns - column)),
            true => Ok(()),
        };
    }
    text.push('\n');
    text
}

/// A taxel on the page: arrow, shear, normal force; or one of them.
fn cell([x, y, z]: [f64; 3], Look { colour, compact, largest }: Look) -> String {
    let share = |value: f64| if largest > 0.0 { (value.abs() / largest).min(1.0) } else { 0.0 };
    let shear = x.hypot(y);
    let arrow = if share(shear) < LEAST_SHEAR {
        '·'
    } else {
        let eighths = (y.atan2(x) / std::f64::consts::FRAC_PI_4).round() as i64;
        ARROWS[eighths.rem_euclid(8) as usize]
    };
    let digit = |value: f64| char::from(b'0' + (9.0 * share(value)).round() as u8);
    let plain = match (compact, arrow, digit(z)) {
        (false, arrow, normal) => format!(" {arrow}{}{normal}", digit(shear)),
        (true, '·', normal @ '1'..='9') => normal.to_string(),
        (true, arrow, _) => arrow.to_string(),
    };
    let strength = (share(z) * PRESSING.len() as f64) as usize;
    if !colour || share(z) < LEAST_SHEAR && arrow == '·' {
        return plain;
    }
    let ramp = if z < 0.0 { PRESSING } else { PULLING };
    let background = ramp[strength.min(ramp.len() - 1)];
    let weight = if share(shear) > 0.3 { "1;" } else { "" };
    format!("\x1b[{weight}38;5;231;48;5;{background}m{plain}\x1b[0m")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Look = Look { colour: false, compact: false, largest: 1.0 };
    const COLOUR: Look = Look { colour: true, ..PLAIN };

    #[test]
    fn arrows_point_where_the_shear_does() {
        let turn = |eighths: f64| {
            let (y, x) = (eighths * std::f64::consts::FRAC_PI_4).sin_cos();
            cell([x, y, 0.0], PLAIN).chars().nth(1).expect("an arrow")
        };
        let seen: Vec<char> = (0..8).map(|eighths| turn(f64::from(eighths))).collect();
        assert_eq!(seen, ARROWS);
        assert_eq!([turn(0.4), turn(7.6), turn(-1.0)], ['→', '→', '↘']);
        assert_eq!(cell([0.0, 0.0, 0.0], COLOUR), " ·00");
    }

    #[test]
    fn y_is_up_and_digits_are_shares_of_the_largest_force() {
        let answer = super::super::tests::answer(&[[1.0, 0.0, -2.0], [0.0; 3], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]);
        let look = Look { largest: largest(&answer), ..PLAIN };
        let page = render("t", &answer, 2, look);
        let lines: Vec<&str> = page.lines().collect();
        assert_eq!(lines[4..], ["  1  ↓50 ·05", "  0  →59 ·00", "      0   1 "]);
        assert!(lines[1].starts_with("F = (1.000, 2.000, -3.000) N   mu = 0.500   phi = 57.3°"), "{}", lines[1]);
        assert!(!page.contains('\x1b'));
        assert!(lines[4..].iter().all(|line| line.chars().count() == width(2)));
    }

    #[test]
    fn a_wide_grid_has_a_character_a_taxel() {
        let mut forces = vec![[0.0; 3]; 24];
        forces[12..15].copy_from_slice(&[[1.0, 0.0, -2.0], [0.0, 0.0, -1.0], [0.0, 0.0, -0.01]]);
        let answer = super::super::tests::answer(&forces);
        let page = render("t", &answer, 12, Look { compact: true, largest: 2.0, ..PLAIN });
        let lines: Vec<&str> = page.lines().collect();
        assert_eq!(lines[4..], ["  1 →5··········", "  0 ············", "    0         10"]);
    }

    #[test]
    fn colours_tell_pressing_from_pulling() {
        let [press, pull] = [-1.0, 1.0].map(|z| cell([0.0, 0.0, z], COLOUR));
        assert!(press.contains("48;5;21m") && pull.contains("48;5;196m"), "{press} {pull}");
        assert!(press.ends_with("\x1b[0m"));
    }
}
