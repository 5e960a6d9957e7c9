//! The processor's side of AXI4-Lite: one write and one read at a time, each channel with pauses of its own.

use std::collections::VecDeque;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::dut::{PortInputs, PortOutputs};

/// Longest pause before a channel moves, in cycles. Half of all pauses are none.
const LONGEST_PAUSE: u32 = 6;

/// What to ask of the bank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Reads a word.
    Read {
        /// Byte address.
        address: u32,
    },
    /// Writes the bytes of a word whose strobes are set.
    Write {
        /// Byte address.
        address: u32,
        /// The word.
        data: u32,
        /// One bit for each byte, the lowest first.
        strobes: u32,
    },
}

/// What came of an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reply {
    /// The access.
    pub access: Access,
    /// What was read.
    pub data: u32,
    /// When the reply was taken.
    pub cycle: u64,
}

/// A request under way. The address and the data of a write wait for themselves, so that either may come first.
#[derive(Clone, Copy, Debug)]
struct Request {
    access: Access,
    /// Pauses left: address, data, reply.
    pauses: [u32; 3],
    address_taken: bool,
    data_taken: bool,
}

/// A master that drives one port.
pub struct Master {
    random: ChaCha8Rng,
    write: Option<Request>,
    read: Option<Request>,
    writes: VecDeque<Access>,
    reads: VecDeque<Access>,
    driven: PortInputs,
    waiting_response: Option<u32>,
    waiting_data: Option<(u32, u32)>,
    replies: Vec<Reply>,
}

impl Master {
    /// With pauses drawn from `seed`.
    pub fn new(seed: u64) -> Self {
        Self {
            random: ChaCha8Rng::seed_from_u64(seed),
            write: None,
            read: None,
            writes: VecDeque::new(),
            reads: VecDeque::new(),
            driven: PortInputs::default(),
            waiting_response: None,
            waiting_data: None,
            replies: Vec::new(),
        }
    }

    /// Asks for an access: writes follow each other, so do reads, and both go on at the same time.
    pub fn begin(&mut self, access: Access) {
        match access {
            Access::Read { .. } => self.reads.push_back(access),
            Access::Write { .. } => self.writes.push_back(access),
        }
    }

    /// Whether an access of this kind would begin at once.
    pub fn is_free(&self, access: &Access) -> bool {
        match access {
            Access::Read { .. } => self.read.is_none() && self.reads.is_empty(),
            Access::Write { .. } => self.write.is_none() && self.writes.is_empty(),
        }
    }

    /// The replies so far; they are forgotten here.
    pub fn take_replies(&mut self) -> Vec<Reply> {
        std::mem::take(&mut self.replies)
    }

    fn request(&mut self, access: Access) -> Request {
        let mut pause = || {
            if self.random.random_bool(0.5) { 0 } else { self.random.random_range(1..=LONGEST_PAUSE) }
        };
        let pauses = [pause(), pause(), pause()];
        Request { access, pauses, address_taken: false, data_taken: false }
    }

    /// What drives the port in the next cycle; in reset nothing does, and what was under way is forgotten.
    pub fn drive(&mut self, run: bool) -> PortInputs {
        self.driven = PortInputs::default();
        if !run {
            (self.write, self.read) = (None, None);
            (self.waiting_response, self.waiting_data) = (None, None);
            return self.driven;
        }
        if self.write.is_none()
            && let Some(access) = self.writes.pop_front()
        {
            self.write = Some(self.request(access));
        }
        if self.read.is_none()
            && let Some(access) = self.reads.pop_front()
        {
            self.read = Some(self.request(access));
        }
        // A pause is over when it has run down; from then on the channel stays willing.
        let passed = |pause: &mut u32| {
            let over = *pause == 0;
            *pause = pause.saturating_sub(1);
            over
        };
        if let Some(request) = &mut self.write
            && let Access::Write { address, data, strobes } = request.access
        {
            let [for_address, for_data, for_reply] = &mut request.pauses;
            self.driven.write_address = (!request.address_taken && passed(for_address)).then_some(address);
            self.driven.write_data = (!request.data_taken && passed(for_data)).then_some((data, strobes));
            self.driven.take_response = request.address_taken && request.data_taken && passed(for_reply);
        }
        if let Some(request) = &mut self.read
            && let Access::Read { address } = request.access
        {
            let [for_address, _, for_reply] = &mut request.pauses;
            self.driven.read_address = (!request.address_taken && passed(for_address)).then_some(address);
            self.driven.take_data = request.address_taken && passed(for_reply);
        }
        self.driven
    }

    /// What the port showed while driven so.
    ///
    /// # Errors
    /// The first broken rule of AXI4-Lite.
    pub fn watch(&mut self, cycle: u64, port: &PortOutputs) -> Result<(), String> {
        if self.waiting_response.is_some() && port.response != self.waiting_response
            || self.waiting_data.is_some() && port.data != self.waiting_data
        {
            return Err(format!("cycle {cycle}: a reply on s_axi_ctrl was withdrawn or changed before it was taken"));
        }
        let asked = |request: &Option<Request>, data: bool| {
            request.is_some_and(|request| request.address_taken && (request.data_taken || !data))
        };
        if port.response.is_some() && !asked(&self.write, true) || port.data.is_some() && !asked(&self.read, false) {
            return Err(format!("cycle {cycle}: s_axi_ctrl replies to what was not asked"));
        }
        for response in [port.response, port.data.map(|(_, response)| response)].into_iter().flatten() {
            if response != 0 {
                return Err(format!("cycle {cycle}: response {response} on s_axi_ctrl, expected 0 (OKAY)"));
            }
        }
        (self.waiting_response, self.waiting_data) = (port.response, port.data);
        if let (Some(request), Some(_), true) = (self.write, port.response, self.driven.take_response) {
            self.replies.push(Reply { access: request.access, data: 0, cycle });
            (self.write, self.waiting_response) = (None, None);
        }
        if let (Some(request), Some((data, _)), true) = (self.read, port.data, self.driven.take_data) {
            self.replies.push(Reply { access: request.access, data, cycle });
            (self.read, self.waiting_data) = (None, None);
        }
        if let Some(request) = &mut self.write {
            request.address_taken |= self.driven.write_address.is_some() && port.write_address_ready;
            request.data_taken |= self.driven.write_data.is_some() && port.write_data_ready;
        }
        if let Some(request) = &mut self.read {
            request.address_taken |= self.driven.read_address.is_some() && port.read_address_ready;
        }
        Ok(())
    }
}
