# SPDX-License-Identifier: MIT OR Apache-2.0
# Projects, synthesis, implementation, reports.

namespace eval standin {
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

standin::command create_project {-in_memory -force -part=} 0 2 {
    if {$::standin::project ne ""} {
        error "project $::standin::project is still open"
    }
    if {![info exists option(-in_memory)]} {
        if {[llength $words] == 0} {
            error "create_project: no name"
        }
        file mkdir [lindex $words end]
    }
    set ::standin::project [expr {[llength $words] ? [lindex $words 0] : "in_memory"}]
    if {[info exists option(-part)]} {
        standin::part $option(-part)
    }
    return project:$::standin::project
}
standin::command close_project {-delete} 0 0 {
    standin::forget_project
}
standin::command current_project {} 0 0 {
    if {$::standin::project eq ""} {
        error "no project is open"
    }
    return project:$::standin::project
}
standin::command current_fileset {} 0 0 { return fileset:sources_1 }
standin::command get_filesets {} 1 1 { return fileset:[lindex $words 0] }
standin::command get_runs {} 1 1 {
    standin::choice "run" [lindex $words 0] {synth_1 impl_1}
    return run:[lindex $words 0]
}
standin::command set_msg_config {-id= -new_severity=} 0 0 {
    standin::choice "severity" $option(-new_severity) {ERROR {CRITICAL WARNING} WARNING INFO STATUS}
    if {![regexp {^[A-Za-z_]+ [0-9]+-[0-9]+$} $option(-id)]} {
        error "no message $option(-id)"
    }
}

# set_property takes NAME VALUE OBJECTS, or -dict LIST OBJECTS, or all three behind flags.
standin::command set_property {-dict= -name= -value= -objects=} 0 3 {
    if {[info exists option(-dict)]} {
        foreach {name value} $option(-dict) {
            standin::set_on $name $value [lindex $words 0]
        }
    } elseif {[info exists option(-name)]} {
        standin::set_on $option(-name) $option(-value) $option(-objects)
    } elseif {[llength $words] == 3} {
        standin::set_on {*}$words
    } else {
        error "set_property: expected a name, a value and objects"
    }
}
standin::command get_property {} 2 2 {
    foreach {name object} $words {}
    if {![info exists ::standin::properties($object,$name)]} {
        error "get_property: $object has no property $name"
    }
    return $::standin::properties($object,$name)
}

standin::command read_verilog {-sv -library=} 1 inf {
    lappend ::standin::sources {*}[standin::files $words {.v .sv}]
}
standin::command read_mem {} 1 inf {
    lappend ::standin::memories {*}[standin::files $words .mem]
}
standin::command read_xdc {-unmanaged -mode= -ref= -cells=} 1 1 {
    lappend ::standin::constraints {*}[standin::files $words .xdc]
}
standin::command add_files {-norecurse -fileset=} 1 inf {
    foreach path [standin::files $words {.v .mem .xdc}] {
        switch [file extension $path] {
            .v { lappend ::standin::sources $path }
            .mem { lappend ::standin::memories $path }
            .xdc { lappend ::standin::constraints $path }
        }
        if {[file extension $path] eq ".xdc"} {
            standin::choice "set of constraints" $option(-fileset) constrs_1
        }
    }
}
standin::command update_compile_order {-fileset=} 0 0

standin::command get_ports {} 1 1 {
    if {[lindex $words 0] ni $::standin::ports} {
        error "no port [lindex $words 0]"
    }
    return port:[lindex $words 0]
}
standin::command create_clock {-name= -period=} 1 1 {
    if {![string is double -strict $option(-period)] || $option(-period) <= 0} {
        error "create_clock: period $option(-period)"
    }
    lappend ::standin::clocks [lindex $words 0]
}

standin::command synth_design {-top= -part= -mode= -flatten_hierarchy= -directive= -generic=} 0 0 {
    standin::part $option(-part)
    standin::choice "mode" $option(-mode) {default out_of_context}
    standin::choice "flattening" $option(-flatten_hierarchy) {rebuilt full none}
    set ::standin::ports [standin::ports [standin::source_of $option(-top) $::standin::sources]]
    if {[llength $::standin::memories] == 0} {
        error "\[Synth 8-4445\] could not open \$readmem data file"
    }
    foreach path $::standin::constraints {
        uplevel #0 [list source $path]
    }
    standin::done synth_design
}
foreach {step before} {
    opt_design synth_design
    place_design opt_design
    phys_opt_design place_design
    route_design place_design
} {
    standin::command $step {-directive=} 0 0 "standin::need $before; standin::done $step"
}
standin::command write_checkpoint {-force} 1 1 {
    standin::need synth_design
    standin::write [lindex $words 0]
}
standin::command report_utilization {-hierarchical -file> -return_string} 0 0 {
    standin::need synth_design
    if {[info exists option(-return_string)]} {
        return [standin::utilization]
    }
}
# The netlist has what metadata.json says of each block, in an instance of its first module; STANDIN_SPLIT names a module
# whose multipliers have become four each.
proc standin::netlist {} {
    set path [file join [file dirname [file dirname [lindex $::standin::sources 0]]] metadata.json]
    set channel [open $path]
    set text [read $channel]
    close $channel
    set cells {}
    foreach {- modules dsp bram36} [regexp -all -inline \
        {"modules": \[([^\]]*)\],\s+"dsp": (\d+),\s+"bram36": ([0-9.]+)} $text] {
        set module [lindex [regexp -inline {sptfra_[a-z_0-9]+} $modules] 0]
        set copies [expr {[standin::setting STANDIN_SPLIT ""] eq $module ? 4 : 1}]
        lappend cells [list $module DSP48E2 [expr {$copies * $dsp}]] [list $module RAMB36E2 [expr {int($bram36)}]] \
            [list $module RAMB18E2 [expr {$bram36 != int($bram36)}]]
    }
    return $cells
}
standin::command get_cells {-quiet -hierarchical -filter=} 0 0 {
    standin::need synth_design
    set found {}
    if {[regexp {^ORIG_REF_NAME == (\w+) \|\| REF_NAME == (\w+)$} $option(-filter) -> module again]} {
        foreach path $::standin::sources {
            if {[file rootname [file tail $path]] eq $module && $again eq $module} {
                lappend found "core/gen_pes\[0\].$module"
            }
        }
    } elseif {[regexp {^REF_NAME =~ (\S+)$} $option(-filter) -> kind]} {
        foreach cell [standin::netlist] {
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
standin::command report_timing_summary {-delay_type= -max_paths= -file> -return_string} 0 0 {
    standin::need route_design
    standin::choice "delay type" $option(-delay_type) {max min min_max}
}
standin::command report_drc {-file>} 0 0 { standin::need route_design }
standin::command get_timing_paths {-delay_type= -max_paths=} 0 0 {
    standin::need route_design
    standin::choice "delay type" $option(-delay_type) {max min min_max}
    set ::standin::properties(path:1,SLACK) [standin::setting STANDIN_SLACK 0.345]
    return [expr {[llength $::standin::clocks] ? "path:1" : ""}]
}

standin::command launch_runs {-to_step= -jobs=} 1 1 {
    standin::need validate_bd_design
    standin::choice "run" [lindex $words 0] {synth_1 impl_1}
    standin::choice "step" $option(-to_step) {write_bitstream route_design}
    standin::done launch_runs
}
standin::command wait_on_run {} 1 1 {
    standin::need launch_runs
    set ::standin::properties(run:[lindex $words 0],PROGRESS) 100%
    set ::standin::properties(run:[lindex $words 0],STATUS) "write_bitstream Complete!"
    set left {}
    if {[info exists ::standin::properties(run:impl_1,STEPS.OPT_DESIGN.TCL.PRE)]} {
        standin::implement_with $::standin::properties(run:impl_1,STEPS.OPT_DESIGN.TCL.PRE)
        set left {runs/impl_1/system_wrapper.ltx runs/impl_1/debug_nets.ltx}
    }
    lappend left runs/impl_1/system_wrapper.bit gen/sources_1/bd/system/hw_handoff/system.hwh
    foreach path $left {
        set place [file join [pwd] $::standin::project $::standin::project.$path]
        file mkdir [file dirname $place]
        standin::write $place "\n"
    }
    standin::done wait_on_run
}
standin::command open_run {} 1 1 {
    standin::need wait_on_run
    lappend ::standin::clocks [lindex $words 0]
    standin::done route_design
}
standin::command write_hw_platform {-fixed -include_bit -force -file>} 0 0 { standin::need wait_on_run }
