//! Which contact each taxel belongs to: the nearest one.

use crate::sensor::Sensor;

/// A taxel without a contact yet: farther than any.
const NONE: (u64, usize) = (u64::MAX, usize::MAX);

/// Distances of neighbours on a sensor, in whole micrometres: along x, along y, along the diagonal.
pub(super) fn distances(sensor: &Sensor) -> [u64; 3] {
    let [x, y] = sensor.pitch_mm;
    [x, y, x.hypot(y)].map(|millimetres| (1e3 * millimetres).round() as u64)
}

/// Gives each taxel of a grid of `columns` to the nearest contact; `contacts` has those of the components, then of all taxels.
///
/// Nearest by steps from neighbour to neighbour, eight of them, each as long as [`distances`] says: with a square pitch at
/// most 8 % longer than the straight line. A taxel as near to two goes to that with the lower number, which is the larger
/// one. Two passes, as hardware would do it: in raster order, where each looks at four neighbours before it, and back.
pub(super) fn spread(
    contacts: &mut [Option<usize>],
    columns: usize,
    [x, y, diagonal]: [u64; 3],
    nearest: &mut Vec<(u64, usize)>,
) {
    nearest.clear();
    nearest.extend(contacts.iter().map(|contact| contact.map_or(NONE, |contact| (0, contact))));
    let taxels = contacts.len();
    let rows = taxels / columns.max(1);
    // A step back in the raster, and forward.
    for sign in [-1, 1] {
        let steps: [(isize, isize, u64); 4] =
            [(sign, 0, x), (-sign, sign, diagonal), (0, sign, y), (sign, sign, diagonal)];
        for index in 0..taxels {
            let taxel = if sign < 0 { index } else { taxels - 1 - index };
            let (column, row) = (taxel % columns, taxel / columns);
            for (along_x, along_y, length) in steps {
                let (Some(column), Some(row)) = (column.checked_add_signed(along_x), row.checked_add_signed(along_y))
                else {
                    continue;
                };
                if column < columns && row < rows && nearest[row * columns + column] != NONE {
                    let (distance, contact) = nearest[row * columns + column];
                    nearest[taxel] = nearest[taxel].min((distance + length, contact));
                }
            }
        }
    }
    for (contact, &nearest) in contacts.iter_mut().zip(nearest.iter()) {
        *contact = (nearest != NONE).then_some(nearest.1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The regions of a drawing of components.
    fn drawn(rows: &[&str], distances: [u64; 3]) -> Vec<String> {
        let columns = rows[0].len();
        let of = |at: u8| (at != b'.').then(|| usize::from(at - b'a'));
        let mut contacts: Vec<Option<usize>> = rows.iter().flat_map(|row| row.bytes().map(of)).collect();
        spread(&mut contacts, columns, distances, &mut Vec::new());
        let letter = |contact: &Option<usize>| contact.map_or('.', |contact| char::from(b'a' + contact as u8));
        contacts.chunks(columns).map(|row| row.iter().map(letter).collect()).collect()
    }

    const EVEN: [u64; 3] = [2000, 2000, 2828];

    #[test]
    fn each_taxel_goes_to_the_nearest_and_between_two_to_the_first() {
        assert_eq!(drawn(&["a....b", "......"], EVEN), ["aaabbb", "aaabbb"]);
        assert_eq!(drawn(&["b...a", "....."], EVEN), ["bbaaa", "bbaaa"]);
        assert_eq!(drawn(&["......", ".....b", "......", "a....."], EVEN), ["aabbbb", "aaabbb", "aaabbb", "aaabbb"]);
    }

    #[test]
    fn pitches_count() {
        // Three rows are nearer than two columns.
        assert_eq!(drawn(&["a...", "....", "....", "...b"], [4000, 1000, 4123]), ["aabb", "aabb", "aabb", "aabb"]);
        assert_eq!(drawn(&["a..", "...", "...", "b.."], [4000, 1000, 4123]), ["aaa", "aaa", "bbb", "bbb"]);
    }

    #[test]
    fn without_a_contact_there_is_no_region() {
        assert_eq!(drawn(&["..", ".."], EVEN), ["..", ".."]);
        assert_eq!(drawn(&["..", ".a"], EVEN), ["aa", "aa"]);
    }
}
