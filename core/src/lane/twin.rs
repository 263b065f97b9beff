//! Two points at once: what waits for one (a root, the steps of a cube root) is work for the other.
//!
//! A law is a chain of some hundred cycles on few registers; a processor looks a few hundred instructions ahead, which is
//! little more than one point. Written on twins the chains of two points stand side by side in the program.

use super::Lane;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Lanes of two points.
#[derive(Debug, Clone, Copy)]
pub struct Twin<L>(pub L, pub L);

/// Fields of two points as fields of twins.
#[inline(always)]
pub fn twins<L: Lane, const K: usize>(a: [L; K], b: [L; K]) -> [Twin<L>; K] {
    let mut out = [Twin(L::zero(), L::zero()); K];
    for k in 0..K {
        out[k] = Twin(a[k], b[k]);
    }
    out
}

/// The inverse of [`twins`].
#[inline(always)]
pub fn apart<L: Lane, const K: usize>(both: [Twin<L>; K]) -> [[L; K]; 2] {
    let mut out = [[L::zero(); K]; 2];
    for k in 0..K {
        (out[0][k], out[1][k]) = (both[k].0, both[k].1);
    }
    out
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<L: Lane> $trait for Twin<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Twin($trait::$method(self.0, other.0), $trait::$method(self.1, other.1))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<L: Lane> Neg for Twin<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Twin(-self.0, -self.1)
    }
}

impl<L: Lane> Lane for Twin<L> {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Twin(L::splat(x), L::splat(x))
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        Twin(self.0.mul_add(b.0, c.0), self.1.mul_add(b.1, c.1))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Twin(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Twin(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Twin(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn inverse_cube_root_guess(self) -> Self {
        Twin(self.0.inverse_cube_root_guess(), self.1.inverse_cube_root_guess())
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let ((m0, k0), (m1, k1)) = (self.0.split(), self.1.split());
        (Twin(m0, m1), Twin(k0, k1))
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        Twin(self.0.power_of_two(), self.1.power_of_two())
    }
    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        Twin(self.0.where_positive(yes.0, no.0), self.1.where_positive(yes.1, no.1))
    }
}
