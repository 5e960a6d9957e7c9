//! Points of a plot as dots that all can be seen: those of one colour that would lie on each other are one dot with
//! their number, and one of another colour stands out below it as a ring.

use crate::svg::{INK, Svg};
use crate::sweep::point::{Hardware, Point, Verified};

/// Radius of a dot that lies on nothing.
const RADIUS: f64 = 4.5;
/// How much wider the dot below is.
const WIDER: f64 = 2.5;
/// Room that the number beside a dot takes, and the height of its digits.
const NUMBER: [f64; 2] = [18.0, 12.0];
const DIGIT: f64 = 9.0;
/// From the dot to the ring around what went through the RTL.
const RING: f64 = 3.0;

/// On which side of the plot a value is too far to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rim {
    Within,
    Above,
    Below,
}

/// A point, where it is drawn, and in what.
#[derive(Clone, Copy, Debug)]
pub struct Dot<'a> {
    pub place: (f64, f64),
    pub rim: Rim,
    /// Name and colour of its kind.
    pub kind: (&'static str, &'static str),
    pub point: &'a Point,
    pub hardware: &'a Hardware,
}

/// Dots of one kind at one place, the most exact first.
struct Cluster<'a> {
    dots: Vec<Dot<'a>>,
    radius: f64,
}

/// Draws the dots into a picture.
pub fn draw(svg: &mut Svg, dots: Vec<Dot>) {
    let mut clusters = clusters(dots);
    // What is below comes first.
    clusters.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    for Cluster { dots, radius } in &clusters {
        let Dot { place, rim, kind: (_, colour), .. } = dots[0];
        let name = name(dots);
        match rim {
            Rim::Within => svg.named_dot(place, *radius, colour, &name),
            Rim::Above => svg.named_triangle(place, radius + 1.0, colour, &name),
            Rim::Below => svg.named_triangle(place, -radius - 1.0, colour, &name),
        }
        if dots.iter().any(|dot| dot.point.verified == Verified::Rtl) {
            svg.ring(place, radius + RING, colour);
        }
    }
    // Above all dots, so that none covers a number.
    let mut numbers: Vec<(f64, f64)> = Vec::new();
    for cluster in clusters.iter().filter(|cluster| cluster.dots.len() > 1) {
        let place = beside(cluster, &clusters, &numbers);
        numbers.push(place);
        svg.haloed_text(place, INK, &cluster.dots.len().to_string());
    }
}

/// Where the number of a cluster hides least: above its dot, below, or at a side.
fn beside(cluster: &Cluster, clusters: &[Cluster], numbers: &[(f64, f64)]) -> (f64, f64) {
    let ((x, y), away) = (cluster.dots[0].place, cluster.radius + RING);
    let side = away + NUMBER[0] / 2.0;
    let middle = y + DIGIT / 2.0;
    let places = [(x, y - away), (x, y + away + DIGIT), (x + side, middle), (x - side, middle)];
    let hidden = |&(x, y): &(f64, f64)| {
        let upon = |other: &&(f64, f64)| (other.0 - x).abs() < NUMBER[0] && (other.1 - y).abs() < NUMBER[1];
        let covers = |other: &&Cluster| {
            let (at, reach) = (other.dots[0].place, other.radius);
            (at.0 - x).abs() < NUMBER[0] / 2.0 + reach && (at.1 - y + DIGIT / 2.0).abs() < DIGIT / 2.0 + reach
        };
        // A number upon another cannot be read; one upon a dot can.
        (numbers.iter().filter(upon).count(), clusters.iter().filter(covers).count())
    };
    places.into_iter().min_by_key(hidden).unwrap_or((x, y))
}

/// A dot takes in those of its kind that would cover half of it; a cluster that another one lies on is drawn wider.
fn clusters(mut dots: Vec<Dot>) -> Vec<Cluster> {
    dots.sort_by(|a, b| a.point.tangential().total_cmp(&b.point.tangential()));
    let mut clusters: Vec<Cluster> = Vec::new();
    for dot in dots {
        let near = |other: &Dot| (dot.place.0 - other.place.0).hypot(dot.place.1 - other.place.1);
        let same = |first: &Dot| first.kind == dot.kind && first.rim == dot.rim && near(first) < RADIUS;
        if let Some(known) = clusters.iter_mut().find(|cluster| same(&cluster.dots[0])) {
            known.dots.push(dot);
            continue;
        }
        let covered = clusters.iter().filter(|other| near(&other.dots[0]) < 0.8 * RADIUS);
        let radius = covered.map(|other| other.radius + WIDER).fold(RADIUS, f64::max);
        clusters.push(Cluster { dots: vec![dot], radius });
    }
    clusters
}

/// What a dot is; of several, what they have in common, and the most exact.
fn name(dots: &[Dot]) -> String {
    let Dot { point, hardware, kind, .. } = dots[0];
    if dots.len() == 1 {
        return format!(
            "{}: {} cycles, {:.1} % tangential, e_mu {:.1} %, {} DSP; {}",
            point.label(),
            hardware.latency_cycles,
            point.tangential(),
            point.errors.e_mu.max,
            hardware.dsp,
            point.verified.title()
        );
    }
    let range = |value: fn(&Dot) -> f64| {
        let values = || dots.iter().map(value);
        format!("{:.1} to {:.1}", values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max))
    };
    format!(
        "{} variants of {}, {} µs, {} % tangential: {:.1} % by {}",
        dots.len(),
        kind.0,
        range(|dot| dot.hardware.latency_us),
        range(|dot| dot.point.tangential()),
        point.tangential(),
        point.label()
    )
}

#[cfg(test)]
mod tests {
    use super::super::conclusion::tests::point;
    use super::super::front::front;

    #[test]
    fn none_hides_another() {
        let mut filtered = point("a", 16, 2000, 4.0);
        filtered.filter = "f1-40".to_owned();
        let points = [point("a", 16, 2000, 4.0), point("b", 16, 2001, 4.01), filtered, point("c", 64, 1000, 4.0)];
        let svg = front(&points.each_ref(), false, false);
        // Two in one, one of another kind upon it, one apart.
        assert_eq!(svg.matches("<g class=\"dot\"").count(), 3, "{svg}");
        let number = svg.rfind(">2</text>").expect("a number");
        assert!(svg.rfind("<g class=\"dot\"").is_some_and(|dot| dot < number), "above all dots: {svg}");
        assert!(
            svg.contains("paint-order=\"stroke\"")
                && svg.contains("2 variants of line, reduced plan, no filter, 16.0 to 16.0 µs")
        );
        let radius: Vec<&str> = ["r=\"7\"", "r=\"4.5\""].into_iter().filter(|radius| svg.contains(radius)).collect();
        assert_eq!(radius.len(), 2, "{svg}");
    }
}
