//! The library of Verilog modules is compiled in: a file that comes or goes makes the crate be built anew.

fn main() {
    println!("cargo::rerun-if-changed=rtl");
}
