//! Range and spelling checks of a design file, each by what the schema says of the key.

use serde_json::Value as Schema;
use toml::Value;

use super::DesignError;
use super::checks::Check;

/// Checks numbers, words and lengths of arrays. A value of another type than the schema's is left to the parser, which
/// knows its line.
pub(super) fn check(check: &Check, path: &str, table: &toml::Table, schema: &Schema) -> Result<(), DesignError> {
    for (name, value) in table {
        if let Some(schema) = schema["properties"].get(name) {
            let key = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
            node(check, &key, value, schema)?;
        }
    }
    Ok(())
}

fn node(found: &Check, key: &str, value: &Value, schema: &Schema) -> Result<(), DesignError> {
    if let Some(alternatives) = schema["anyOf"].as_array() {
        let fitting = alternatives.iter().find(|schema| is_of(value, schema));
        return fitting.map_or(Ok(()), |schema| node(found, key, value, schema));
    }
    match value {
        Value::Table(table) => check(found, key, table, schema),
        Value::Array(values) => array(found, key, values, schema),
        Value::Integer(_) | Value::Float(_) if schema["type"] == "array" && is_pair(schema) => Err(found.value(
            key,
            format!("is one number, {value}"),
            format!("write two, for x and y: [{0:?}, {0:?}]", number(value)),
        )),
        Value::Integer(_) | Value::Float(_) if is_of(value, schema) => limits(found, key, value, schema),
        Value::String(word) => choice(found, key, word, schema),
        _ => Ok(()),
    }
}

/// Whether a value has the schema's type.
fn is_of(value: &Value, schema: &Schema) -> bool {
    schema["type"].as_str().is_some_and(|kind| match value {
        Value::Integer(_) => kind == "integer" || kind == "number",
        Value::Float(_) => kind == "number",
        Value::String(_) => kind == "string",
        Value::Array(_) => kind == "array",
        Value::Table(_) => kind == "object",
        Value::Boolean(_) | Value::Datetime(_) => false,
    })
}

fn is_pair(schema: &Schema) -> bool {
    schema["minItems"] == 2 && schema["maxItems"] == 2
}

fn number(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64)).unwrap_or(f64::NAN)
}

fn array(check: &Check, key: &str, values: &[Value], schema: &Schema) -> Result<(), DesignError> {
    // A TOML reader drops what is too much for a fixed array.
    if is_pair(schema) && values.len() != 2 {
        return Err(check.value(key, format!("has {} values", values.len()), "use two".to_owned()));
    }
    for (index, value) in values.iter().enumerate() {
        node(check, &format!("{key}[{index}]"), value, &schema["items"])?;
    }
    Ok(())
}

fn limits(check: &Check, key: &str, value: &Value, schema: &Schema) -> Result<(), DesignError> {
    if let Some(allowed) = schema["enum"].as_array() {
        let is_one = allowed.iter().any(|one| one.as_f64() == Some(number(value)));
        let words: Vec<String> = allowed.iter().map(Schema::to_string).collect();
        let (last, first) = words.split_last().map_or(("", &[][..]), |(last, first)| (last.as_str(), first));
        let remedy = format!("use {} or {last}", first.join(", "));
        return if is_one { Ok(()) } else { Err(check.value(key, format!("is {value}"), remedy)) };
    }
    let [low, high, above] = ["minimum", "maximum", "exclusiveMinimum"].map(|bound| schema[bound].as_f64());
    match (value, above) {
        (_, Some(_)) => check.above_zero(key, number(value), high.unwrap_or(f64::MAX), unit(key)).map(drop),
        (Value::Integer(whole), None) if schema["type"] == "integer" => {
            let [low, high] = [low.unwrap_or(-f64::MAX), high.unwrap_or(f64::MAX)].map(|bound| bound as i64);
            check.integer(key, *whole, low, high).map(drop)
        }
        _ if low.is_none() && high.is_none() => Ok(()),
        _ => {
            let [low, high] = [low.unwrap_or(-f64::MAX), high.unwrap_or(f64::MAX)];
            check.real(key, number(value), low, high, unit(key)).map(drop)
        }
    }
}

/// The unit that the end of a key names.
fn unit(key: &str) -> &'static str {
    let name = key.split('[').next().unwrap_or(key);
    let units = [("_mm", "mm"), ("_pa", "Pa"), ("_mhz", "MHz")];
    units.into_iter().find(|(ending, _)| name.ends_with(ending)).map_or("", |(_, unit)| unit)
}

fn choice(check: &Check, key: &str, word: &str, schema: &Schema) -> Result<(), DesignError> {
    let allowed: Vec<&str> = words(schema).map(|(word, _)| word).collect();
    if allowed.is_empty() || allowed.contains(&word) {
        return Ok(());
    }
    Err(check.choice(key, word, &allowed))
}

/// The words that a key may have, each with its meaning.
pub(super) fn words(schema: &Schema) -> impl Iterator<Item = (&str, &str)> {
    let variants = schema["oneOf"].as_array().into_iter().flatten();
    variants.filter_map(|variant| Some((variant["const"].as_str()?, variant["description"].as_str().unwrap_or(""))))
}
