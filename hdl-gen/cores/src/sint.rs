//! A signed rust-hdl signal type of up to 64 bits.
//!
//! rust-hdl's own `Signed` multiplies 16 by 16 bits only and has no arithmetic shift. The operators here keep the width
//! and wrap, so that a kernel means the same in Rust as the emitted expression of equally wide operands.

use std::ops::{Add, Neg, Shl, Shr, Sub};

use rust_hdl_core::prelude::{Bits, LiteralType, Synth, TypeDescriptor, TypeKind, VCDValue, VerilogLiteral};

/// An `N`-bit two's complement number.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub(super) struct Sint<const N: usize>(i64);

impl<const N: usize> Sint<N> {
    const UNUSED: usize = 64 - N;

    fn wrap(value: i64) -> Self {
        Self((value << Self::UNUSED) >> Self::UNUSED)
    }

    /// One bit of the two's complement pattern; `N - 1` is the sign.
    pub(super) fn get_bit(self, index: usize) -> bool {
        self.0 >> index & 1 == 1
    }
}

impl<const N: usize> From<i64> for Sint<N> {
    fn from(value: i64) -> Self {
        Self::wrap(value)
    }
}

impl<const N: usize> Add for Sint<N> {
    type Output = Self;
    fn add(self, right: Self) -> Self {
        Self::wrap(self.0.wrapping_add(right.0))
    }
}

impl<const N: usize> Sub for Sint<N> {
    type Output = Self;
    fn sub(self, right: Self) -> Self {
        Self::wrap(self.0.wrapping_sub(right.0))
    }
}

impl<const N: usize> Neg for Sint<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::wrap(self.0.wrapping_neg())
    }
}

impl<const N: usize> Shl<LiteralType> for Sint<N> {
    type Output = Self;
    fn shl(self, distance: LiteralType) -> Self {
        Self::wrap(self.0.checked_shl(distance as u32).unwrap_or(0))
    }
}

impl<const N: usize, const M: usize> Shr<Bits<M>> for Sint<N> {
    type Output = Self;
    fn shr(self, distance: Bits<M>) -> Self {
        Self(self.0 >> LiteralType::from(distance).min(63))
    }
}

impl<const N: usize> Synth for Sint<N> {
    const BITS: usize = N;

    fn descriptor() -> TypeDescriptor {
        TypeDescriptor { name: format!("Sint::<{N}>"), kind: TypeKind::Signed(N) }
    }

    fn vcd(self) -> VCDValue {
        unsigned_cast(self).into()
    }

    fn verilog(self) -> VerilogLiteral {
        unsigned_cast(self).into()
    }
}

/// The bit pattern of `value`. The name is one that `hdl_gen` translates.
pub(super) fn unsigned_cast<const N: usize>(value: Sint<N>) -> Bits<N> {
    (value.0.cast_unsigned() & (u64::MAX >> Sint::<N>::UNUSED)).into()
}

/// `value` read as two's complement. The name is one that `hdl_gen` translates.
pub(super) fn signed_cast<const N: usize>(value: Bits<N>) -> Sint<N> {
    Sint::wrap(LiteralType::from(value).cast_signed())
}

/// `value` sign-extended or cut to `M` bits. The name is one that `hdl_gen` translates.
pub(super) fn signed_bit_cast<const M: usize, const N: usize>(value: Sint<N>) -> Sint<M> {
    Sint::wrap(value.0)
}
