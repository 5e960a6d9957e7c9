//! Frames that have a place in the hardware at once.

/// Frames that wait in the ingress FIFO.
pub const INGRESS_FRAMES: usize = 2;
/// Frames whose weights are kept for the output where the lanes put the field together.
pub const WEIGHT_PLACES: usize = 4;
/// Frames whose field has a place.
pub const FIELD_PLACES: usize = 2;

/// Frames that have a place from their start until they have left; none is needed where nothing of a frame stays.
pub fn places(field: bool, folded: bool) -> Option<usize> {
    field.then_some(if folded { WEIGHT_PLACES } else { FIELD_PLACES })
}
