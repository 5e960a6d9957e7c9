//! The compiler runs: Verilator, its runtime library (once), the design's C++ (one translation unit).
//!
//! Measured with a 16-lane multiply-accumulate engine on two cores: parsing Verilator's headers takes 0.4 s of a
//! small design's 0.7 s, so they are precompiled together with the runtime, for builds without a trace.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::cache::Cache;
use super::{BuildError, RtlSources, Trace, hex};
use crate::tools;

use sha2::{Digest, Sha256};

/// The shared object's name in its entry.
pub const LIBRARY: &str = "dut.so";
const ARCHIVE: &str = "libverilated.a";
const TRACER: &str = "libtracer.a";
const HEADER: &str = "runtime.h";
const WRAPPER: &str = include_str!("wrapper.cpp");

/// Registers and `x` literals become run-time random bits, so that logic that relies on an unwritten register fails.
/// Nobody reads the C++: without its comments it is a fifth shorter, and with fewer instances that have a copy of their
/// module's code (2000 is Verilator's own measure) by another fourth. That compiles a seventh faster, which a simulation of 3
/// to 14 % more gives back after some 400,000 cycles.
const VERILATOR_FLAGS: [&str; 10] = [
    "--cc",
    "--x-assign",
    "unique",
    "--x-initial",
    "unique",
    "--no-decoration",
    "--inline-mult",
    "100",
    "-Wno-fatal",
    "-DSIMULATION",
];
/// Symbols stay inside their shared object, so that several simulated designs live in one process. The wrapper turns
/// run-time warnings into errors: to Verilator, a ROM file that is not there is but a warning.
const CXX_FLAGS: [&str; 8] = [
    "-std=c++17",
    "-fPIC",
    "-fvisibility=hidden",
    "-w",
    "-DVL_USER_FATAL",
    "-DVL_USER_STOP",
    "-DVL_USER_FINISH",
    "-DVL_USER_WARN",
];
/// How far the compiler optimises: `-O1` would save at most 6 % of a simulation and take some 1 s more to compile, and would need a
/// precompiled header of its own: GCC takes the optimisation from the header, whatever the flags beside it say.
const OPTIMISATION: &str = "-Og";
/// The redundancies that GCC's FRE looks for Verilator has removed: to look through functions of thousands of stores takes up
/// to two fifths of the compiler's time, and the simulation is as quick without. Clang does not know the flag.
const OF_GCC: &str = "-fno-tree-fre";

/// How a compiler that says this of its version is to optimise what Verilator writes.
fn optimisation(version: &str) -> impl Iterator<Item = &'static str> {
    let of_gcc = (!version.contains("clang")).then_some(OF_GCC);
    [OPTIMISATION].into_iter().chain(of_gcc)
}

/// The tools and flags of a build.
#[derive(Clone)]
pub struct Toolchain {
    trace: Trace,
    include: PathBuf,
    version: String,
    compiler: String,
}

impl Toolchain {
    pub fn find(trace: Trace) -> Result<Self, BuildError> {
        let compiler = cxx_version()?;
        let include = tools::verilator_root()?.join("include");
        Ok(Self { trace, include, version: super::verilator_version()?, compiler })
    }

    /// All that can change the result, the sources apart.
    pub fn identity(&self) -> String {
        // A file of either kind stands for how they are put together.
        let unit = everything(&["fast.cpp", "slow__Slow.cpp"].map(PathBuf::from), WRAPPER);
        let parts = [self.version.as_str(), self.compiler.as_str(), &unit, &VERILATOR_FLAGS.join(" ")];
        format!("{}\n{}", parts.join("\n"), self.cxx_flags().join(" "))
    }

    fn cxx_flags(&self) -> Vec<String> {
        let traced = |format| u8::from(self.trace == format);
        let mut flags: Vec<String> =
            CXX_FLAGS.into_iter().chain(optimisation(&self.compiler)).map(ToOwned::to_owned).collect();
        for off in ["COVERAGE", "SC", "TIMING"] {
            flags.push(format!("-DVM_{off}=0"));
        }
        flags.push(format!("-DVM_TRACE={}", u8::from(self.trace != Trace::Off)));
        flags.push(format!("-DVM_TRACE_VCD={}", traced(Trace::Vcd)));
        flags.push(format!("-DVM_TRACE_FST={}", traced(Trace::Fst)));
        flags.push(format!("-DVM_TRACE_SAIF={}", traced(Trace::Saif)));
        flags
    }

    fn compile(&self) -> Result<Command, BuildError> {
        let mut command = tools::cxx()?;
        command.args(self.cxx_flags()).arg("-I").arg(&self.include).arg("-I").arg(self.include.join("vltstd"));
        Ok(command)
    }

    /// What writes the trace, of Verilator's sources.
    fn tracer_sources(&self) -> &'static [&'static str] {
        match self.trace {
            Trace::Off => &[],
            Trace::Vcd => &["verilated_vcd_c.cpp"],
            Trace::Saif => &["verilated_saif_c.cpp"],
            Trace::Fst => &["verilated_fst_c.cpp", "fstcpp/fstcpp_writer.cpp", "fstcpp/fstcpp_variable_info.cpp"],
        }
    }

    fn libraries(&self) -> &'static [&'static str] {
        if self.trace == Trace::Fst { &["-llz4", "-lz", "-lpthread"] } else { &["-lpthread"] }
    }
}

/// Folders with what all designs are linked with.
pub struct Runtime {
    /// The runtime, one for all builds, as its code is the same whatever is traced; and a precompiled header for those without
    /// a trace.
    common: PathBuf,
    /// What writes the trace, of builds with one.
    tracer: Option<PathBuf>,
}

impl Runtime {
    /// Compiled on first use, which takes about 6 s, and 2 s with a format of traces.
    pub fn new(toolchain: &Toolchain, cache: &Cache) -> Result<Self, BuildError> {
        let plain = Toolchain { trace: Trace::Off, ..toolchain.clone() };
        let common = once("runtime", &plain, cache, |folder| build_common(&plain, folder))?;
        let tracer = match toolchain.tracer_sources() {
            [] => None,
            sources => Some(once("tracer", toolchain, cache, |folder| {
                compile_all(toolchain, sources, Vec::new(), &folder.join(TRACER))
            })?),
        };
        Ok(Self { common, tracer })
    }

    /// In the order in which they are linked.
    fn archives(&self) -> impl Iterator<Item = PathBuf> {
        let tracer = self.tracer.iter().map(|folder| folder.join(TRACER));
        tracer.chain([self.common.join(ARCHIVE)])
    }
}

/// The cache's entry of a kind, by the tools and flags; every test of a fresh checkout wants it at the same moment.
fn once(
    kind: &str,
    toolchain: &Toolchain,
    cache: &Cache,
    build: impl FnOnce(&Path) -> Result<(), BuildError>,
) -> Result<PathBuf, BuildError> {
    let key = format!("{kind}-{}", &hex(&Sha256::digest(toolchain.identity()))[..16]);
    cache.exclusive(&key, || match cache.get(&key) {
        Some(folder) => Ok(folder),
        None => cache.publish(&key, build),
    })
}

fn build_common(toolchain: &Toolchain, folder: &Path) -> Result<(), BuildError> {
    let header = folder.join(HEADER);
    fs::write(&header, "#include \"verilated.h\"\n").map_err(BuildError::io("write", &header))?;
    let mut precompile = toolchain.compile()?;
    precompile.args(["-x", "c++-header"]).arg(&header).arg("-o").arg(folder.join(format!("{HEADER}.gch")));
    compile_all(toolchain, &["verilated.cpp", "verilated_threads.cpp"], vec![precompile], &folder.join(ARCHIVE))
}

/// Compiles sources of Verilator's to an archive, beside other jobs of the compiler.
fn compile_all(
    toolchain: &Toolchain,
    sources: &[&str],
    mut jobs: Vec<Command>,
    archive: &Path,
) -> Result<(), BuildError> {
    let mut objects = Vec::new();
    for (index, source) in sources.iter().enumerate() {
        let object = archive.with_file_name(format!("runtime{index}.o"));
        let mut job = toolchain.compile()?;
        job.arg("-c").arg(toolchain.include.join(source)).arg("-o").arg(&object);
        jobs.push(job);
        objects.push(object);
    }
    std::thread::scope(|scope| {
        let running: Vec<_> = jobs
            .into_iter()
            .map(|job| scope.spawn(|| output(job, "the C++ compiler", "Verilator's runtime")))
            .collect();
        running.into_iter().try_for_each(|job| match job.join() {
            Ok(result) => result.map(drop),
            Err(panic) => std::panic::resume_unwind(panic),
        })
    })?;
    let mut together = Command::new("ar");
    together.arg("rcs").arg(archive).args(&objects);
    output(together, "ar", "Verilator's runtime")?;
    for object in objects {
        fs::remove_file(&object).map_err(BuildError::io("remove", &object))?;
    }
    Ok(())
}

/// Translates and compiles the sources in `folder`; the ROM files are looked for in `rom_folder` at run time.
pub fn design(
    toolchain: &Toolchain,
    runtime: &Runtime,
    sources: &RtlSources,
    folder: &Path,
    rom_folder: &Path,
) -> Result<(), BuildError> {
    let generated = folder.join("cpp");
    translate(toolchain, sources, folder, &generated, rom_folder)?;
    let unit = generated.join("everything.cc");
    fs::write(&unit, one_unit(&generated, WRAPPER)?).map_err(BuildError::io("write", &unit))?;

    let mut compile = toolchain.compile()?;
    if toolchain.trace == Trace::Off {
        // Works only as the first include; a compiler that does not take it reads the plain one.
        compile.arg("-include").arg(runtime.common.join(HEADER));
    }
    compile.arg("-I").arg(&generated);
    compile.args(["-shared", "-o"]).arg(folder.join(LIBRARY)).arg(&unit).args(runtime.archives());
    compile.args(["-Wl,-Bsymbolic", "-Wl,--no-undefined"]).args(toolchain.libraries());
    output(compile, "the C++ compiler", &sources.top)?;
    fs::remove_dir_all(&generated).map_err(BuildError::io("remove", &generated))
}

/// The text of one translation unit with all C++ that Verilator has written into a folder, and `caller`, which uses it.
///
/// # Errors
/// [`BuildError::Io`] if the folder cannot be read.
pub fn one_unit(folder: &Path, caller: &str) -> Result<String, BuildError> {
    Ok(everything(&sorted_cpp(folder)?, caller))
}

/// What Verilator calls slow runs once, at the start, and is not optimised: that takes a quarter off the compiler's time. It
/// comes last, after the headers that the rest shares with it.
fn everything(files: &[PathBuf], caller: &str) -> String {
    let is_slow = |path: &&PathBuf| path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("__Slow"));
    let (slow, fast): (Vec<&PathBuf>, Vec<&PathBuf>) = files.iter().partition(is_slow);
    let include = |path: &&PathBuf| format!("#include \"{}\"", path.display());
    let mut lines: Vec<String> = fast.iter().map(include).collect();
    lines.push(caller.to_owned());
    lines.push("#pragma GCC optimize (\"O0\")".to_owned());
    lines.extend(slow.iter().map(include));
    lines.join("\n") + "\n"
}

/// Verilog to C++ in `generated`, by Verilator.
pub fn translate(
    toolchain: &Toolchain,
    sources: &RtlSources,
    folder: &Path,
    generated: &Path,
    rom_folder: &Path,
) -> Result<(), BuildError> {
    let mut rom_parameter = std::ffi::OsString::from("-GROM_DIR=\"");
    rom_parameter.push(rom_folder);
    rom_parameter.push("/\"");
    let mut command = tools::verilator()?;
    command.args(VERILATOR_FLAGS).args(["--prefix", "Vdut", "--top-module", &sources.top]);
    command.arg(rom_parameter).arg("--Mdir").arg(generated);
    match toolchain.trace {
        Trace::Off => {}
        Trace::Vcd => drop(command.arg("--trace-vcd")),
        Trace::Fst => drop(command.arg("--trace-fst")),
        Trace::Saif => drop(command.arg("--trace-saif")),
    }
    command.args(sources.verilog().map(|path| folder.join(path)));
    output(command, "Verilator", &sources.top).map(drop)
}

/// The C++ sources of a folder, in the order of their names.
pub fn sorted_cpp(folder: &Path) -> Result<Vec<PathBuf>, BuildError> {
    let entries = fs::read_dir(folder).map_err(BuildError::io("read", folder))?;
    let mut files: Vec<PathBuf> = entries
        .filter_map(Result::ok)
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "cpp"))
        .collect();
    files.sort();
    Ok(files)
}

/// Whether a program that uses zlib and LZ4 compiles and links.
pub fn fst_libraries_present() -> bool {
    let Ok(mut compiler) = tools::cxx() else {
        return false;
    };
    compiler.args(["-x", "c++", "-shared", "-fPIC", "-o", "/dev/null", "-", "-llz4", "-lz"]);
    let Ok(mut child) = compiler.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn() else {
        return false;
    };
    let written = child.stdin.take().map(|mut pipe| pipe.write_all(b"#include <lz4.h>\n#include <zlib.h>\n"));
    matches!(written, Some(Ok(()))) && child.wait().is_ok_and(|status| status.success())
}

fn cxx_version() -> Result<String, BuildError> {
    version(tools::cxx()?, "the C++ compiler", "set CXX to one that runs, such as g++")
}

/// The flags by which the installed compiler is to optimise what Verilator writes: it compiles soonest for what it simulates.
///
/// # Errors
/// [`BuildError`] if there is no compiler, or it does not run.
pub fn cxx_optimisation() -> Result<Vec<&'static str>, BuildError> {
    Ok(optimisation(&cxx_version()?).collect())
}

/// What a program says of its version, if it runs; `remedy` is for a user whose program does not.
pub fn version(mut program: Command, tool: &str, remedy: &str) -> Result<String, BuildError> {
    program.arg("--version");
    let path = PathBuf::from(program.get_program());
    said(program)?
        .map_err(|output| BuildError::Failed(format!("{tool} ({}) does not run: {output}\n{remedy}", path.display())))
}

/// Runs a command to its end; its standard output.
pub fn output(command: Command, step: &str, top: &str) -> Result<String, BuildError> {
    said(command)?.map_err(|output| BuildError::Failed(format!("{step} failed on `{top}`:\n{output}")))
}

/// A command's standard output if it succeeded, all it said if not.
fn said(mut command: Command) -> Result<Result<String, String>, BuildError> {
    let program = PathBuf::from(command.get_program());
    let result = command.stdin(Stdio::null()).output().map_err(BuildError::io("run", &program))?;
    let said = String::from_utf8_lossy(&result.stdout).into_owned();
    let complaint = String::from_utf8_lossy(&result.stderr);
    Ok(if result.status.success() {
        Ok(said)
    } else {
        let all = format!("{said}{complaint}").trim_end().to_owned();
        Err(if all.is_empty() { format!("it said nothing; {}", result.status) } else { all })
    })
}
