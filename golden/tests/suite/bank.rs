//! Banks that a board loads, and which designs have room for dead taxels.

use golden::bank;
use golden::dead_taxels::DeadTaxels;
use golden::design::Design;

const PAD: &str = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 3\nrows = 2\npitch_mm = [4.0, 2.0]\ndepth_mm = 2.0\n\
    pa_per_count = -2.0\n";

fn design(sensor: &str, hardware: &str) -> Result<Design, String> {
    let text = format!("{PAD}{sensor}\n[hardware]\ncontrol = true\ncalibration = \"ram\"\n{hardware}\n");
    Design::from_toml(&text, "pad.toml").map_err(|error| error.to_string())
}

#[test]
fn room_for_dead_taxels_is_one_two_four_or_eight() {
    let good = design("dead = { taxels = [1, 4], room = 2 }", "").unwrap();
    assert_eq!(good.input.room, 2);
    assert_eq!(Design::from_toml(&good.to_toml(), "again.toml").unwrap(), good);
    assert!(!design("", "").unwrap().to_toml().contains("room"));
    for (sensor, said) in [
        ("dead = { room = 3 }", "use one of 1, 2, 4, 8"),
        ("dead = { room = 0 }", "use one of 1, 2, 4, 8"),
        ("dead = { taxels = [1], room = -1 }", "use one of 1, 2, 4, 8"),
        ("dead = { taxels = [1, 4], room = 1 }", "2 taxels are dead"),
        ("dead = { taxels = [1, 4] }", "a list of taxels, dead = [44], or a table"),
    ] {
        let message = design(sensor, "").unwrap_err();
        assert!(message.contains("sensor.dead") && message.contains(said), "{message}");
    }
    let in_rom = Design::from_toml(&format!("{PAD}dead = {{ room = 1 }}\n"), "pad.toml").unwrap_err().to_string();
    assert!(in_rom.contains("stands in ROM") && in_rom.contains("calibration = \"ram\""), "{in_rom}");
}

/// The header names the dead taxels; their gains are 0, and so are their weights; the others' are those of the prior.
#[test]
fn a_bank_has_the_weights_of_the_dead_taxels() {
    let text = bank::to_csv(&design("dead = { taxels = [4, 1], room = 8 }", "").unwrap()).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines.len()), ("gain,offset,taxel 1,taxel 4", 7));
    let table: Vec<Vec<f64>> =
        lines[1..].iter().map(|line| line.split(',').map(|value| value.parse().unwrap()).collect()).collect();
    for (taxel, line) in table.iter().enumerate() {
        let dead = [1, 4].contains(&taxel);
        assert_eq!(line[..2], [if dead { 0.0 } else { 1.0 }, 0.0], "taxel {taxel}");
        assert_eq!(line[2..] == [0.0, 0.0], dead, "taxel {taxel}");
    }
    let both = design("dead = { taxels = [1, 4], room = 8 }", "").unwrap();
    let dead = DeadTaxels::new(&both.sensor, both.algorithm.kernel, &[1, 4]);
    for (place, weights) in dead.weights().iter().enumerate() {
        assert_eq!(table.iter().map(|line| line[2 + place]).collect::<Vec<_>>(), *weights, "place {place}");
    }
    // Where banks have no room, and where nothing is dead.
    for sensor in ["", "dead = { room = 2 }"] {
        let text = bank::to_csv(&design(sensor, "").unwrap()).unwrap();
        assert_eq!(text, format!("gain,offset\n{}", "1.0,0.0\n".repeat(6)));
    }
    let of_rom = bank::to_csv(&design("dead = [1]", "").unwrap()).unwrap();
    assert!(of_rom.starts_with("gain,offset\n1.0,0.0\n0.0,0.0\n"), "{of_rom}");
}

/// What `sptfra export-calibration` writes is a calibration that a design can name, and a curve.
#[test]
fn a_design_can_name_a_bank() {
    let load = |sensor: &str, files: &[(&str, String)]| {
        let hardware = "[hardware]\ncontrol = true\ncalibration = \"ram\"\n";
        let sensor = format!("{}{sensor}\ndead = {{ room = 2 }}\n", PAD.replace("pa_per_count = -2.0\n", ""));
        Design::from_parts(&format!("{sensor}{hardware}"), "pad.toml", files).map_err(|error| error.to_string())
    };
    let gains = ("gains.csv", "1.5,3\n0.5,-2.25\n1,0\n1,0\n0,0\n1,1e-7\n".to_owned());
    let points = |least: f64| ("points.csv", format!("0,0\n100.5,-2000\n4000,{least}\n"));
    let counts = load("pa_per_count = -2.0\ncalibration = \"gains.csv\"", std::slice::from_ref(&gains)).unwrap();
    let bank = |design: &Design| ("bank.csv", bank::to_csv(design).unwrap());
    let named = |sensor: &str, design: &Design| load(sensor, &[bank(design), points(-5e4)]);
    let again = named("pa_per_count = -2.0\ncalibration = \"bank.csv\"", &counts).unwrap();
    assert_eq!((&again, again.input.dead.as_slice()), (&counts, &[4][..]));
    // With a curve, whose offsets are in pascals.
    let files = [gains, points(-6e4)];
    let curved = load("curve = \"points.csv\"\ncalibration = \"gains.csv\"", &files).unwrap();
    let again = named("curve = \"bank.csv\"\ncalibration = \"bank.csv\"", &curved).unwrap();
    assert_eq!(again, curved);
    assert_eq!(named("curve = \"bank.csv\"", &curved).unwrap().input.curve, curved.input.curve);
    for (sensor, of, parts) in [
        (
            "curve = \"points.csv\"\ncalibration = \"bank.csv\"",
            &curved,
            ["bank.csv, line 8", "another than the design's"],
        ),
        ("pa_per_count = -2.0\ncalibration = \"bank.csv\"", &curved, ["line 8", "in place of pa_per_count"]),
        ("curve = \"bank.csv\"", &counts, ["bank.csv, line 7", "no curve; write count,pascals"]),
    ] {
        let message = named(sensor, of).unwrap_err();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    // A taxel of the header that is alive, and a line without its weight.
    let text = bank(&counts).1;
    for (right, wrong, parts) in [
        ("\n0.0,0.0,", "\n1.0,0.0,", ["bank.csv, line 6", "taxel 4 among the dead ones, and its gain is 1"]),
        ("\n0.0,0.0,0.0", "\n0.0,0.0", ["bank.csv, line 6", "a weight for each taxel of the header"]),
        ("taxel 4", "taxel 6", ["bank.csv, line 1", "dead taxels of this sensor"]),
        ("taxel 4", "pascals", ["bank.csv, line 1", "no header of gains and offsets"]),
        ("taxel 4", "taxel +4", ["bank.csv, line 1", "no header of gains and offsets"]),
        // As no board takes them.
        ("taxel 4", "taxel 4,taxel 4", ["bank.csv, line 1", "has taxel 4 behind taxel 4; write each dead taxel once"]),
        ("taxel 4", "taxel 4,Taxel 3", ["bank.csv, line 1", "has taxel 3 behind taxel 4"]),
    ] {
        assert!(text.contains(right), "{text}");
        let file = ("bank.csv", text.replace(right, wrong));
        let message = load("pa_per_count = -2.0\ncalibration = \"bank.csv\"", &[file]).unwrap_err();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}
