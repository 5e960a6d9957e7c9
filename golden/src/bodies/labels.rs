//! Blobs of touched taxels, by their raster order.

/// The labels of a grid's taxels, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// Blob of each taxel, from 0 in the order of their first taxels; `None` where nothing touches.
    pub blobs: Vec<Option<usize>>,
    /// Number of blobs.
    pub count: usize,
    /// Of each provisional label, one that it turned out to be the same blob as: itself or a lower one.
    same: Vec<usize>,
    /// Of each provisional label, its blob.
    numbers: Vec<usize>,
}

impl Labels {
    /// Labels the taxels of a grid of `columns`: neighbours along x or y that both touch are of one blob, neighbours along
    /// the diagonal alone are not.
    ///
    /// As hardware would do it: taxel by taxel in raster order, each looks at the one before and the one above. Where both
    /// have labels, the higher one is noted to be the lower one. With one pass over the labels and one over the taxels the
    /// blobs are numbered: m + m/2 + m steps at most, since no two neighbours begin a label of their own.
    pub fn find(&mut self, touched: &[bool], columns: usize) {
        let Self { blobs, count, same, numbers } = self;
        blobs.clear();
        same.clear();
        for (taxel, &touches) in touched.iter().enumerate() {
            if !touches {
                blobs.push(None);
                continue;
            }
            let before = if taxel % columns > 0 { blobs[taxel - 1] } else { None };
            let above = taxel.checked_sub(columns).and_then(|above| blobs[above]);
            let label = match (before, above) {
                (Some(before), Some(above)) => join(same, before, above),
                (Some(label), None) | (None, Some(label)) => label,
                (None, None) => {
                    same.push(same.len());
                    same.len() - 1
                }
            };
            blobs.push(Some(label));
        }
        *count = 0;
        numbers.clear();
        for (label, &of) in same.iter().enumerate() {
            // A label that is another one's is so of a lower one, which has its number.
            let number = if of == label { *count } else { numbers[of] };
            *count += usize::from(of == label);
            numbers.push(number);
        }
        for blob in blobs.iter_mut().flatten() {
            *blob = numbers[*blob];
        }
    }
}

/// Notes that two labels are of one blob, and returns its lowest label.
fn join(same: &mut [usize], a: usize, b: usize) -> usize {
    let [a, b] = [a, b].map(|mut label| {
        while same[label] != label {
            label = same[label];
        }
        label
    });
    let (low, high) = (a.min(b), a.max(b));
    same[high] = low;
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The blobs of a drawing, a letter for each: what is no space touches.
    fn drawn(rows: &[&str]) -> (Vec<String>, usize) {
        let columns = rows[0].len();
        let touched: Vec<bool> = rows.iter().flat_map(|row| row.bytes().map(|at| at != b'.')).collect();
        let mut labels = Labels::default();
        // Used before, as by a frame of another kind.
        labels.find(&vec![true; touched.len()], columns);
        labels.find(&touched, columns);
        let letter = |blob: &Option<usize>| blob.map_or('.', |blob| char::from(b'a' + blob as u8));
        (labels.blobs.chunks(columns).map(|row| row.iter().map(letter).collect()).collect(), labels.count)
    }

    fn assert_drawn(rows: &[&str], count: usize) {
        let (found, blobs) = drawn(rows);
        assert_eq!(
            (found.as_slice(), blobs),
            (rows.iter().map(|row| (*row).to_owned()).collect::<Vec<_>>().as_slice(), count)
        );
    }

    #[test]
    fn nothing_has_no_blob_and_all_is_one() {
        assert_drawn(&["....", "...."], 0);
        assert_drawn(&["aaaa", "aaaa"], 1);
    }

    #[test]
    fn corners_are_blobs_of_their_own_and_rows_do_not_run_on() {
        assert_drawn(&["a..b", "....", "c..d"], 4);
        // The last taxel of a row is no neighbour of the first one of the next.
        assert_drawn(&["...a", "b..."], 2);
    }

    #[test]
    fn a_diagonal_does_not_connect() {
        assert_drawn(&["a..", ".b.", "..c"], 3);
        assert_drawn(&[".a", "b."], 2);
    }

    #[test]
    fn arms_that_meet_late_are_one() {
        assert_drawn(&["a.a", "a.a", "aaa"], 1);
        // Three arms, the middle one first met by the right one, and a blob between that keeps its own number.
        assert_drawn(&["a.a.a.b", "a.aaa..", "a.a...c", "aaa...c"], 3);
        // A spiral, whose labels are joined through others.
        assert_drawn(&["aaaaaaa", "......a", "aaaaa.a", "a...a.a", "a.aaa.a", "a.....a", "aaaaaaa"], 1);
    }

    #[test]
    fn labels_joined_through_others_are_one() {
        // Each row joins two labels that were joined to others before.
        assert_drawn(&["a.a.a.a", "a.a.aaa", "a.aaa..", "aaa...b"], 2);
    }
}
