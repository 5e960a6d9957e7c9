//! The register bank of a simulated core, driven as a processor would drive it: AXI4-Lite with pauses, beside the
//! streams.

mod check;
mod master;

use std::collections::VecDeque;

pub use check::{RegisterReport, check};
pub use master::{Access, Master, Reply};

use crate::dut::{Core, Dut, DutError, Inputs, Outputs};

/// Byte addresses, as in `control/NAME.rdl`, of what is used here.
#[allow(missing_docs, reason = "the register map says what each is")]
pub mod address {
    pub const IDENTITY: u32 = 0x000;
    pub const VERSION: u32 = 0x004;
    pub const HASH_LOW: u32 = 0x008;
    pub const HASH_HIGH: u32 = 0x00C;
    pub const GEOMETRY: u32 = 0x010;
    pub const FRAME: u32 = 0x014;
    pub const FEATURES: u32 = 0x018;
    pub const CLOCK: u32 = 0x01C;
    pub const FULL_SCALE: u32 = 0x020;
    pub const PREDICTED_LATENCY: u32 = 0x024;
    pub const PREDICTED_INTERVAL: u32 = 0x028;
    pub const CONTROL: u32 = 0x040;
    pub const STATUS: u32 = 0x044;
    pub const INTERRUPT_ENABLE: u32 = 0x048;
    pub const INTERRUPT_STATUS: u32 = 0x04C;
    pub const FRAMES_IN: u32 = 0x050;
    pub const FRAMES_OUT: u32 = 0x054;
    pub const FRAMES_BAD: u32 = 0x058;
    pub const LAST_STATUS: u32 = 0x05C;
    pub const LAST_LATENCY: u32 = 0x060;
    pub const LAST_INTERVAL: u32 = 0x064;
    pub const FRAMES_DROPPED: u32 = 0x068;
    pub const SMOOTHING: u32 = 0x06C;
    pub const CALIBRATION: u32 = 0x080;
    pub const CALIBRATION_INDEX: u32 = 0x090;
    pub const CALIBRATION_DATA: u32 = 0x094;
    pub const CALIBRATION_COMMIT: u32 = 0x098;
    pub const TARE: u32 = 0x09C;
    pub const CALIBRATION_STATUS: u32 = 0x0A0;
    pub const CALIBRATION_ERRORS: u32 = 0x0A4;
    pub const CALIBRATION_CRC: u32 = 0x0A8;
    pub const CALIBRATION_CURVE: u32 = 0x0AC;
}

/// Cycles after which an access that has no reply never gets one.
const PATIENCE: u64 = 1000;

/// A simulated core with a master on its register port; its streams are driven as those of any [`Core`].
pub struct Controlled {
    dut: Dut,
    master: Master,
    /// Accesses for later: the cycle from which on each may begin.
    planned: VecDeque<(u64, Access)>,
    cycle: u64,
    /// Cycles in which the interrupt was high.
    interrupts: u64,
    interrupt: bool,
}

impl Controlled {
    /// Around a core before its first clock edge; `seed` decides the pauses on the register port.
    ///
    /// # Errors
    /// [`DutError::Failed`] if the core has no register port.
    pub fn new(dut: Dut, seed: u64) -> Result<Self, DutError> {
        let mut controlled = Self {
            dut,
            master: Master::new(seed),
            planned: VecDeque::new(),
            cycle: 0,
            interrupts: 0,
            interrupt: false,
        };
        controlled.step(Inputs::default())?;
        Ok(controlled)
    }

    /// Plans an access that begins in this cycle of the simulation or as soon as the ones planned before have begun.
    pub fn plan(&mut self, cycle: u64, access: Access) {
        self.planned.push_back((cycle, access));
    }

    /// The replies since they were asked for last, in the order of their arrival.
    pub fn replies(&mut self) -> Vec<Reply> {
        self.master.take_replies()
    }

    /// Cycles simulated.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Whether the interrupt was high in the last cycle.
    pub fn interrupt(&self) -> bool {
        self.interrupt
    }

    /// Cycles in which the interrupt was high.
    pub fn interrupts(&self) -> u64 {
        self.interrupts
    }

    /// One access with both streams at rest, out of reset; the replies of others that end meanwhile are dropped.
    ///
    /// # Errors
    /// [`DutError::Failed`] if the port breaks a rule or gives no reply.
    pub fn access(&mut self, access: Access) -> Result<Reply, DutError> {
        self.master.begin(access);
        self.replies();
        for _ in 0..PATIENCE {
            self.step(Inputs { run: true, ..Inputs::default() })?;
            if let Some(reply) = self.replies().into_iter().find(|reply| reply.access == access) {
                return Ok(reply);
            }
        }
        Err(DutError::Failed(format!("{access:?} has no reply after {PATIENCE} cycles")))
    }

    /// Reads a register, both streams at rest.
    ///
    /// # Errors
    /// As [`Controlled::access`].
    pub fn read(&mut self, address: u32) -> Result<u32, DutError> {
        self.access(Access::Read { address }).map(|reply| reply.data)
    }

    /// Writes a whole register, both streams at rest.
    ///
    /// # Errors
    /// As [`Controlled::access`].
    pub fn write(&mut self, address: u32, data: u32) -> Result<(), DutError> {
        self.access(Access::Write { address, data, strobes: 0xF }).map(drop)
    }
}

impl Core for Controlled {
    fn words(&self) -> usize {
        self.dut.words()
    }

    fn step(&mut self, inputs: Inputs) -> Result<Outputs, DutError> {
        if self.planned.front().is_some_and(|&(cycle, access)| cycle <= self.cycle && self.master.is_free(&access))
            && let Some((_, access)) = self.planned.pop_front()
        {
            self.master.begin(access);
        }
        self.dut.drive_port(&self.master.drive(inputs.run));
        let outputs = self.dut.step(inputs)?;
        let Some(port) = self.dut.port() else {
            return Err(DutError::Failed("the core has no register port; set hardware.control".to_owned()));
        };
        // Registers are not reset before the first edge, so nothing that is seen in reset counts.
        if inputs.run {
            self.master.watch(self.cycle, &port).map_err(DutError::Failed)?;
            self.interrupt = port.interrupt;
            self.interrupts += u64::from(port.interrupt);
        }
        self.cycle += 1;
        Ok(outputs)
    }
}
