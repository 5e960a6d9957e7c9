# SPDX-License-Identifier: MIT OR Apache-2.0
# Stands in for one of the programs of Vivado's simulator: knows the flags that the generated script uses, and does with
# Icarus Verilog what it was asked to do.
#
#   tclsh simulator.tcl xvlog|xelab|xsim [ARGUMENT ...]
#
# What one program leaves for the next lies in the working directory, as with the real ones: xsim.dir/work holds the
# compiled sources, xsim.dir/SNAPSHOT the elaborated design. Every call goes to ../record_simulator, one a line.
#
# Environment: STANDIN_MUTE, if set the simulation says nothing.

set program [lindex $argv 0]

# Flags that take a value, flags that take none.
array set valued {
    xvlog {-work -log -include -define}
    xelab {-timescale -snapshot -log -generic_top -debug}
    xsim {-onfinish -onerror -log -tclbatch}
}
array set plain {
    xvlog {-sv -nolog -relax}
    xelab {-nolog -relax}
    xsim {-runall -nolog}
}

proc fail {text} {
    puts stderr "ERROR: \[$::program\] $text"
    exit 1
}

set record [open ../record_simulator a]
puts $record $argv
close $record

set words {}
array set option {}
foreach word [lrange $argv 1 end] {
    if {[info exists flag]} {
        set option($flag) $word
        unset flag
    } elseif {![string match -* $word]} {
        lappend words $word
    } elseif {$word in $valued($program)} {
        set flag $word
    } elseif {$word in $plain($program)} {
        set option($word) 1
    } else {
        fail "unknown flag $word"
    }
}
if {[info exists flag]} {
    fail "$flag needs a value"
}

switch $program {
    xvlog {
        foreach path $words {
            if {![file isfile $path] || [file extension $path] ne ".v"} {
                fail "no Verilog file $path"
            }
        }
        file mkdir [file join xsim.dir work]
        set library [open [file join xsim.dir work sources] w]
        puts $library $words
        puts $library [expr {[info exists option(-define)] ? "-D$option(-define)" : ""}]
        close $library
    }
    xelab {
        if {![regexp {^work\.(\w+)$} $words -> top]} {
            fail "no design unit $words"
        }
        if {![info exists option(-timescale)]} {
            fail "delays without a time scale"
        }
        if {[catch {open [file join xsim.dir work sources]} library]} {
            fail "nothing was compiled into library work"
        }
        set sources [gets $library]
        set defines [gets $library]
        file mkdir [file join xsim.dir $option(-snapshot)]
        set program_file [file join xsim.dir $option(-snapshot) simulation]
        if {[catch {exec iverilog -g2005 {*}$defines -s $top -o $program_file {*}$sources 2>@1} said]} {
            fail $said
        }
    }
    xsim {
        set program_file [file join xsim.dir [lindex $words 0] simulation]
        if {![file isfile $program_file]} {
            fail "no snapshot [lindex $words 0]"
        }
        if {![info exists option(-runall)]} {
            fail "would wait for commands"
        }
        # Like the real one: 0 whatever the testbench found.
        catch {exec vvp -n $program_file 2>@1} said
        if {![info exists ::env(STANDIN_MUTE)]} {
            puts $said
        }
    }
}
