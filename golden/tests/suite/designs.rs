//! The designs that tests load, by name.

use std::path::{Path, PathBuf};

use golden::design::Design;

/// Filters of the paper's two sensors, by the end of their names.
const PAPER: [(&str, &str); 5] = [
    ("none", "\"none\""),
    ("f1-l40", "\"f1\", l = 40"),
    ("f1-l50", "\"f1\", l = 50"),
    ("f2-p30", "\"f2\", p = 30.0"),
    ("f2-p50", "\"f2\", p = 50.0"),
];

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace")
}

/// Folders of design files: the shipped ones, and those of the tests.
pub fn folders() -> [PathBuf; 2] {
    ["designs", "golden/tests/designs"].map(|folder| workspace().join(folder))
}

/// The file of this design.
pub fn design_file(name: &str) -> PathBuf {
    let mut files = folders().into_iter().map(|folder| folder.join(format!("{name}.toml")));
    files.find(|file| file.is_file()).unwrap_or_else(|| panic!("no design {name}"))
}

/// The names of the paper's designs, `sensor1-none` to `sensor2-f2-p50`.
pub fn paper() -> impl Iterator<Item = String> {
    ["sensor1", "sensor2"].into_iter().flat_map(|sensor| PAPER.map(|(filter, _)| format!("{sensor}-{filter}")))
}

/// The design of this name: that of a file, or a variant of `designs/paper.toml`.
pub fn design(name: &str) -> Design {
    for (sensor, pitch_mm) in [("sensor1", "[4.0, 2.0]"), ("sensor2", "[4.0, 4.0]")] {
        let filter = name.strip_prefix(sensor).and_then(|end| end.strip_prefix('-'));
        if let Some((_, keys)) = PAPER.iter().find(|(end, _)| filter == Some(end)) {
            let text = format!(
                "format = 3\nbase = \"designs/paper.toml\"\nname = \"{}\"\n[sensor]\npitch_mm = {pitch_mm}\n\
                 [algorithm]\nfilter = {{ kind = {keys} }}\n",
                name.replace('-', "_")
            );
            let origin = workspace().join("variant.toml");
            return Design::from_toml(&text, &origin.to_string_lossy()).expect("a good design");
        }
    }
    Design::load(&design_file(name)).expect("a good design")
}
