//! What a generated folder offers to other tools: Vivado scripts, file lists, `FuseSoC`, Bender, a CI workflow.
//!
//! Vivado itself is not here. Its scripts run in `tclsh` against a stand-in (`flows/vivado.tcl`) that knows the
//! commands, their flags and their files and refuses everything else; broken copies of the scripts show that it does.

#[path = "flows/block_design.rs"]
mod block_design;
#[path = "flows/broken.rs"]
mod broken;
#[path = "flows/control.rs"]
mod control;
#[path = "flows/folder.rs"]
mod folder;
#[path = "flows/fusesoc.rs"]
mod fusesoc;
#[path = "flows/lists.rs"]
mod lists;
#[path = "flows/scripts.rs"]
mod scripts;
#[path = "flows/simulation.rs"]
mod simulation;
#[path = "flows/workflow.rs"]
mod workflow;
