//! The register that every core is built from.

use rust_hdl_core::prelude::*;

/// What a register emits; the emitter recognises a register by it.
pub(super) const REGISTER_BODY: &str = "always @(posedge clock) q <= d;";

/// `q` follows `d` at the rising edge of `clock`. No reset and no initial value: a kernel writes its reset as logic,
/// and only where control state needs one.
#[derive(LogicBlock)]
pub(super) struct Register<T: Synth> {
    pub(super) clock: Signal<In, Clock>,
    pub(super) d: Signal<In, T>,
    pub(super) q: Signal<Out, T>,
}

impl<T: Synth> Default for Register<T> {
    fn default() -> Self {
        Self { clock: Signal::default(), d: Signal::default(), q: Signal::default() }
    }
}

impl<T: Synth> Logic for Register<T> {
    fn update(&mut self) {
        if self.clock.pos_edge() {
            self.q.next = self.d.val();
        }
    }

    fn connect(&mut self) {
        self.q.connect();
    }

    fn hdl(&self) -> Verilog {
        Verilog::Custom(REGISTER_BODY.to_owned())
    }
}

/// Clocks the named registers and lets them hold, unless a later statement of the kernel gives them another value.
/// `hdl_gen` translates it by its name.
macro_rules! dff_setup {
    ($self: ident, $clock: ident, $($register: ident),+) => {
        $($self.$register.clock.next = $self.$clock.val();)+
        $($self.$register.d.next = $self.$register.q.val();)+
    }
}

/// A comment of the kernel that goes into the emitted text. `hdl_gen` translates it by its name.
macro_rules! comment {
    ($text: literal) => {};
}

pub(super) use {comment, dff_setup};
