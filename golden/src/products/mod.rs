//! The sparse products of a frame as a list, the passes that make one list of another, and the one interpreter of all.
//!
//! A list begins as the paper writes it ([`ProductList::paper`]). Passes keep what it computes: fewer products
//! ([`ProductList::fewer_products`]), the parity fold ([`ProductList::folded`]), the diagonal mirror
//! ([`ProductList::mirrored`]). [`Frame::step`] executes the steps of a list in any [`Arithmetic`]: here in f64 and f32, frame by frame
//! or many at a time; a generator of hardware brings integers.

pub(crate) mod batch;
mod interpreter;
mod list;
mod real;
mod scalar;
mod step;
mod stored;

pub use crate::sums::{ByPq, RESULTANTS};
pub use interpreter::{Arithmetic, Frame};
pub use list::{Form, ProductList, Source};
pub use real::{Engine, Real, RealFrame};
pub use scalar::{Number, Scalar, put_moments};
pub use step::{Coefficients, Epilogue, Step, Vector};
pub use stored::{PaperMatrices, Stored};
