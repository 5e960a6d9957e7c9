//! The forces of frames to look at: on a terminal, as a picture, and for machines.

mod page;
mod range;
mod terminal;

use std::error::Error;

use golden::design::Design;
use golden::sensor::Sensor;
use golden::solver::{Solution, Status};
use hdl_gen::model::Model;
use hdl_gen::plan::Plan;
use serde_json::{Value, json};

use crate::field_plot::{self, Truth};
use crate::frame_set::FrameSet;
use crate::stream_words::decode;
use golden::progress::Progress;
use page::Look;
pub use range::FrameRange;
pub use terminal::{Rate, play};

/// A frame with what the hardware answers to it.
pub struct View {
    design: String,
    origin: String,
    frame: usize,
    sensor: Sensor,
    /// In Pa.
    stress: Vec<f64>,
    answer: Solution,
    truth: Option<Truth>,
}

impl View {
    /// Which frame it is, from 0.
    pub fn number(&self) -> usize {
        self.frame
    }

    /// The largest component of a taxel's force, in newtons; 0 where there are resultants only.
    pub fn largest(&self) -> f64 {
        page::largest(&self.answer)
    }

    /// The page for a terminal, on which the digit 9 stands for `largest` newtons; one character a taxel where that is
    /// asked for, or where the terminal is too narrow for four.
    pub fn page(&self, largest: f64, compact: bool) -> String {
        let title = format!("{}, frame {} of {}", self.design, self.frame, self.origin);
        let columns = self.sensor.columns;
        let compact = compact || terminal::columns().is_some_and(|wide| wide < page::width(columns));
        page::render(&title, &self.answer, columns, Look { colour: terminal::wants_colour(), compact, largest })
    }

    /// The same as a picture: the stress, and the forces with the true sum if that is known. `None` where the design puts
    /// out resultants only.
    pub fn svg(&self) -> Option<String> {
        let has_field = !self.answer.field[2].is_empty();
        has_field.then(|| field_plot::frame(&self.sensor, &self.stress, &self.answer, self.truth.as_ref()))
    }

    /// The same for machines; values have the names of the output stream, fields go in taxel order.
    fn json(&self) -> Value {
        let Solution { status, resultant: [force_x, force_y, force_z], mu, phi, mu_x, mu_y, .. } = self.answer;
        let mut json = json!({
            "design": self.design,
            "origin": self.origin,
            "frame": self.frame,
            "columns": self.sensor.columns,
            "status": status.0,
            "meaning": status.to_string(),
            "F_x": force_x,
            "F_y": force_y,
            "F_z": force_z,
            "mu": mu,
            "phi": phi,
            "mu_x": mu_x,
            "mu_y": mu_y,
        });
        let [x, y, z] = &self.answer.field;
        // A design may put out resultants only.
        if !z.is_empty() {
            json["field"] = json!({ "f_x": x, "f_y": y, "f_z": z });
        }
        json
    }
}

/// All values of the answers for machines, forces in N, angles in rad: an object for one frame, a list for several.
///
/// # Errors
/// That of the JSON writer.
pub fn json(views: &[View]) -> Result<String, serde_json::Error> {
    let text = match views {
        [view] => serde_json::to_string_pretty(&view.json())?,
        views => serde_json::to_string_pretty(&views.iter().map(View::json).collect::<Vec<_>>())?,
    };
    Ok(text + "\n")
}

/// Frames as the hardware answers them.
///
/// # Errors
/// What is wrong, if the design has no plan or a frame does not exist.
pub fn frames(
    design: &Design,
    frames: &FrameSet,
    range: FrameRange,
    progress: &Progress,
) -> Result<Vec<View>, Box<dyn Error>> {
    let count = frames.stress.len();
    let range = range.within(count).map_err(|frame| {
        let (origin, last) = (&frames.origin, count.saturating_sub(1));
        format!("--frame {frame}: {origin} has {count} frames; choose 0 to {last}")
    })?;
    progress.stage("planning");
    let plan = Plan::new(design)?;
    progress.stage("computing the forces");
    let mut model = Model::new(&plan);
    let view = |frame: usize| {
        let stress = &frames.stress[frame];
        let words = model.process(&plan.streams().packet(stress));
        View {
            design: design.name.clone(),
            origin: frames.origin.clone(),
            frame,
            sensor: design.sensor.clone(),
            stress: design.stress_of(stress),
            truth: frames.truth_of(frame),
            // The model's answers have the length that it was made for.
            answer: decode(&words).unwrap_or_else(|| Solution::zeros(Status::default(), 0)),
        }
    };
    Ok(range.map(view).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn answer(forces: &[[f64; 3]]) -> Solution {
        let field = [0, 1, 2].map(|axis| forces.iter().map(|force| force[axis]).collect());
        let zeros = Solution::zeros(Status::default(), 0);
        Solution { resultant: [1.0, 2.0, -3.0], mu: 0.5, phi: 1.0, mu_x: 0.3, mu_y: 0.4, field, ..zeros }
    }

    #[test]
    fn resultants_have_no_field() {
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
        let alone = view(answer(&[]));
        assert!(alone.page(1.0, false).contains("resultants only"));
        assert_eq!((alone.svg(), alone.largest()), (None, 0.0));
        let read = |views: &[View]| serde_json::from_str::<Value>(&json(views).unwrap()).unwrap();
        let one = read(&[alone]);
        assert!(one.get("field").is_none() && one["F_z"] == -3.0 && one["mu_y"] == 0.4, "{one}");
        let two = read(&[view(answer(&[[1.0, 2.0, 3.0]])), view(answer(&[]))]);
        assert_eq!((&two[0]["field"]["f_y"], &two[1]["frame"]), (&json!([2.0]), &json!(3)));
    }
}
