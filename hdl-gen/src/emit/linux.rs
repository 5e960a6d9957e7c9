//! Device-tree overlays: what Linux is to know of the block design of `vivado/`.

use tera::context;

use crate::plan::Plan;
use crate::plan::streams::WORD_BITS;

use super::boards::{Board, Processor};
use super::{EmitError, FileMap, template};

/// Bytes of a cache line, and of a descriptor of the DMA.
const LINE: usize = 64;
/// Frames on their way for which the buffer has room.
const FRAMES: usize = 32;
/// The buffer is a multiple of so many bytes.
const BUFFER_UNIT: usize = 0x1_0000;

/// Interrupts of forces received and of the core, as the interrupt controller numbers those of the fabric: the Zynq
/// UltraScale+ has 89 to 96 for `pl_ps_irq0` and 104 to 111 for `pl_ps_irq1` (UG1085), the Zynq-7000 29 and on for
/// `IRQ_F2P` (UG585).
const fn interrupts(processor: Processor, control: bool) -> (u32, u32) {
    match processor {
        Processor::ZynqUltraPsE => (104, 90),
        Processor::ProcessingSystem7 => (if control { 31 } else { 30 }, 30),
    }
}

/// Bytes for frames on their way, each with a descriptor either way, in whole lines.
fn buffer_bytes(plan: &Plan) -> usize {
    let streams = plan.streams();
    let lines = |words: usize| (words * WORD_BITS / 8).next_multiple_of(LINE);
    let frame = 2 * LINE + lines(streams.words_in()) + lines(streams.words_out);
    (FRAMES * frame).next_multiple_of(BUFFER_UNIT)
}

/// Adds an overlay for each board with the design's device.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit its data.
pub fn insert(plan: &Plan, boards: &[Board], files: &mut FileMap) -> Result<(), EmitError> {
    let (design, hardware) = (&plan.design, &plan.design.hardware);
    for board in boards.iter().filter(|board| board.has(&hardware.part)) {
        let (dma_interrupt, core_interrupt) = interrupts(board.processor, hardware.control);
        // Addresses are hexadecimal, interrupts are numbers of shared peripherals.
        let context = context! {
            name => &design.name,
            board => &board.name,
            title => &board.title,
            zynq_ultra => &(board.processor == Processor::ZynqUltraPsE),
            clock_hz => &((hardware.clock_mhz * 1e6).round() as u64),
            dma_address => &format!("{:x}", board.registers),
            core_address => &format!("{:x}", board.core_registers()),
            dma_interrupt,
            core_interrupt,
            control => &hardware.control,
            frames => &FRAMES,
            buffer_bytes => &format!("{:x}", buffer_bytes(plan)),
        };
        let path = format!("linux/{}_{}.dtso", design.name, board.name);
        let text = template::one(&path, include_str!("../../templates/linux/overlay.dtso.tera"), &context)?;
        files.insert(path, text.into_bytes());
    }
    Ok(())
}
