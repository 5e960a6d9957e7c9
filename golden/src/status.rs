//! The status word of a frame.

use std::fmt;

/// A set of status bits; the same bits as in the first word of the hardware's output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Status(pub u32);

impl Status {
    /// The stresses add up to less than the noise floor: all results are zero.
    pub const NO_CONTACT: Self = Self(1 << 0);
    /// Nothing tells the direction of push: the friction components are zero.
    pub const DIRECTION_UNKNOWN: Self = Self(1 << 1);
    /// A friction component is at the end of its range.
    pub const AT_BOUND: Self = Self(1 << 2);
    /// A stress was at full scale, where no sensor tells it from a clipped one, or beyond and was clamped.
    pub const SATURATED: Self = Self(1 << 3);
    /// A NaN or an infinity in the frame: all results are zero.
    pub const NOT_FINITE: Self = Self(1 << 4);
    /// Too few or too many values in the frame (hardware only): all results are zero.
    pub const BAD_LENGTH: Self = Self(1 << 5);
    /// A dead taxel's reading was replaced by what its neighbours say.
    pub const REPLACED: Self = Self(1 << 8);
    /// More than an eighth of the stress is in replaced taxels: see [`crate::dead_taxels::GUESSED`].
    pub const TOO_MANY_REPLACED: Self = Self(1 << 9);

    /// The tangential force may be far off: its standard error is above the design's limit, or the layer is too thin for the
    /// taxels ([`crate::design::Design::thin_layer`]), which is so of every frame of a design.
    pub const LOW_CONFIDENCE: Self = Self(1 << 6);
    /// More than one contact, where contacts are counted.
    pub const SEVERAL_CONTACTS: Self = Self(1 << 7);
    /// Friction is at the design's limit: what is held begins to slide.
    pub const SLIP: Self = Self(1 << 10);
    /// Nothing pulls in a frame of a sensor that reads tension, as its design says, though friction of
    /// [`crate::solver::PULLING`] was found, or none could be.
    pub const NO_TENSION: Self = Self(1 << 11);
    /// Frames were dropped before this one (hardware only).
    pub const DROPPED: Self = Self(1 << 12);

    /// All bits with the words that describe them, from bit 0 on. Not every design raises all of them.
    pub const NAMED: [(Self, &'static str); 13] = [
        (Self::NO_CONTACT, "no contact"),
        (Self::DIRECTION_UNKNOWN, "direction unknown"),
        (Self::AT_BOUND, "optimum at the bound"),
        (Self::SATURATED, "saturated"),
        (Self::NOT_FINITE, "NaN or infinity"),
        (Self::BAD_LENGTH, "wrong frame length"),
        (Self::LOW_CONFIDENCE, "low confidence"),
        (Self::SEVERAL_CONTACTS, "more than one contact"),
        (Self::REPLACED, "dead taxel replaced"),
        (Self::TOO_MANY_REPLACED, "too many replaced"),
        (Self::SLIP, "slip"),
        (Self::NO_TENSION, "no tension"),
        (Self::DROPPED, "frames dropped before"),
    ];

    /// True if every bit of `other` is set.
    pub fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Clears the bits of `other`.
    pub fn remove(&mut self, other: Self) {
        self.0 &= !other.0;
    }

    /// Sets the bits of `other`.
    pub fn insert(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl fmt::Display for Status {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<&str> =
            Self::NAMED.into_iter().filter(|(bit, _)| self.contains(*bit)).map(|(_, word)| word).collect();
        formatter.write_str(&if words.is_empty() { "good".to_owned() } else { words.join(", ") })
    }
}
