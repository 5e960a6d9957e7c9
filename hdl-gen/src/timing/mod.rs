//! Latencies of the modules, and the cycle model: when which frame is where. Knows no plan, only durations.

pub mod buffers;
pub mod control;
pub mod durations;
pub mod latency;
mod timeline;

pub use timeline::{INTERVAL_FRAMES, Timeline, mean_interval};
