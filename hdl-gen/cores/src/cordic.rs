//! Vectoring CORDIC: magnitude and angle of a vector, one iteration a cycle.

use hdl_gen::cores::cordic::{ARC_TANGENTS, ITERATIONS, QUARTER_TURN};
use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment, dff_setup};
use crate::sint::{Sint, signed_bit_cast, signed_cast, unsigned_cast};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock)]
struct Cordic {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    start: Signal<In, Bit>,
    x: Signal<In, Sint<32>>,
    y: Signal<In, Sint<32>>,
    magnitude: Signal<Out, Bits<34>>,
    angle: Signal<Out, Sint<32>>,
    done: Signal<Out, Bit>,
    rotating: Register<Bit>,
    shifted: Register<Bit>,
    rounding: Register<Bit>,
    finished: Register<Bit>,
    iteration: Register<Bits<5>>,
    origin: Register<Bit>,
    along: Register<Sint<39>>,
    across: Register<Sint<39>>,
    turned: Register<Sint<37>>,
    along_part: Register<Sint<39>>,
    across_part: Register<Sint<39>>,
    arc_tangent: Register<Sint<37>>,
    magnitude_out: Register<Bits<34>>,
    angle_out: Register<Sint<32>>,
    x_wide: Signal<Local, Sint<39>>,
    y_wide: Signal<Local, Sint<39>>,
    along_rounded: Signal<Local, Sint<39>>,
    turned_rounded: Signal<Local, Sint<37>>,
    along_bits: Signal<Local, Bits<39>>,
    turned_bits: Signal<Local, Bits<37>>,
    angle_bits: Signal<Local, Bits<32>>,
    quarter_turn: Constant<Sint<37>>,
    arc_tangents: [Constant<Sint<37>>; ITERATIONS as usize],
}

impl Default for Cordic {
    fn default() -> Self {
        Self {
            clock: Signal::default(),
            reset: Signal::default(),
            start: Signal::default(),
            x: Signal::default(),
            y: Signal::default(),
            magnitude: Signal::default(),
            angle: Signal::default(),
            done: Signal::default(),
            rotating: Register::default(),
            shifted: Register::default(),
            rounding: Register::default(),
            finished: Register::default(),
            iteration: Register::default(),
            origin: Register::default(),
            along: Register::default(),
            across: Register::default(),
            turned: Register::default(),
            along_part: Register::default(),
            across_part: Register::default(),
            arc_tangent: Register::default(),
            magnitude_out: Register::default(),
            angle_out: Register::default(),
            x_wide: Signal::default(),
            y_wide: Signal::default(),
            along_rounded: Signal::default(),
            turned_rounded: Signal::default(),
            along_bits: Signal::default(),
            turned_bits: Signal::default(),
            angle_bits: Signal::default(),
            quarter_turn: Constant::new(QUARTER_TURN.into()),
            arc_tangents: ARC_TANGENTS.map(|entry| Constant::new(entry.into())),
        }
    }
}

impl Logic for Cordic {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, rotating, iteration, origin, along, across, turned, magnitude_out, angle_out);
        clock!(self, clock, shifted, rounding, finished, along_part, across_part, arc_tangent);
        self.shifted.d.next = self.rotating.q.val() & !self.shifted.q.val();
        self.rounding.d.next = false;
        self.finished.d.next = self.rounding.q.val();

        comment!("a micro-rotation, first cycle: the angle and the part of each component that moves to the other");
        self.along_part.d.next = self.along.q.val() >> self.iteration.q.val();
        self.across_part.d.next = self.across.q.val() >> self.iteration.q.val();
        match self.iteration.q.val().index() {
            0 => self.arc_tangent.d.next = self.arc_tangents[0].val(),
            1 => self.arc_tangent.d.next = self.arc_tangents[1].val(),
            2 => self.arc_tangent.d.next = self.arc_tangents[2].val(),
            3 => self.arc_tangent.d.next = self.arc_tangents[3].val(),
            4 => self.arc_tangent.d.next = self.arc_tangents[4].val(),
            5 => self.arc_tangent.d.next = self.arc_tangents[5].val(),
            6 => self.arc_tangent.d.next = self.arc_tangents[6].val(),
            7 => self.arc_tangent.d.next = self.arc_tangents[7].val(),
            8 => self.arc_tangent.d.next = self.arc_tangents[8].val(),
            9 => self.arc_tangent.d.next = self.arc_tangents[9].val(),
            10 => self.arc_tangent.d.next = self.arc_tangents[10].val(),
            11 => self.arc_tangent.d.next = self.arc_tangents[11].val(),
            12 => self.arc_tangent.d.next = self.arc_tangents[12].val(),
            13 => self.arc_tangent.d.next = self.arc_tangents[13].val(),
            14 => self.arc_tangent.d.next = self.arc_tangents[14].val(),
            15 => self.arc_tangent.d.next = self.arc_tangents[15].val(),
            16 => self.arc_tangent.d.next = self.arc_tangents[16].val(),
            17 => self.arc_tangent.d.next = self.arc_tangents[17].val(),
            18 => self.arc_tangent.d.next = self.arc_tangents[18].val(),
            19 => self.arc_tangent.d.next = self.arc_tangents[19].val(),
            20 => self.arc_tangent.d.next = self.arc_tangents[20].val(),
            21 => self.arc_tangent.d.next = self.arc_tangents[21].val(),
            22 => self.arc_tangent.d.next = self.arc_tangents[22].val(),
            23 => self.arc_tangent.d.next = self.arc_tangents[23].val(),
            24 => self.arc_tangent.d.next = self.arc_tangents[24].val(),
            25 => self.arc_tangent.d.next = self.arc_tangents[25].val(),
            26 => self.arc_tangent.d.next = self.arc_tangents[26].val(),
            27 => self.arc_tangent.d.next = self.arc_tangents[27].val(),
            28 => self.arc_tangent.d.next = self.arc_tangents[28].val(),
            _ => self.arc_tangent.d.next = self.arc_tangents[29].val(),
        }

        comment!("components with guard bits");
        self.x_wide.next = signed_bit_cast::<39, 32>(self.x.val()) << 5;
        self.y_wide.next = signed_bit_cast::<39, 32>(self.y.val()) << 5;

        comment!("a micro-rotation, second cycle: towards angle 0");
        comment!("at the start a vector in the left half plane turns by a quarter: the rest reaches 1.74 rad");
        if self.rotating.q.val() & self.shifted.q.val() {
            if self.across.q.val().get_bit(38) {
                self.along.d.next = self.along.q.val() - self.across_part.q.val();
                self.across.d.next = self.across.q.val() + self.along_part.q.val();
                self.turned.d.next = self.turned.q.val() - self.arc_tangent.q.val();
            } else {
                self.along.d.next = self.along.q.val() + self.across_part.q.val();
                self.across.d.next = self.across.q.val() - self.along_part.q.val();
                self.turned.d.next = self.turned.q.val() + self.arc_tangent.q.val();
            }
            self.iteration.d.next = self.iteration.q.val() + 1;
            if self.iteration.q.val() == 29 {
                self.rotating.d.next = false;
                self.rounding.d.next = true;
            }
        } else if self.start.val() & !self.rotating.q.val() & !self.rounding.q.val() {
            if !self.x.val().get_bit(31) {
                self.along.d.next = self.x_wide.val();
                self.across.d.next = self.y_wide.val();
                self.turned.d.next = 0.into();
            } else if !self.y.val().get_bit(31) {
                self.along.d.next = self.y_wide.val();
                self.across.d.next = -self.x_wide.val();
                self.turned.d.next = self.quarter_turn.val();
            } else {
                self.along.d.next = -self.y_wide.val();
                self.across.d.next = self.x_wide.val();
                self.turned.d.next = -self.quarter_turn.val();
            }
            self.origin.d.next = (self.x.val() == 0.into()) & (self.y.val() == 0.into());
            self.iteration.d.next = 0.into();
            self.rotating.d.next = true;
        }

        comment!("round the guard bits away");
        self.along_rounded.next = self.along.q.val() + 16.into();
        self.turned_rounded.next = self.turned.q.val() + 16.into();
        self.along_bits.next = unsigned_cast(self.along_rounded.val());
        self.turned_bits.next = unsigned_cast(self.turned_rounded.val());
        self.angle_bits.next = self.turned_bits.val().get_bits::<32>(5);
        if self.rounding.q.val() {
            self.magnitude_out.d.next = self.along_bits.val().get_bits::<34>(5);
            self.angle_out.d.next = signed_cast(self.angle_bits.val());
            if self.origin.q.val() {
                self.angle_out.d.next = 0.into();
            }
        }

        comment!("reset ends what is under way");
        if self.reset.val() {
            self.rotating.d.next = false;
            self.rounding.d.next = false;
            self.finished.d.next = false;
        }
        self.magnitude.next = self.magnitude_out.q.val();
        self.angle.next = self.angle_out.q.val();
        self.done.next = self.finished.q.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "common/sptfra_cordic.v",
    banner: "\
Vectoring CORDIC: magnitude (34 bits) and angle (32 bits) of (x, y), components within +-2^30.

30 micro-rotations, two cycles each. A start in cycle 0 gives done for one cycle in cycle 62. A new start is taken
from then on. The angle is atan2(y, x) in radians with 29 fraction bits. The magnitude is the length
times 1.6467602581210654 (the CORDIC gain), in units of x and y. For max(|x|, |y|) >= 2^29 the angle is within
2^-26 rad and the magnitude within 2^-26 of itself; (0, 0) gives zeros.",
    ports: &[
        ("clock", "rising edge"),
        ("reset", "synchronous, high: gives up the conversion under way"),
        ("start", "takes the operands; ignored while a conversion is under way"),
        ("x", "component along angle 0"),
        ("y", "component along angle pi/2"),
        ("magnitude", "valid from done until the next done"),
        ("angle", "valid from done until the next done"),
        ("done", "high for one cycle, 62 cycles after start"),
    ],
    unused: &["along_bits", "turned_bits"],
};

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(Cordic::default(), &DESCRIPTION)
}
