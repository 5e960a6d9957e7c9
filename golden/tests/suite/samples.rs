//! Integer samples: which designs have them, and which frames they take. A calibration in RAM: which designs may.

use golden::design::{CalibrationIn, Design, Samples};
use golden::frames::{read_recording, to_text};

const PAD: &str = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
     name = \"pad\"\n[sensor]\ncolumns = 2\nrows = 2\npitch_mm = [4.0, 2.0]\ndepth_mm = 2.0\n";

fn pad(sensor: &str, samples: &str) -> Result<Design, String> {
    let text = format!("{PAD}{sensor}\n[hardware]\nsamples = \"{samples}\"\n");
    Design::from_toml(&text, "pad.toml").map_err(|error| error.to_string())
}

#[test]
fn integers_are_counts() {
    for (word, samples, range) in
        [("int16", Samples::Int16, [-32_768.0, 32_767.0]), ("uint16", Samples::Uint16, [0.0, 65_535.0])]
    {
        let design = pad("pa_per_count = -10.0", word).unwrap();
        assert_eq!((design.hardware.samples, samples.range()), (samples, Some(range)));
        assert_eq!(Design::from_toml(&design.to_toml(), "again").unwrap(), design);
        let message = pad("", word).unwrap_err();
        assert!(["hardware.samples", word, "pascals", "sensor.pa_per_count"].iter().all(|part| message.contains(part)));
    }
    let message = pad("pa_per_count = -10.0", "int12").unwrap_err();
    assert!(message.contains("samples") && message.contains("`float32`, `int16`, `uint16`"), "{message}");
    let plain = pad("", "float32").unwrap();
    assert!(plain.to_toml().contains("\nsamples = \"float32\"\n"), "{}", plain.to_toml());
}

#[test]
fn frames_hold_what_samples_can_be() {
    let folder = tempfile::tempdir().unwrap();
    let read = |text: &str, samples: &str| {
        let file = folder.path().join("frames.csv");
        std::fs::write(&file, text).unwrap();
        let design = pad("pa_per_count = -10.0", samples).unwrap();
        read_recording(&file, &design, 0).map(|read| read.frames).map_err(|error| error.to_string())
    };
    assert_eq!(read("0,1,2,3\n1,2,3,-4\n", "int16").unwrap(), [[1.0, 2.0, 3.0, -4.0]]);
    assert_eq!(read("1,2,3,-4\n", "int16").unwrap(), [[1.0, 2.0, 3.0, -4.0]]);
    for (text, samples, parts) in [
        ("1,2,3,4\n\n1,2.5,3,4\n", "int16", ["line 3, column 2", "2.5", "from -32768 to 32767; if these are pascals"]),
        ("a,b,c,d\n# none\n1,2,3,40000\n", "int16", ["line 3, column 4", "40000", "int16"]),
        ("0,1,2,3\n1,2,3,40000\n", "int16", ["line 2, column 4", "40000", "int16"]),
        ("9,2,3,4\n-1,2,3,4\n", "uint16", ["line 2, column 1", "-1", "from 0 to 65535"]),
    ] {
        let message = read(text, samples).unwrap_err();
        assert!(parts.iter().all(|part| message.contains(part)) && message.contains("frames.csv"), "{message}");
    }
    assert!(read("1,2.5,3,4\n", "float32").is_ok());
    // A header of fewer fields than there are labels.
    let file = folder.path().join("frames.csv");
    std::fs::write(&file, "recording\na,b,1,2.5,3,4\n").unwrap();
    let error = read_recording(&file, &pad("pa_per_count = -10.0", "int16").unwrap(), 2).unwrap_err();
    assert!(error.to_string().contains("line 2, column "), "{error}");
}

#[test]
fn what_a_sensor_delivers_fits_its_samples() {
    let mut frame = [-1e6, 1e6, -15.0, 0.0];
    pad("pa_per_count = -10.0", "uint16").unwrap().deliver(&mut frame);
    assert_eq!(frame.map(f64::to_bits), [65_535.0_f64, 0.0, 2.0, 0.0].map(f64::to_bits));
    assert_eq!(to_text(&[frame.to_vec()]), "65535,0,2,0\n");
    // Bits are kept where they are not those of a whole number.
    assert_eq!(to_text(&[vec![1.0, -0.0], vec![2.0, 0.5]]), "1.0,-0.0\n2.0,0.5\n");
}

#[test]
fn a_calibration_in_ram_needs_registers_and_counts() {
    let design = |sensor: &str, hardware: &str| {
        let text = format!("{PAD}{sensor}\n[hardware]\ncalibration = \"ram\"\n{hardware}\n");
        Design::from_toml(&text, "pad.toml").map_err(|error| error.to_string())
    };
    let counts = "pa_per_count = -2.0";
    let good = design(counts, "control = true").unwrap();
    assert_eq!(good.hardware.calibration, CalibrationIn::Ram);
    assert_eq!(Design::from_toml(&good.to_toml(), "again.toml").unwrap(), good);
    assert!(design("curve = { power = 1.2, scale = -1.0 }", "control = true").is_ok());
    for (sensor, hardware, said) in [
        (counts, "", "no registers"),
        (counts, "control = false", "add control = true"),
        ("", "control = true", "add sensor.pa_per_count"),
        ("curve = { power = 1.2, scale = -1.0 }", "", "no registers"),
    ] {
        let message = design(sensor, hardware).unwrap_err();
        assert!(message.contains("hardware.calibration") && message.contains(said), "{message}");
    }
    // With the default, or without the key.
    for text in ["", "calibration = \"rom\""] {
        let design = Design::from_toml(&format!("{PAD}\n[hardware]\n{text}\n"), "pad.toml").unwrap();
        assert!(design.to_toml().contains("\ncalibration = \"rom\"\n"), "{}", design.to_toml());
    }
}
