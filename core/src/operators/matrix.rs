//! Matrices for one cell class or for the eight cells of a block, and the pool that shares them.

use crate::lane::{Coefficient, F8, LANES};
use std::collections::HashMap;
use std::hash::Hash;

/// A dense matrix, row by row; entries are `f64` (congruent cells) or [`F8`] (each lane its own).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Matrix<C> {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Entries, row by row.
    pub data: Vec<C>,
}

impl<C: Coefficient> Matrix<C> {
    /// A matrix from its entries, row by row.
    pub fn new(rows: usize, columns: usize, data: Vec<C>) -> Self {
        debug_assert_eq!(data.len(), rows * columns);
        Self { rows, columns, data }
    }

    /// A row.
    #[inline(always)]
    pub fn row(&self, r: usize) -> &[C] {
        &self.data[r * self.columns..(r + 1) * self.columns]
    }
}

impl Matrix<f64> {
    /// The product with another, which has as many rows as this has columns.
    pub fn times(&self, other: &Self) -> Self {
        let entry = |r: usize, c: usize| (0..self.columns).map(|k| self.row(r)[k] * other.row(k)[c]).sum();
        let data = (0..self.rows).flat_map(|r| (0..other.columns).map(move |c| (r, c)));
        Self::new(self.rows, other.columns, data.map(|(r, c)| entry(r, c)).collect())
    }

    /// The Kronecker product: entry (i R + j, k C + l) is self(i, k) other(j, l), R x C the shape of the other.
    pub fn kron(&self, other: &Self) -> Self {
        let (rows, columns) = (self.rows * other.rows, self.columns * other.columns);
        let entry = |r: usize, c: usize| {
            self.row(r / other.rows)[c / other.columns] * other.row(r % other.rows)[c % other.columns]
        };
        let data = (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c)));
        Self::new(rows, columns, data.map(|(r, c)| entry(r, c)).collect())
    }
}

impl Matrix<F8> {
    /// One matrix per lane; all have the same shape.
    pub fn interleave(lanes: [&Matrix<f64>; LANES]) -> Self {
        let first = lanes[0];
        let data = (0..first.data.len()).map(|e| F8(lanes.map(|lane| lane.data[e]))).collect();
        Self { rows: first.rows, columns: first.columns, data }
    }
}

/// The place of the matrix that a block uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Share {
    /// All its cells are congruent: entry of [`Pool::shared`].
    Shared(usize),
    /// Its cells differ: entry of [`Pool::own`].
    Own(usize),
}

/// Matrices of all blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Pool<S, O> {
    /// For each block the place of its matrix.
    pub share: Vec<Share>,
    /// One matrix for each class of congruent cells.
    pub shared: Vec<S>,
    /// One matrix for each block of different cells.
    pub own: Vec<O>,
}

/// Numbers the classes of cells by a key that congruent cells share: (class of each cell, a cell of each class).
pub fn classes<K: Hash + Eq>(cells: usize, key: impl Fn(usize) -> K) -> (Vec<usize>, Vec<usize>) {
    let mut numbers = HashMap::new();
    let mut examples = Vec::new();
    let class = (0..cells)
        .map(|cell| {
            *numbers.entry(key(cell)).or_insert_with(|| {
                examples.push(cell);
                examples.len() - 1
            })
        })
        .collect();
    (class, examples)
}

/// Those of the classes of eight lanes; none where one is not there.
fn lanes_of<S>(all: &[Option<S>], classes: [usize; LANES]) -> Option<[&S; LANES]> {
    let mut out = [all[classes[0]].as_ref()?; LANES];
    for (out, class) in out.iter_mut().zip(classes) {
        *out = all[class].as_ref()?;
    }
    Some(out)
}

impl<S, O> Pool<S, O> {
    /// The same for blocks in another order: place k has block `order[k]`.
    pub(super) fn in_order(self, order: &[usize]) -> Self {
        Self { share: order.iter().map(|&block| self.share[block]).collect(), ..self }
    }

    /// Shares `build(class)` among blocks of one class, `interleave`s the classes of the others. What is in no further block is dropped
    /// on the way, so that matrices of single cells are not held twice.
    pub fn new(blocks: &[[usize; LANES]], class: &[usize], all: Vec<S>, interleave: impl Fn([&S; LANES]) -> O) -> Self {
        let mut all: Vec<Option<S>> = all.into_iter().map(Some).collect();
        let (mut share, mut own, mut used) = (Vec::new(), Vec::new(), vec![false; all.len()]);
        let is_one_class = |cells: &[usize; LANES]| cells.iter().all(|&cell| class[cell] == class[cells[0]]);
        // Lanes of mixed blocks that are still to come.
        let mut left = vec![0_usize; all.len()];
        for cells in blocks {
            match is_one_class(cells) {
                true => used[class[cells[0]]] = true,
                false => cells.iter().for_each(|&cell| left[class[cell]] += 1),
            }
        }
        for cells in blocks {
            if is_one_class(cells) {
                share.push(Share::Shared(class[cells[0]]));
                continue;
            }
            share.push(Share::Own(own.len()));
            own.extend(lanes_of(&all, cells.map(|cell| class[cell])).map(&interleave));
            for class in cells.map(|cell| class[cell]) {
                left[class] -= 1;
                if left[class] == 0 && !used[class] {
                    all[class] = None;
                }
            }
        }
        // A class that occurs only in mixed blocks needs no matrix of its own.
        let mut number = vec![0; all.len()];
        let mut shared = Vec::new();
        for (class, matrices) in all.into_iter().enumerate().filter(|(class, _)| used[*class]) {
            number[class] = shared.len();
            shared.extend(matrices);
        }
        for entry in &mut share {
            if let Share::Shared(class) = entry {
                *class = number[*class];
            }
        }
        Self { share, shared, own }
    }
}
