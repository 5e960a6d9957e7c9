//! The keys of `docs/reference/design-keys.md`, printed from the schema that checks the files.

use std::fmt::Write;
use std::fs;

use golden::design::design_schema;
use serde_json::Value;

use crate::support::workspace;

const MARKS: [&str; 2] = ["<!-- printed from the schema -->\n", "<!-- end of what is printed -->\n"];

fn text<'a>(schema: &'a Value, key: &str) -> &'a str {
    schema[key].as_str().unwrap_or_default()
}

fn toml(value: &Value) -> String {
    toml::Value::try_from(value).map_or_else(|_| value.to_string(), |value| value.to_string())
}

/// Type and range of a value, in words.
fn kind(schema: &Value) -> String {
    if let Some(forms) = schema["anyOf"].as_array() {
        return forms.iter().map(kind).collect::<Vec<_>>().join(" or ");
    }
    if let Some(allowed) = schema["enum"].as_array() {
        return allowed.iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
    }
    if let Some(words) = schema["oneOf"].as_array() {
        return words.iter().map(|word| format!("`{}`", word["const"])).collect::<Vec<_>>().join(", ");
    }
    let bound = |name: &str| schema[name].as_f64().map(|bound| bound.to_string());
    let range = match (bound("minimum"), bound("maximum"), bound("exclusiveMinimum")) {
        (_, Some(high), Some(low)) => format!(" above {low}, at most {high}"),
        (_, None, Some(low)) => format!(" above {low}"),
        (Some(low), Some(high), None) => format!(" from {low} to {high}"),
        _ => String::new(),
    };
    match text(schema, "type") {
        "integer" => format!("whole number{range}"),
        "number" => format!("number{range}"),
        "boolean" => "true or false".to_owned(),
        "string" => "text".to_owned(),
        "array" if schema["maxItems"] == 2 => format!("two of: {}", kind(&schema["items"])),
        "array" => format!("list of: {}", kind(&schema["items"])),
        _ => "table".to_owned(),
    }
}

/// An entry for each key of a table, and below it those of the keys that it has.
fn keys(page: &mut String, table: &Value, path: &str) {
    let required = table["required"].as_array();
    for (name, schema) in table["properties"].as_object().into_iter().flatten() {
        if path.is_empty() && schema["type"] == "object" {
            let _ = write!(page, "\n## [{name}]\n\n{}\n\n", text(schema, "description"));
            keys(page, schema, &format!("{name}."));
            continue;
        }
        let shown = path.split_once('.').map_or("", |(_, rest)| rest);
        let default = match schema.get("default").filter(|_| schema.get("properties").is_none()) {
            Some(default) => format!("; default `{}`", toml(default)),
            None if required.is_some_and(|names| names.iter().any(|one| one == name)) => "; required".to_owned(),
            None => String::new(),
        };
        let _ = writeln!(page, "- `{shown}{name}`: {}{default}. {}", kind(schema), text(schema, "description"));
        for word in schema["oneOf"].as_array().into_iter().flatten() {
            let _ = writeln!(page, "  - `{}`: {}", word["const"], text(word, "description"));
        }
        for form in schema["anyOf"].as_array().map_or(std::slice::from_ref(schema), Vec::as_slice) {
            keys(page, form, &format!("{path}{name}."));
        }
    }
}

/// `UPDATE_EXPECTED=1` prints them anew.
#[test]
fn keys_of_the_page_are_those_of_the_schema() {
    let file = workspace("docs/reference/design-keys.md");
    let page = fs::read_to_string(&file).expect("readable");
    let (before, rest) = page.split_once(MARKS[0]).expect("a mark");
    let (_, after) = rest.split_once(MARKS[1]).expect("a mark");
    let mut expected = format!("{before}{}", MARKS[0]);
    keys(&mut expected, design_schema(), "");
    let expected = format!("{expected}\n{}{after}", MARKS[1]);
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        fs::write(&file, &expected).expect("written");
    }
    assert!(fs::read_to_string(&file).expect("readable") == expected, "UPDATE_EXPECTED=1 prints the keys anew");
}
