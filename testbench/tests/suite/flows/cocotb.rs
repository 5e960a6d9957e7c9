//! The example for cocotb: it is Python, drives the ports that the top has, and runs in Icarus Verilog.

use std::fs;
use std::process::Command;

use hdl_gen::emit::emit;
use hdl_gen::plan::Plan;

use super::folder::{Folder, environment, run};
use crate::support::shipped;

/// Prints the attributes of `dut`: what the example takes for ports.
const PORTS: &str = "import ast, sys
nodes = ast.walk(ast.parse(sys.argv[1]))
print(*{n.attr for n in nodes if isinstance(n, ast.Attribute) and isinstance(n.value, ast.Name) and n.value.id == 'dut'})";

#[test]
fn it_is_python_and_drives_every_input() {
    for design in ["small", "small-control", "small-scanner"] {
        let design = shipped(design);
        let files = emit(&Plan::new(&design).expect("can be planned")).expect("is printed");
        let text = |path: String| String::from_utf8(files[&path].clone()).expect("text");
        let (script, top) = (text(format!("sim/{}_cocotb.py", design.name)), text(format!("rtl/{}.v", design.name)));
        let ran = run(Command::new(environment().join("bin/python")).args(["-c", PORTS, &script])).succeeded();
        let mut known: Vec<String> = ran.stdout.split_whitespace().map(str::to_owned).collect();
        let registers = script.split("REGISTER_PORT = \"").nth(1).and_then(|rest| rest.split('"').next());
        assert_eq!(registers.is_some(), design.hardware.control);
        known.extend(registers.unwrap_or_default().split_whitespace().map(|name| format!("s_axi_ctrl_{name}")));
        known.retain(|name| name != "_log");
        // The name comes last but for a comma and a comment.
        let ports = |direction: &str| -> Vec<String> {
            let lines = top.lines().filter(|line| line.trim_start().starts_with(direction));
            let name = |line: &str| {
                line.split("//").next()?.trim_end().trim_end_matches(',').split(' ').next_back().map(str::to_owned)
            };
            lines.filter_map(name).collect()
        };
        let (inputs, outputs) = (ports("input "), ports("output "));
        assert!(inputs.len() > 5 && inputs.iter().all(|port| known.contains(port)), "{inputs:?} {known:?}");
        assert!(known.iter().all(|port| inputs.contains(port) || outputs.contains(port)), "{outputs:?} {known:?}");
        // Frames beside it, of beats as wide as the core's.
        let frames = text(format!("sim/{}_stimulus.mem", design.name));
        let digits = 1 + design.hardware.stream_bits as usize / 4;
        assert!(frames.lines().all(|line| line.len() == digits), "{digits}");
        assert!(script.contains(&format!("\nBITS = {}  #", design.hardware.stream_bits)));
    }
}

/// With registers and without; and it sees a word of the model that differs.
#[test]
fn it_runs_and_sees_a_wrong_word() {
    let python = environment().join("bin/python");
    let there = Command::new(&python).args(["-c", "import cocotb_tools.runner"]).output().expect("Python starts");
    assert!(there.status.success(), "cocotb is missing: run `make cocotb-tools`");
    for (design, wrong) in [("small-control", false), ("small", false), ("small", true)] {
        let design = shipped(design);
        let folder = Folder::new(&emit(&Plan::new(&design).expect("can be planned")).expect("is printed"));
        let script = folder.design().join(format!("sim/{}_cocotb.py", design.name));
        if wrong {
            // The status of the first answer.
            let place = folder.design().join(format!("sim/{}_expected.mem", design.name));
            let text = fs::read_to_string(&place).expect("expected words");
            let last = text.find('\n').expect("lines") - 1;
            let digit = if text.as_bytes()[last] == b'0' { "1" } else { "0" };
            fs::write(&place, format!("{}{digit}{}", &text[..last], &text[last + 1..])).expect("written");
        }
        let ran = run(Command::new(&python).arg(&script).current_dir(folder.work()));
        assert_eq!(ran.ok, !wrong, "{}\n{}", ran.stdout, ran.stderr);
        let said = ran.stdout + &ran.stderr;
        assert!(said.contains(if wrong { "FAIL=1" } else { "TESTS=1 PASS=1 FAIL=0" }), "{said}");
    }
}
