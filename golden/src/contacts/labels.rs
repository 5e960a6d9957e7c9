//! Components of touched taxels, by their raster order.

/// The labels of a grid's taxels, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// Contact of each taxel, from 0 in the order of their first taxels; `None` where nothing touches.
    pub components: Vec<Option<usize>>,
    /// Number of components.
    pub count: usize,
    /// Of each provisional label, one that it turned out to be the same component as: itself or a lower one.
    same: Vec<usize>,
    /// Of each provisional label, its component.
    numbers: Vec<usize>,
}

impl Labels {
    /// Labels the taxels of a grid of `columns`: neighbours along x or y that both touch are of one component, those along the
    /// diagonal alone are not.
    ///
    /// As hardware would do it: taxel by taxel in raster order, each looks at the one before and the one above. Where both
    /// have labels, the higher one is noted to be the lower one. With one pass over the labels and one over the taxels the
    /// components are numbered: m + m/2 + m steps at most, since no two neighbours begin a label of their own.
    pub fn find(&mut self, touched: &[bool], columns: usize) {
        let Self { components, count, same, numbers } = self;
        components.clear();
        same.clear();
        for (taxel, &touches) in touched.iter().enumerate() {
            if !touches {
                components.push(None);
                continue;
            }
            let before = if taxel % columns > 0 { components[taxel - 1] } else { None };
            let above = taxel.checked_sub(columns).and_then(|above| components[above]);
            let label = match (before, above) {
                (Some(before), Some(above)) => join(same, before, above),
                (Some(label), None) | (None, Some(label)) => label,
                (None, None) => {
                    same.push(same.len());
                    same.len() - 1
                }
            };
            components.push(Some(label));
        }
        *count = 0;
        numbers.clear();
        for (label, &of) in same.iter().enumerate() {
            // A label that is another one's is so of a lower one, which has its number.
            let number = if of == label { *count } else { numbers[of] };
            *count += usize::from(of == label);
            numbers.push(number);
        }
        for component in components.iter_mut().flatten() {
            *component = numbers[*component];
        }
    }
}

/// Notes that two labels are of one component, and returns its lowest label.
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

    /// The components of a drawing, a letter for each: what is no space touches.
    fn drawn(rows: &[&str]) -> (Vec<String>, usize) {
        let columns = rows[0].len();
        let touched: Vec<bool> = rows.iter().flat_map(|row| row.bytes().map(|at| at != b'.')).collect();
        let mut labels = Labels::default();
        // Used before, as by a frame of another kind.
        labels.find(&vec![true; touched.len()], columns);
        labels.find(&touched, columns);
        let letter = |component: &Option<usize>| component.map_or('.', |component| char::from(b'a' + component as u8));
        (labels.components.chunks(columns).map(|row| row.iter().map(letter).collect()).collect(), labels.count)
    }

    fn assert_drawn(rows: &[&str], count: usize) {
        let (found, components) = drawn(rows);
        assert_eq!(
            (found.as_slice(), components),
            (rows.iter().map(|row| (*row).to_owned()).collect::<Vec<_>>().as_slice(), count)
        );
    }

    #[test]
    fn nothing_has_no_component_and_all_is_one() {
        assert_drawn(&["....", "...."], 0);
        assert_drawn(&["aaaa", "aaaa"], 1);
    }

    #[test]
    fn corners_are_components_of_their_own_and_rows_do_not_run_on() {
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
        // Three arms, the middle one first met by the right one, and a component between that keeps its own number.
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
