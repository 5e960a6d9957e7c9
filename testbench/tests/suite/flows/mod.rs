//! What a generated folder offers to other tools: Vivado scripts, file lists, `FuseSoC`, Bender, a CI workflow.
//!
//! Vivado itself is not here. Its scripts run in `tclsh` against a stub (`flows/vivado.tcl`) that knows the
//! commands, their flags and their files and refuses everything else; broken copies of the scripts show that it does.

mod block_design;
mod broken;
mod cocotb;
mod control;
mod folder;
mod fusesoc;
mod ila;
mod linux;
mod lists;
mod power;
mod scripts;
mod simulation;
mod two_cores;
mod workflow;
