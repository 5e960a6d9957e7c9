# SPDX-License-Identifier: MIT OR Apache-2.0
# Projects, synthesis, implementation, reports.

namespace eval stub {
    variable sources {}
    variable memories {}
    variable constraints {}
    variable clocks {}
    variable project {}

    # What can be set on each kind of object; objects are named KIND:NAME.
    variable legal_properties
    array set legal_properties {
        fileset {top include_dirs}
        project {part board_part board_connections ip_repo_paths source_mgmt_mode}
        run {{STEPS.SYNTH_DESIGN.ARGS.MORE OPTIONS} STEPS.OPT_DESIGN.TCL.PRE}
        debug_core {
            C_DATA_DEPTH C_INPUT_PIPE_STAGES C_TRIGIN_EN C_TRIGOUT_EN C_ADV_TRIGGER C_EN_STRG_QUAL ALL_PROBE_SAME_MU
            ALL_PROBE_SAME_MU_CNT
        }
        debug_port {port_width PROBE_TYPE}
        xdc {USED_IN}
        address_block {range width}
        register {address_offset size}
        field {bit_offset bit_width access description}
        core {name version core_revision display_name description}
    }

    proc part {name} {
        if {![regexp {^xc[a-z0-9]+(-[a-z0-9LV]+)+$} $name]} {
            error "no part $name"
        }
    }

    proc forget_project {} {
        variable sources {}
        variable memories {}
        variable constraints {}
        variable clocks {}
        variable steps {}
        variable project {}
    }

    proc set_on {name value objects} {
        variable legal_properties
        variable properties
        foreach object $objects {
            set kind [lindex [split $object :] 0]
            if {$kind eq "cell"} {
                configure $object $name $value
            } elseif {![info exists legal_properties($kind)] || $name ni $legal_properties($kind)} {
                error "set_property: no property $name of $object"
            }
            if {$name eq "USED_IN"} {
                foreach use $value {
                    choice "use of $object" $use {synthesis implementation simulation out_of_context}
                }
            }
            set properties($object,$name) $value
        }
    }

    proc utilization {} {
        return "
+----------------------------+--------+-------+------------+-----------+-------+
|          Site Type         |  Used  | Fixed | Prohibited | Available | Util% |
+----------------------------+--------+-------+------------+-----------+-------+
| CLB LUTs                   |   4321 |     0 |          0 |    274080 |  1.58 |
|   LUT as Logic             |   4300 |     0 |          0 |    274080 |  1.57 |
| CLB Registers              |   5432 |     0 |          0 |    548160 |  0.99 |
| Block RAM Tile             |   12.5 |     0 |          0 |       912 |  1.37 |
| DSPs                       |     34 |     0 |          0 |      2520 |  1.35 |
+----------------------------+--------+-------+------------+-----------+-------+
"
    }
}

stub::command create_project {-in_memory -force -part=} 0 2 {
    if {$::stub::project ne ""} {
        error "project $::stub::project is still open"
    }
    if {![info exists option(-in_memory)]} {
        if {[llength $words] == 0} {
            error "create_project: no name"
        }
        file mkdir [lindex $words end]
    }
    set ::stub::project [expr {[llength $words] ? [lindex $words 0] : "in_memory"}]
    if {[info exists option(-part)]} {
        stub::part $option(-part)
    }
    return project:$::stub::project
}
stub::command close_project {-delete} 0 0 {
    stub::forget_project
}
stub::command current_project {} 0 0 {
    if {$::stub::project eq ""} {
        error "no project is open"
    }
    return project:$::stub::project
}
stub::command current_fileset {} 0 0 { return fileset:sources_1 }
stub::command get_filesets {} 1 1 { return fileset:[lindex $words 0] }
stub::command get_runs {} 1 1 {
    stub::choice "run" [lindex $words 0] {synth_1 impl_1}
    return run:[lindex $words 0]
}
stub::command set_msg_config {-id= -new_severity=} 0 0 {
    stub::choice "severity" $option(-new_severity) {ERROR {CRITICAL WARNING} WARNING INFO STATUS}
    if {![regexp {^[A-Za-z_]+ [0-9]+-[0-9]+$} $option(-id)]} {
        error "no message $option(-id)"
    }
}

# set_property takes NAME VALUE OBJECTS, or -dict LIST OBJECTS, or all three behind flags.
stub::command set_property {-dict= -name= -value= -objects=} 0 3 {
    if {[info exists option(-dict)]} {
        foreach {name value} $option(-dict) {
            stub::set_on $name $value [lindex $words 0]
        }
    } elseif {[info exists option(-name)]} {
        stub::set_on $option(-name) $option(-value) $option(-objects)
    } elseif {[llength $words] == 3} {
        stub::set_on {*}$words
    } else {
        error "set_property: expected a name, a value and objects"
    }
}
stub::command get_property {} 2 2 {
    foreach {name object} $words {}
    if {![info exists ::stub::properties($object,$name)]} {
        error "get_property: $object has no property $name"
    }
    return $::stub::properties($object,$name)
}

stub::command read_verilog {-sv -library=} 1 inf {
    lappend ::stub::sources {*}[stub::files $words {.v .sv}]
}
stub::command read_mem {} 1 inf {
    lappend ::stub::memories {*}[stub::files $words .mem]
}
stub::command read_xdc {-unmanaged -mode= -ref= -cells=} 1 1 {
    lappend ::stub::constraints {*}[stub::files $words .xdc]
}
stub::command add_files {-norecurse -fileset=} 1 inf {
    foreach path [stub::files $words {.v .mem .xdc}] {
        switch [file extension $path] {
            .v { lappend ::stub::sources $path }
            .mem { lappend ::stub::memories $path }
            .xdc { lappend ::stub::constraints $path }
        }
        if {[file extension $path] eq ".xdc"} {
            stub::choice "set of constraints" $option(-fileset) constrs_1
        }
    }
}
stub::command update_compile_order {-fileset=} 0 0

stub::command get_ports {} 1 1 {
    if {[lindex $words 0] ni $::stub::ports} {
        error "no port [lindex $words 0]"
    }
    return port:[lindex $words 0]
}
stub::command create_clock {-name= -period=} 1 1 {
    if {![string is double -strict $option(-period)] || $option(-period) <= 0} {
        error "create_clock: period $option(-period)"
    }
    lappend ::stub::clocks [lindex $words 0]
}

stub::command synth_design {-top= -part= -mode= -flatten_hierarchy= -directive= -generic=} 0 0 {
    stub::part $option(-part)
    stub::choice "mode" $option(-mode) {default out_of_context}
    stub::choice "flattening" $option(-flatten_hierarchy) {rebuilt full none}
    set ::stub::ports [stub::ports [stub::source_of $option(-top) $::stub::sources]]
    if {[llength $::stub::memories] == 0} {
        error "\[Synth 8-4445\] could not open \$readmem data file"
    }
    foreach path $::stub::constraints {
        uplevel #0 [list source $path]
    }
    stub::done synth_design
}
foreach {step before} {
    opt_design synth_design
    place_design opt_design
    phys_opt_design place_design
    route_design place_design
} {
    stub::command $step {-directive=} 0 0 "stub::need $before; stub::done $step"
}
stub::command write_checkpoint {-force} 1 1 {
    stub::need synth_design
    stub::write [lindex $words 0]
}
stub::command report_utilization {-hierarchical -file> -return_string} 0 0 {
    stub::need synth_design
    if {[info exists option(-return_string)]} {
        return [stub::utilization]
    }
}
# The netlist has what metadata.json says of each block, in an instance of its first module; STANDIN_SPLIT names a module
# whose multipliers have become four each.
proc stub::netlist {} {
    set path [file join [file dirname [file dirname [lindex $::stub::sources 0]]] metadata.json]
    set channel [open $path]
    set text [read $channel]
    close $channel
    set cells {}
    foreach {- modules dsp bram36} [regexp -all -inline \
        {"modules": \[([^\]]*)\],\s+"dsp": (\d+),\s+"bram36": ([0-9.]+)} $text] {
        set module [lindex [regexp -inline {sptfra_[a-z_0-9]+} $modules] 0]
        set copies [expr {[stub::setting STANDIN_SPLIT ""] eq $module ? 4 : 1}]
        lappend cells [list $module DSP48E2 [expr {$copies * $dsp}]] [list $module RAMB36E2 [expr {int($bram36)}]] \
            [list $module RAMB18E2 [expr {$bram36 != int($bram36)}]]
    }
    return $cells
}
stub::command get_cells {-quiet -hierarchical -filter=} 0 0 {
    stub::need synth_design
    set found {}
    if {[regexp {^ORIG_REF_NAME == (\w+) \|\| REF_NAME == (\w+)$} $option(-filter) -> module again]} {
        foreach path $::stub::sources {
            if {[file rootname [file tail $path]] eq $module && $again eq $module} {
                lappend found "core/gen_pes\[0\].$module"
            }
        }
    } elseif {[regexp {^REF_NAME =~ (\S+)$} $option(-filter) -> kind]} {
        foreach cell [stub::netlist] {
            lassign $cell module primitive count
            for {set index 0} {$index < $count && [string match $kind $primitive]} {incr index} {
                lappend found "core/gen_pes\[0\].$module/$primitive$index"
            }
        }
    } else {
        error "get_cells: filter $option(-filter)"
    }
    return $found
}
stub::command report_timing_summary {-delay_type= -max_paths= -file> -return_string} 0 0 {
    stub::need route_design
    stub::choice "delay type" $option(-delay_type) {max min min_max}
}
stub::command report_drc {-file>} 0 0 { stub::need route_design }
stub::command get_timing_paths {-delay_type= -max_paths=} 0 0 {
    stub::need route_design
    stub::choice "delay type" $option(-delay_type) {max min min_max}
    set ::stub::properties(path:1,SLACK) [stub::setting STANDIN_SLACK 0.345]
    return [expr {[llength $::stub::clocks] ? "path:1" : ""}]
}

stub::command launch_runs {-to_step= -jobs=} 1 1 {
    stub::need validate_bd_design
    stub::choice "run" [lindex $words 0] {synth_1 impl_1}
    stub::choice "step" $option(-to_step) {write_bitstream route_design}
    stub::done launch_runs
}
stub::command wait_on_run {} 1 1 {
    stub::need launch_runs
    set ::stub::properties(run:[lindex $words 0],PROGRESS) 100%
    set ::stub::properties(run:[lindex $words 0],STATUS) "write_bitstream Complete!"
    set left {}
    if {[info exists ::stub::properties(run:impl_1,STEPS.OPT_DESIGN.TCL.PRE)]} {
        stub::implement_with $::stub::properties(run:impl_1,STEPS.OPT_DESIGN.TCL.PRE)
        set left {runs/impl_1/system_wrapper.ltx runs/impl_1/debug_nets.ltx}
    }
    lappend left runs/impl_1/system_wrapper.bit gen/sources_1/bd/system/hw_handoff/system.hwh
    foreach path $left {
        set place [file join [pwd] $::stub::project $::stub::project.$path]
        file mkdir [file dirname $place]
        stub::write $place "\n"
    }
    stub::done wait_on_run
}
stub::command open_run {} 1 1 {
    stub::need wait_on_run
    lappend ::stub::clocks [lindex $words 0]
    stub::done route_design
}
stub::command write_hw_platform {-fixed -include_bit -force -file>} 0 0 { stub::need wait_on_run }
