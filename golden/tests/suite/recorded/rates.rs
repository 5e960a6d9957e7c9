//! Frames and forces whose logs run at other rates or tell other times.

use golden::calibrate::recorded::{Measured, fit_forces, read_forces};
use golden::frames::{Layout, read_recording};
use golden::solver::{Solver, Status};

use super::says;
use super::simulated::{COUNTS, Indenter, Recipe, Recording, design, record};

fn recording() -> Recording {
    record(&Recipe { scale: 40.0, noise: 2.0, places: 12, frames: 8, ..Recipe::new(81, Indenter::Disc) })
}

/// Whatever is wrong with the times of loads, no design comes out for which loaded frames are none.
#[test]
fn no_loaded_frame_becomes_no_contact() {
    let recording = recording();
    for wrong in 1..8 {
        let mut measured = recording.measured.clone();
        for (frame, force) in measured.forces.iter_mut().enumerate() {
            // Written down too early, in each hold.
            if frame % 10 >= 8 - wrong {
                *force = [Some(0.0); 3];
            }
        }
        let Ok(found) = fit_forces(&design(COUNTS, ""), &recording.frames, &measured) else { continue };
        let solver = Solver::new(&found.design).unwrap();
        let loaded = recording.frames.iter().zip(&recording.measured.forces).filter(|(_, force)| force[2] != Some(0.0));
        let nothing = |(frame, _): &(&Vec<f64>, &[Option<f64>; 3])| {
            solver.solve(frame).unwrap().status.contains(Status::NO_CONTACT)
        };
        let nothing = loaded.filter(nothing).count();
        assert!(nothing < 20, "{wrong} frames of each hold: {nothing} loaded frames are no contact");
    }
}

/// A recording whose pauses differ, with its forces from another moment on.
fn apart(recording: &Recording, lag: isize) -> (Vec<Vec<f64>>, Measured) {
    let pause = |frame: usize| if frame % 10 == 9 { 1 + frame / 10 * 7 % 5 } else { 1 };
    let places: Vec<usize> = (0..recording.frames.len()).flat_map(|frame| vec![frame; pause(frame)]).collect();
    let skip = |frames: isize| usize::try_from(frames).unwrap_or(0);
    (
        places.iter().skip(skip(-lag)).map(|&frame| recording.frames[frame].clone()).collect(),
        Measured::of_forces(places.iter().skip(skip(lag)).map(|&frame| recording.measured.forces[frame]).collect()),
    )
}

#[test]
fn logs_without_times_are_paired_by_what_they_have_in_common() {
    let recording = recording();
    let fit = |lag| {
        let (frames, measured) = apart(&recording, lag);
        fit_forces(&design(COUNTS, ""), &frames, &measured)
    };
    let together = fit(0).unwrap();
    assert!(!says(&together.remarks, &["begin together"]), "{:?}", together.remarks);
    let error = together.errors.unwrap().median;
    for (lag, said) in [(4, "line 1 to frame 5"), (30, "line 1 to frame 31"), (-7, "line 8 to frame 1")] {
        let found = fit(lag).unwrap();
        assert!(says(&found.remarks, &["paired by what fits best", said]), "{lag}: {:?}", found.remarks);
        assert!(found.errors.unwrap().median < 1.2 * error, "{lag}");
    }
    // The same loads at the same intervals again and again fit in many ways.
    let mut measured = recording.measured.clone();
    measured.forces.rotate_left(5);
    let refused = fit_forces(&design(COUNTS, ""), &recording.frames, &measured).unwrap_err().to_string();
    assert!(refused.contains("do not begin together") && refused.contains("column of times"), "{refused}");
}

/// Clocks that differ by years, or by a little where one says what belongs together.
#[test]
fn clocks_that_differ_are_said_and_the_lag_is_found() {
    let (frames, measured) = apart(&recording(), 20);
    let times = |begin: f64, count: usize| (0..count).map(|at| begin + 0.01 * at as f64).collect::<Vec<f64>>();
    let fit = |begin: f64| {
        let logged = Measured { times: Some(times(1e3, measured.forces.len())), ..measured.clone() };
        fit_forces(&design(COUNTS, ""), &frames, &logged.at(&times(begin, frames.len())).unwrap())
    };
    let found = fit(1e6).unwrap();
    assert!(
        says(&found.remarks, &["clocks", "differ"]) && says(&found.remarks, &["line 1 to frame 21"]),
        "{:?}",
        found.remarks
    );
    let refused = fit(1e3).unwrap_err().to_string();
    assert!(refused.contains("line 1 to frame 21 would: do their clocks differ?"), "{refused}");
}

#[test]
fn logs_with_missing_frames_are_refused() {
    let recording = recording();
    for lost in [3, 10] {
        let (mut frames, measured) = apart(&recording, 0);
        let middle = frames.len() / 2;
        frames.drain(middle..middle + lost);
        let measured = Measured::of_forces(measured.forces[..frames.len()].to_vec());
        let refused = fit_forces(&design(COUNTS, ""), &frames, &measured).unwrap_err().to_string();
        for part in ["pad: about frame ", &format!(", {lost} frames are missing"), "column of times"] {
            assert!(refused.contains(part), "{lost}: {refused}");
        }
    }
}

#[test]
fn frames_that_are_left_out_take_their_lines_along() {
    let recording = recording();
    let bad = [1, 100, 101, 102, recording.frames.len() - 1];
    let line = |(place, frame): (usize, &Vec<f64>)| {
        let value = |value: &f64| if bad.contains(&place) { "-".to_owned() } else { value.to_string() };
        frame.iter().map(value).collect::<Vec<_>>().join(",") + "\n"
    };
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("frames.csv");
    std::fs::write(&path, recording.frames.iter().enumerate().map(line).collect::<String>()).unwrap();
    let layout = Layout { skip_bad: true, ..Layout::default() };
    let read = read_recording(&path, &design(COUNTS, ""), layout).unwrap();
    assert_eq!((read.count(), &read.skipped[..]), (recording.frames.len(), &bad[..]));
    let kept: Vec<_> = (0..recording.frames.len()).filter(|place| !bad.contains(place)).collect();
    assert_eq!(read.frames, kept.iter().map(|&place| recording.frames[place].clone()).collect::<Vec<_>>());
    let forces: Vec<_> = kept.iter().map(|&place| recording.measured.forces[place]).collect();
    assert_eq!(recording.measured.clone().without_skipped(&read).forces, forces);
    // A blank first cell beside a tab is one.
    std::fs::write(&path, "F_x\tF_y\tF_z\n\t0.2\t-5\n0.1\t0.2\t-5\n").unwrap();
    let read_back = read_forces(&path).unwrap().forces;
    assert_eq!(read_back, [[None, Some(0.2), Some(-5.0)], [Some(0.1), Some(0.2), Some(-5.0)]]);
    // Points between semicolons.
    std::fs::write(&path, "F_x;F_y;F_z\n1;2;-1.226\n2;1;-2.310\n").unwrap();
    assert!(read_forces(&path).unwrap_err().to_string().contains("three digits follow every point"));
    // Who left them out of both has one line for each that is kept.
    assert_eq!(Measured::of_forces(forces.clone()).without_skipped(&read).forces, forces);
}

#[test]
fn logs_of_other_rates_are_paired_by_their_times() {
    let recording = recording();
    // Frames at 100 Hz, forces at 1 kHz that begin half a second earlier.
    let times: Vec<f64> = (0..recording.frames.len()).map(|frame| 0.01 * frame as f64).collect();
    let count = 10 * recording.frames.len();
    let line = |line: usize| ((line as f64 - 500.0) / 10.0).round();
    let forces = (0..count + 500).map(|at| {
        let frame = line(at);
        recording.measured.forces.get(frame as usize).filter(|_| frame >= 0.0).copied().unwrap_or([Some(0.0); 3])
    });
    let mut measured = Measured::of_forces(forces.collect());
    measured.times = Some((0..count + 500).map(|at| 0.001 * (at as f64 - 500.0)).collect());
    let paired = measured.at(&times).unwrap();
    assert_eq!(paired.forces.len(), recording.frames.len());
    assert!(
        paired
            .forces
            .iter()
            .flatten()
            .flatten()
            .zip(recording.measured.forces.iter().flatten().flatten())
            .all(|(a, b)| (a - b).abs() < 1e-9)
    );
    assert!(says(&paired.remarks, &["paired by their times"]));
    // Clocks that differ are set to begin together, and the lag is found by what fits; nothing fits a log of another length.
    let far: Vec<f64> = times.iter().map(|time| time + 1e4).collect();
    let apart = measured.at(&far).unwrap();
    assert!(says(&apart.remarks, &["the clocks", "differ by about -10000.5 s"]), "{:?}", apart.remarks);
    let short: Vec<f64> = times.iter().map(|time| 10.0 * time + 1e4).collect();
    assert!(measured.at(&short).unwrap_err().contains("the same clock"));
    let falling: Vec<f64> = times.iter().map(|time| -time).collect();
    assert!(measured.at(&falling).unwrap_err().contains("times fall"));
    // Between two lines a straight one.
    let mut two = Measured::of_forces(vec![[None, None, Some(0.0)], [None, None, Some(-10.0)]]);
    two.times = Some(vec![0.0, 1.0]);
    assert_eq!(two.at(&[0.25, 1.0]).unwrap().forces, [[None, None, Some(-2.5)], [None, None, Some(-10.0)]]);
}
