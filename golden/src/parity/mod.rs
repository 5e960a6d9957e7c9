//! Mirror parity: vectors of one value a taxel as four quarter-size vectors, and matrices as four quarter-size blocks.
//!
//! The grid of taxels is its own mirror image in x and in y. A vector is the sum of four that are each even or odd in x
//! and in y, its *classes*, and each is told by its values on a quarter of the grid. C33 keeps the class of what it
//! multiplies, C31 changes it from even to odd in x and back, C32 in y; so do their inverses and products. A matrix of
//! m by m entries is then four blocks of about m/4 by m/4, without any error.
//!
//! The fold has no factors in it, so that hardware folds with additions alone: even and odd sums of the four mirror
//! images, and a quarter of the same sums back.

mod folded;

use std::ops::{Add, Sub};

pub use folded::FoldedMatrix;

/// Number of classes: even or odd in x, times even or odd in y. Class `c = odd_x + 2 * odd_y`.
pub const CLASSES: usize = 4;

/// The sign of member `member` in class `class`: -1 where an odd direction is mirrored, else 1.
pub fn sign(class: usize, member: usize) -> f64 {
    if (class & member).count_ones() % 2 == 1 { -1.0 } else { 1.0 }
}

/// The quads of a grid: each taxel of the quarter next to the origin with its mirror images.
///
/// Quad `q = qy * hx + qx` with `hx = ceil(columns / 2)` and `hy = ceil(rows / 2)`. Its member `s = sx + 2 * sy` is the
/// taxel in column `qx`, mirrored if `sx` is 1, and row `qy`, mirrored if `sy` is 1. On a centre line members coincide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quads {
    columns: usize,
    rows: usize,
}

impl Quads {
    /// The quads of a grid of `columns` by `rows` taxels, each at least 1.
    pub fn new(columns: usize, rows: usize) -> Self {
        Self { columns, rows }
    }

    /// Quads along x, hx.
    pub fn columns(&self) -> usize {
        self.columns.div_ceil(2)
    }

    /// Quads along y, hy.
    pub fn rows(&self) -> usize {
        self.rows.div_ceil(2)
    }

    /// Number of quads, n = hx hy.
    pub fn count(&self) -> usize {
        self.columns() * self.rows()
    }

    /// Number of taxels, m.
    pub fn taxels(&self) -> usize {
        self.columns * self.rows
    }

    /// The taxels of quad `q` by member; one on a centre line is there twice, the centre of the grid four times.
    pub fn members(&self, q: usize) -> [usize; 4] {
        let (qx, qy) = (q % self.columns(), q / self.columns());
        [0, 1, 2, 3].map(|s| {
            let x = if s & 1 == 1 { self.columns - 1 - qx } else { qx };
            let y = if s & 2 == 2 { self.rows - 1 - qy } else { qy };
            y * self.columns + x
        })
    }

    /// The taxels of quad `q`, each once, as `(member, taxel)` with the smallest member that it is.
    pub fn distinct(&self, q: usize) -> impl Iterator<Item = (usize, usize)> {
        let members = self.members(q);
        (0..4).filter(move |&s| !members[..s].contains(&members[s])).map(move |s| (s, members[s]))
    }

    /// The taxels of every quad by member.
    pub fn all(&self) -> Vec<[usize; 4]> {
        (0..self.count()).map(|q| self.members(q)).collect()
    }

    /// Number of taxels of quad `q`: 4, on a centre line 2, at the centre of the grid 1.
    pub fn size(&self, q: usize) -> usize {
        self.distinct(q).count()
    }

    /// Whether vectors of `class` can be other than zero at quad `q`: an odd one is zero on its centre line.
    pub fn exists(&self, class: usize, q: usize) -> bool {
        let members = self.members(q);
        (0..4).all(|s| members[s] != members[0] || sign(class, s) > 0.0)
    }

    /// Folds a vector of m values: `fold[c][q]` is the sum over the four members s of `sign(c, s) * x[member s of q]`,
    /// taxels that are there twice counted twice.
    pub fn fold(&self, x: &[f64]) -> [Vec<f64>; CLASSES] {
        let mut folded: [Vec<f64>; CLASSES] = std::array::from_fn(|_| Vec::with_capacity(self.count()));
        self.fold_into(&mut folded, |taxel| x[taxel]);
        folded
    }

    /// As [`Quads::fold`], of the value that `x` has of a taxel, into memory that is there.
    pub(crate) fn fold_into(&self, folded: &mut [Vec<f64>; CLASSES], x: impl Fn(usize) -> f64) {
        folded.iter_mut().for_each(Vec::clear);
        for q in 0..self.count() {
            let values = butterfly(self.members(q).map(&x));
            folded.iter_mut().zip(values).for_each(|(class, value)| class.push(value));
        }
    }

    /// Undoes [`Quads::fold`]: `x[member s of q]` is a quarter of the sum over the classes c of
    /// `sign(c, s) * folded[c][q]`.
    pub fn unfold(&self, folded: &[Vec<f64>; CLASSES]) -> Vec<f64> {
        let mut x = vec![0.0; self.taxels()];
        self.unfold_into(folded, &mut x);
        x
    }

    /// As [`Quads::unfold`], into memory that is there.
    pub(crate) fn unfold_into(&self, folded: &[Vec<f64>; CLASSES], x: &mut [f64]) {
        for q in 0..self.count() {
            let values = butterfly(folded.each_ref().map(|class| class[q]));
            for (taxel, value) in self.members(q).into_iter().zip(values) {
                x[taxel] = 0.25 * value;
            }
        }
    }
}

/// `out[c]` is the sum over s of `sign(c, s) * x[s]`; on a centre line the differences are zero to the bit. Of one value
/// it is that: W is 4 or 1.
#[inline]
pub fn butterfly<T: Copy + Add<Output = T> + Sub<Output = T>, const W: usize>(mut x: [T; W]) -> [T; W] {
    // Known when it is compiled, and written out: this is in every loop over quads.
    if W == 4 {
        let (even, odd) = ([x[0] + x[1], x[2] + x[3]], [x[0] - x[1], x[2] - x[3]]);
        (x[0], x[1], x[2], x[3]) = (even[0] + even[1], odd[0] + odd[1], even[0] - even[1], odd[0] - odd[1]);
    }
    x
}
