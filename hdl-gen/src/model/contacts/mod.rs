//! Several bodies, in integers and in what their hardware makes of float32: each module's results, bit for bit.

pub mod regions;
