//! Parity fold: vectors of one value a taxel as four quarter-size vectors, and matrices as four quarter-size blocks.
//!
//! The grid of taxels is its own mirror image in x and in y. A taxel and its *images* form an *orbit*. A vector is the
//! sum of four that are each even or odd in x and in y, its *parity components*. Each has one value for an orbit. C33
//! keeps the component of what it multiplies, C31 changes it from even to odd in x and back, C32 in y; so do their
//! inverses and products. A matrix of m by m entries is then four blocks of about m/4 by m/4, without any error.
//!
//! The fold has no factors in it, so that hardware folds with additions alone: even and odd sums of the four mirror
//! images, and a quarter of the same sums back.

mod folded;

use std::ops::{Add, Sub};

pub use folded::FoldedMatrix;

/// Number of parity components, and of images of an orbit. Component `c = odd_x + 2 * odd_y`, image `s = sx + 2 * sy`.
pub const COMPONENTS: usize = 4;

/// The sign of an image in a component: -1 where an odd direction is mirrored, else 1.
pub fn sign(component: usize, image: usize) -> f64 {
    if (component & image).count_ones() % 2 == 1 { -1.0 } else { 1.0 }
}

/// The orbits of a grid: each taxel of the quarter next to the origin with its mirror images.
///
/// Orbit `q = qy * hx + qx` with `hx = ceil(columns / 2)` and `hy = ceil(rows / 2)`. Its image `s = sx + 2 * sy` is the
/// taxel in column `qx`, mirrored if `sx` is 1, and row `qy`, mirrored if `sy` is 1. On a centre line images coincide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orbits {
    columns: usize,
    rows: usize,
}

impl Orbits {
    /// The orbits of a grid of `columns` by `rows` taxels, each at least 1.
    pub fn new(columns: usize, rows: usize) -> Self {
        Self { columns, rows }
    }

    /// Orbits along x, hx.
    pub fn columns(&self) -> usize {
        self.columns.div_ceil(2)
    }

    /// Orbits along y, hy.
    pub fn rows(&self) -> usize {
        self.rows.div_ceil(2)
    }

    /// Number of orbits, n = hx hy.
    pub fn count(&self) -> usize {
        self.columns() * self.rows()
    }

    /// Number of taxels, m.
    pub fn taxels(&self) -> usize {
        self.columns * self.rows
    }

    /// The taxels of orbit `q` by image; one on a centre line is there twice, the centre of the grid four times.
    pub fn images(&self, q: usize) -> [usize; 4] {
        let (qx, qy) = (q % self.columns(), q / self.columns());
        [0, 1, 2, 3].map(|s| {
            let x = if s & 1 == 1 { self.columns - 1 - qx } else { qx };
            let y = if s & 2 == 2 { self.rows - 1 - qy } else { qy };
            y * self.columns + x
        })
    }

    /// The taxels of orbit `q`, each once, as `(image, taxel)` with the smallest image that it is.
    pub fn distinct(&self, q: usize) -> impl Iterator<Item = (usize, usize)> {
        let images = self.images(q);
        (0..4).filter(move |&s| !images[..s].contains(&images[s])).map(move |s| (s, images[s]))
    }

    /// The taxels of every orbit by image.
    pub fn all(&self) -> Vec<[usize; 4]> {
        (0..self.count()).map(|q| self.images(q)).collect()
    }

    /// Number of taxels of orbit `q`: 4, on a centre line 2, at the centre of the grid 1.
    pub fn size(&self, q: usize) -> usize {
        self.distinct(q).count()
    }

    /// Whether vectors of `component` can be other than zero at orbit `q`: an odd one is zero on its centre line.
    pub fn exists(&self, component: usize, q: usize) -> bool {
        let images = self.images(q);
        (0..4).all(|s| images[s] != images[0] || sign(component, s) > 0.0)
    }

    /// Folds a vector of m values: `fold[c][q]` is the sum over the four images s of `sign(c, s) * x[image s of q]`,
    /// taxels that are there twice counted twice.
    pub fn fold(&self, x: &[f64]) -> [Vec<f64>; COMPONENTS] {
        let mut folded: [Vec<f64>; COMPONENTS] = std::array::from_fn(|_| Vec::with_capacity(self.count()));
        self.fold_into(&mut folded, |taxel| x[taxel]);
        folded
    }

    /// As [`Orbits::fold`], of the value that `x` has of a taxel, into memory that is there.
    pub(crate) fn fold_into(&self, folded: &mut [Vec<f64>; COMPONENTS], x: impl Fn(usize) -> f64) {
        folded.iter_mut().for_each(Vec::clear);
        for q in 0..self.count() {
            let values = butterfly(self.images(q).map(&x));
            folded.iter_mut().zip(values).for_each(|(component, value)| component.push(value));
        }
    }

    /// Undoes [`Orbits::fold`]: `x[image s of q]` is a quarter of the sum over the components c of
    /// `sign(c, s) * folded[c][q]`.
    pub fn unfold(&self, folded: &[Vec<f64>; COMPONENTS]) -> Vec<f64> {
        let mut x = vec![0.0; self.taxels()];
        self.unfold_into(folded, &mut x);
        x
    }

    /// As [`Orbits::unfold`], into memory that is there.
    pub(crate) fn unfold_into(&self, folded: &[Vec<f64>; COMPONENTS], x: &mut [f64]) {
        for q in 0..self.count() {
            let values = butterfly(folded.each_ref().map(|component| component[q]));
            for (taxel, value) in self.images(q).into_iter().zip(values) {
                x[taxel] = 0.25 * value;
            }
        }
    }
}

/// `out[c]` is the sum over s of `sign(c, s) * x[s]`; on a centre line the differences are zero to the bit. Of one value
/// it is that: W is 4 or 1.
#[inline]
pub fn butterfly<T: Copy + Add<Output = T> + Sub<Output = T>, const W: usize>(mut x: [T; W]) -> [T; W] {
    // Known when it is compiled, and written out: this is in every loop over orbits.
    if W == 4 {
        let (even, odd) = ([x[0] + x[1], x[2] + x[3]], [x[0] - x[1], x[2] - x[3]]);
        (x[0], x[1], x[2], x[3]) = (even[0] + even[1], odd[0] + odd[1], even[0] - even[1], odd[0] - odd[1]);
    }
    x
}

/// The orbit, or the taxel, on the other side of the diagonal of a square grid of `side` by `side`.
pub fn mirror(orbit: usize, side: usize) -> usize {
    orbit % side * side + orbit / side
}

/// The component that `component` is on the other side of the diagonal.
pub fn swapped(component: usize) -> usize {
    (component & 1) << 1 | component >> 1
}
