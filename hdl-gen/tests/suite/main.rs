//! Tests of the generator through its public interface, one module a topic.

mod bad_input;
mod columns;
mod command;
mod counts;
mod emission;
mod energy;
mod expected;
mod folded_formats;
mod formats;
mod hostile;
mod inspect_command;
mod joint;
mod lanes;
mod model;
mod need;
mod new_command;
mod reduced;
mod roms;
mod savings;
mod scale;
mod schedule;
mod support;
