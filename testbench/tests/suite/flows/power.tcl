# SPDX-License-Identifier: MIT OR Apache-2.0
# Estimates of power from a routed checkpoint (UG835, UG907).

namespace eval stub {
    # Nets of the design that the activity file has; NA before one was read, as in Vivado's report.
    variable matched NA

    # Nets below the instance with this path, by counting parentheses: 0 if there is no such instance.
    proc nets_below {text path} {
        set stack {}
        set depth 0
        set within -1
        set nets 0
        foreach line [split $text \n] {
            if {[regexp {^\s*\(INSTANCE\s+(\S+)} $line -> name]} {
                lappend stack $name
                if {[join $stack /] eq $path} {
                    set within [llength $stack]
                }
            }
            if {$within >= 0 && [string match {*(TC *} $line]} {
                incr nets
            }
            set change [expr {[regexp -all {\(} $line] - [regexp -all {\)} $line]}]
            incr depth $change
            # The file itself is the outermost parenthesis; a NET group adds one more, which closes by itself.
            while {[llength $stack] > 0 && $depth < [llength $stack] + 1} {
                if {[llength $stack] == $within} {
                    return $nets
                }
                set stack [lrange $stack 0 end-1]
            }
        }
        return $nets
    }

    proc power {} {
        variable matched
        return "
+--------------------------+---------------------+
| Total On-Chip Power (W)  | 0.681               |
| Design Power Budget (W)  | Unspecified*        |
| Power Budget Margin (W)  | NA                  |
| Dynamic (W)              | 0.084               |
| Device Static (W)        | 0.597               |
| Effective TJA (C/W)      | 1.0                 |
| Max Ambient (C)          | 99.3                |
| Junction Temperature (C) | 25.7                |
| Confidence Level         | Medium              |
| Setting File             | ---                 |
| Simulation Activity File | ---                 |
| Design Nets Matched      | $matched |
+--------------------------+---------------------+
"
    }
}

stub::command open_checkpoint {-part=} 1 1 {
    stub::files [list $words] .dcp
    stub::done open_checkpoint
}
stub::command read_saif {-strip_path= -no_strip -out_file>} 1 1 {
    stub::need open_checkpoint
    stub::files [list $words] .saif
    set nets [stub::nets_below [stub::text [lindex $words 0]] $option(-strip_path)]
    set ::stub::matched [expr {$nets > 0 ? "56% ($nets/12380)" : "0% (0/12380)"}]
}
stub::command report_power {-hier= -file> -return_string} 0 0 {
    stub::need open_checkpoint
    if {[info exists option(-hier)]} {
        stub::choice "hierarchy" $option(-hier) {logic power all}
    }
    if {[info exists option(-return_string)]} {
        return [stub::power]
    }
}
stub::command report_switching_activity {-average -file>} 0 1 { stub::need open_checkpoint }
