//! Units of times, forces and pressures, as the headers of files name them.

/// Newtons of a kilogram's weight.
const GRAVITY: f64 = 9.806_65;

/// Seconds of the unit of a column of times, by its name; nothing for another column.
pub(crate) fn seconds(name: &str) -> Option<f64> {
    let lower = name.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphanumeric() && c != 'µ').filter(|word| !word.is_empty());
    let is_time = matches!(words.next()?, "t" | "time" | "timestamp" | "zeit");
    let unit = match words.next() {
        None | Some("s" | "sec" | "seconds") => 1.0,
        Some("ms" | "millis" | "milliseconds") => 1e-3,
        Some("us" | "µs" | "micros" | "microseconds") => 1e-6,
        Some("ns") => 1e-9,
        Some(_) => return None,
    };
    is_time.then_some(unit)
}

/// Pascals of a unit of pressure: one of its own, or a force on an area. Nothing for another unit.
pub(crate) fn pascals(unit: &str) -> Option<f64> {
    force_or_pressure(unit).and_then(|(pascals, is_pressure)| is_pressure.then_some(pascals))
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
