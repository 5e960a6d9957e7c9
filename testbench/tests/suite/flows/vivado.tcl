# SPDX-License-Identifier: MIT OR Apache-2.0
# Stands in for Vivado: knows the commands that the generated scripts use, their flags and what they act on.
#
#   tclsh vivado.tcl RECORD SCRIPT [ARGUMENT ...]
#
# Every call is written to RECORD, one a line. An unknown command or flag, a file that is not there, an object that does
# not exist or a step out of order is an error. It shows that a script is legal and complete, not what Vivado makes of
# it.
#
# Environment: STANDIN_SLACK, the worst slack in ns; STANDIN_WITHOUT, a pattern of board parts and IPs that are not
# installed; STANDIN_BLIND, if set the IP packager infers no interface.

# Older releases of Vivado have Tcl 8.5.
foreach newer {lmap try tailcall coroutine} {
    rename $newer {}
}

namespace eval stub {
    variable folder [file dirname [file normalize [info script]]]
    variable properties
    array set properties {}
    variable steps {}

    proc setting {name default} {
        return [expr {[info exists ::env($name)] ? $::env($name) : $default}]
    }

    # Declares a command. A flag that ends in = takes a value, one that ends in > a file to write; `least` to `most`
    # other words. The body sees them as `words`, and given flags in the array `option`.
    proc command {name flags least most {body {}}} {
        namespace eval ::[namespace qualifiers $name] {}
        proc ::$name args "
            set words \[stub::parse [list $name $flags $least $most] \$args option\]
            $body
        "
    }

    proc parse {name flags least most arguments result} {
        variable channel
        upvar 1 $result option
        puts $channel [list $name {*}$arguments]
        set words {}
        for {set index 0} {$index < [llength $arguments]} {incr index} {
            set word [lindex $arguments $index]
            if {![string match -* $word]} {
                lappend words $word
            } elseif {$word in $flags} {
                set option($word) 1
            } elseif {"$word=" in $flags || "$word>" in $flags} {
                incr index
                if {$index >= [llength $arguments]} {
                    error "$name: $word needs a value"
                }
                set option($word) [lindex $arguments $index]
                if {"$word>" in $flags} {
                    write $option($word)
                }
            } else {
                error "$name: unknown flag $word"
            }
        }
        if {[llength $words] < $least || [llength $words] > $most} {
            error "$name: [llength $words] words, expected $least to $most"
        }
        return $words
    }

    proc write {path {text "written by the stub\n"}} {
        set file [open $path w]
        puts -nonewline $file $text
        close $file
    }

    proc text {path} {
        set file [open $path]
        set text [read $file]
        close $file
        return $text
    }

    # Files named by words, each of which may be a list; all must exist and have the ending.
    proc files {words ending} {
        set files {}
        foreach word $words {
            foreach path $word {
                if {![file isfile $path]} {
                    error "no file $path"
                }
                if {[file extension $path] ni $ending} {
                    error "$path: expected a file that ends in $ending"
                }
                lappend files $path
            }
        }
        return $files
    }

    proc choice {what value legal} {
        if {$value ni $legal} {
            error "$what is $value, legal are: $legal"
        }
    }

    proc done {step} {
        variable steps
        lappend steps $step
    }

    proc need {step} {
        variable steps
        if {$step ni $steps} {
            error "$step is to come first"
        }
    }

    # Ports of a module, in order, from its Verilog.
    proc ports {path} {
        set ports {}
        foreach {- - port} [regexp -all -inline {(?:input|output)\s+(wire|reg)\s+(?:\[[^]]*\]\s*)?(\w+)} [text $path]] {
            lappend ports $port
        }
        return $ports
    }

    # The source among `files` that holds the module.
    proc source_of {module files} {
        foreach path $files {
            if {[regexp "\\nmodule\\s+$module\\s*\[#(\]" \n[text $path]]} {
                return $path
            }
        }
        error "no source holds module $module"
    }
}

foreach part {project.tcl ip_packager.tcl block_design.tcl ila.tcl power.tcl} {
    source [file join $stub::folder $part]
}

set stub::channel [open [lindex $argv 0] w]
set script [lindex $argv 1]
set argv [lrange $argv 2 end]
set argc [llength $argv]
source $script
close $stub::channel
