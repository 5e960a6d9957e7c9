//! A design as a file to edit: each key with its meaning, and those that it does not have as remarks.

use std::fmt::Write;

use serde_json::Value as Schema;
use toml::{Table, Value};

use super::schema::{design_schema, properties};

/// Columns of a remark.
const WIDTH: usize = 110;

/// The file of a design named `name` with these `values`.
pub(super) fn commented(name: &str, values: &Table) -> String {
    let schema = design_schema();
    let mut file = format!("# {name}: {}\n", text(schema));
    let (tables, top): (Vec<_>, Vec<_>) =
        properties(schema).partition(|(_, schema)| schema["type"] == "object" && schema.get("properties").is_some());
    lines(&mut file, top.into_iter(), values);
    for (name, table) in tables {
        let _ = write!(file, "\n[{name}]\n");
        let values = values.get(name).and_then(Value::as_table).cloned().unwrap_or_default();
        lines(&mut file, properties(table), &values);
    }
    file
}

fn text(schema: &Schema) -> &str {
    schema["description"].as_str().unwrap_or_default()
}

fn lines<'a>(file: &mut String, keys: impl Iterator<Item = (&'a String, &'a Schema)>, values: &Table) {
    for (name, schema) in keys {
        let value = values.get(name).cloned();
        let mark = if value.is_some() { "" } else { "# " };
        let Some(value) = value.or_else(|| Value::try_from(schema["examples"].get(0)?).ok()) else { continue };
        file.push('\n');
        remark(file, "# ", text(schema));
        for word in schema["oneOf"].as_array().into_iter().flatten() {
            remark(file, "#   ", &format!("{}: {}", word["const"], text(word)));
        }
        let _ = writeln!(file, "{mark}{name} = {value}");
    }
}

/// A remark in lines of at most [`WIDTH`] columns, each of which begins with `start`.
fn remark(file: &mut String, start: &str, remark: &str) {
    let mut line = String::new();
    for word in remark.split_whitespace() {
        if start.len() + line.len() + word.len() > WIDTH {
            let _ = writeln!(file, "{start}{}", line.trim_end());
            line.clear();
        }
        line += word;
        line += " ";
    }
    let _ = writeln!(file, "{start}{}", line.trim_end());
}
