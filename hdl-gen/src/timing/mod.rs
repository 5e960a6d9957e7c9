//! Latencies of the modules, and the cycle model: when which frame is where. Knows no plan, only durations.

pub mod control;
pub mod durations;
pub mod latency;
pub mod places;
mod timeline;

pub use timeline::{INTERVAL_FRAMES, Timeline, mean_interval};
