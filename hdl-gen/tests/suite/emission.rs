//! What is emitted: the same bytes every time, complete, readable back.

use std::collections::BTreeSet;

use golden::design::{Correction, Design, WEIGHTS_FILE};
use hdl_gen::cores::Multiplier;
use hdl_gen::emit::rtl::library;
use hdl_gen::emit::{FileMap, emit};
use hdl_gen::plan::Plan;
use serde_json::Value;

use crate::support::{design_text, plan, small_plan};

fn text_files(files: &FileMap) -> impl Iterator<Item = (&str, &str)> {
    files.iter().map(|(name, bytes)| (name.as_str(), std::str::from_utf8(bytes).expect("text")))
}

#[test]
fn the_same_design_gives_the_same_bytes() {
    let text = design_text("pad", [5, 4], [4.0, 2.0], 3.0, "[algorithm]\nplan = \"paper\"\n[hardware]\nlanes = 6");
    let once = emit(&plan(&text)).unwrap();
    let threads: Vec<_> = (0..2)
        .map(|_| {
            let text = text.clone();
            std::thread::spawn(move || emit(&plan(&text)).unwrap())
        })
        .collect();
    assert_eq!(emit(&plan(&text)).unwrap(), once);
    for thread in threads {
        assert_eq!(thread.join().unwrap(), once);
    }
}

#[test]
fn files_tell_neither_place_nor_time() {
    let files = emit(&small_plan("")).unwrap();
    let folder = |path: std::path::PathBuf| path.to_str().unwrap().to_owned();
    let mut places = vec![folder(std::env::current_dir().unwrap()), folder(std::env::temp_dir())];
    places.extend([env!("CARGO_MANIFEST_DIR").to_owned(), "C:\\".to_owned()]);
    places.extend(std::env::home_dir().map(folder).filter(|home| home.len() > 1));
    for (name, text) in text_files(&files) {
        assert!(!name.starts_with('/') && !name.contains(".."), "{name}");
        for place in &places {
            assert!(!text.contains(place), "{name} contains {place}");
        }
        let is_date = |window: &[u8]| {
            window
                .iter()
                .enumerate()
                .all(|(at, byte)| if at == 4 || at == 7 { *byte == b'-' } else { byte.is_ascii_digit() })
        };
        assert!(!text.as_bytes().windows(10).any(is_date), "{name} contains a date");
        assert!(!text.contains('\r') && text.ends_with('\n'), "{name}: line ends");
    }
}

#[test]
fn the_resolved_design_gives_the_same_files() {
    let hardware = "lanes = 3\nfull_scale_pa = 12345.6\nclock_mhz = 99.9\ncoefficient_bits = 17\ndata_bits = 26";
    let files = emit(&small_plan(hardware)).unwrap();
    let resolved = std::str::from_utf8(&files["design.toml"]).unwrap();
    assert_eq!(Design::from_toml(resolved, "design.toml").unwrap(), small_plan(hardware).design);
    assert_eq!(emit(&plan(resolved)).unwrap(), files);
}

#[test]
fn metadata_describes_the_folder() {
    let plan = small_plan("lanes = 5");
    let files = emit(&plan).unwrap();
    let metadata: Value = serde_json::from_slice(&files["metadata.json"]).unwrap();
    assert_eq!(metadata["name"], "pad");
    assert_eq!(metadata["top"], "pad");
    assert_eq!(
        (&metadata["taxels"], &metadata["beats_in"], &metadata["beats_out"]),
        (&12.into(), &12.into(), &52.into())
    );
    assert_eq!(metadata["format"], 3);
    // The list has every word once, or a part of it, in the order of the stream.
    let output = metadata["output"].as_array().unwrap();
    let place =
        |name: &str| output.iter().find(|word| word["name"] == name).map(|word| (&word["index"], &word["type"]));
    assert_eq!(place("F_z"), Some((&4.into(), &"float32".into())));
    assert_eq!(place("T_x"), Some((&5.into(), &"float32".into())));
    assert_eq!(place("status"), Some((&0.into(), &"flags".into())));
    assert_eq!(place("timestamp"), Some((&1.into(), &"unsigned".into())));
    let field = output.last().unwrap();
    assert_eq!((&field["name"], &field["index"], &field["count"]), (&"field".into(), &16.into(), &36.into()));
    let indexes: Vec<u64> = output.iter().map(|word| word["index"].as_u64().unwrap()).collect();
    assert!(indexes.is_sorted());
    assert_eq!(metadata["status_bits"]["slip"], 10);
    assert_eq!(metadata["predicted"]["latency_cycles"], plan.timeline.latency_cycles);
    assert_eq!(metadata["predicted"]["interval_cycles"], plan.timeline.interval_cycles);
    assert_eq!(metadata["formats"]["stress_pa"]["lsb"], plan.formats.stress.lsb);
    assert_eq!(metadata["products"].as_array().unwrap().len(), plan.products.len());
    assert_eq!(metadata["nnz"].as_object().unwrap().len(), 13);
    let listed: BTreeSet<&str> = metadata["files"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    let there: BTreeSet<&str> = files.keys().map(String::as_str).filter(|&name| name != "metadata.json").collect();
    assert_eq!(listed, there);
}

/// Every file that the folder's page names is in the folder, and its figures are those of `metadata.json`.
#[test]
fn the_readme_describes_the_folder() {
    for hardware in ["", "control = true\nstream_bits = 64"] {
        let files = emit(&small_plan(hardware)).unwrap();
        let readme = std::str::from_utf8(&files["README.md"]).unwrap();
        let named = readme.split(['`', ' ', '\n']).map(|word| word.trim_start_matches("FOLDER/"));
        let named: BTreeSet<&str> = named.filter(|word| word.contains('/') && word.contains('.')).collect();
        assert!(named.len() > 1 && named.iter().all(|path| files.contains_key(*path)), "{named:?}");
        assert_eq!(readme.contains("control/"), !hardware.is_empty());
        let metadata: Value = serde_json::from_slice(&files["metadata.json"]).unwrap();
        let cycles = |key: &str| format!("{} cycles, ", metadata["predicted"][key]);
        assert!(readme.contains(&format!("| {}", cycles("latency_cycles"))), "{readme}");
        assert!(readme.contains(&format!("| {}", cycles("interval_cycles"))), "{readme}");
        assert!(readme.contains(&format!("an answer is {} beats", metadata["beats_out"])), "{readme}");
    }
}

#[test]
fn every_file_holds_the_module_it_is_named_after() {
    for plan in
        [small_plan("lanes = 1"), plan(&design_text("wide", [10, 10], [4.0, 2.0], 3.0, "[hardware]\nlanes = 64"))]
    {
        let files = emit(&plan).unwrap();
        let modules: Vec<_> = text_files(&files).filter(|(name, _)| name.starts_with("rtl/")).collect();
        assert!(modules.len() > 20);
        for (name, text) in modules {
            let module = name.trim_start_matches("rtl/").trim_end_matches(".v");
            let code: Vec<&str> = text.lines().filter(|line| line.starts_with("module ")).collect();
            assert_eq!(code.len(), 1, "{name}");
            let rest = code[0].trim_start_matches("module ");
            assert!(rest.starts_with(module) && rest[module.len()..].starts_with([' ', '(']), "{name}: {}", code[0]);
            assert!(text.starts_with("// ") && !text.contains("{%"), "{name}");
        }
    }
}

#[test]
fn a_design_that_differs_differs_in_its_hash() {
    let hash = |hardware: &str| {
        let files = emit(&small_plan(hardware)).unwrap();
        let metadata: Value = serde_json::from_slice(&files["metadata.json"]).unwrap();
        metadata["design_hash"].as_str().unwrap().to_owned()
    };
    assert_eq!(hash("lanes = 4"), hash("lanes = 4\nclock_mhz = 125.0"));
    assert_ne!(hash("lanes = 4"), hash("lanes = 8"));
}

#[test]
fn a_generated_design_has_its_weights_beside_it_and_in_its_hash() {
    let emitted = |weight: i32| {
        let text = design_text(
            "pad",
            [4, 3],
            [4.0, 2.0],
            3.0,
            "[algorithm]\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]",
        );
        let mut design = Design::from_toml(&text, "pad.toml").unwrap();
        design.algorithm.joint.correction = Some(Correction {
            half_window: [0, 0],
            hidden: vec![vec![1, 2, 3, 4, 5, weight]],
            output: [vec![7], vec![8]],
        });
        emit(&Plan::new(&design).unwrap()).unwrap()
    };
    let files = emitted(6);
    // The folder's design can be used as it stands.
    let folder = tempfile::tempdir().unwrap();
    for name in ["design.toml", WEIGHTS_FILE] {
        std::fs::write(folder.path().join(name), &files[name]).unwrap();
    }
    let design = Design::load(&folder.path().join("design.toml")).unwrap();
    assert_eq!(emit(&Plan::new(&design).unwrap()).unwrap(), files);
    let hash = |files: &FileMap| {
        let metadata: Value = serde_json::from_slice(&files["metadata.json"]).unwrap();
        metadata["design_hash"].as_str().unwrap().to_owned()
    };
    assert_ne!(hash(&files), hash(&emitted(7)));
}

/// A message of the simulation names its instance: modules stand in a core several times.
#[test]
fn messages_of_modules_carry_the_path_of_their_instance() {
    let modules = library(Multiplier::Whole);
    let messages = modules.iter().flat_map(|(module, text)| text.lines().map(move |line| (module, line)));
    let messages: Vec<_> = messages.filter(|(_, line)| line.contains("display(")).collect();
    assert!(messages.len() > 10, "{messages:?}");
    for (module, line) in messages {
        assert!(line.contains("$fdisplay(32'h80000002, \"%m: "), "{module}: {line}");
    }
}
