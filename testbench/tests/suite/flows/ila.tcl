# SPDX-License-Identifier: MIT OR Apache-2.0
# Logic analysers in a linked design (UG835, UG908).

namespace eval stub {
    # Whether the system is linked: its nets exist only then.
    variable linked 0
    # Where the core is in the system; STANDIN_CORES, a second one.
    variable core_nets {}
    # Ports of the analyser: name to width, and to what is connected.
    variable debug_ports
    array set debug_ports {}

    # Bits of the nets that the packaged core marks, as synthesis names them.
    proc marked {} {
        variable core_root
        set marked {}
        foreach path [lsort [glob -directory [file join $core_root src] *.v]] {
            set within [expr {[string match *_core.v $path] ? "core/inst/core" : "core/inst"}]
            set pattern {\(\* mark_debug = "true" \*\)\n\s*wire (?:signed )?(?:\[([0-9]+):0\] )?(\w+)}
            foreach {- high name} [regexp -all -inline $pattern [text $path]] {
                foreach place [concat core [setting STANDIN_CORES {}]] {
                    set net system_i/[regsub ^core $within $place]/$name
                    if {$high eq ""} {
                        lappend marked $net
                    } else {
                        for {set bit $high} {$bit >= 0} {incr bit -1} {
                            lappend marked $net\[$bit\]
                        }
                    }
                }
            }
        }
        return $marked
    }

    # An implementation run: links, runs the script before opt_design, which then builds what is complete.
    proc implement_with {script} {
        variable linked
        variable debug_ports
        variable properties
        set linked 1
        uplevel #0 [list source $script]
        foreach port [array names debug_ports] {
            if {$debug_ports($port) eq ""} {
                error "opt_design: $port has unconnected channels"
            }
        }
        set linked 0
    }
}

stub::command get_nets {-hierarchical -filter= -segments -top_net_of_hierarchical_group} 0 1 {
    if {!$::stub::linked} {
        error "get_nets: no design is open"
    }
    if {[info exists option(-filter)]} {
        if {![info exists option(-hierarchical)] || $option(-filter) ne "MARK_DEBUG == 1"} {
            error "get_nets: filter $option(-filter)"
        }
        return [stub::marked]
    }
    foreach net [lindex $words 0] {
        if {[info exists option(-top_net_of_hierarchical_group)]} {
            stub::choice "net" $net {system_i/core/inst/aclk system_i/core/inst/core/aclk}
            return system_i/clock
        }
        stub::choice "net" $net [stub::marked]
    }
    return [lindex $words 0]
}
stub::command create_debug_core {} 2 2 {
    foreach {name type} $words {}
    stub::choice "debug core" $type ila
    set ::stub::debug_ports($name/clk) {}
    set ::stub::debug_ports($name/probe0) {}
    return debug_core:$name
}
stub::command get_debug_cores {} 1 1 {
    if {![info exists ::stub::debug_ports([lindex $words 0]/clk)]} {
        error "no debug core [lindex $words 0]"
    }
    return debug_core:[lindex $words 0]
}
stub::command create_debug_port {} 2 2 {
    foreach {core type} $words {}
    stub::choice "debug port" $type probe
    set ::stub::debug_ports($core/probe[llength [array names ::stub::debug_ports $core/probe*]]) {}
}
stub::command get_debug_ports {} 1 1 {
    if {![info exists ::stub::debug_ports([lindex $words 0])]} {
        error "no debug port [lindex $words 0]"
    }
    return debug_port:[lindex $words 0]
}
stub::command connect_debug_port {} 2 2 {
    foreach {port nets} $words {}
    set width [get_property port_width [get_debug_ports $port]]
    if {[llength $nets] != $width} {
        error "$port has $width channels for [llength $nets] nets"
    }
    set depth [get_property C_DATA_DEPTH debug_core:[file dirname $port]]
    stub::choice "depth" $depth {1024 2048 4096 8192 16384 32768 65536 131072}
    if {[string match */clk $port] != ($nets eq "system_i/clock")} {
        error "$port is connected to $nets"
    }
    set ::stub::debug_ports($port) $nets
}
