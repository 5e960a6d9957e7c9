//! Components of touched taxels, by their raster order: a flood fill from each first taxel.

/// The labels of a grid's taxels, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// Contact of each taxel, from 0 in the order of their first taxels; `None` where nothing touches.
    pub components: Vec<Option<usize>>,
    /// Number of components.
    pub count: usize,
    /// Taxels of a component whose neighbours have not been looked at.
    open: Vec<usize>,
}

impl Labels {
    /// Labels the taxels of a grid of `columns`: neighbours along x or y that both touch are of one component, those along the
    /// diagonal alone are not.
    pub fn find(&mut self, touched: &[bool], columns: usize) {
        let Self { components, count, open } = self;
        components.clear();
        components.resize(touched.len(), None);
        *count = 0;
        for first in 0..touched.len() {
            if !touched[first] || components[first].is_some() {
                continue;
            }
            components[first] = Some(*count);
            open.push(first);
            while let Some(taxel) = open.pop() {
                let before = (taxel % columns > 0).then(|| taxel - 1);
                let behind = Some(taxel + 1).filter(|behind| behind % columns > 0);
                let beside = [before, behind, taxel.checked_sub(columns), Some(taxel + columns)];
                for next in beside.into_iter().flatten() {
                    if touched.get(next) == Some(&true) && components[next].is_none() {
                        components[next] = Some(*count);
                        open.push(next);
                    }
                }
            }
            *count += 1;
        }
    }
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
        // Three arms that meet below, and a component between them with a number of its own.
        assert_drawn(&["a.a.a.b", "a.aaa..", "a.a...c", "aaa...c"], 3);
        // A spiral: the fill turns all ways.
        assert_drawn(&["aaaaaaa", "......a", "aaaaa.a", "a...a.a", "a.aaa.a", "a.....a", "aaaaaaa"], 1);
    }

    #[test]
    fn teeth_that_meet_are_one() {
        // Teeth that meet row by row, and a taxel on its own.
        assert_drawn(&["a.a.a.a", "a.a.aaa", "a.aaa..", "aaa...b"], 2);
    }
}
