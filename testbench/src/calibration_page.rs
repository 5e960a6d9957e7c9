//! A page with plots of a calibration: loads as found, the curve, the gains. Complete in itself.

use std::fmt::Write;

use golden::calibrate::recorded::Recorded;
use golden::design::{Design, Sensor};

use crate::svg::escaped;

/// Sides of a plot in pixels, and its margins: room for a label of six digits on the left, for half of one on the right.
const SIDES: [f64; 2] = [380.0, 300.0];
const MARGIN: f64 = 64.0;
const RIGHT: f64 = 28.0;

/// The page of what recordings told: of uniform pressure, and of contacts with known forces.
pub fn page(design: &Design, [uniform, forces]: [Option<&Recorded>; 2]) -> String {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: calibration</title>\n\
         <style>body{{font:15px/1.45 sans-serif;max-width:58em;margin:2em auto;padding:0 1em;color:#222;background:#fff}}\
         svg{{margin:0 1em 1em 0}}text{{font:12px sans-serif;fill:#333}}h2{{margin-top:1.6em}}</style></head><body>\n\
         <h1>{0}: calibration from recordings</h1>\n",
        escaped(&design.name)
    );
    for (title, unit, found) in [("Uniform pressure", "Pa", uniform), ("Contacts with known forces", "N", forces)] {
        let Some(found) = found else { continue };
        let _ =
            write!(html, "<h2>{title}</h2>\n{}{}{}\n", loads(found, unit), curve(found), gains(found, &design.sensor));
        for (title, lines) in [
            ("Determined", &found.determined),
            ("Not determined", &found.undetermined),
            ("To be known", &found.remarks),
        ] {
            if !lines.is_empty() {
                let items: String = lines.iter().map(|line| format!("<li>{}</li>\n", escaped(line))).collect();
                let _ = write!(html, "<h3>{title}</h3>\n<ul>\n{items}</ul>\n");
            }
        }
    }
    html.push_str("</body></html>\n");
    html
}

/// A plot from 0 to the largest values of both axes.
struct Plot {
    largest: [f64; 2],
    body: String,
}

impl Plot {
    fn new(title: &str, axes: [&str; 2], largest: [f64; 2]) -> Self {
        let largest = largest.map(|value| if value > 0.0 { value * 1.05 } else { 1.0 });
        let ([width, height], m) = (SIDES, MARGIN);
        let mut body = format!(
            "<text x=\"{}\" y=\"18\" text-anchor=\"middle\">{title}</text>\n\
             <path d=\"M{m} {m}V{bottom}H{right}\" fill=\"none\" stroke=\"#555\"/>\n\
             <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n\
             <text transform=\"translate(12 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            0.5 * width,
            0.5 * width,
            height - 6.0,
            axes[0],
            0.5 * height,
            axes[1],
            bottom = height - m,
            right = width - RIGHT,
        );
        let plot = Self { largest, body: String::new() };
        for tick in [0.0, 0.5, 1.0] {
            let [x, y] = plot.at([tick * largest[0], tick * largest[1]]);
            let _ = writeln!(
                body,
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
                 <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                height - m + 15.0,
                figure(tick * largest[0]),
                m - 4.0,
                y + 4.0,
                figure(tick * largest[1])
            );
        }
        Self { body, ..plot }
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [width, height] = SIDES;
        [
            MARGIN + (width - RIGHT - MARGIN) * x / self.largest[0],
            height - MARGIN - (height - 2.0 * MARGIN) * y / self.largest[1],
        ]
    }

    fn line(&mut self, points: impl Iterator<Item = [f64; 2]>, stroke: &str) {
        let points: Vec<String> = points.map(|point| self.at(point)).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            self.body,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{stroke}\" stroke-width=\"1.5\"/>",
            points.join(" ")
        );
    }

    fn svg(self) -> String {
        format!("<svg width=\"{}\" height=\"{}\" role=\"img\">\n{}</svg>\n", SIDES[0], SIDES[1], self.body)
    }
}

fn loads(found: &Recorded, unit: &str) -> String {
    // None was measured where friction alone was.
    if found.holds.is_empty() {
        return String::new();
    }
    let largest = found.holds.iter().fold(0.0_f64, |most, hold| most.max(hold.measured_n).max(hold.found_n));
    let axes = [format!("measured ({unit})"), format!("found, left out ({unit})")];
    let title = if found.errors.is_some() {
        "Each hold, as found when it was left out"
    } else {
        "Each hold (none was left out)"
    };
    let mut plot = Plot::new(title, axes.each_ref().map(String::as_str), [largest; 2]);
    plot.line([[0.0; 2], [largest; 2]].into_iter(), "#999");
    for hold in &found.holds {
        let [x, y] = plot.at([hold.measured_n, hold.found_n]);
        let _ = writeln!(
            plot.body,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"#2a6fb0\" fill-opacity=\"0.6\"><title>frames {} to {}</title></circle>",
            hold.frames[0], hold.frames[1]
        );
    }
    plot.svg()
}

fn curve(found: &Recorded) -> String {
    let largest = found.points.iter().fold([0.0_f64; 2], |most, point| [most[0].max(point[0]), most[1].max(point[1])]);
    let mut plot =
        Plot::new("What a count means, gain 1", ["counts above the unloaded reading", "pascals that press"], largest);
    plot.line(found.points.iter().copied(), "#c0552b");
    plot.svg()
}

/// The gains as a map; taxels that the recording does not tell are crossed out.
fn gains(found: &Recorded, sensor: &Sensor) -> String {
    let side = (SIDES[0] / sensor.columns as f64).min(SIDES[1] / sensor.rows as f64).min(28.0);
    let spread = found.gains.iter().fold(0.01_f64, |most, gain| most.max((gain.gain - 1.0).abs()));
    let mut cells = String::new();
    for (taxel, gain) in found.gains.iter().enumerate() {
        // Rows upwards, as `sptfra view` has them.
        let x = (taxel % sensor.columns) as f64 * side;
        let y = (sensor.rows - 1 - taxel / sensor.columns) as f64 * side;
        let share = (gain.gain - 1.0) / spread;
        let fade = (255.0 - 175.0 * share.abs()).round();
        let colour = if share < 0.0 { format!("rgb({fade},{fade},255)") } else { format!("rgb(255,{fade},{fade})") };
        let _ = writeln!(
            cells,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{side:.1}\" height=\"{side:.1}\" fill=\"{colour}\" stroke=\"#ddd\"><title>taxel {taxel}: {:.3}{}</title></rect>",
            gain.gain,
            if gain.told { "" } else { ", not determined" }
        );
        if !gain.told {
            let _ = writeln!(
                cells,
                "<path d=\"M{x:.1} {y:.1}l{side:.1} {side:.1}m0 -{side:.1}l-{side:.1} {side:.1}\" stroke=\"#bbb\" fill=\"none\"/>"
            );
        }
    }
    let [width, height] = [side * sensor.columns as f64, side * sensor.rows as f64];
    format!(
        "<svg width=\"{0:.0}\" height=\"{1:.0}\" role=\"img\">\n<text x=\"0\" y=\"18\">Gains: blue {2:.2} to red {3:.2}; crossed: not determined</text>\n\
         <g transform=\"translate(0 28)\">\n{cells}</g></svg>\n",
        width.max(SIDES[0]),
        height + 32.0,
        1.0 - spread,
        1.0 + spread
    )
}

fn figure(value: f64) -> String {
    match value.abs() {
        size if size >= 1e6 => format!("{value:.1e}"),
        size if size >= 1000.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels of a character at 12 px, and of the axis title that stands upright.
    const CHARACTER: f64 = 7.0;
    const UPRIGHT: f64 = 16.0;

    #[test]
    fn labels_of_six_digits_are_not_cut() {
        let plot = Plot::new("Pressures", ["measured (Pa)", "found (Pa)"], [643_210.0, 643_210.0]).svg();
        let mut labels = 0;
        for text in plot.split("<text x=\"").skip(1) {
            let (x, text) = text.split_once('"').expect("a number");
            let (x, words) = (x.parse::<f64>().expect("a number"), text.split(['>', '<']).nth(1).expect("words"));
            let width = CHARACTER * words.chars().count() as f64;
            let [left, right] =
                if text.contains("\"end\"") { [x - width, x] } else { [x - 0.5 * width, x + 0.5 * width] };
            assert!(left >= UPRIGHT && right <= SIDES[0], "{words}: {left} to {right}");
            labels += usize::from(words.parse::<f64>().is_ok());
        }
        assert_eq!(labels, 6);
    }
}
