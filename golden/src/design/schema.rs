//! The JSON schemas of design and scene files, and the range checks by them.

use std::sync::LazyLock;

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value as Schema};
use toml::{Table, Value};

use super::checks::Check;
use super::keys::DesignKeys;
use super::{DesignError, Sensor};

static DESIGN: LazyLock<Schema> = LazyLock::new(|| {
    let mut schema = of::<DesignKeys>();
    schema["title"] = "Design file of sptfra".into();
    schema
});

/// The schema of a file's keys.
pub(crate) fn of<Keys: JsonSchema>() -> Schema {
    // Editors read draft 7; references would only be in the way of those who walk over the schema.
    let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<Keys>().to_value();
    tidy(&mut schema);
    schema
}

/// The JSON schema of a design file, draft 7, for editors: a design begins with `#:schema FILE`.
pub fn design_schema() -> &'static Schema {
    &DESIGN
}

/// Takes out nulls, which TOML does not have, and the line ends of doc comments.
fn tidy(node: &mut Schema) {
    match node {
        Schema::Object(object) => {
            object.retain(|_, value| !value.is_null());
            if let Some(Schema::String(text)) = object.get_mut("description") {
                let paragraph = text.split("\n\n").next().unwrap_or_default();
                *text = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
            }
            if let Some(Schema::Array(kinds)) = object.get_mut("type") {
                kinds.retain(|kind| kind != "null");
                if let [kind] = kinds.as_slice() {
                    object["type"] = kind.clone();
                }
            }
            if let Some(Schema::Array(forms)) = object.get_mut("anyOf") {
                forms.retain(|form| form["type"] != "null");
                if let [Schema::Object(only)] = forms.as_mut_slice() {
                    let only = std::mem::take(only);
                    object.remove("anyOf");
                    // What is said of the key goes before what is said of its type.
                    let own = std::mem::replace(object, only);
                    object.extend(own);
                }
            }
            object.values_mut().for_each(tidy);
        }
        Schema::Array(values) => values.iter_mut().for_each(tidy),
        _ => (),
    }
}

/// The keys of a table with their schemas.
pub(super) fn properties(schema: &Schema) -> impl Iterator<Item = (&String, &Schema)> {
    schema["properties"].as_object().into_iter().flat_map(Map::iter)
}

impl Sensor {
    /// The sensor, if it is in the ranges of a design's.
    pub(crate) fn checked(self, origin: &str) -> Result<Self, DesignError> {
        let keys = Table::try_from(&self).unwrap_or_default();
        check_table(&Check { origin }, "sensor", &keys, &DESIGN["properties"]["sensor"])?;
        Ok(self)
    }
}

/// Checks numbers and the lengths of arrays. Values of another type are left to the parser, which knows their line.
pub(crate) fn check(origin: &str, file: &Table, schema: &Schema) -> Result<(), DesignError> {
    check_table(&Check { origin }, "", file, schema)
}

fn check_table(check: &Check, path: &str, table: &Table, schema: &Schema) -> Result<(), DesignError> {
    let key = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    let known = table.iter().filter_map(|(name, value)| Some((name, value, schema["properties"].get(name)?)));
    known.into_iter().try_for_each(|(name, value, schema)| check_value(check, &key(name), value, schema))
}

fn check_value(check: &Check, key: &str, value: &Value, schema: &Schema) -> Result<(), DesignError> {
    if let Some(forms) = schema["anyOf"].as_array() {
        let fitting = forms.iter().find(|form| form["type"] == kind(value) || is_number(value, form));
        return fitting.map_or(Ok(()), |form| check_value(check, key, value, form));
    }
    let is_pair = schema["type"] == "array" && schema["maxItems"] == 2;
    match value {
        Value::Table(table) => check_table(check, key, table, schema),
        Value::Integer(_) | Value::Float(_) if is_pair => Err(check.value(
            key,
            format!("is one number, {value}"),
            format!("write two, for x and y: [{value}, {value}]"),
        )),
        // A TOML reader drops what is too much for a fixed array.
        Value::Array(values) if is_pair && values.len() != 2 => {
            Err(check.value(key, format!("has {} values", values.len()), "use two"))
        }
        Value::Array(values) => {
            let mut items = values.iter().enumerate();
            items.try_for_each(|(at, item)| check_value(check, &format!("{key}[{at}]"), item, &schema["items"]))
        }
        _ if is_number(value, schema) => check_number(check, key, value, schema),
        _ => Ok(()),
    }
}

/// The name that a schema has for a value's type.
fn kind(value: &Value) -> &'static str {
    match value {
        Value::Table(_) => "object",
        Value::Array(_) => "array",
        Value::String(_) => "string",
        _ => "",
    }
}

fn is_number(value: &Value, schema: &Schema) -> bool {
    schema["type"] == "number" && number(value).is_some() || schema["type"] == "integer" && value.is_integer()
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

fn check_number(check: &Check, key: &str, value: &Value, schema: &Schema) -> Result<(), DesignError> {
    let found = number(value).unwrap_or(f64::NAN);
    if let Some(allowed) = schema["enum"].as_array() {
        let words: Vec<String> = allowed.iter().map(Schema::to_string).collect();
        let remedy = || format!("use one of {}", words.join(", "));
        let is_one = allowed.iter().any(|one| one.as_f64() == Some(found));
        return if is_one { Ok(()) } else { Err(check.value(key, format!("is {value}"), remedy())) };
    }
    let [low, high, above] = ["minimum", "maximum", "exclusiveMinimum"].map(|bound| schema[bound].as_f64());
    match (value, low, high) {
        _ if above.is_some() => check.above_zero(key, found, high.unwrap_or(f64::MAX), unit(key)).map(drop),
        (Value::Integer(whole), Some(low), Some(high)) if schema["type"] == "integer" => {
            check.integer(key, *whole, low as i64, high as i64).map(drop)
        }
        (_, Some(low), Some(high)) => check.real(key, found, low, high, unit(key)).map(drop),
        _ => Ok(()),
    }
}

/// The unit that the end of a key names.
fn unit(key: &str) -> &'static str {
    let name = key.split('[').next().unwrap_or(key);
    let units = [("_mm", "mm"), ("_pa", "Pa"), ("_mhz", "MHz"), ("_n", "N"), ("_deg", "degrees")];
    units.into_iter().find(|(ending, _)| name.ends_with(ending)).map_or("", |(_, unit)| unit)
}
