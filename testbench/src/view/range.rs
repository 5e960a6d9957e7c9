//! Which frames to look at.

use std::ops::RangeInclusive;
use std::str::FromStr;

/// One frame, some in a row, or all: `4`, `4-9`, `all`. The first is 0, both ends are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameRange {
    /// From one frame to another.
    Some(usize, usize),
    /// Whatever there is.
    All,
}

/// What to write where a text is not a range.
const USAGE: &str = "write a frame as 4, some in a row as 4-9, or all; the first frame is 0";

impl FromStr for FrameRange {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, &'static str> {
        if text == "all" {
            return Ok(Self::All);
        }
        let number = |text: &str| text.parse().map_err(|_| USAGE);
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        let (first, last) = (number(first)?, number(last)?);
        if first <= last { Ok(Self::Some(first, last)) } else { Err(USAGE) }
    }
}

impl FrameRange {
    /// The frames that are meant of `count`, at least one; or the first of them that is not there.
    pub(super) fn within(self, count: usize) -> Result<RangeInclusive<usize>, usize> {
        let (first, last) = match self {
            Self::Some(first, last) => (first, last),
            Self::All => (0, count.saturating_sub(1)),
        };
        if last < count { Ok(first..=last) } else { Err(first.max(count)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_meant() {
        let within = |text: &str, count| text.parse::<FrameRange>().map(|range| range.within(count));
        assert_eq!(within("4", 5), Ok(Ok(4..=4)));
        assert_eq!(within("0-3", 5), Ok(Ok(0..=3)));
        assert_eq!(within("all", 5), Ok(Ok(0..=4)));
        assert_eq!(within("4-7", 5), Ok(Err(5)), "the first that is not there");
        assert_eq!(within("9", 5), Ok(Err(9)));
        assert_eq!(within("all", 0), Ok(Err(0)));
        for wrong in ["", "-", "3-", "4-3", "4..9", "-1", "every"] {
            assert_eq!(within(wrong, 5), Err(USAGE), "{wrong}");
        }
    }
}
