//! Frames of contacts with known forces.

use golden::scene::Kind;

use crate::support::{program, shipped, workspace};

/// The frames are those of the kind by the seed; another seed is another contact.
#[test]
fn contacts_of_a_kind_are_made_by_command() {
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, more: &[&str]| {
        let file = folder.path().join(name);
        let mut command = program();
        command.args(["scene", "--design"]).arg(workspace("designs/sensor2-fast.toml"));
        let output = command.args(more).arg("--out").arg(&file).output().unwrap();
        (output, file)
    };
    let options = ["--kind", "held", "--count", "3", "--seed", "7"];
    let [first, second, other] = [("a.csv", "7"), ("b.csv", "7"), ("c.csv", "8")].map(|(name, seed)| {
        let (output, file) = made(name, &[&options[..5], &[seed]].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read(file).unwrap()
    });
    assert!(first == second && first != other);
    let joint = shipped("sensor2-fast");
    let frames = Kind::Held.frames(&joint.sensor, 0.5, 7..10).unwrap();
    let expected = folder.path().join("expected.csv");
    golden::frames::write_frames(&expected, &frames.into_iter().map(|frame| frame.stress).collect::<Vec<_>>()).unwrap();
    assert!(std::fs::read(expected).unwrap() == first);

    let refused = |more: &[&str]| String::from_utf8(made("d.csv", more).0.stderr).unwrap();
    assert!(refused(&["--kind", "holding"]).contains("mixed-inside"));
    assert!(refused(&["--kind", "held", "--friction", "3"]).contains("from 0 to 2"));
    assert!(refused(&["--count", "3"]).contains("--kind"));
}
