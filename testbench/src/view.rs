//! The forces of a frame as text: an arrow and digits for each taxel, in colour where there is a terminal.

use std::fmt::Write;
use std::io::IsTerminal;

use golden::design::Design;
use golden::sensor::Sensor;
use golden::solver::Status;
use hdl_gen::model::Model;
use hdl_gen::plan::{Plan, PlanError};
use serde::Serialize;
use thiserror::Error;

use crate::field_plot;
use crate::frame_set::FrameSet;
use crate::stream_words::{Answer, decode};
use golden::progress::Progress;

/// Towards larger x, then a further eighth of a turn towards larger y each; y is up on the page.
const ARROWS: [char; 8] = ['→', '↗', '↑', '↖', '←', '↙', '↓', '↘'];
/// Shear below this share of the largest force has no direction worth an arrow.
const LEAST_SHEAR: f64 = 0.02;
/// Colours of the 256 of a terminal, from a small to a large normal force: pressing, pulling.
const PRESSING: [u8; 5] = [17, 18, 19, 20, 21];
const PULLING: [u8; 5] = [52, 88, 124, 160, 196];

/// Why there is nothing to see.
#[derive(Debug, Error)]
pub enum ViewError {
    /// The design cannot be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// There is no such frame.
    #[error("--frame {frame}: {origin} has {count} frames; choose 0 to {}", .count.saturating_sub(1))]
    NoFrame {
        /// The one asked for.
        frame: usize,
        /// How many there are.
        count: usize,
        /// Where they are.
        origin: String,
    },
}

/// Whether standard output is a terminal, and its user has nothing against colours.
pub fn wants_colour() -> bool {
    std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// A frame with what the hardware answers to it.
pub struct View {
    design: String,
    origin: String,
    frame: usize,
    sensor: Sensor,
    /// In Pa.
    stress: Vec<f64>,
    answer: Answer,
    truth: Option<[f64; 3]>,
}

/// A view for machines; values have the names of the output stream, fields go in taxel order.
#[derive(Serialize)]
struct Json<'a> {
    design: &'a str,
    /// Where the frames come from.
    origin: &'a str,
    frame: usize,
    columns: usize,
    status: u32,
    /// The status in words.
    meaning: String,
    #[serde(rename = "F_x")]
    force_x: f64,
    #[serde(rename = "F_y")]
    force_y: f64,
    #[serde(rename = "F_z")]
    force_z: f64,
    mu: f64,
    phi: f64,
    mu_x: f64,
    mu_y: f64,
    /// Not there if the design puts out resultants only.
    #[serde(skip_serializing_if = "Option::is_none")]
    field: Option<Field<'a>>,
}

#[derive(Serialize)]
struct Field<'a> {
    #[serde(rename = "f_x")]
    x: &'a [f64],
    #[serde(rename = "f_y")]
    y: &'a [f64],
    #[serde(rename = "f_z")]
    z: &'a [f64],
}

impl View {
    /// The page for a terminal.
    pub fn page(&self, colour: bool) -> String {
        let title = format!("{}, frame {} of {}", self.design, self.frame, self.origin);
        render(&title, &self.answer, self.sensor.columns, colour)
    }

    /// The same as a picture: the stress, and the forces with the true sum if that is known. `None` where the design puts
    /// out resultants only.
    pub fn svg(&self) -> Option<String> {
        let has_field = !self.answer.field[2].is_empty();
        has_field.then(|| field_plot::frame(&self.sensor, &self.stress, &self.answer, self.truth))
    }

    /// The same for machines: all values of the answer, forces in N, angles in rad.
    ///
    /// # Errors
    /// That of the JSON writer.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        let Answer { status, resultant: [force_x, force_y, force_z], mu, phi, mu_xy: [mu_x, mu_y], .. } = self.answer;
        let [x, y, z] = &self.answer.field;
        let json = Json {
            design: &self.design,
            origin: &self.origin,
            frame: self.frame,
            columns: self.sensor.columns,
            status,
            meaning: Status(status).to_string(),
            force_x,
            force_y,
            force_z,
            mu,
            phi,
            mu_x,
            mu_y,
            field: (!z.is_empty()).then_some(Field { x, y, z }),
        };
        Ok(serde_json::to_string_pretty(&json)? + "\n")
    }
}

/// A frame as the hardware answers it.
///
/// # Errors
/// [`ViewError`] if the design has no plan or the frame does not exist.
pub fn frame(design: &Design, frames: &FrameSet, frame: usize, progress: &Progress) -> Result<View, ViewError> {
    let Some(stress) = frames.stress.get(frame) else {
        return Err(ViewError::NoFrame { frame, count: frames.stress.len(), origin: frames.origin.clone() });
    };
    progress.stage("planning");
    let plan = Plan::new(design)?;
    progress.stage("computing the forces");
    let words = Model::new(&plan).process(&plan.streams().packet(stress));
    Ok(View {
        design: design.name.clone(),
        origin: frames.origin.clone(),
        frame,
        sensor: design.sensor.clone(),
        stress: stress.iter().enumerate().map(|(taxel, &value)| design.input.to_pa(taxel, value)).collect(),
        truth: frames.truth.as_ref().map(|truth| truth[frame].force),
        // The model's answers have the length that it was made for.
        answer: decode(&words).unwrap_or_default(),
    })
}

/// The page of an answer.
pub fn render(title: &str, answer: &Answer, columns: usize, colour: bool) -> String {
    let mut text = format!("{title}\n");
    let [x, y, z] = answer.resultant;
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "F = ({x:.3}, {y:.3}, {z:.3}) N   mu = {:.3}   phi = {:.1}°   {}",
        answer.mu,
        answer.phi.to_degrees(),
        Status(answer.status)
    );
    let [fx, fy, fz] = &answer.field;
    if fx.is_empty() {
        text.push_str("No field: the design puts out resultants only.\n");
        return text;
    }
    let largest = fx.iter().chain(fy).chain(fz).fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let _ =
        writeln!(text, "arrow and first digit: shear; second digit: |f_z|; 9 is {largest:.4} N, · next to nothing\n");
    let rows = fx.len() / columns.max(1);
    for row in (0..rows).rev() {
        let _ = write!(text, "{row:>3} ");
        for taxel in row * columns..(row + 1) * columns {
            text.push_str(&cell([fx[taxel], fy[taxel], fz[taxel]], largest, colour));
        }
        text.push('\n');
    }
    text.push_str("    ");
    for column in 0..columns {
        let _ = write!(text, "{:>3} ", column % 100);
    }
    text.push('\n');
    text
}

/// Four columns of the page: arrow, shear, normal force.
fn cell([x, y, z]: [f64; 3], largest: f64, colour: bool) -> String {
    let share = |value: f64| if largest > 0.0 { (value.abs() / largest).min(1.0) } else { 0.0 };
    let shear = x.hypot(y);
    let arrow = if share(shear) < LEAST_SHEAR {
        '·'
    } else {
        let eighths = (y.atan2(x) / std::f64::consts::FRAC_PI_4).round() as i64;
        ARROWS[eighths.rem_euclid(8) as usize]
    };
    let digit = |value: f64| char::from(b'0' + (9.0 * share(value)).round() as u8);
    let plain = format!(" {arrow}{}{}", digit(shear), digit(z));
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

    fn answer(forces: &[[f64; 3]]) -> Answer {
        let field = [0, 1, 2].map(|axis| forces.iter().map(|force| force[axis]).collect());
        Answer { resultant: [1.0, 2.0, -3.0], mu: 0.5, phi: 1.0, mu_xy: [0.3, 0.4], field, ..Answer::default() }
    }

    #[test]
    fn arrows_point_where_the_shear_does() {
        let turn = |eighths: f64| {
            let (y, x) = (eighths * std::f64::consts::FRAC_PI_4).sin_cos();
            cell([x, y, 0.0], 1.0, false).chars().nth(1).expect("an arrow")
        };
        let seen: Vec<char> = (0..8).map(|eighths| turn(f64::from(eighths))).collect();
        assert_eq!(seen, ARROWS);
        assert_eq!([turn(0.4), turn(7.6), turn(-1.0)], ['→', '→', '↘']);
        assert_eq!(cell([0.0, 0.0, 0.0], 0.0, true), " ·00");
    }

    #[test]
    fn y_is_up_and_digits_are_shares_of_the_largest_force() {
        let page = render("t", &answer(&[[1.0, 0.0, -2.0], [0.0; 3], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]), 2, false);
        let lines: Vec<&str> = page.lines().collect();
        assert_eq!(lines[4..], ["  1  ↓50 ·05", "  0  →59 ·00", "      0   1 "]);
        assert!(lines[1].starts_with("F = (1.000, 2.000, -3.000) N   mu = 0.500   phi = 57.3°"), "{}", lines[1]);
        assert!(!page.contains('\x1b'));
    }

    #[test]
    fn colours_tell_pressing_from_pulling() {
        let [press, pull] = [-1.0, 1.0].map(|z| cell([0.0, 0.0, z], 1.0, true));
        assert!(press.contains("48;5;21m") && pull.contains("48;5;196m"), "{press} {pull}");
        assert!(press.ends_with("\x1b[0m"));
    }

    #[test]
    fn resultants_have_no_field() {
        assert!(render("t", &answer(&[]), 2, true).contains("resultants only"));
        let sensor = Sensor { columns: 2, rows: 2, pitch_mm: [4.0; 2], depth_mm: 3.0 };
        let [design, origin] = ["d", "o"].map(str::to_owned);
        let view = |answer| View {
            design: design.clone(),
            origin: origin.clone(),
            frame: 3,
            sensor: sensor.clone(),
            stress: vec![0.0; 4],
            answer,
            truth: None,
        };
        assert_eq!(view(answer(&[])).svg(), None);
        let json: serde_json::Value = serde_json::from_str(&view(answer(&[])).json().unwrap()).unwrap();
        assert!(json.get("field").is_none() && json["F_z"] == -3.0 && json["mu_y"] == 0.4, "{json}");
        let json: serde_json::Value = serde_json::from_str(&view(answer(&[[1.0, 2.0, 3.0]])).json().unwrap()).unwrap();
        assert_eq!(json["field"]["f_y"], serde_json::json!([2.0]));
    }
}
