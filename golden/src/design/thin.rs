//! Layers so thin that a contact's edge falls between the taxels.

use super::{Design, Estimator};
use crate::kernel;

/// Depths over the coarser pitch below which the forces are wrong by more than a few percent: by the line estimator, by the
/// joint one with its constants alone, and with a correction. Of 200 unseen round contacts at each depth
/// (`docs/contacts.md`, "Thin layers").
const LINE: f64 = 0.75;
const CONSTANTS: f64 = 0.5;
const CORRECTED: f64 = 0.4;

impl Design {
    /// What to tell whose layer is too thin for its taxels; `None` if it is not.
    pub fn thin_layer(&self) -> Option<String> {
        let [x, y] = self.sensor.pitch_mm;
        let depth = self.sensor.depth_mm / x.max(y);
        let corrected = self.algorithm.joint.correction.is_some();
        let (limit, remedy) = match self.algorithm.estimator {
            Estimator::Line => {
                let short = 100.0 * (1.0 - 1.0 / kernel::gain(&self.sensor, self.algorithm.kernel));
                let wrong = match short {
                    1.0.. => format!("F_z comes out {short:.0} % too small"),
                    // With the "cell" kernel.
                    _ => "tangential forces are off by tenths of F_z".to_owned(),
                };
                (LINE, format!("by the line estimator {wrong}; write estimator = \"joint\""))
            }
            Estimator::Joint if corrected => {
                (CORRECTED, "many frames have no direction, and tangential forces are off by half of F_z".to_owned())
            }
            Estimator::Joint => {
                (CONSTANTS, "tangential forces are off by tenths of F_z; golden calibrate helps down to 0.4".to_owned())
            }
        };
        (depth < limit).then(|| {
            format!("the layer is {depth:.2} of a pitch thin, so that contacts fall between the taxels: {remedy}")
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
        let text = format!(
            "name = \"thin\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = {depth_mm:?}\n\
             [algorithm]\nestimator = \"{estimator}\"\nkernel = \"{kernel}\"\n"
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
        assert!(line.contains("line estimator tangential forces are off"), "{line}");
        let joint = said(1.9, "joint").expect("thin");
        assert!(joint.contains("0.47 of a pitch") && joint.contains("golden calibrate"), "{joint}");
    }

    #[test]
    fn a_correction_carries_further() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs/sensor1-joint.toml");
        let mut design = Design::load(&path).expect("a design");
        for (depth_mm, thin) in [(1.7, false), (1.5, true)] {
            design.sensor.depth_mm = depth_mm;
            assert_eq!(design.thin_layer().is_some_and(|said| said.contains("no direction")), thin, "{depth_mm} mm");
        }
    }
}
