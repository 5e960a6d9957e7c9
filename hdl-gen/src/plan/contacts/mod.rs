//! What hardware for several bodies needs of a design.

mod instructions;
pub mod records;
