//! Units of times, forces and pressures, as the headers of files name them.

/// Newtons of a kilogram's weight.
const GRAVITY: f64 = 9.806_65;

/// Seconds of the unit of a column of times, by its name; nothing for another column.
pub(crate) fn seconds(name: &str) -> Option<f64> {
    Some(match unit_of_time(name)?.as_str() {
        "" | "s" | "sec" | "seconds" => 1.0,
        "ms" | "millis" | "milliseconds" => 1e-3,
        "us" | "µs" | "micros" | "microseconds" => 1e-6,
        "ns" => 1e-9,
        _ => return None,
    })
}

/// The unit behind the name of a column of times, of any kind, empty without one; nothing for another column.
pub(crate) fn unit_of_time(name: &str) -> Option<String> {
    let lower = name.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphanumeric() && c != 'µ').filter(|word| !word.is_empty());
    let is_time = matches!(words.next()?, "t" | "time" | "timestamp" | "datetime" | "zeit");
    is_time.then(|| words.next().unwrap_or_default().to_owned())
}

/// Seconds since 1970 of a time stamp of ISO 8601, such as 2026-03-01T12:00:00.123: with T or a space, without a zone or with
/// Z or +01:00.
pub(crate) fn timestamp(text: &str) -> Option<f64> {
    let (date, time) = text.trim().split_once(['T', ' '])?;
    let whole = |part: &str, digits: usize| {
        (part.len() == digits && part.bytes().all(|byte| byte.is_ascii_digit())).then(|| part.parse::<i64>().ok())?
    };
    let [year, month, day] = <[&str; 3]>::try_from(date.split('-').collect::<Vec<_>>()).ok()?;
    let [year, month, day] = [whole(year, 4)?, whole(month, 2)?, whole(day, 2)?];
    // The year begins in March, so that a leap day is its last.
    let (years, months) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let days = 365 * years + years / 4 - years / 100 + years / 400 + (153 * months + 2) / 5 + day - 719_469;
    let (time, zone) = time.split_at(time.find(['Z', '+', '-']).unwrap_or(time.len()));
    let of_day = |time: &str| {
        let mut parts = time.splitn(3, ':');
        let [hours, minutes] = [whole(parts.next()?, 2)?, whole(parts.next()?, 2)?];
        let seconds = parts.next().map_or(Some(0.0), |seconds| seconds.replace(',', ".").parse::<f64>().ok())?;
        ((0.0..61.0).contains(&seconds) && hours < 24 && minutes < 60)
            .then_some((3600 * hours + 60 * minutes) as f64 + seconds)
    };
    let ahead = match zone.split_at_checked(1) {
        None | Some(("Z", "")) => 0.0,
        Some((sign, zone)) => of_day(zone)? * if sign == "-" { -1.0 } else { 1.0 },
    };
    ((1..=12).contains(&month) && (1..=31).contains(&day)).then_some((86_400 * days) as f64 + of_day(time)? - ahead)
}

/// The times of lines, of which few are unknown, NaN: between two that are known in equal steps. How many were unknown.
/// Nothing where all are.
///
/// # Errors
///
/// The place of the first unknown one, if more than a tenth are, or it is the first or last.
pub(crate) fn without_gaps(mut times: Vec<f64>) -> Result<Option<(Vec<f64>, usize)>, usize> {
    let unknown: Vec<usize> = (0..times.len()).filter(|&line| !times[line].is_finite()).collect();
    if unknown.len() == times.len() {
        return Ok(None);
    }
    let is_end = |line: usize| line == 0 || line + 1 == times.len();
    if let Some(first) = unknown.iter().find(|&&line| is_end(line) || 10 * unknown.len() > times.len()) {
        return Err(*first);
    }
    for &line in &unknown {
        let after = (line..times.len()).find(|&after| times[after].is_finite()).unwrap_or(line);
        times[line] = times[line - 1] + (times[after] - times[line - 1]) / (after - line + 1) as f64;
    }
    Ok(Some((times, unknown.len())))
}

/// Pascals of a unit of pressure: one of its own, or a force on an area. Nothing for another unit.
pub(crate) fn pascals(unit: &str) -> Option<f64> {
    force_or_pressure(unit).and_then(|(pascals, is_pressure)| is_pressure.then_some(pascals))
}

/// What a unit measures that is certainly no pressure.
pub(crate) fn no_pressure(unit: &str) -> Option<&'static str> {
    match unit.to_lowercase().as_str() {
        "v" | "mv" | "uv" | "µv" | "volt" | "volts" => Some("a voltage"),
        "ohm" | "ohms" | "kohm" | "ω" | "kω" | "mω" => Some("a resistance"),
        "pf" | "nf" | "ff" => Some("a capacitance"),
        "raw" | "adc" | "count" | "counts" | "lsb" | "digit" | "digits" => Some("a count"),
        _ => force_or_pressure(unit).and_then(|(_, is_pressure)| (!is_pressure).then_some("a force")),
    }
}

/// Newtons or pascals of a unit, and whether it is one of pressure.
pub(crate) fn force_or_pressure(unit: &str) -> Option<(f64, bool)> {
    let lower = unit.to_lowercase().replace('²', "2").replace('^', "");
    if let Some((force, area)) = lower.split_once('/') {
        let per_m2 = match area {
            "mm2" => 1e6,
            "cm2" => 1e4,
            "m2" => 1.0,
            _ => return None,
        };
        let force = unit.split('/').next().unwrap_or(force);
        return force_or_pressure(force)
            .and_then(|(newtons, is_pressure)| (!is_pressure).then_some((newtons * per_m2, true)));
    }
    Some(match lower.as_str() {
        "n" | "newton" | "newtons" => (1.0, false),
        "mn" if unit.starts_with('M') => (1e6, false),
        "mn" => (1e-3, false),
        "kn" => (1e3, false),
        "g" | "gf" | "gram" | "grams" => (1e-3 * GRAVITY, false),
        "kg" | "kgf" => (GRAVITY, false),
        "lb" | "lbf" => (4.448_221_615, false),
        "pa" => (1.0, true),
        "kpa" => (1e3, true),
        "mpa" if unit.ends_with("Pa") && unit.starts_with('m') => (1e-3, true),
        "mpa" => (1e6, true),
        "mbar" | "hpa" => (100.0, true),
        "bar" => (1e5, true),
        "psi" => (6_894.757_293, true),
        "mmhg" => (133.322_387, true),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::timestamp;

    #[test]
    fn time_stamps_are_seconds() {
        for (text, seconds) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2000-02-29 12:00:01.5", 951_825_601.5),
            ("2026-03-01T12:00:00.123", 1_772_366_400.123),
            ("2026-03-01T12:00:00,123Z", 1_772_366_400.123),
            ("2026-03-01T14:00:00.123+02:00", 1_772_366_400.123),
            ("2026-03-01 09:30-02:30", 1_772_366_400.0),
        ] {
            assert_eq!(timestamp(text), Some(seconds), "{text}");
        }
        for text in ["2026-03-01", "12:00:00", "2026-13-01T12:00:00", "2026-03-01T25:00", "2026-03-01T12:00:xx", "1 2"]
        {
            assert_eq!(timestamp(text), None, "{text}");
        }
    }
}
