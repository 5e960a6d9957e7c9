//! Frames that have a buffer in the hardware at once.

/// Frames that wait in the ingress FIFO.
pub const INGRESS_FRAMES: usize = 2;
/// Frames whose weights are kept for the output where the lanes put the field together.
pub const WEIGHT_BUFFERS: usize = 4;
/// Frames whose field has a buffer.
pub const FIELD_BUFFERS: usize = 2;

/// Frames that have a buffer from their start until they have left; none is needed where nothing of a frame stays.
pub fn buffers(field: bool, folded: bool) -> Option<usize> {
    field.then_some(if folded { WEIGHT_BUFFERS } else { FIELD_BUFFERS })
}
