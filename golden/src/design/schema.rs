//! The JSON schema of design files, and what is printed from it: the reference page and a commented design.

use std::fmt::Write;
use std::sync::LazyLock;

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

use super::Design;
use super::keys::DesignKeys;
use super::ranges::words;

/// Columns of a commented design.
const WIDTH: usize = 110;

static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
    // Editors read draft 7; references would only be in the way of those who walk over the schema.
    let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<DesignKeys>().to_value();
    tidy(&mut schema);
    schema["title"] = "Design file of sptfra".into();
    schema
});

/// The schema as a tree.
pub(super) fn schema() -> &'static Value {
    &SCHEMA
}

/// The JSON schema of a design file, draft 7, for editors: a design begins with `#:schema FILE`.
pub fn design_schema() -> String {
    format!("{:#}\n", *SCHEMA)
}

/// Takes out what TOML does not have, nulls, and the line ends of doc comments.
fn tidy(node: &mut Value) {
    match node {
        Value::Object(object) => {
            object.retain(|_, value| !value.is_null());
            if let Some(Value::String(text)) = object.get_mut("description") {
                let paragraph = text.split("\n\n").next().unwrap_or_default();
                *text = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
            }
            if let Some(Value::Array(kinds)) = object.get_mut("type") {
                kinds.retain(|kind| kind != "null");
                if let [kind] = kinds.as_slice() {
                    object["type"] = kind.clone();
                }
            }
            if let Some(Value::Array(alternatives)) = object.get_mut("anyOf") {
                alternatives.retain(|alternative| alternative["type"] != "null");
                if let [only] = alternatives.as_mut_slice()
                    && let Value::Object(only) = only.take()
                {
                    object.remove("anyOf");
                    let own = std::mem::replace(object, only);
                    // What is said of the key goes before what is said of its type.
                    object.extend(own);
                }
            }
            object.values_mut().for_each(tidy);
        }
        Value::Array(values) => values.iter_mut().for_each(tidy),
        _ => (),
    }
}

fn properties(schema: &Value) -> impl Iterator<Item = (&String, &Value)> {
    schema["properties"].as_object().into_iter().flat_map(Map::iter)
}

/// Whether a key has keys of its own and no other form.
fn is_table(schema: &Value) -> bool {
    schema["type"] == "object" && schema.get("properties").is_some()
}

fn text<'a>(schema: &'a Value, key: &str) -> &'a str {
    schema[key].as_str().unwrap_or_default()
}

/// A value as TOML writes it.
fn toml(value: &Value) -> String {
    toml::Value::try_from(value).map_or_else(|_| value.to_string(), |value| value.to_string())
}

/// The reference page of the keys, in Markdown.
pub fn design_reference() -> String {
    let mut page = String::from(
        "# Keys of a design file\n\n\
         A design file is TOML. A key without a default that is not marked as required may be left out.\n\
         This page is printed from the schema that checks the files.\n",
    );
    let (tables, top): (Vec<_>, Vec<_>) = properties(schema()).partition(|(_, schema)| is_table(schema));
    page.push_str("\n## Top of the file\n");
    keys(&mut page, schema(), "", &top);
    for (name, table) in tables {
        let _ = write!(page, "\n## `[{name}]`\n\n{}\n", text(table, "description"));
        keys(&mut page, table, "", &properties(table).collect::<Vec<_>>());
    }
    page
}

/// The entries of keys, and below each of them those of the keys that it has.
fn keys(page: &mut String, table: &Value, path: &str, of: &[(&String, &Value)]) {
    let required = table["required"].as_array();
    for (name, schema) in of {
        let is_required = required.is_some_and(|names| names.iter().any(|one| one == *name));
        let _ = write!(page, "\n### `{path}{name}`\n\n{}\n\n", text(schema, "description"));
        facts(page, schema, is_required);
        let forms = schema["anyOf"].as_array().map_or(std::slice::from_ref(*schema), Vec::as_slice);
        for form in forms {
            keys(page, form, &format!("{path}{name}."), &properties(form).collect::<Vec<_>>());
        }
    }
}

/// Type, range, words and default of a key.
fn facts(page: &mut String, schema: &Value, is_required: bool) {
    let variants: Vec<_> = words(schema).collect();
    for (word, meaning) in &variants {
        let _ = writeln!(page, "- `\"{word}\"`: {meaning}");
    }
    if variants.is_empty() {
        let _ = writeln!(page, "- {}", kind(schema));
    }
    if let Some(default) = schema.get("default").filter(|_| !is_table(schema)) {
        let _ = writeln!(page, "- default: `{}`", toml(default));
    } else if is_required {
        page.push_str("- required\n");
    }
    if let Some(example) = schema["examples"].get(0).filter(|_| schema.get("default").is_none()) {
        let _ = writeln!(page, "- example: `{}`", toml(example));
    }
}

/// Type and range of a value, in words.
fn kind(schema: &Value) -> String {
    if let Some(forms) = schema["anyOf"].as_array() {
        return forms.iter().map(kind).collect::<Vec<_>>().join(", or ");
    }
    if let Some(allowed) = schema["enum"].as_array() {
        return allowed.iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
    }
    let bound = |name: &str| schema[name].as_f64().map(|bound| bound.to_string());
    let range = match (bound("minimum"), bound("maximum"), bound("exclusiveMinimum")) {
        (_, Some(high), Some(low)) => format!(", above {low} and at most {high}"),
        (_, None, Some(low)) => format!(", above {low}"),
        (Some(low), Some(high), None) => format!(", {low} to {high}"),
        _ => String::new(),
    };
    match text(schema, "type") {
        "integer" => format!("whole number{range}"),
        "number" => format!("number{range}"),
        "boolean" => "true or false".to_owned(),
        "string" => "text".to_owned(),
        "array" if schema["minItems"] == 2 => format!("two of: {}", kind(&schema["items"])),
        "array" => format!("list of: {}", kind(&schema["items"])),
        _ => "table".to_owned(),
    }
}

/// A design as a file to edit: each key with its meaning, and those that it does not have as remarks.
pub(super) fn commented(design: &Design, values: &toml::Table) -> String {
    let mut file = format!("# {}: {}\n", design.name, text(schema(), "description"));
    let (tables, top): (Vec<_>, Vec<_>) = properties(schema()).partition(|(_, schema)| is_table(schema));
    lines(&mut file, &top, values);
    for (name, table) in tables {
        let _ = write!(file, "\n[{name}]\n");
        let empty = toml::Table::new();
        let values = values.get(name).and_then(toml::Value::as_table).unwrap_or(&empty);
        lines(&mut file, &properties(table).collect::<Vec<_>>(), values);
    }
    file
}

fn lines(file: &mut String, keys: &[(&String, &Value)], values: &toml::Table) {
    for (name, schema) in keys {
        let value = values.get(*name).map(ToString::to_string);
        let remark = if value.is_some() { "" } else { "# " };
        let Some(value) = value.or_else(|| Some(toml(schema["examples"].get(0)?))) else { continue };
        file.push('\n');
        wrapped(file, text(schema, "description"));
        for (word, meaning) in words(schema) {
            wrapped(file, &format!("  \"{word}\": {meaning}"));
        }
        let _ = writeln!(file, "{remark}{name} = {value}");
    }
}

/// A remark, in lines of at most [`WIDTH`] columns.
fn wrapped(file: &mut String, remark: &str) {
    let indent = if remark.starts_with(' ') { "#     " } else { "# " };
    let mut line = if remark.starts_with(' ') { "#  ".to_owned() } else { "#".to_owned() };
    for word in remark.split_whitespace() {
        if line.len() + 1 + word.len() > WIDTH {
            file.push_str(&line);
            file.push('\n');
            indent.trim_end().clone_into(&mut line);
            line.push_str(&" ".repeat(indent.len() - line.len() - 1));
        }
        line.push(' ');
        line.push_str(word);
    }
    file.push_str(&line);
    file.push('\n');
}
