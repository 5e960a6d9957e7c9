//! A simulated core, one clock cycle at a time.

use std::ffi::{CString, c_char, c_void};
use std::path::{Path, PathBuf};

use libloading::Library;
use thiserror::Error;

/// The side of a stream that its sender drives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Beat {
    /// `tvalid`.
    pub valid: bool,
    /// `tdata`, the first word in the lowest bits.
    pub data: u128,
    /// `tkeep`, a bit for each byte: of a stream out that has it, all bits of one that has not.
    pub keep: u16,
    /// `tlast`.
    pub last: bool,
}

/// What drives the core during one clock cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// `aresetn`: false resets.
    pub run: bool,
    /// `s_axis_tvalid`, `tdata`, `tlast`.
    pub source: Beat,
    /// `m_axis_tready`.
    pub ready: bool,
}

/// What the core shows before the rising edge that ends the cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// `s_axis_tready`.
    pub ready: bool,
    /// `m_axis_tvalid`, `tdata`, `tlast`.
    pub sink: Beat,
}

/// What drives the AXI4-Lite port of a core with a register bank during one clock cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PortInputs {
    /// `awvalid` and `awaddr`.
    pub write_address: Option<u32>,
    /// `wvalid`, `wdata` and `wstrb`.
    pub write_data: Option<(u32, u32)>,
    /// `bready`.
    pub take_response: bool,
    /// `arvalid` and `araddr`.
    pub read_address: Option<u32>,
    /// `rready`.
    pub take_data: bool,
}

/// What the AXI4-Lite port shows before the rising edge that ends the cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools, reason = "each is a wire")]
pub struct PortOutputs {
    /// `awready`.
    pub write_address_ready: bool,
    /// `wready`.
    pub write_data_ready: bool,
    /// `bvalid` and `bresp`.
    pub response: Option<u32>,
    /// `arready`.
    pub read_address_ready: bool,
    /// `rvalid`, `rdata` and `rresp`.
    pub data: Option<(u32, u32)>,
    /// The core's interrupt.
    pub interrupt: bool,
}

/// 32-bit words of the widest beat.
pub const MOST_WORDS: usize = 4;

/// Anything with the two streams of a core: the simulated RTL, or a stub in a test of the driver.
pub trait Core {
    /// 32-bit words of a beat, of either stream.
    fn words(&self) -> usize {
        1
    }

    /// One clock cycle.
    ///
    /// # Errors
    /// [`DutError::Failed`] if the simulation stopped.
    fn step(&mut self, inputs: Inputs) -> Result<Outputs, DutError>;
}

/// Why a simulated core cannot be used.
#[derive(Debug, Error)]
pub enum DutError {
    /// The shared object cannot be loaded.
    #[error("cannot load the simulation {}: {source}", .path.display())]
    Load {
        /// The shared object.
        path: PathBuf,
        /// Why not.
        source: libloading::Error,
    },
    /// `$fatal`, `$stop`, or a ROM file that is missing or longer than its ROM.
    #[error("the simulation stopped: {0}")]
    Failed(String),
    /// The design was built without tracing, or the file cannot be created.
    #[error("cannot write a trace to {}", .0.display())]
    Trace(PathBuf),
}

type New = unsafe extern "C" fn(seed: u32, text: *mut c_char, size: usize) -> *mut c_void;
type Words = unsafe extern "C" fn() -> u32;
type Step = unsafe extern "C" fn(
    dut: *mut c_void,
    inputs: u64,
    data_in: *const u32,
    data_out: *mut u32,
    text: *mut c_char,
    size: usize,
) -> u64;
type DriveControl = unsafe extern "C" fn(dut: *mut c_void, addresses: u32, data: u32, flags: u32);
type ReadControl = unsafe extern "C" fn(dut: *mut c_void) -> u64;
type Delete = unsafe extern "C" fn(dut: *mut c_void);
type OpenTrace = unsafe extern "C" fn(dut: *mut c_void, path: *const c_char, half_period: u64) -> i32;

/// The RTL as Verilator compiled it.
pub struct Dut {
    handle: *mut c_void,
    words: usize,
    step: Step,
    drive_control: DriveControl,
    read_control: ReadControl,
    delete: Delete,
    // Dropped after `delete` was called: the functions above live in it.
    library: Library,
}

const MESSAGE_SIZE: usize = 512;
const FAILED: u64 = 1 << 63;

impl Dut {
    /// Loads a shared object that [`crate::verilate`] built. See [`crate::verilate::Built::load`] for `seed`.
    ///
    /// # Errors
    /// [`DutError`] if it cannot be loaded or a ROM file cannot be read.
    pub fn load(path: &Path, seed: u32) -> Result<Self, DutError> {
        let failed = |source| DutError::Load { path: path.to_owned(), source };
        // SAFETY: the library is our own wrapper, whose functions have exactly these signatures and whose
        // initialisers touch nothing outside it.
        let (library, words, new, step, drive_control, read_control, delete) = unsafe {
            let library = Library::new(path).map_err(failed)?;
            let words: Words = *library.get(b"dut_words").map_err(failed)?;
            let new: New = *library.get(b"dut_new").map_err(failed)?;
            let step: Step = *library.get(b"dut_step").map_err(failed)?;
            let drive_control: DriveControl = *library.get(b"dut_drive_control").map_err(failed)?;
            let read_control: ReadControl = *library.get(b"dut_read_control").map_err(failed)?;
            let delete: Delete = *library.get(b"dut_delete").map_err(failed)?;
            (library, words() as usize, new, step, drive_control, read_control, delete)
        };
        let mut text = [0u8; MESSAGE_SIZE];
        // SAFETY: `text` is writable for its whole size.
        let handle = unsafe { new(seed, text.as_mut_ptr().cast(), text.len()) };
        if handle.is_null() {
            return Err(DutError::Failed(message(&text)));
        }
        Ok(Self { handle, words, step, drive_control, read_control, delete, library })
    }

    /// Drives the AXI4-Lite port from the next cycle on; no effect on a core without one.
    pub fn drive_port(&mut self, inputs: &PortInputs) {
        let addresses = inputs.write_address.unwrap_or(0) & 0xFFF | (inputs.read_address.unwrap_or(0) & 0xFFF) << 16;
        let (data, strobes) = inputs.write_data.unwrap_or((0, 0));
        let flags = u32::from(inputs.write_address.is_some())
            | u32::from(inputs.write_data.is_some()) << 1
            | u32::from(inputs.take_response) << 2
            | u32::from(inputs.read_address.is_some()) << 3
            | u32::from(inputs.take_data) << 4
            | (strobes & 0xF) << 8;
        // SAFETY: the handle is live.
        unsafe { (self.drive_control)(self.handle, addresses, data, flags) }
    }

    /// What the AXI4-Lite port showed in the last cycle; nothing on a core without one.
    pub fn port(&self) -> Option<PortOutputs> {
        // SAFETY: the handle is live.
        let word = unsafe { (self.read_control)(self.handle) };
        let bit = |position: u32| word >> position & 1 != 0;
        let pair = |position: u32| (word >> position) as u32 & 3;
        (!bit(63)).then(|| PortOutputs {
            write_address_ready: bit(32),
            write_data_ready: bit(33),
            response: bit(34).then(|| pair(40)),
            read_address_ready: bit(35),
            data: bit(36).then(|| (word as u32, pair(42))),
            interrupt: bit(37),
        })
    }

    /// Writes every signal to `path` from now on, at a clock with this half period in ps; the file is complete when the core
    /// is dropped.
    ///
    /// # Errors
    /// [`DutError::Trace`] if the design was built without tracing or the file cannot be created.
    pub fn trace(&mut self, path: &Path, half_period: u64) -> Result<(), DutError> {
        let failed = || DutError::Trace(path.to_owned());
        let name = CString::new(path.as_os_str().as_encoded_bytes()).map_err(|_| failed())?;
        // SAFETY: the signature is the wrapper's; the handle is live and the name ends with a zero.
        let opened = unsafe {
            let open: OpenTrace = *self.library.get(b"dut_trace").map_err(|_| failed())?;
            open(self.handle, name.as_ptr(), half_period)
        };
        if opened == 0 { Err(failed()) } else { Ok(()) }
    }
}

impl Core for Dut {
    fn words(&self) -> usize {
        self.words
    }

    #[inline]
    fn step(&mut self, inputs: Inputs) -> Result<Outputs, DutError> {
        let word = u64::from(inputs.source.valid) << 32
            | u64::from(inputs.source.last) << 33
            | u64::from(inputs.ready) << 34
            | u64::from(inputs.run) << 35;
        let mut text = [const { std::mem::MaybeUninit::<u8>::uninit() }; MESSAGE_SIZE];
        let data_in: [u32; MOST_WORDS] = std::array::from_fn(|place| (inputs.source.data >> (32 * place)) as u32);
        let mut data_out = [0; MOST_WORDS];
        // SAFETY: the handle is live, no beat has more than `MOST_WORDS` words, and `text` is writable for its whole size.
        let outputs = unsafe {
            let (data_in, data_out) = (data_in.as_ptr(), data_out.as_mut_ptr());
            (self.step)(self.handle, word, data_in, data_out, text.as_mut_ptr().cast(), MESSAGE_SIZE)
        };
        if outputs & FAILED != 0 {
            // SAFETY: on failure the wrapper wrote a message and its final zero; the rest is never looked at.
            let text = unsafe { std::ffi::CStr::from_ptr(text.as_ptr().cast()) };
            return Err(DutError::Failed(text.to_string_lossy().into_owned()));
        }
        let bit = |position: u32| outputs >> position & 1 != 0;
        let data = data_out.iter().rev().fold(0, |data, &word| data << 32 | u128::from(word));
        Ok(Outputs { sink: Beat { data, keep: outputs as u16, valid: bit(32), last: bit(33) }, ready: bit(34) })
    }
}

impl Drop for Dut {
    fn drop(&mut self) {
        // SAFETY: the handle came from `dut_new` of this library and is not used again.
        unsafe { (self.delete)(self.handle) }
    }
}

fn message(text: &[u8]) -> String {
    let end = text.iter().position(|&byte| byte == 0).unwrap_or(text.len());
    String::from_utf8_lossy(&text[..end]).into_owned()
}
