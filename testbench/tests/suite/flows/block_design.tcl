# SPDX-License-Identifier: MIT OR Apache-2.0
# Board parts, IP catalogue and block designs.

namespace eval stub {
    # What is installed: more than one version each, and not in order.
    variable boards {
        xilinx.com:zcu102:part0:3.10 xczu9eg-ffvb1156-2-e xilinx.com:zcu102:part0:3.4 xczu9eg-ffvb1156-2-e
        xilinx.com:zcu104:part0:1.1 xczu7ev-ffvc1156-2-e xilinx.com:kv260_som:part0:1.4 xck26-sfvc784-2LV-c
        tul.com.tw:pynq-z2:part0:1.0 xc7z020clg400-1 acme.org:carrier:part0:1.0 xczu9eg-ffvb1156-2-e
    }
    variable catalogue {
        xilinx.com:ip:zynq_ultra_ps_e:3.3 xilinx.com:ip:zynq_ultra_ps_e:3.5 xilinx.com:ip:axi_dma:7.1
        xilinx.com:ip:smartconnect:1.0 xilinx.com:ip:proc_sys_reset:5.0 xilinx.com:ip:xlconcat:2.1
        xilinx.com:ip:processing_system7:5.5
    }

    # Legal parameters and values, by IP.
    variable parameters
    array set parameters {
        zynq_ultra_ps_e {
            PSU__FPGA_PL0_ENABLE {[01]} PSU__CRL_APB__PL0_REF_CTRL__FREQMHZ {[0-9.]+}
            PSU__USE__M_AXI_GP0 {[01]} PSU__USE__M_AXI_GP1 {[01]} PSU__USE__M_AXI_GP2 {[01]}
            PSU__USE__S_AXI_GP2 {[01]} PSU__USE__IRQ0 {[01]} PSU__USE__IRQ1 {[01]}
        }
        processing_system7 {
            PCW_FPGA0_PERIPHERAL_FREQMHZ {[0-9.]+} PCW_USE_M_AXI_GP0 {[01]} PCW_USE_S_AXI_HP0 {[01]}
            PCW_USE_FABRIC_INTERRUPT {[01]} PCW_IRQ_F2P_INTR {[01]}
        }
        axi_dma {
            c_include_sg {[01]} c_sg_include_stscntrl_strm {[01]} c_include_mm2s {[01]} c_include_s2mm {[01]}
            c_include_mm2s_dre {[01]} c_include_s2mm_dre {[01]}
            c_m_axis_mm2s_tdata_width {8|16|32|64|128} c_m_axi_mm2s_data_width {32|64|128}
            c_m_axi_s2mm_data_width {32|64|128}
            c_sg_length_width {[89]|1[0-9]|2[0-6]} c_addr_width {3[2-9]|[45][0-9]|6[0-4]}
        }
        smartconnect {NUM_SI {[1-9]|1[0-6]} NUM_MI {[1-9]|1[0-6]} NUM_CLKS {[1-4]}}
        proc_sys_reset {}
        xlconcat {NUM_PORTS {[1-9]|[12][0-9]|3[0-2]}}
        core {ROM_DIR {.*}}
    }

    # Pins whose presence no parameter decides: name, direction and kind.
    variable fixed_pins
    array set fixed_pins {
        zynq_ultra_ps_e {pl_clk0 out clock pl_resetn0 out reset}
        processing_system7 {FCLK_CLK0 out clock FCLK_RESET0_N out reset}
        axi_dma {
            s_axi_lite_aclk in clock m_axi_mm2s_aclk in clock m_axi_s2mm_aclk in clock axi_resetn in reset
            mm2s_introut out interrupt s2mm_introut out interrupt
        }
        smartconnect {aclk in clock aresetn in reset}
        proc_sys_reset {
            slowest_sync_clk in clock ext_reset_in in reset peripheral_aresetn out reset interconnect_aresetn out reset
        }
        xlconcat {dout out interrupt}
        core {aclk in clock aresetn in reset}
    }

    # Pins and interfaces that a parameter switches: parameter, its default, name, side, kind.
    variable switched
    array set switched {
        zynq_ultra_ps_e {
            PSU__USE__M_AXI_GP0 1 maxihpm0_fpd_aclk in clock PSU__USE__M_AXI_GP0 1 M_AXI_HPM0_FPD master aximm
            PSU__USE__M_AXI_GP1 1 maxihpm1_fpd_aclk in clock PSU__USE__M_AXI_GP1 1 M_AXI_HPM1_FPD master aximm
            PSU__USE__M_AXI_GP2 0 maxihpm0_lpd_aclk in clock PSU__USE__M_AXI_GP2 0 M_AXI_HPM0_LPD master aximm
            PSU__USE__S_AXI_GP2 0 saxihp0_fpd_aclk in clock PSU__USE__S_AXI_GP2 0 S_AXI_HP0_FPD slave aximm
            PSU__USE__IRQ0 1 pl_ps_irq0 in interrupt PSU__USE__IRQ1 0 pl_ps_irq1 in interrupt
        }
        processing_system7 {
            PCW_USE_M_AXI_GP0 1 M_AXI_GP0_ACLK in clock PCW_USE_M_AXI_GP0 1 M_AXI_GP0 master aximm
            PCW_USE_S_AXI_HP0 0 S_AXI_HP0_ACLK in clock PCW_USE_S_AXI_HP0 0 S_AXI_HP0 slave aximm
            PCW_IRQ_F2P_INTR 0 IRQ_F2P in interrupt
        }
        axi_dma {
            c_include_sg 1 M_AXI_SG master aximm c_include_sg 1 m_axi_sg_aclk in clock
            c_include_mm2s 1 M_AXI_MM2S master aximm c_include_mm2s 1 M_AXIS_MM2S master axis
            c_include_s2mm 1 M_AXI_S2MM master aximm c_include_s2mm 1 S_AXIS_S2MM slave axis
        }
        smartconnect {}
        proc_sys_reset {}
        xlconcat {}
        core {}
    }

    variable cells
    array set cells {}
    # Net of each connected pin and interface, driver of each net.
    variable nets
    array set nets {}
    variable drivers
    array set drivers {}
    # Offset of each segment of registers that has one.
    variable placed
    array set placed {}

    proc installed {names} {
        set without [setting STANDIN_WITHOUT {}]
        set found {}
        foreach name $names {
            if {![string match $without $name]} {
                lappend found $name
            }
        }
        return $found
    }

    proc value {cell parameter default} {
        variable properties
        set key cell:$cell,CONFIG.$parameter
        return [expr {[info exists properties($key)] ? $properties($key) : $default}]
    }

    # Called for each parameter that is set on a cell.
    proc configure {object name value} {
        variable parameters
        variable cells
        set kind $cells([string range $object 5 end])
        array set legal $parameters($kind)
        if {![regexp {^CONFIG\.(\w+)$} $name -> parameter] || ![info exists legal($parameter)]} {
            error "$kind has no parameter $name"
        }
        if {![regexp "^(?:$legal($parameter))\$" $value]} {
            error "$kind: $name cannot be $value"
        }
    }

    # Name, side and kind of all pins and interfaces of a cell as configured.
    proc pins {cell} {
        variable cells
        variable fixed_pins
        variable switched
        set kind $cells($cell)
        set pins $fixed_pins($kind)
        foreach {parameter default name side type} $switched($kind) {
            if {[value $cell $parameter $default]} {
                lappend pins $name $side $type
            }
        }
        switch $kind {
            axi_dma {
                lappend pins S_AXI_LITE slave aximm
                if {[value $cell c_include_sg 1] && [value $cell c_sg_include_stscntrl_strm 1]} {
                    lappend pins M_AXIS_CNTRL master axis S_AXIS_STS slave axis
                }
            }
            core {
                # As packaged.
                lappend pins s_axis slave axis m_axis master axis
                foreach {interface side type} {s_axi_ctrl slave aximm interrupt out interrupt} {
                    if {[info exists ::stub::interfaces($interface)]} {
                        lappend pins $interface $side $type
                    }
                }
            }
            xlconcat {
                for {set index 0} {$index < [value $cell NUM_PORTS 2]} {incr index} {
                    lappend pins In$index in interrupt
                }
            }
            smartconnect {
                foreach {prefix count side} [list S [value $cell NUM_SI 2] slave M [value $cell NUM_MI 1] master] {
                    for {set index 0} {$index < $count} {incr index} {
                        lappend pins [format %s%02d_AXI $prefix $index] $side aximm
                    }
                }
            }
        }
        return $pins
    }

    # Side and kind of CELL/PIN.
    proc pin {path} {
        variable cells
        foreach {cell wanted} [split $path /] {}
        if {![info exists cells($cell)]} {
            error "no cell $cell"
        }
        foreach {name side kind} [pins $cell] {
            if {$name eq $wanted} {
                return [list $side $kind]
            }
        }
        error "no pin $path"
    }

    proc attach {path net} {
        variable nets
        if {[info exists nets($path)]} {
            error "$path is connected already"
        }
        set nets($path) $net
    }
}

stub::command get_board_parts {} 1 1 {
    set found {}
    foreach board [stub::installed [dict keys $::stub::boards]] {
        if {[string match [lindex $words 0] $board]} {
            lappend found $board
            set ::stub::properties($board,PART_NAME) [dict get $::stub::boards $board]
        }
    }
    return $found
}
stub::command get_ipdefs {-all -filter=} 0 1 {
    if {![regexp {^VLNV =~ (\S+)$} $option(-filter) -> pattern]} {
        error "get_ipdefs: filter $option(-filter)"
    }
    return [lsearch -all -inline -glob [stub::installed $::stub::catalogue] $pattern]
}
stub::command update_ip_catalog {-rebuild -scan_changes} 0 0 {
    foreach folder [get_property ip_repo_paths [current_project]] {
        lappend ::stub::catalogue [string trim [stub::text [file join $folder component.xml]]]
    }
}

stub::command create_bd_design {} 1 1 {
    set ::stub::diagram [lindex $words 0]
    get_property board_part [current_project]
}
stub::command create_bd_cell {-type= -vlnv=} 1 1 {
    stub::choice "type" $option(-type) {ip module hier}
    stub::choice "IP" $option(-vlnv) $::stub::catalogue
    foreach {vendor library name version} [split $option(-vlnv) :] {}
    set cell [lindex $words 0]
    if {[info exists ::stub::cells($cell)]} {
        error "there is a cell $cell already"
    }
    set ::stub::cells($cell) [expr {$vendor eq "xilinx.com" ? $name : "core"}]
    return cell:$cell
}
stub::command apply_bd_automation {-rule= -config=} 1 1 {
    set kind $::stub::cells([string range [lindex $words 0] 5 end])
    stub::choice "rule" $option(-rule) xilinx.com:bd_rule:$kind
    array set legal {zynq_ultra_ps_e apply_board_preset processing_system7 {make_external apply_board_preset Master Slave}}
    foreach {name value} $option(-config) {
        stub::choice "setting" $name $legal($kind)
    }
}
stub::command get_bd_pins {} 1 1 {
    stub::choice "kind of pin" [lindex [stub::pin [lindex $words 0]] 1] {clock reset interrupt}
    return [lindex $words 0]
}
stub::command get_bd_intf_pins {} 1 1 {
    stub::choice "kind of interface" [lindex [stub::pin [lindex $words 0]] 1] {aximm axis}
    return [lindex $words 0]
}
stub::command connect_bd_net {-net=} 2 inf {
    set net $option(-net)
    foreach path $words {
        foreach {side kind} [stub::pin $path] {}
        stub::attach $path $net
        if {$side eq "out"} {
            if {[info exists ::stub::drivers($net)]} {
                error "net $net has two drivers"
            }
            set ::stub::drivers($net) $kind
        }
    }
    foreach path $words {
        if {![info exists ::stub::drivers($net)]} {
            error "net $net has no driver"
        }
        stub::choice "driver of $path" $::stub::drivers($net) [lindex [stub::pin $path] 1]
    }
}
stub::command connect_bd_intf_net {} 2 2 {
    foreach {from to} $words {}
    foreach {from_side from_kind} [stub::pin $from] {}
    foreach {to_side to_kind} [stub::pin $to] {}
    if {"$from_side $to_side" ni {"master slave" "slave master"} || $from_kind ne $to_kind} {
        error "$from ($from_side $from_kind) does not fit $to ($to_side $to_kind)"
    }
    stub::attach $from $from-$to
    stub::attach $to $from-$to
}
# With an offset a segment of registers goes where it is said, without words the rest goes where there is room.
stub::command assign_bd_address {-target_address_space= -offset= -range=} 0 1 {
    if {[llength $words] == 0} {
        stub::done assign_bd_address
        return
    }
    stub::choice "address space" $option(-target_address_space) space:ps/Data
    if {![regexp {^0x[0-9A-F]{8}$} $option(-offset)] || $option(-offset) % 0x1000 != 0} {
        error "offset $option(-offset) is none of a page"
    }
    stub::choice "range" $option(-range) {4K 64K}
    set segment [lindex $words 0]
    foreach {other offset} [array get ::stub::placed] {
        if {$offset == $option(-offset)} {
            error "$segment and $other would both be at $offset"
        }
    }
    set ::stub::placed($segment) $option(-offset)
    set ::stub::properties($segment,OFFSET) $option(-offset)
    set ::stub::properties($segment,RANGE) $option(-range)
}
stub::command validate_bd_design {} 0 0 {
    stub::need assign_bd_address
    foreach cell [lsort [array names ::stub::cells]] {
        foreach {name side kind} [stub::pins $cell] {
            if {$side in {in master slave} && ![info exists ::stub::nets($cell/$name)]} {
                error "$cell/$name is not connected"
            }
            # Propagated from the processor, which divides 33.333 MHz times whole numbers.
            if {$kind eq "clock"} {
                set ::stub::properties($cell/$name,CONFIG.FREQ_HZ) 124998749
            }
        }
    }
    stub::done validate_bd_design
}
stub::command save_bd_design {} 0 0 {
    stub::need validate_bd_design
    stub::done save_bd_design
}
stub::command get_files {} 1 1 {
    foreach path $::stub::constraints {
        if {[file tail $path] eq [lindex $words 0]} {
            return [list xdc:$path]
        }
    }
    if {[file extension [lindex $words 0]] eq ".xdc"} {
        error "the project has no file [lindex $words 0]"
    }
    stub::need save_bd_design
    stub::choice "file" [lindex $words 0] $::stub::diagram.bd
    return [lindex $words 0]
}
stub::command make_wrapper {-files= -top} 0 0 {
    stub::need save_bd_design
    set path [file join [pwd] ${::stub::diagram}_wrapper.v]
    stub::write $path "\nmodule ${::stub::diagram}_wrapper (\n);\nendmodule\n"
    return $path
}
stub::command get_bd_addr_spaces {} 1 1 {
    stub::choice "address space" [lindex $words 0] {ps/Data dma/Data_MM2S dma/Data_S2MM}
    return space:[lindex $words 0]
}
# Of a slave's registers, or of what an address space sees.
stub::command get_bd_addr_segs {-of_objects=} 0 1 {
    if {[llength $words] == 1} {
        if {![regexp {^(.*)/\*$} [lindex $words 0] -> interface]} {
            error "use a pattern INTERFACE/*, not [lindex $words 0]"
        }
        stub::choice "kind of slave" [stub::pin $interface] {{slave aximm}}
        return /ps/Data/SEG_[string map {/ _} $interface]
    }
    stub::need assign_bd_address
    stub::choice "address space" $option(-of_objects) space:ps/Data
    return [lsort [array names ::stub::placed]]
}
