//! Names of taxels, columns and rows: their numbers, units and places.

use crate::sensor::Sensor;
use crate::units::pascals;

/// The taxel of each name by its number, or by its row and column; nothing where numbers do not say so.
pub(super) fn taxels(names: &[String], sensor: &Sensor) -> Result<Option<Vec<usize>>, Open> {
    match order(names, sensor) {
        Ok(None) => order(&indexed(names), sensor),
        of => of,
    }
}

/// Places of columns or rows by the number at the end of names that begin alike, or by their letters: they follow each other
/// without a gap in some order.
pub(super) fn places(names: &[&[u8]]) -> Option<Vec<usize>> {
    let names: Vec<_> = names.iter().map(|name| String::from_utf8_lossy(name)).collect();
    let word = at_digits(names.first()?).0;
    let place = |name: &str| match (at_digits(name), name.as_bytes()) {
        (_, [letter]) if letter.is_ascii_alphabetic() => Some(usize::from(letter.to_ascii_lowercase())),
        ((before, digits), _) => digits.parse().ok().filter(|_| before == word),
    };
    let places = names.iter().map(|name| place(name)).collect::<Option<Vec<usize>>>()?;
    let least = places.iter().min()?;
    (*least..least + names.len()).all(|place| places.contains(&place)).then_some(places)
}

/// Names with a colon between two numbers that stand for a row and a column: a letter and a number as `A1`, or digits side by
/// side as `s12`. Others stay as they are.
fn indexed(names: &[String]) -> Vec<String> {
    let parts: Vec<(&str, &str)> = names.iter().map(|name| split(name).0).map(at_digits).collect();
    let halves = |(before, digits): &(&str, &str)| {
        let is_even = !digits.is_empty() && digits.len().is_multiple_of(2);
        let (row, column) =
            digits.split_at_checked(digits.len() / 2).filter(|_| is_even && digits.len() == parts[0].1.len())?;
        Some(format!("{before}{row}:{column}"))
    };
    let lettered = |(before, digits): &(&str, &str)| {
        let (stem, letter) = last_letter(before)?;
        let same = !digits.is_empty() && last_letter(parts[0].0).is_some_and(|(first, _)| first == stem);
        same.then(|| format!("{stem}{}:{digits}", u32::from(letter.to_ascii_lowercase()) - u32::from('a')))
    };
    let are_letters = parts.iter().any(|(before, _)| *before != parts[0].0);
    let all = if are_letters {
        parts.iter().map(lettered).collect()
    } else {
        parts.iter().map(halves).collect::<Option<_>>()
    };
    all.unwrap_or_else(|| names.to_vec())
}

/// A word without the letter at its end, and that.
fn last_letter(word: &str) -> Option<(&str, char)> {
    let mut letters = word.chars();
    let letter = letters.next_back().filter(char::is_ascii_alphabetic)?;
    Some((letters.as_str(), letter))
}

/// What stands before the digits at the end of a name, and these.
fn at_digits(name: &str) -> (&str, &str) {
    name.split_at(name.trim_end_matches(|c: char| c.is_ascii_digit()).len())
}

/// Two numbers in each name, of which either may be that of the row.
pub(super) struct Open;

/// Likewise, of names as they stand.
fn order(names: &[String], sensor: &Sensor) -> Result<Option<Vec<usize>>, Open> {
    let (columns, rows) = (sensor.columns, sensor.rows);
    let kind = kind_of(&names[0]);
    if names.iter().any(|name| kind_of(name) != kind) {
        return Ok(None);
    }
    let numbers: Vec<Vec<usize>> = names.iter().map(|name| numbers_of(name)).collect();
    // Each of the numbers in a name that is not the same in all names, from 0.
    let mut parts: Vec<(String, Vec<usize>)> = Vec::new();
    for (part, before) in kind.split('#').enumerate().take(kind.matches('#').count()) {
        let Some(values) = numbers.iter().map(|of| of.get(part).copied()).collect::<Option<Vec<usize>>>() else {
            return Ok(None);
        };
        let least = values.iter().copied().min().unwrap_or(0);
        if values.iter().any(|&value| value != least) {
            let word = before.rsplit(|c: char| !c.is_alphabetic()).find(|word| !word.is_empty()).unwrap_or_default();
            parts.push((word.to_lowercase(), values.iter().map(|value| value - least.min(1)).collect()));
        }
    }
    let mut is_open = false;
    let order: Option<Vec<usize>> = match parts.as_slice() {
        [(_, only)] => Some(only.clone()),
        [(first, a), (second, b)] => {
            let row_first = match [first.as_str(), second] {
                ["r", "c"] | ["row", "col" | "column"] | ["y", "x"] | ["zeile", "spalte"] => true,
                ["c", "r"] | ["col" | "column", "row"] | ["x", "y"] | ["spalte", "zeile"] => false,
                _ => {
                    is_open = columns == rows;
                    b.iter().max().is_some_and(|&most| most + 1 == columns)
                }
            };
            let (row, column) = if row_first { (a, b) } else { (b, a) };
            let place =
                |(&row, &column): (&usize, &usize)| (row < rows && column < columns).then_some(row * columns + column);
            row.iter().zip(column).map(place).collect()
        }
        _ => None,
    };
    let is_each = |order: &Vec<usize>| {
        let mut sorted = order.clone();
        sorted.sort_unstable();
        sorted.into_iter().eq(0..names.len())
    };
    match order.filter(is_each) {
        Some(order) if is_open => {
            if order.is_sorted() {
                Ok(None)
            } else {
                Err(Open)
            }
        }
        order => Ok(order),
    }
}

/// Two names of which the second has the smaller number, where all names are sorted as text.
pub(super) fn as_text(names: &[String]) -> Option<&[String]> {
    let is_one_kind = names.windows(2).all(|pair| kind_of(&pair[0]) == kind_of(&pair[1]));
    (is_one_kind && names.is_sorted())
        .then(|| names.windows(2).find(|pair| numbers_of(&pair[0]) > numbers_of(&pair[1])))?
}

/// The numbers in a name.
fn numbers_of(name: &str) -> Vec<usize> {
    split(name).0.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse().ok()).collect()
}

/// A name without its unit, and the unit: in brackets, or a known one behind the first or the last number.
pub(super) fn split(name: &str) -> (&str, &str) {
    let around = |c: char| !c.is_alphanumeric();
    if let Some((before, unit)) = name.rsplit_once(['(', '[', '{'])
        && unit.starts_with(char::is_alphabetic)
        && (unit.contains('/') || !unit.contains(|c: char| c.is_ascii_digit()))
    {
        return (before, unit.trim_matches(around));
    }
    let first = name
        .find(|c: char| c.is_ascii_digit())
        .map(|from| from + name[from..].find(|c: char| !c.is_ascii_digit()).unwrap_or(name.len() - from));
    let last = name.rfind(|c: char| c.is_ascii_digit()).map(|last| last + 1);
    [first, last]
        .into_iter()
        .flatten()
        .map(|behind| (&name[..behind], name[behind..].trim_matches(around)))
        .find(|(_, unit)| pascals(unit).is_some())
        .unwrap_or((name, ""))
}

/// A name with `#` in the place of each of its numbers.
pub(super) fn kind_of(name: &str) -> String {
    let (name, unit) = split(name);
    let mut kind = String::new();
    for letter in name.chars() {
        if !letter.is_ascii_digit() {
            kind.push(letter);
        } else if !kind.ends_with('#') {
            kind.push('#');
        }
    }
    kind + unit
}
