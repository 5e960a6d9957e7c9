//! The systems for boards, in the stub.

use std::fs;
use std::path::Path;

use hdl_gen::emit::boards::Board;
use hdl_gen::emit::{Options, emit_for};
use hdl_gen::plan::Plan;

use super::folder::{Folder, files, workspace};
use crate::support::shipped;

const SCRIPT: &str = "vivado/block_design.tcl";

#[test]
fn the_system_is_complete_and_uses_the_newest_parts() {
    let ran = Folder::small().vivado(SCRIPT, &[], &[]).succeeded();
    assert!(ran.call("set_property board_part").contains("zcu102:part0:3.10"), "3.10 is newer than 3.4");
    assert!(ran.calls.iter().any(|call| call.contains("-vlnv xilinx.com:ip:zynq_ultra_ps_e:3.5")));
    assert!(ran.calls.iter().any(|call| call.contains("-vlnv user.org:tactile:small_4x3:")));
    for connection in ["dma/M_AXIS_MM2S core/s_axis", "core/m_axis dma/S_AXIS_S2MM"] {
        ran.call(&format!("connect_bd_intf_net {connection}"));
    }
    ran.call("connect_bd_net -net interrupt_out dma/s2mm_introut ps/pl_ps_irq1");
    assert!(ran.stdout.contains("core/aclk: 124.998749 MHz, in the design: 125.0 MHz\n"), "{}", ran.stdout);
    assert!(ran.stdout.contains("SEG_dma_S_AXI_LITE: offset 0xA0000000, range 64K"), "{}", ran.stdout);
    assert!(ran.stdout.contains("interrupt ps/pl_ps_irq0[0]: dma/mm2s_introut\n"), "{}", ran.stdout);
    assert!(ran.stdout.contains("interrupt ps/pl_ps_irq1[0]: dma/s2mm_introut\n"), "{}", ran.stdout);
    assert!(!ran.calls.iter().any(|call| call.starts_with("launch_runs")));
}

#[test]
fn no_version_is_pinned() {
    let folder = Folder::small();
    let script = folder.read(SCRIPT);
    let pinned = script.lines().find(|line| {
        let after = line.split("xilinx.com:ip:").nth(1).or_else(|| line.split("part0:").nth(1));
        after.is_some_and(|name| name.split(':').nth(1).is_some_and(|version| version.starts_with(char::is_numeric)))
    });
    assert_eq!(pinned, None);
}

#[test]
fn a_bitstream_is_made_on_request_and_must_meet_timing() {
    let folder = Folder::small();
    let ran = folder.vivado(SCRIPT, &["bitstream"], &[]).succeeded();
    assert!(ran.call("write_hw_platform").contains("-include_bit"));
    assert!(folder.work().join("small_4x3_zcu102.xsa").exists());
    assert!(ran.call("launch_runs").contains("-jobs 4"));
    for beside in ["bit", "hwh"] {
        assert!(folder.work().join(format!("small_4x3_zcu102.{beside}")).exists(), "{beside}");
    }
    let ran = folder.vivado(SCRIPT, &["jobs=2", "bitstream"], &[]).succeeded();
    assert!(ran.call("launch_runs").contains("-jobs 2"));
    let slow = folder.vivado(SCRIPT, &["bitstream"], &[("STANDIN_SLACK", "-1.5")]);
    slow.refused("timing is not met: WNS -1.5 ns");
}

#[test]
fn what_is_not_installed_is_named() {
    let folder = Folder::small();
    let without = |pattern| folder.vivado(SCRIPT, &[], &[("STANDIN_WITHOUT", pattern)]);
    without("*:zcu102:*").refused("no board files for the ZCU102");
    without("*:axi_dma:*").refused("no IP axi_dma");
}

#[test]
fn a_design_for_another_device_is_refused() {
    let folder = Folder::new(&files(Some("xczu7ev-ffvc1156-2-e")));
    let ran = folder.vivado(SCRIPT, &["zcu102"], &[]);
    ran.refused("the ZCU102 has a xczu9eg-ffvb1156-2-e, the design is for xczu7ev-ffvc1156-2-e");
    folder
        .vivado(SCRIPT, &["zcu666"], &[])
        .refused("no word zcu666: there are bitstream, queue, jobs=N, and the boards zcu102, ");
    let ran = Folder::new(&files(Some("xc7k70tfbg484-1"))).vivado(SCRIPT, &[], &[]);
    ran.refused("no board here has a xc7k70tfbg484-1: name one of zcu102, zcu104, kv260, pynq-z2");
}

/// A DMA with descriptors reaches memory for them too, and offers no streams that nobody takes.
#[test]
fn a_queue_has_descriptors() {
    let folder = Folder::small();
    let ran = folder.vivado(SCRIPT, &["queue"], &[]).succeeded();
    ran.call("connect_bd_intf_net dma/M_AXI_SG memory/S02_AXI");
    assert!(ran.call("connect_bd_net -net clock").ends_with("core/aclk dma/m_axi_sg_aclk"));
    assert!(!folder.vivado(SCRIPT, &[], &[]).succeeded().calls.iter().any(|call| call.contains("M_AXI_SG")));
    for (right, wrong, message) in [
        (
            "CONFIG.c_sg_include_stscntrl_strm 0",
            "CONFIG.c_sg_include_stscntrl_strm 1",
            "dma/M_AXIS_CNTRL is not connected",
        ),
        ("{2 + $queue}", "2", "no pin memory/S02_AXI"),
        ("core/aclk {*}$descriptors", "core/aclk", "dma/m_axi_sg_aclk is not connected"),
    ] {
        let folder = Folder::small();
        let text = folder.read(SCRIPT);
        assert_eq!(text.matches(right).count(), 1, "{right}");
        fs::write(folder.design().join(SCRIPT), text.replace(right, wrong)).expect("written");
        folder.vivado(SCRIPT, &["queue"], &[]).refused(message);
    }
}

/// Each board's own processor, with all of its ports connected; the board is that of the design's device.
#[test]
fn every_board_has_a_system() {
    for (board, part, processor, interrupts) in [
        ("zcu104", "xczu7ev-ffvc1156-2-e", "zynq_ultra_ps_e", "ps/pl_ps_irq1"),
        ("kv260", "xck26-sfvc784-2LV-c", "zynq_ultra_ps_e", "ps/pl_ps_irq1"),
        ("pynq-z2", "xc7z020clg400-1", "processing_system7", "interrupt_concat/dout ps/IRQ_F2P"),
    ] {
        let folder = Folder::new(&files(Some(part)));
        let ran = folder.vivado(SCRIPT, &["bitstream"], &[]).succeeded();
        assert!(ran.call("set_property board_part").contains(&board.replace("kv260", "kv260_som")), "{board}");
        assert!(ran.calls.iter().any(|call| call.contains(&format!("-vlnv xilinx.com:ip:{processor}:"))), "{board}");
        assert!(
            ran.calls.iter().any(|call| call.starts_with("connect_bd_net") && call.ends_with(interrupts)),
            "{board}"
        );
        assert!(folder.work().join(format!("small_4x3_{board}.hwh")).exists());
        // A module is on a carrier.
        let carried = ran.calls.iter().any(|call| call.starts_with("set_property board_connections"));
        assert_eq!(carried, board == "kv260");
    }
}

/// A user's own board is that of the design's device, before one that is here.
#[test]
fn a_board_of_ones_own_has_a_system() {
    let text = fs::read_to_string(workspace().join("hdl-gen/boards/zcu102.toml")).expect("is there");
    let own = text.replace("0xA0000000", "0xA0040000").replace("*:zcu102:*", "acme.org:carrier:*");
    let board = Board::from_toml(&own, Path::new("my-carrier.toml")).expect("is one");
    let plan = Plan::new(&shipped("small")).expect("can be planned");
    let folder =
        Folder::new(&emit_for(&plan, &Options { boards: vec![board], ..Options::default() }).expect("is printed"));
    let ran = folder.vivado(SCRIPT, &["bitstream"], &[]).succeeded();
    assert!(ran.call("set_property board_part").contains("acme.org:carrier:part0:1.0"));
    assert!(ran.stdout.contains("SEG_dma_S_AXI_LITE: offset 0xA0040000, range 64K"), "{}", ran.stdout);
    assert!(folder.work().join("small_4x3_my-carrier.hwh").exists());
    let ran = folder.vivado(SCRIPT, &["zcu102"], &[]).succeeded();
    assert!(ran.call("set_property board_part").contains("zcu102:part0:3.10"));
}
