//! From TOML text to the keys of a design, each of its type and in its range.

use std::path::PathBuf;

use toml::{Table, Value};

use super::checks::Check;
use super::files::FileSource;
use super::keys::{CurveKey, DesignKeys};
use super::{DesignError, base, old_format, schema};

/// How much alike two names are, 0 to 1, of which one was meant to be the other.
const ALIKE: f64 = 0.7;

/// The text as a table of this format, each number in its range.
pub(super) fn table(text: &str, origin: &str) -> Result<Table, DesignError> {
    let table = toml::from_str(text).map_err(|error| syntax_position(&error, text, origin))?;
    old_format::refuse(origin, &table)?;
    schema::check(origin, &table, schema::design_schema())?;
    Ok(table)
}

/// Puts the base's keys under those of `own`: the base's text and place, or `None` if it names no base.
fn merge(check: &Check, own: &mut Table, beside: FileSource<'_>) -> Result<Option<[String; 2]>, DesignError> {
    let Some(name) = own.get("base").and_then(Value::as_str).map(str::to_owned) else { return Ok(None) };
    let path = beside.path(&name);
    let text = beside.read(&name).map_err(|source| {
        let problem = format!("names {}, which cannot be read: {source}", path.display());
        check.value("base", problem, "give the path of a design file from this one")
    })?;
    let origin = path.display().to_string();
    let mut keys = table(&text, &origin)?;
    if keys.contains_key("base") {
        let problem = format!("names {origin}, which has a base itself");
        return Err(check.value("base", problem, "name that one, and write here what is changed"));
    }
    base::drop_errors(own, &mut keys);
    base::relocate(&mut keys, &name);
    own.remove("base");
    base::under(own, keys);
    Ok(Some([text, origin]))
}

/// The keys of a design file, with those of its base; `beside` are the files that it names.
pub(super) fn keys(text: &str, origin: &str, beside: FileSource<'_>) -> Result<DesignKeys, DesignError> {
    let mut own = table(text, origin)?;
    let Some([base, place]) = merge(&Check { origin }, &mut own, beside)? else {
        return toml::from_str(text).map_err(|error| syntax_position(&error, text, origin));
    };
    own.try_into().map_err(|error: toml::de::Error| {
        // The merged table has no lines: what is wrong stands in one of the two files, unless a key is in neither.
        let at = |text: &str, origin: &str| {
            let error = toml::from_str::<DesignKeys>(text).err()?;
            (!error.message().starts_with("missing")).then(|| syntax_position(&error, text, origin))
        };
        let found = at(text, origin).or_else(|| at(&base, &place));
        found.unwrap_or_else(|| syntax_position(&error, text, origin))
    })
}

/// The files that a design names, and those of its base.
pub(super) fn files_named_in(text: &str, origin: &str, beside: FileSource<'_>) -> Result<Vec<PathBuf>, DesignError> {
    let base = table(text, origin)?.get("base").and_then(Value::as_str).map(str::to_owned);
    let DesignKeys { sensor, algorithm, .. } = keys(text, origin, beside)?;
    let weights = algorithm.correction.map(|correction| correction.file);
    let points = match sensor.curve {
        Some(CurveKey::File(file)) => Some(file),
        _ => None,
    };
    let names = [base, sensor.calibration, points, weights].into_iter().flatten();
    Ok(names.map(|name| beside.path(&name)).collect())
}

/// Turns an error of the TOML reader about a `text` that is from `origin` into one with line and column.
pub fn syntax_position(error: &toml::de::Error, text: &str, origin: &str) -> DesignError {
    let offset = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |position| position + 1);
    let context = text.get(line_start..).and_then(|rest| rest.lines().next()).unwrap_or("").trim();
    let context: String = context.chars().take(80).collect();
    let near = if context.is_empty() { String::new() } else { format!(", in `{context}`") };
    let line = before.matches('\n').count() + 1;
    let column = before.get(line_start..).map_or(0, |text| text.chars().count()) + 1;
    DesignError(format!("{origin}, line {line}, column {column}{near}: {}", plain(error.message())))
}

/// A message of the parser without the names that types have in Rust, and with the key that an unknown one is like.
fn plain(message: &str) -> String {
    const WORDS: [(&str, &str); 10] = [
        ("expected f64", "expected a number"),
        ("expected i64", "expected a whole number"),
        ("expected usize", "expected a whole number"),
        ("expected u32", "expected a whole number"),
        ("an array of length 2", "two numbers"),
        ("a sequence", "a list, such as [2.0, 2.0]"),
        ("unknown field", "unknown key"),
        ("unknown variant", "unknown word"),
        ("missing field", "missing key"),
        ("\n", ", "),
    ];
    let message = WORDS.iter().fold(message.to_owned(), |message, (rust, word)| message.replace(rust, word));
    let mut names = message.split('`').skip(1).step_by(2);
    let nearest = names.next().filter(|_| message.starts_with("unknown key")).and_then(|found| {
        let like = names.map(|name| (strsim::jaro_winkler(found, name), name));
        like.filter(|(likeness, _)| *likeness > ALIKE).max_by(|(a, _), (b, _)| a.total_cmp(b))
    });
    match nearest {
        Some((_, nearest)) => format!("did you mean `{nearest}`? {message}"),
        None => message,
    }
}
