# SPDX-License-Identifier: MIT OR Apache-2.0
# The IP packager.

namespace eval stub {
    # Interfaces of the core being packaged: name to vlnv; clock and reset of each; where its files went.
    variable interfaces
    variable associated
    variable core_root
    # Registers and fields that were added, by the object that has them.
    variable registers
    variable page

    proc interface_names {} {
        variable interfaces
        return [lsort [array names interfaces]]
    }

    proc has_interface {name} {
        if {$name ni [interface_names]} {
            error "the core has no interface $name"
        }
    }

    # What Vivado recognises by the names of the ports.
    proc infer_all {ports} {
        variable interfaces
        foreach port $ports {
            if {[regexp {^(\w+_axis|axis)_tvalid$} $port -> name]} {
                set interfaces($name) xilinx.com:interface:axis_rtl:1.0
            } elseif {[regexp {^(\w+)_awvalid$} $port -> name]} {
                set interfaces($name) xilinx.com:interface:aximm_rtl:1.0
            } elseif {$port eq "interrupt"} {
                set interfaces(interrupt) xilinx.com:signal:interrupt_rtl:1.0
            } elseif {$port eq "aclk"} {
                set interfaces(aclk) xilinx.com:signal:clock_rtl:1.0
            } elseif {$port eq "aresetn"} {
                set interfaces(aresetn) xilinx.com:signal:reset_rtl:1.0
            }
        }
    }
}

stub::command ipx::package_project {
    -root_dir= -vendor= -library= -taxonomy= -import_files -force -set_current=
} 0 0 {
    foreach flag {-root_dir -vendor -library -taxonomy -import_files} {
        if {![info exists option($flag)]} {
            error "ipx::package_project: $flag is missing"
        }
    }
    set top $::stub::properties(fileset:sources_1,top)
    set source [stub::source_of $top $::stub::sources]
    set ::stub::core_ports [stub::ports $source]
    set ::stub::core_root $option(-root_dir)
    set ::stub::core_id [list $option(-vendor) $option(-library)]
    array unset ::stub::interfaces
    array unset ::stub::associated
    array unset ::stub::registers
    set ::stub::page ROM_DIR
    file mkdir [file join $option(-root_dir) src]
    # A constraint that goes into systems would define their clock anew.
    foreach path $::stub::constraints {
        if {![info exists ::stub::properties(xdc:$path,USED_IN)]
            || "out_of_context" ni $::stub::properties(xdc:$path,USED_IN)} {
            error "[file tail $path] is not for synthesis out of context only"
        }
    }
    foreach path [concat $::stub::sources $::stub::memories $::stub::constraints] {
        file copy -force $path [file join $option(-root_dir) src]
    }
    if {![info exists ::env(STANDIN_BLIND)]} {
        stub::infer_all $::stub::core_ports
    }
    stub::done ipx::package_project
}
stub::command ipx::current_core {} 0 0 {
    stub::need ipx::package_project
    return core:current
}
stub::command ipx::get_bus_interfaces {-of_objects=} 0 1 {
    stub::choice "core" $option(-of_objects) core:current
    set found {}
    foreach name [stub::interface_names] {
        if {[llength $words] == 0 || $name eq [lindex $words 0]} {
            lappend found interface:$name
        }
    }
    return $found
}
# Each AXI slave has one, of its own name.
stub::command ipx::get_memory_maps {-of_objects=} 1 1 {
    stub::choice "core" $option(-of_objects) core:current
    set name [lindex $words 0]
    if {[info exists ::stub::interfaces($name)] && [string match *:aximm_rtl:* $::stub::interfaces($name)]} {
        return map:$name
    }
    return {}
}
# A memory map that was inferred has a block, unless STANDIN_BLOCKLESS is set.
stub::command ipx::get_address_blocks {-of_objects=} 0 1 {
    stub::choice "memory map" $option(-of_objects) map:s_axi_ctrl
    return [expr {[info exists ::env(STANDIN_BLOCKLESS)] ? {} : "address_block:reg0"}]
}
stub::command ipx::add_address_block {} 2 2 {
    stub::choice "memory map" [lindex $words 1] map:s_axi_ctrl
    return address_block:[lindex $words 0]
}
stub::command ipx::add_register {} 2 2 {
    foreach {name block} $words {}
    stub::choice "address block" $block address_block:reg0
    if {[info exists ::stub::registers($name)]} {
        error "register $name is there already"
    }
    set ::stub::registers($name) {}
    return register:$name
}
stub::command ipx::add_field {} 2 2 {
    foreach {name register} $words {}
    set register [regsub {^register:} $register ""]
    if {$name in $::stub::registers($register)} {
        error "field $name of $register is there already"
    }
    lappend ::stub::registers($register) $name
    return field:$register.$name
}
# Registers of 32 bits at addresses of their own, fields that do not overlap.
proc stub::check_registers {} {
    variable registers
    set taken {}
    foreach register [lsort [array names registers]] {
        set offset [expr {[get_property address_offset register:$register] + 0}]
        if {$offset % 4 != 0 || $offset in $taken || [get_property size register:$register] != 32} {
            error "register $register: size or address is wrong"
        }
        lappend taken $offset
        set bits 0
        foreach name $registers($register) {
            set field field:$register.$name
            stub::choice "access of $field" [get_property access $field] {read-only write-only read-write}
            set mask [expr {((1 << [get_property bit_width $field]) - 1) << [get_property bit_offset $field]}]
            if {($mask & $bits) != 0 || $mask >= (1 << 32)} {
                error "$field overlaps another or leaves its register"
            }
            set bits [expr {$bits | $mask}]
        }
    }
}
stub::command ipx::infer_bus_interface {} 3 3 {
    foreach {ports vlnv core} $words {}
    stub::choice "core" $core core:current
    stub::choice "interface type" $vlnv {
        xilinx.com:interface:axis_rtl:1.0 xilinx.com:signal:clock_rtl:1.0 xilinx.com:signal:reset_rtl:1.0
    }
    foreach port $ports {
        if {$port ni $::stub::core_ports} {
            error "the core has no port $port"
        }
    }
    set ::stub::interfaces([regsub {_t[a-z]+$} [lindex $ports 0] ""]) $vlnv
}
stub::command ipx::associate_bus_interfaces {-busif= -clock= -reset=} 1 1 {
    stub::choice "core" [lindex $words 0] core:current
    foreach flag [array names option] {
        if {$flag ne "-clock"} {
            stub::has_interface $option($flag)
            set ::stub::associated($option($flag)) $option(-clock)
        }
    }
    # The clock itself is always inferred: the attribute on the port asks for it.
    if {$option(-clock) ni $::stub::core_ports} {
        error "the core has no clock $option(-clock)"
    }
}
stub::command ipx::get_file_groups {-of_objects=} 1 1 {
    stub::choice "core" $option(-of_objects) core:current
    stub::choice "file group" [lindex $words 0] {
        xilinx_anylanguagesynthesis xilinx_anylanguagebehavioralsimulation xilinx_xpgui
    }
    return group:[lindex $words 0]
}
stub::command ipx::get_files {-of_objects=} 0 1 {
    if {![string match group:* $option(-of_objects)]} {
        error "ipx::get_files: $option(-of_objects) is no file group"
    }
    set found {}
    foreach path [lsort [glob -directory [file join $::stub::core_root src] *]] {
        set ::stub::properties(file:$path,NAME) src/[file tail $path]
        lappend found file:$path
    }
    return $found
}
stub::command ipgui::get_guiparamspec {-name= -component=} 0 0 {
    stub::choice "core" $option(-component) core:current
    return [expr {$option(-name) eq $::stub::page ? "page:$option(-name)" : ""}]
}
stub::command ipgui::remove_param {-component=} 1 1 {
    stub::choice "parameter" [lindex $words 0] page:$::stub::page
    set ::stub::page {}
}
stub::command ipx::create_xgui_files {} 1 1 {
    stub::choice "core" [lindex $words 0] core:current
    stub::done ipx::create_xgui_files
}
stub::command ipx::update_checksums {} 1 1 {
    stub::need ipx::create_xgui_files
    stub::done ipx::update_checksums
}
stub::command ipx::check_integrity {} 1 1 {
    stub::need ipx::update_checksums
    foreach name [stub::interface_names] {
        if {[regexp {:(clock|interrupt)_rtl:} $::stub::interfaces($name)]} {
            continue
        }
        if {![info exists ::stub::associated($name)]} {
            error "interface $name has no clock"
        }
    }
    foreach name {s_axis m_axis aresetn} {
        stub::has_interface $name
    }
    foreach name [stub::interface_names] {
        if {[string match *:aximm_rtl:* $::stub::interfaces($name)] && $::stub::associated($name) ne "aclk"} {
            error "interface $name is in another clock domain"
        }
    }
    stub::check_registers
    foreach name {name version core_revision display_name description} {
        get_property $name core:current
    }
    stub::done ipx::check_integrity
}
stub::command ipx::save_core {} 1 1 {
    stub::need ipx::check_integrity
    foreach {vendor library} $::stub::core_id {}
    set vlnv $vendor:$library:[get_property name core:current]:[get_property version core:current]
    stub::write [file join $::stub::core_root component.xml] "$vlnv\n"
}
