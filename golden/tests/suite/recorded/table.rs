//! Files of forces as people write them.

use std::fs;

use golden::calibrate::recorded::{Measured, read_forces, read_pressures};

fn forces(text: &str) -> Result<Measured, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("forces.csv");
    fs::write(&path, text).unwrap();
    read_forces(&path).map_err(|error| error.to_string())
}

fn near(found: &[[Option<f64>; 3]], expected: &[[Option<f64>; 3]]) -> bool {
    let close = |a: &Option<f64>, b: &Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-9,
        (None, None) => true,
        _ => false,
    };
    found.len() == expected.len() && found.iter().flatten().zip(expected.iter().flatten()).all(|(a, b)| close(a, b))
}

#[test]
fn columns_units_and_blanks() {
    let z = |values: &[Option<f64>]| values.iter().map(|&value| [None, None, value]).collect::<Vec<_>>();
    for (text, expected) in [
        ("F_x (N),F_y (N),F_z (N)\n1,2,-3\n,,-4\n", vec![[Some(1.0), Some(2.0), Some(-3.0)], [None, None, Some(-4.0)]]),
        ("t [s];Fz [mN];comment\n0,0;2500,5;a\n0,1;nan;b\n", z(&[Some(2.5005), None])),
        ("frame\tweight_g\n1\t100\n2\t200\n", z(&[Some(0.980_665), Some(1.961_33)])),
        ("F_z (MN)\n2\n", z(&[Some(2e6)])),
        ("F_z_mN\n2\n", z(&[Some(2e-3)])),
        ("weight (g)\n\"550,5\"\n", z(&[Some(0.550_5 * 9.806_65)])),
        ("F_z,\n5,\n", z(&[Some(5.0)])),
        ("load\nkN\n0.001\n0.002\n", z(&[Some(1.0), Some(2.0)])),
        ("Gewicht [g]\n550\n", z(&[Some(0.550 * 9.806_65)])),
        ("t (s),Kraft_mN\n0,5\n", z(&[Some(5e-3)])),
        ("kg\n2\n", z(&[Some(2.0 * 9.806_65)])),
        ("# Normal force (N)\n5\n7\n", z(&[Some(5.0), Some(7.0)])),
        ("5\n\n7\n", z(&[Some(5.0), None, Some(7.0)])),
        ("0 5.5\n1 6.5\n", z(&[Some(5.5), Some(6.5)])),
        ("0,5\n10,6\n20,550\n", z(&[Some(5.0), Some(6.0), Some(550.0)])),
        ("sep=;\nt;F_z (mN)\n0;5\n", z(&[Some(5e-3)])),
        ("F_x;F_z (N)\nmN;\n5;6\n", vec![[Some(5e-3), None, Some(6.0)]]),
        ("0,1,2,-3,4,5,6,7\n", vec![[Some(1.0), Some(2.0), Some(-3.0)]]),
        ("status,F_x,F_y,F_z,mu\n0,1.0,2.0,-3.0,0.5\n", vec![[Some(1.0), Some(2.0), Some(-3.0)]]),
    ] {
        let found = forces(text).unwrap();
        assert!(near(&found.forces, &expected), "{text:?}: {:?}", found.forces);
    }
    let found = forces("place,F_z\nA,1\nA,2\nB,\n").unwrap();
    assert_eq!(found.contacts.unwrap(), ["A", "A", "B"]);
    let found = forces("operator,F_z\n0,1\n").unwrap();
    assert!(found.remarks.iter().any(|line| line.contains("not used") && line.contains("operator")));
    let found = forces("time (ms),F_z\n0,1\n1500,2\n").unwrap();
    assert_eq!(found.times, Some(vec![0.0, 1.5]));
    // A time that is not there.
    let found = forces("t (s),F_z\n0,1\n,2\n2,3\n3,3\n4,3\n5,3\n6,3\n7,3\n8,3\n9,3\n").unwrap();
    assert_eq!(found.times, Some((0..10).map(f64::from).collect()));
    assert!(found.remarks.iter().any(|line| line.contains("1 line without a time")), "{:?}", found.remarks);
    assert!(forces("t (s),F_z\n0,1\n,2\n2,3\n").unwrap_err().contains("line 3: the time is no number, and others are"));
    for names in ["timestamp,F_z\n", ""] {
        let found = forces(&format!("{names}2026-03-01 12:00:00Z,1\n2026-03-01T12:00:01.5,2\n")).unwrap();
        assert_eq!(found.times, Some(vec![1_772_366_400.0, 1_772_366_401.5]));
        assert_eq!(found.forces, z(&[Some(1.0), Some(2.0)]));
    }
    assert!(forces("3\n").unwrap().remarks.iter().any(|line| line.contains("taken for F_z in newtons")));
    assert!(forces("Kraft\n3\n").unwrap().remarks.iter().any(|line| line.contains("neither quantity nor unit, Kraft")));
}

#[test]
fn what_nobody_can_tell_is_refused() {
    for (text, parts) in [
        ("", ["forces.csv", "no line of numbers", "one line for each frame"]),
        ("1,2\n0,5\n", ["2 columns without a header", "nobody can tell", "F_x,F_y,F_z"]),
        (
            "550,5\n551,0\n760,25\n",
            ["2 columns without", "commas are decimal ones", "write decimal points, or a header"],
        ),
        ("-5,5\n", ["2 columns without", "commas are decimal ones", "write decimal points, or a header"]),
        ("5|2\n6|3\n", ["line 1", "\"|\" separates the values", "commas"]),
        // A remark between the lines names nothing.
        ("1,2,3,4,5\n# a,b,F_z,d,e\n6,7,8,9,1\n", ["5 columns without", "nobody can tell", "header"]),
        ("a,b\n1,2\n", ["the columns a, b", "nobody can tell", "write a header"]),
        ("mass\n5\n", ["\"mass\" has no unit", "name the unit", "kg"]),
        ("weight\n5\n", ["\"weight\" has no unit", "name the unit", "kg"]),
        ("a (N),b (N)\n1,2\n", ["the columns a (N), b (N)", "nobody can tell", "write a header"]),
        ("F_z (stone)\n5\n", ["\"stone\" is no unit of a force", "name the unit", "mN"]),
        ("F_z (kPa)\n5\n", ["\"kPa\" is no unit of a force", "name the unit", "mN"]),
        ("F_z\n5\nheavy\n", ["line 3, column 1", "\"heavy\" is no finite", "leave blank"]),
        ("F_z\n\"1,010\"\n\"2,500\"\n", ["line 2, column 1", "separators of thousands", "write decimal points"]),
        ("weight (g)\n550,5\n", ["line 2: 2 values", "1 name", "decimal commas? Separate the values by semicolons"]),
        ("normal force [N]\n5,40\n", ["line 2: 2 values", "1 name", "decimal commas"]),
        ("F_z\n-5,40\n", ["line 2: 2 values", "1 name", "decimal commas"]),
        ("F_x,F_y,F_z\n3,0,-6\n3,00,0,00,-6,00\n", ["line 3: 6 values", "3 names", "decimal commas"]),
        ("F_z\n5 6\n", ["line 2: 2 values", "1 name", "name every column"]),
        ("F_z,load\n5,5\n", ["2 columns are the force along z", "name", "unit"]),
    ] {
        let said = forces(text).unwrap_err();
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
    }
}

#[test]
fn pressures_and_arrays() {
    let folder = tempfile::tempdir().unwrap();
    let [text, array] = ["p.csv", "f.npy"].map(|name| folder.path().join(name));
    fs::write(&text, "pressure (mPa)\n2000\n").unwrap();
    assert_eq!(read_pressures(&text).unwrap().pressures, [Some(2.0)]);
    fs::write(&text, "pressure (kPa)\n0\n12.5\n-\n").unwrap();
    assert_eq!(read_pressures(&text).unwrap().pressures, [Some(0.0), Some(12500.0), None]);
    golden::frames::write_frames(&array, &[vec![2.0], vec![3.5]]).unwrap();
    assert!(near(&read_forces(&array).unwrap().forces, &[[None, None, Some(2.0)], [None, None, Some(3.5)]]));
    assert!(read_forces(&folder.path().join("none.csv")).unwrap_err().to_string().contains("cannot"));
}
