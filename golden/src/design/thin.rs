//! Layers so thin that a contact's edge falls between the taxels.

use super::Design;
use crate::estimators;

impl Design {
    /// What to tell whose layer is too thin for its taxels; `None` if it is not. How thin is too thin, the estimator says.
    pub fn thin_layer(&self) -> Option<String> {
        let depth = self.sensor.depth_by_pitch();
        let thin = estimators::thin(self.algorithm.constants(), &self.sensor, self.algorithm.kernel);
        self.sensor.is_thinner_than(thin.limit).then(|| {
            let remedy = thin.remedy;
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
