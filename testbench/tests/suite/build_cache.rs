//! Building: nothing is compiled twice, everything that matters is noticed, bad input gives a message.

use std::fs;
use std::path::Path;

use crate::stub::{PLAIN_TRACE, answer, load, packet_sum};
use testbench::dut::DutError;
use testbench::stream::{Traffic, exchange};
use testbench::verilate::{BuildError, RtlSources, Trace, Verilate, default_cache, translation};

/// A cache of its own that borrows the compiled runtime of the shared one, whose build takes seconds.
fn fresh_cache() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    Verilate::default().build(&packet_sum(0)).expect("builds");
    for entry in fs::read_dir(default_cache()).expect("shared cache").filter_map(Result::ok) {
        if entry.file_name().to_string_lossy().starts_with("runtime-") && entry.path().is_dir() {
            copy(&entry.path(), &folder.path().join(entry.file_name()));
        }
    }
    folder
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("writable");
    for entry in fs::read_dir(from).expect("readable").filter_map(Result::ok) {
        fs::copy(entry.path(), to.join(entry.file_name())).expect("copies");
    }
}

#[test]
fn an_unchanged_design_is_not_compiled_again() {
    let cache = fresh_cache();
    let verilate = Verilate::new(cache.path());
    let first = verilate.build(&packet_sum(0)).expect("builds");
    let written = || fs::metadata(&first.library).and_then(|data| data.modified()).expect("a file");
    let then = written();
    let second = verilate.build(&packet_sum(0)).expect("builds");
    assert_eq!((first.compiled, second.compiled), (true, false));
    assert_eq!(first.library, second.library);
    assert_eq!(then, written());
}

#[test]
fn a_changed_rom_or_source_is_compiled() {
    let cache = fresh_cache();
    let verilate = Verilate::new(cache.path());
    let mut sources = packet_sum(0);
    let first = verilate.build(&sources).expect("builds");
    sources.files.insert("rom/addend.mem".to_owned(), b"1\n2\n3\n4\n".to_vec());
    let other_rom = verilate.build(&sources).expect("builds");
    let other_source = verilate.build(&packet_sum(2)).expect("builds");
    assert!(other_rom.compiled && other_source.compiled);
    assert_ne!(first.library, other_rom.library);
    let outcome = exchange(&mut other_rom.load(1).expect("loads"), &Traffic::new(&[vec![5]], 100), |_| ());
    assert_eq!(outcome.expect("runs").exchanges[0].words, [0, 1, 5, 2]);
}

#[test]
fn two_builders_of_one_design_do_not_disturb_each_other() {
    let cache = fresh_cache();
    let builds: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> =
            (0..4).map(|_| scope.spawn(|| Verilate::new(cache.path()).build(&packet_sum(0)))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic").expect("builds")).collect()
    });
    assert!(builds.iter().all(|built| built.library == builds[0].library));
    let leftovers = fs::read_dir(cache.path()).expect("readable").filter_map(Result::ok);
    assert_eq!(leftovers.filter(|entry| entry.file_name().to_string_lossy().starts_with("building-")).count(), 0);
    assert_eq!(answer(0, &[5])[2], 5);
    builds[0].load(1).expect("loads");
}

#[test]
fn two_different_cores_live_in_one_process() {
    let mut right = load(0);
    let mut wrong = load(2);
    let packets = [vec![1, 2, 3]];
    let traffic = Traffic::new(&packets, 100);
    for core in [&mut right, &mut wrong] {
        let outcome = exchange(core, &traffic, |_| ()).expect("runs");
        assert_eq!(outcome.exchanges[0].words, answer(0, &packets[0]));
    }
}

#[test]
fn registers_without_reset_start_random_and_the_seed_decides() {
    // Reads a register that nothing ever writes.
    let source = "module seeded #(parameter ROM_DIR = \"\") (input wire aclk, input wire aresetn,
        input wire [31:0] s_axis_tdata, input wire s_axis_tvalid, output wire s_axis_tready, input wire s_axis_tlast,
        output wire [31:0] m_axis_tdata, output wire m_axis_tvalid, input wire m_axis_tready, output wire m_axis_tlast);
        reg [31:0] value; always @(posedge aclk) value <= value;
        assign m_axis_tdata = value; assign m_axis_tvalid = s_axis_tvalid; assign m_axis_tlast = s_axis_tlast;
        assign s_axis_tready = m_axis_tready; endmodule";
    let sources = RtlSources {
        top: "seeded".to_owned(),
        files: [("rtl/seeded.v".to_owned(), source.as_bytes().to_vec())].into(),
    };
    let built = Verilate::default().build(&sources).expect("builds");
    let value = |seed| {
        let outcome = exchange(&mut built.load(seed).expect("loads"), &Traffic::new(&[vec![0]], 100), |_| ());
        outcome.expect("runs").exchanges[0].words[0]
    };
    assert_eq!(value(1), value(1));
    assert_ne!(value(1), value(2));
}

#[test]
fn verilog_that_does_not_compile_gives_verilators_words() {
    let mut sources = packet_sum(0);
    sources.files.insert("rtl/packet_sum.v".to_owned(), b"module packet_sum (input wire aclk); endmodul\n".to_vec());
    let error = Verilate::default().build(&sources).expect_err("must fail").to_string();
    assert!(error.starts_with("Verilator failed on `packet_sum`") && error.contains("syntax error"), "{error}");
}

#[test]
fn a_missing_or_long_rom_file_is_an_error_not_an_abort() {
    let mut sources = packet_sum(0);
    sources.files.insert("rom/addend.mem".to_owned(), b"1\n2\n3\n4\n5\n".to_vec());
    let long = Verilate::default().build(&sources).expect("builds").load(1);
    sources.files.remove("rom/addend.mem");
    let missing = Verilate::default().build(&sources).expect("builds").load(1);
    for result in [long, missing] {
        let Err(DutError::Failed(message)) = result else { panic!("must be refused") };
        assert!(message.contains("addend.mem"), "{message}");
    }
}

#[test]
fn sources_outside_the_folder_and_empty_designs_are_refused() {
    let mut sources = packet_sum(0);
    sources.files.insert("rtl/../../escape.v".to_owned(), Vec::new());
    assert!(matches!(Verilate::default().build(&sources), Err(BuildError::SourcePath(_))));
    sources.files.clear();
    assert!(matches!(Verilate::default().build(&sources), Err(BuildError::NoVerilog(_))));
}

#[test]
fn a_trace_is_written_by_a_build_with_tracing_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("wave.vcd");
    assert!(matches!(load(0).trace(&file, 4000), Err(DutError::Trace(_))));

    let verilate = Verilate::default().with_trace(PLAIN_TRACE);
    let mut core = verilate.build(&packet_sum(0)).expect("builds").load(1).expect("loads");
    core.trace(&file, 4000).expect("opens");
    exchange(&mut core, &Traffic::new(&[vec![1, 2]], 100), |_| ()).expect("runs");
    drop(core);
    let text = fs::read_to_string(&file).expect("written");
    assert!(text.contains("$var") && text.contains("m_axis_tdata") && text.contains("\n#40000\n"));
    assert!(matches!(Trace::best(), Trace::Vcd | Trace::Fst));
}

#[test]
fn a_broken_entry_is_built_again() {
    let cache = fresh_cache();
    let verilate = Verilate::new(cache.path());
    let first = verilate.build(&packet_sum(0)).expect("builds");
    let rom = first.library.with_file_name("rom").join("addend.mem");
    let library = fs::read(&first.library).expect("readable");
    for (file, broken) in [(&first.library, &library[..library.len() / 3]), (&first.library, b""), (&rom, b"1\n2\n")] {
        // Another file of that name: the one that this process has loaded stays mapped.
        fs::remove_file(file).expect("writable");
        fs::write(file, broken).expect("writable");
        let again = verilate.build(&packet_sum(0)).expect("builds");
        assert!(again.compiled && again.library == first.library);
        let outcome = exchange(&mut again.load(1).expect("loads"), &Traffic::new(&[vec![5]], 100), |_| ());
        assert_eq!(outcome.expect("runs").exchanges[0].words, answer(0, &[5]));
    }
    assert_eq!(fs::read(&first.library).map(|bytes| bytes.len()).ok(), Some(library.len()));
    assert!(!verilate.build(&packet_sum(0)).expect("builds").compiled);
}

#[test]
fn what_an_interrupted_build_left_is_removed_and_a_running_one_is_not() {
    let cache = fresh_cache();
    let unfinished = |name: &str| {
        let folder = cache.path().join(name);
        fs::create_dir(&folder).expect("writable");
        fs::write(folder.join("dut.so"), "half").expect("writable");
        fs::File::create(folder.join("used")).expect("writable")
    };
    let running = unfinished("building-running");
    running.lock().expect("locked");
    drop(unfinished("building-abandoned"));
    Verilate::new(cache.path()).build(&packet_sum(0)).expect("builds");
    assert!(!cache.path().join("building-abandoned").exists());
    assert!(cache.path().join("building-running/dut.so").exists());
}

/// A module of the library holds more than a design uses of it.
#[test]
fn what_generate_leaves_out_is_no_hardware() {
    let library = "module sptfra_part #(parameter CHANNELS = 4) (input wire clock, input wire x, output reg y);
        generate
            if (CHANNELS == 4) begin : gen_four
                always @(posedge clock) y <= x;
            end else begin : gen_one
                always @(posedge clock) y <= !x;
            end
            if (CHANNELS > 4) begin : gen_check
                sptfra_error_ways invalid ();
            end
        endgenerate
        `ifdef SIMULATION
        wire seen = x;
        `endif
        endmodule\n";
    let top = "module t #(parameter ROM_DIR = \"\") (input wire clock, input wire x, output wire y);
        sptfra_part #(.CHANNELS (1)) part (.clock(clock), .x(x), .y(y));
        endmodule\n";
    let of = |library: &str| {
        let file = |name: &str, text: &str| (name.to_owned(), text.as_bytes().to_vec());
        let files = [file("rtl/sptfra_part.v", library), file("rtl/t.v", top)].into();
        translation(&RtlSources { top: "t".to_owned(), files }).expect("translated")
    };
    let changed = |from: &str, to: &str| of(&library.replace(from, to)) != of(library);
    assert!(changed("y <= !x", "y <= x"));
    assert!(!changed("y <= x", "y <= !y"));
    assert!(!changed("CHANNELS > 4", "CHANNELS > 5"));
    assert!(!changed("seen = x", "seen = !x"));
}
