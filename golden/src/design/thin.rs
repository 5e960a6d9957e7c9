//! Layers so thin that a contact's edge falls between the taxels.

use super::Design;
use crate::kernel::{self, Kernel};

/// Depth over the coarser pitch below which no kernel and no correction serve.
const LEAST: f64 = 0.3;
const BELOW: &str = "take a thicker layer or a finer pitch";
const TENTHS: &str = "tangential forces are off by tenths of F_z";

impl Design {
    /// What to tell whose layer is too thin for its taxels; `None` if it is not.
    ///
    /// Below the limits, depths over the coarser pitch, forces are wrong by more than a few percent: of 200 unseen round
    /// contacts at each depth (`docs/explanation/accuracy.md`, "Depth over pitch"). The grid search's gain makes up for the
    /// normal force, its correction for part of the rest. That part is larger where forces are spread over their cells:
    /// through a thin layer a point force beside a taxel hardly reaches it.
    pub fn thin_layer(&self) -> Option<String> {
        let (sensor, kernel) = (&self.sensor, self.algorithm.kernel);
        let has_correction = self.algorithm.constants().map(|joint| joint.correction.is_some());
        let (limit, wrong, remedy) = match (has_correction, kernel) {
            // By the line search what falls between the taxels is lost.
            (None, _) => {
                let short = 100.0 * (1.0 - 1.0 / kernel::gain(sensor, kernel));
                let wrong = match short {
                    1.0.. => format!("by the line search F_z comes out {short:.0} % too small"),
                    // With the "cell" kernel.
                    _ => format!("by the line search {TENTHS}"),
                };
                (0.75, wrong, "write estimator = \"joint\"")
            }
            (Some(false), Kernel::Point) => (0.5, TENTHS.into(), "kernel = \"cell\" and sptfra calibrate serve to 0.3"),
            (Some(false), Kernel::Cell) => (0.4, TENTHS.into(), "sptfra calibrate serves down to 0.3"),
            (Some(true), Kernel::Point) => {
                let remedy = "kernel = \"cell\", calibrated anew, serves down to 0.3";
                (0.4, "many frames have no direction".into(), remedy)
            }
            (Some(true), Kernel::Cell) => (LEAST, "one contact in twenty is off by a tenth of F_z".into(), BELOW),
        };
        let remedy = if has_correction.is_some() && sensor.is_thinner_than(LEAST) { BELOW } else { remedy };
        let depth = sensor.depth_by_pitch();
        sensor.is_thinner_than(limit).then(|| {
            format!(
                "the layer is {depth:.2} of a pitch thin, so that contacts fall between the taxels: {wrong}; {remedy}"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(depth_mm: f64, estimator: &str) -> Option<String> {
        by_kernel(depth_mm, estimator, "point")
    }

    fn by_kernel(depth_mm: f64, estimator: &str, kernel: &str) -> Option<String> {
        let constants = if estimator == "joint" { "gain = 1\nfriction_correction = [1, 0]\n" } else { "" };
        let text = format!(
            "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
             name = \"thin\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = {depth_mm:?}\n\
             [algorithm]\nestimator = \"{estimator}\"\nkernel = \"{kernel}\"\n{constants}"
        );
        Design::from_toml(&text, "thin").expect("a design").thin_layer()
    }

    #[test]
    fn what_is_thin_depends_on_the_estimator() {
        assert_eq!([said(3.0, "line"), said(2.0, "joint")], [None, None]);
        let line = said(2.8, "line").expect("thin");
        assert!(line.contains("0.70 of a pitch") && line.contains("write estimator = \"joint\""), "{line}");
        assert!(line.contains("F_z comes out"), "{line}");
        let line = by_kernel(2.8, "line", "cell").expect("thin");
        assert!(line.contains("line search tangential forces are off"), "{line}");
        assert_eq!(by_kernel(1.9, "joint", "cell"), None);
        let cells = by_kernel(1.5, "joint", "cell").expect("thin");
        assert!(cells.contains("0.38 of a pitch") && cells.contains("sptfra calibrate serves"), "{cells}");
        let thinnest = by_kernel(1.0, "joint", "cell").expect("thin");
        assert!(thinnest.contains("thicker layer") && !thinnest.contains("calibrate"), "{thinnest}");
        let joint = said(1.9, "joint").expect("thin");
        assert!(joint.contains("0.47 of a pitch") && joint.contains("sptfra calibrate"), "{joint}");
    }

    #[test]
    fn a_correction_carries_further() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs/sensor1-fast.toml");
        let mut design = Design::load(&path).expect("a design");
        for (depth_mm, thin) in [(1.7, false), (1.5, true)] {
            design.sensor.depth_mm = depth_mm;
            assert_eq!(design.thin_layer().is_some_and(|said| said.contains("no direction")), thin, "{depth_mm} mm");
        }
        design.algorithm.kernel = crate::kernel::Kernel::Cell;
        for (depth_mm, thin) in [(1.2, false), (1.1, true)] {
            design.sensor.depth_mm = depth_mm;
            assert_eq!(design.thin_layer().is_some_and(|said| said.contains("thicker layer")), thin, "{depth_mm} mm");
        }
        // 0.39999... of a pitch was meant to be 0.4.
        (design.sensor.pitch_mm, design.sensor.depth_mm) = ([1.5, 1.5], 0.6);
        (design.algorithm.joint.correction, design.algorithm.kernel) = (None, crate::kernel::Kernel::Cell);
        assert_eq!(design.thin_layer(), None);
    }
}
