//! What the columns of a table mean, by their names and units.

use crate::units::{force_or_pressure, seconds};

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A component of the force: x, y, z.
    Force(usize),
    Pressure,
    /// Which contact, in words.
    Contact,
    /// When, in seconds.
    Time,
}

/// What the columns of a header are, and what their unit is worth in newtons or pascals.
pub(super) fn meanings(names: &[String], remarks: &mut Vec<String>) -> Result<Vec<Option<(Meaning, f64)>>, String> {
    let (mut unused, mut units) = (Vec::new(), Vec::new());
    let mut found = Vec::new();
    for name in names {
        if let Some(unit) = seconds(name) {
            found.push(Some((Meaning::Time, unit)));
            continue;
        }
        // Units keep their case: mN and MN differ.
        let (base, behind) = name.split_at(name.find(['(', '[', '{', '/']).unwrap_or(name.len()));
        let behind = behind.trim_start_matches(|c: char| !c.is_alphanumeric());
        let (mut base, mut unit) = (base.trim(), behind.split([')', ']', '}']).next().unwrap_or_default().trim());
        if unit.is_empty()
            && let Some((before, after)) = base.rsplit_once(['_', ' '])
            && force_or_pressure(after).is_some()
        {
            (base, unit) = (before, after);
        }
        let Some(meaning) = meaning(base) else {
            // Of a name in another language, or of none, the unit tells.
            units.extend(force_or_pressure(if unit.is_empty() { base } else { unit }).map(|unit| (found.len(), unit)));
            unused.push(name.as_str());
            found.push(None);
            continue;
        };
        // Of these the usual unit is no newton.
        let is_mass = ["mass", "weight"].iter().any(|word| base.to_lowercase().contains(word));
        let factor = match (unit, meaning) {
            ("", Meaning::Force(_)) if is_mass => return Err(format!("column {name:?} has no unit")),
            ("", _) | (_, Meaning::Contact | Meaning::Time) => 1.0,
            (unit, meaning) => match force_or_pressure(unit) {
                Some((factor, pressure)) if pressure == (meaning == Meaning::Pressure) => factor,
                _ => {
                    return Err(format!(
                        "column {name:?}: {unit:?} is no unit of a {}",
                        if meaning == Meaning::Pressure { "pressure" } else { "force" }
                    ));
                }
            },
        };
        found.push(Some((meaning, factor)));
    }
    let is_measured = |column: &Option<(Meaning, f64)>| {
        column.is_some_and(|(meaning, _)| matches!(meaning, Meaning::Force(_) | Meaning::Pressure))
    };
    if let ([(column, (factor, is_pressure))], false) = (&units[..], found.iter().any(is_measured)) {
        found[*column] = Some((if *is_pressure { Meaning::Pressure } else { Meaning::Force(2) }, *factor));
        unused.retain(|name| *name != names[*column]);
        remarks.push(format!(
            "column {:?} is taken for {}",
            names[*column],
            if *is_pressure { "the pressure" } else { "F_z" }
        ));
    }
    for axis in 0..3 {
        let same = found.iter().flatten().filter(|(meaning, _)| *meaning == Meaning::Force(axis)).count();
        if same > 1 {
            return Err(format!("{same} columns are the force along {}", ["x", "y", "z"][axis]));
        }
    }
    if !unused.is_empty() && unused.len() < names.len() {
        remarks.push(format!("not used of the file: {}", unused.join(", ")));
    }
    Ok(found)
}

fn meaning(name: &str) -> Option<Meaning> {
    let letters: String = name.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    Some(match letters.as_str() {
        "fx" | "forcex" | "xforce" => Meaning::Force(0),
        "fy" | "forcey" | "yforce" => Meaning::Force(1),
        "fz" | "forcez" | "zforce" | "f" | "fn" | "force" | "forces" | "load" | "weight" | "mass" | "normal"
        | "normalforce" | "normalload" | "axial" | "axialforce" | "axialload" | "appliedforce" | "appliedload" => {
            Meaning::Force(2)
        }
        "p" | "pressure" | "pressures" | "press" => Meaning::Pressure,
        "contact" | "place" | "hold" | "trial" | "position" | "point" => Meaning::Contact,
        _ => return None,
    })
}
