//! What is made of the keys' one statement: schema, commented design.

use golden::design::{Design, design_schema};
use serde_json::Value;

use super::MINIMAL;

/// Every key has a meaning, and one that is neither required nor has a default an example.
#[test]
fn the_schema_says_all_of_a_key() {
    fn tables(node: &Value, path: &str, count: &mut usize) {
        let required: Vec<&str> = node["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        for (name, key) in node["properties"].as_object().into_iter().flatten() {
            let path = format!("{path}.{name}");
            assert!(key["description"].as_str().is_some_and(|text| !text.is_empty()), "{path}");
            let has_example = key.get("default").is_some() || key.get("examples").is_some();
            assert!(has_example || required.contains(&name.as_str()), "{path}");
            *count += 1;
            tables(key, &path, count);
        }
    }
    let schema = design_schema();
    let mut count = 0;
    tables(schema, "", &mut count);
    assert!(count > 40, "{count}");
    assert_eq!(schema["properties"]["hardware"]["properties"]["lanes"]["maximum"], 128);
    assert_eq!(schema["properties"]["hardware"]["additionalProperties"], false);
    assert!(!schema.to_string().contains("null"), "TOML has no null");
}

/// A commented design is the design, and each of its remarks that is a key can be made one.
#[test]
fn a_commented_design_reads_back_the_same() {
    let design = Design::from_toml(MINIMAL, "pad.toml").unwrap();
    let text = design.to_commented_toml();
    assert_eq!(Design::from_toml(&text, "commented.toml").unwrap(), design);
    assert!(text.lines().all(|line| line.chars().count() <= 120), "{text}");
    for (remark, key) in [("# pa_per_count = -12.5", "pa_per_count"), ("# noise_floor_pa = 1.5", "noise_floor_pa")] {
        assert!(text.contains(remark), "{text}");
        let given = text.replace(remark, remark.trim_start_matches("# "));
        let read = Design::from_toml(&given, "commented.toml").unwrap();
        assert!(read != design && read.to_toml().contains(key));
    }
}
