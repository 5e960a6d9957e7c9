//! How much is tried. `make test` is for every change, and of many things of one kind that each take seconds, such as broken
//! copies and designs at random, it tries some; `make test-long` tries all of them.

use std::env;
use std::sync::LazyLock;

/// The variable by which `make test-long` asks for all.
pub const ALL: &str = "SPTFRA_TEST_ALL";
/// Otherwise one of so many.
const SHARE: usize = 8;

static IS_ALL: LazyLock<bool> = LazyLock::new(|| env::var_os(ALL).is_some_and(|value| value != "0"));

/// Whether this is `make test-long`.
pub fn all() -> bool {
    *IS_ALL
}

/// All of them, or every eighth from the first on.
pub fn some_of<T>(things: impl IntoIterator<Item = T>) -> Vec<T> {
    things.into_iter().step_by(if all() { 1 } else { SHARE }).collect()
}

/// All of them, or every second from the first on: of designs that have their parts from one another, in another company. What
/// stands at an odd place is met elsewhere or at night, so put at an even one what is nowhere else; seeds that choose a mode
/// by their remainder go in such an order that each half has several.
pub fn half_of<T>(things: impl IntoIterator<Item = T>) -> Vec<T> {
    things.into_iter().step_by(if all() { 1 } else { 2 }).collect()
}

/// So many, or an eighth of that.
pub fn share_of(count: usize) -> usize {
    if all() { count } else { count.div_ceil(SHARE) }
}
