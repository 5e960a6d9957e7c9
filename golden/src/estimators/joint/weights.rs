//! The weights of a correction as a table of their own: CSV with a header, one line for each hidden unit.

use std::fmt::Write;

use super::constants::{Correction, EXTRA_INPUTS, MAX_HIDDEN, WEIGHT_LIMIT};

/// Names of the inputs behind the window, in order: friction of the level set's centre, the contact's centre within its
/// taxel, and one.
const EXTRA: [&str; EXTRA_INPUTS] = ["mu_x", "mu_y", "centre_x", "centre_y", "one"];
/// The last columns: the hidden unit's weights in both components of the correction.
const OUTPUT: [&str; 2] = ["to_x", "to_y"];

/// The columns: places of the window, row by row, seen from the contact's centre; the other inputs; the outputs.
fn header([half_x, half_y]: [usize; 2]) -> String {
    let steps = |half: usize| -(half as i64)..=half as i64;
    let places = steps(half_y).flat_map(|y| steps(half_x).map(move |x| format!("x{x:+}y{y:+}")));
    let others = EXTRA.into_iter().chain(OUTPUT);
    places.chain(others.map(str::to_owned)).collect::<Vec<_>>().join(",")
}

impl Correction {
    /// The weights as CSV, in the form of `docs/reference/files.md`; a design reads them back.
    pub fn to_csv(&self) -> String {
        let mut text = header(self.half_window) + "\n";
        let [along_x, along_y] = &self.output;
        for ((unit, to_x), to_y) in self.hidden.iter().zip(along_x).zip(along_y) {
            for weight in unit {
                // Writing to a String cannot fail.
                let _ = write!(text, "{weight},");
            }
            let _ = writeln!(text, "{to_x},{to_y}");
        }
        text
    }

    /// Reads what [`Correction::to_csv`] writes.
    ///
    /// # Errors
    ///
    /// The line, from 1, and what is wrong with it.
    pub(crate) fn read_csv(text: &str, half_window: [usize; 2]) -> Result<Self, (usize, String)> {
        let mut lines = (1..).zip(text.lines());
        if lines.next().is_none_or(|(_, line)| line != header(half_window)) {
            let [x, y] = half_window;
            return Err((1, format!("the header is not that of half_window = [{x}, {y}]")));
        }
        let (mut hidden, mut output) = (Vec::new(), [Vec::new(), Vec::new()]);
        let columns = Self::inputs(half_window) + OUTPUT.len();
        for (line, content) in lines {
            let weights = content.split(',').map(|word| weight(word).map_err(|problem| (line, problem)));
            let mut weights: Vec<i32> = weights.collect::<Result<_, _>>()?;
            if weights.len() != columns {
                return Err((line, format!("{} weights in place of {columns}", weights.len())));
            }
            for (output, weight) in output.iter_mut().zip(weights.split_off(Self::inputs(half_window))) {
                output.push(weight);
            }
            hidden.push(weights);
        }
        if !(1..=MAX_HIDDEN).contains(&hidden.len()) {
            return Err((hidden.len() + 1, format!("{} hidden units, not 1 to {MAX_HIDDEN}", hidden.len())));
        }
        Ok(Self { half_window, hidden, output })
    }
}

/// A whole number of steps in the range of weights.
fn weight(word: &str) -> Result<i32, String> {
    let shown = || word.chars().take(40).collect::<String>();
    let weight: i32 = word.parse().map_err(|_| format!("{:?} is no whole number", shown()))?;
    if (-WEIGHT_LIMIT..WEIGHT_LIMIT).contains(&weight) {
        Ok(weight)
    } else {
        Err(format!("{weight} is no weight from -{WEIGHT_LIMIT} to {}", WEIGHT_LIMIT - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small() -> Correction {
        Correction {
            half_window: [1, 0],
            hidden: vec![vec![1, -2, 3, 4, 5, 6, 7, -131_072], vec![0, 0, 0, 0, 0, 0, 0, 131_071]],
            output: [vec![9, -10], vec![11, 12]],
        }
    }

    #[test]
    fn a_table_names_its_columns_and_reads_back() {
        let text = small().to_csv();
        let expected = "x-1y+0,x+0y+0,x+1y+0,mu_x,mu_y,centre_x,centre_y,one,to_x,to_y\n\
                        1,-2,3,4,5,6,7,-131072,9,11\n0,0,0,0,0,0,0,131071,-10,12\n";
        assert_eq!(text, expected);
        assert_eq!(Correction::read_csv(&text, [1, 0]), Ok(small()));
    }

    #[test]
    fn a_damaged_table_is_refused_with_its_line() {
        let text = small().to_csv();
        let lines = |keep: usize| text.lines().take(keep).map(|line| format!("{line}\n")).collect::<String>();
        for (damaged, half_window, line, part) in [
            (text.clone(), [0, 1], 1, "half_window = [0, 1]"),
            (String::new(), [1, 0], 1, "header"),
            (lines(1), [1, 0], 1, "0 hidden units, not 1 to 256"),
            (lines(1) + &"0,0,0,0,0,0,0,0,0,0\n".repeat(257), [1, 0], 258, "257 hidden units"),
            (text.replace(",11\n", "\n"), [1, 0], 2, "9 weights in place of 10"),
            (text.replace("131071", "131072"), [1, 0], 3, "131072 is no weight from -131072 to 131071"),
            (text.replace("-2,", "2.5,"), [1, 0], 2, "\"2.5\" is no whole number"),
        ] {
            let (found, problem) = Correction::read_csv(&damaged, half_window).expect_err("it is damaged");
            assert!(found == line && problem.contains(part), "{found}: {problem}");
        }
    }
}
