//! The AXI-Stream skid buffer: cuts every combinational path of a stream, both ways, at full throughput.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment, dff_setup};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct AxisSkid {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    s_tdata: Signal<In, Bits<32>>,
    s_tlast: Signal<In, Bit>,
    s_tvalid: Signal<In, Bit>,
    s_tready: Signal<Out, Bit>,
    m_tdata: Signal<Out, Bits<32>>,
    m_tlast: Signal<Out, Bit>,
    m_tvalid: Signal<Out, Bit>,
    m_tready: Signal<In, Bit>,
    ready: Register<Bit>,
    valid: Register<Bit>,
    data: Register<Bits<32>>,
    last: Register<Bit>,
    spare_full: Register<Bit>,
    spare_data: Register<Bits<32>>,
    spare_last: Register<Bit>,
    taken: Signal<Local, Bit>,
    blocked: Signal<Local, Bit>,
    spare_needed: Signal<Local, Bit>,
}

impl Logic for AxisSkid {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, valid, data, last, spare_data, spare_last);
        clock!(self, clock, ready, spare_full);
        self.taken.next = self.s_tvalid.val() & self.ready.q.val();
        self.blocked.next = self.valid.q.val() & !self.m_tready.val();

        comment!("the output register takes the spare word first; nothing is taken in while there is one");
        if !self.blocked.val() {
            self.valid.d.next = self.spare_full.q.val() | self.taken.val();
            if self.spare_full.q.val() {
                self.data.d.next = self.spare_data.q.val();
                self.last.d.next = self.spare_last.q.val();
            } else {
                self.data.d.next = self.s_tdata.val();
                self.last.d.next = self.s_tlast.val();
            }
        }

        comment!("a word that arrives while the output is blocked becomes the spare word");
        self.spare_needed.next = self.blocked.val() & (self.spare_full.q.val() | self.taken.val());
        if self.ready.q.val() {
            self.spare_data.d.next = self.s_tdata.val();
            self.spare_last.d.next = self.s_tlast.val();
        }

        comment!("nothing is offered or taken in reset");
        if self.reset.val() {
            self.valid.d.next = false;
        }
        self.spare_full.d.next = self.spare_needed.val() & !self.reset.val();
        self.ready.d.next = !(self.spare_needed.val() | self.reset.val());
        self.s_tready.next = self.ready.q.val();
        self.m_tdata.next = self.data.q.val();
        self.m_tlast.next = self.last.q.val();
        self.m_tvalid.next = self.valid.q.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "axis/sptfra_axis_skid.v",
    banner: "\
AXI-Stream skid buffer: a register in every wire of a stream, tready included.

Latency 1 cycle, one word of 32 bits a cycle, two words of storage. Both tvalid and tready are low from the
first clock edge in reset; tready rises one cycle after reset ends.",
    ports: &[
        ("clock", "rising edge"),
        ("reset", "synchronous, high: drops what is stored"),
        ("s_tdata", "word in"),
        ("s_tlast", "last word of its frame, in"),
        ("s_tvalid", "a word is offered"),
        ("s_tready", "a word offered now is taken"),
        ("m_tdata", "word out; with tlast stable while tvalid waits for tready"),
        ("m_tlast", "last word of its frame, out"),
        ("m_tvalid", "a word is offered"),
        ("m_tready", "the word offered now is taken"),
    ],
    unused: &[],
};

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(AxisSkid::default(), &DESCRIPTION)
}
