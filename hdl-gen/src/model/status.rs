//! Status bits, as golden has them, for words of 32 bits.

use golden::status::Status;

/// `sum |b|` below the noise floor.
pub const NO_CONTACT: u32 = Status::NO_CONTACT.0;
/// No tension or compression above the noise floor, or a line without sense.
pub const DIRECTION_UNKNOWN: u32 = Status::DIRECTION_UNKNOWN.0;
/// The minimum lies at an end of [-1, 1], or the dependent component was clipped.
pub const AT_BOUND: u32 = Status::AT_BOUND.0;
/// An input beyond the full scale, or a clipped intermediate.
pub const SATURATED: u32 = Status::SATURATED.0;
/// NaN or infinity.
pub const NOT_FINITE: u32 = Status::NOT_FINITE.0;
/// Early or late TLAST.
pub const BAD_LENGTH: u32 = Status::BAD_LENGTH.0;
/// The error is above the design's limit.
pub const LOW_CONFIDENCE: u32 = Status::LOW_CONFIDENCE.0;
/// More contacts than the one that is solved.
pub const SEVERAL_CONTACTS: u32 = Status::SEVERAL_CONTACTS.0;
/// A dead taxel was replaced.
pub const REPLACED: u32 = Status::REPLACED.0;
/// Too much of the stress is in replaced taxels.
pub const TOO_MANY_REPLACED: u32 = Status::TOO_MANY_REPLACED.0;
/// Friction at the design's limit.
pub const SLIP: u32 = Status::SLIP.0;
/// Nothing pulls, where the design says that tension is read and the friction that something should.
pub const NO_TENSION: u32 = Status::NO_TENSION.0;
/// Frames were dropped before this one: no frame's own matter, and in no answer of the model.
pub const DROPPED: u32 = Status::DROPPED.0;
