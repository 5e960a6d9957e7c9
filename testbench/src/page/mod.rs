//! stub
use golden::design::Design;
use crate::sweep::point::Point;
use crate::sweep::{Sweep, SweepError};
/// x
pub struct Contents;
impl Contents {
    /// x
    pub fn new(_d: &[Design], _s: &Sweep, _p: &[Point]) -> Result<Self, SweepError> { Ok(Self) }
}
/// x
pub fn render(_c: &Contents) -> Result<String, SweepError> { Ok(String::new()) }
