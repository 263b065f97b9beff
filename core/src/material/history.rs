//! The history of a point: what a law with memory keeps from step to step, declared once.

use super::Material;
use crate::lane::Lane;

/// What kind of quantity a variable is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rank {
    /// One number.
    Scalar,
    /// A symmetric tensor of the plane and its 33 component: suffixes `_11`, `_22`, `_12`, `_33` in any order.
    SymmetricTensor,
}

/// A variable of a history. Fields, columns and files take names, order and virgin values from here.
#[derive(Debug, PartialEq)]
pub struct Variable {
    /// Its name in outputs.
    pub name: &'static str,
    /// What it is, in a line, with its unit.
    pub about: &'static str,
    /// What kind of quantity it is.
    pub rank: Rank,
    /// Suffix of the name and value in virgin material of each of its numbers, in the order in which they are kept.
    pub numbers: &'static [(&'static str, f64)],
}

/// K numbers of a lane each, kept in registers: `[L; K]`.
pub trait Numbers<L: Lane>: Copy {
    /// K.
    const COUNT: usize;

    /// All the same.
    fn splat(x: L) -> Self;

    /// In their order.
    fn slice(&self) -> &[L];

    /// In their order.
    fn slice_mut(&mut self) -> &mut [L];
}

impl<L: Lane, const K: usize> Numbers<L> for [L; K] {
    const COUNT: usize = K;

    #[inline(always)]
    fn splat(x: L) -> Self {
        [x; K]
    }

    #[inline(always)]
    fn slice(&self) -> &[L] {
        self
    }

    #[inline(always)]
    fn slice_mut(&mut self) -> &mut [L] {
        self
    }
}

/// What a law is integrated from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Past<H> {
    /// The history at t_n; after [`Material::stress`] that at F.
    pub history: H,
    /// The time since t_n, s; 0 where the history is already that at F.
    pub dt: f64,
}

impl<H> Past<H> {
    /// A history that is already that at F.
    #[inline(always)]
    pub fn now(history: H) -> Self {
        Self { history, dt: 0.0 }
    }
}

/// Numbers of the history of a law; 0 for an elastic one.
#[inline(always)]
pub const fn count<M: Material>() -> usize {
    <M::History<f64> as Numbers<f64>>::COUNT
}

/// The history of virgin material.
#[inline(always)]
pub fn virgin<L: Lane, M: Material>() -> M::History<L> {
    let mut out = M::History::<L>::splat(L::zero());
    let mut numbers = out.slice_mut().iter_mut();
    for variable in M::HISTORY {
        for (out, (_, value)) in numbers.by_ref().zip(variable.numbers) {
            *out = L::splat(*value);
        }
    }
    out
}

/// Whether the declared variables have as many numbers as a history: looked at when a law is compiled.
pub(crate) const fn is_declared_whole<M: Material>() -> bool {
    let (mut numbers, mut k) = (0, 0);
    while k < M::HISTORY.len() {
        numbers += M::HISTORY[k].numbers.len();
        k += 1;
    }
    numbers == count::<M>()
}
