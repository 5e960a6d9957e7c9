//! The rooms of the generator: who may import whom, and where Verilog is printed.

use std::fs;
use std::path::{Path, PathBuf};

/// Rooms in the order of imports: each may import those before it.
const ROOMS: [&str; 11] =
    ["cores", "parameters", "format", "resources", "timing", "estimators", "plan", "blocks", "build", "model", "emit"];

fn files(place: &Path) -> Vec<PathBuf> {
    if place.is_file() {
        return vec![place.to_owned()];
    }
    let entries = fs::read_dir(place).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| files(&path)).collect()
}

/// The code of each file of a room, but for tests.
fn texts(room: &str) -> Vec<(PathBuf, String)> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let place = [source.join(room), source.join(format!("{room}.rs"))].into_iter().find(|place| place.exists());
    let code = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default().to_owned();
        (path, code)
    };
    files(&place.unwrap()).into_iter().map(code).collect()
}

#[test]
fn imports_point_one_way() {
    for (number, room) in ROOMS.into_iter().enumerate() {
        for (path, text) in texts(room) {
            for other in &ROOMS[number + 1..] {
                let import = format!("crate::{other}::");
                let imports = text.contains(&import) || text.contains(&format!("crate::{other};"));
                assert!(!imports, "{}: imports {other}, which comes later", path.display());
            }
        }
    }
}

/// Templates and parameters of instances; nobody else.
#[test]
fn only_templates_and_parameters_print_verilog() {
    for room in ROOMS.into_iter().filter(|room| !["emit", "parameters"].contains(room)) {
        for (path, text) in texts(room) {
            let literal = ["'d{", "'sd{", "'h{", "'b{", "'{base}"].into_iter().find(|literal| text.contains(literal));
            assert_eq!(literal, None, "{}: a Verilog literal", path.display());
        }
    }
}
