//! The matrices that are worth storing, and their flat form for a file.

use super::curl_free::CurlPool;
use super::points::PointPool;
use super::{Blocks, CurlFree, Line, Matrix, Needs, PointMatrices, Points, Pool, Share};
use crate::error::Error;
use crate::lane::{Coefficient, F8, LANES, as_f64};
use crate::mesh::Mesh;
use std::ops::Range;

/// The results of all decompositions. Everything else in the operators is quickly computed from the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Stored {
    /// Matrices of the points, where the method has a predictor.
    pub points: Option<PointPool>,
    /// Complements of the gradients, where the curl is controlled.
    pub curl_free: Option<CurlPool>,
}

impl Stored {
    /// Builds what `needs` asks for.
    ///
    /// # Errors
    /// A cell whose points cannot carry Q_N.
    pub fn build(mesh: &Mesh, blocks: &Blocks, line: &Line, needs: &Needs) -> Result<Self, Error> {
        let points = needs.sampling.map(|s| Points::matrices(mesh, blocks, line, s)).transpose()?;
        let curl_free = needs.curl_free.then(|| CurlFree::matrices(mesh, blocks, line));
        Ok(Self { points, curl_free })
    }
}

/// Matrices that are stored together. One number, the size, determines their kind and all their shapes.
pub trait Bundle<C: Coefficient>: Sized {
    /// The size.
    fn size(&self) -> usize;
    /// Shapes (rows, columns) for a size and n nodes a cell, in the order of storage.
    /// `None` if no kind has that size.
    fn shapes(size: usize, nodes: usize) -> Option<Vec<(usize, usize)>>;
    /// The matrices, in the order of storage.
    fn list(&self) -> Vec<&Matrix<C>>;
    /// The inverse of [`Bundle::list`]; `None` if their number is wrong.
    fn from_list(list: Vec<Matrix<C>>) -> Option<Self>;
}

impl<C: Coefficient> Bundle<C> for PointMatrices<C> {
    /// 3 count + kind of [`PointMatrices::kind`].
    fn size(&self) -> usize {
        let (kind, count) = self.kind();
        3 * count + kind
    }
    fn shapes(size: usize, nodes: usize) -> Option<Vec<(usize, usize)>> {
        PointMatrices::<C>::shapes(size % 3, size / 3, nodes.isqrt())
    }
    fn list(&self) -> Vec<&Matrix<C>> {
        self.matrices()
    }
    fn from_list(list: Vec<Matrix<C>>) -> Option<Self> {
        PointMatrices::from_list(list)
    }
}

impl<C: Coefficient> Bundle<C> for Matrix<C> {
    fn size(&self) -> usize {
        self.columns
    }
    fn shapes(size: usize, nodes: usize) -> Option<Vec<(usize, usize)>> {
        Some(vec![(2 * nodes, size)])
    }
    fn list(&self) -> Vec<&Matrix<C>> {
        vec![self]
    }
    fn from_list(mut list: Vec<Matrix<C>>) -> Option<Self> {
        list.pop()
    }
}

/// A pool as plain arrays.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Flat {
    /// For each block k >= 0 for entry k of the shared matrices, -1 - k for entry k of its own.
    pub share: Vec<i64>,
    /// Sizes of the shared matrices.
    pub shared_sizes: Vec<usize>,
    /// Sizes of the own matrices.
    pub own_sizes: Vec<usize>,
    /// Entries of the shared matrices.
    pub shared: Vec<f64>,
    /// Entries of the own matrices, lane fastest.
    pub own: Vec<f64>,
}

impl Flat {
    /// The arrays of a pool.
    pub fn of<S: Bundle<f64>, O: Bundle<F8>>(pool: &Pool<S, O>) -> Self {
        let own = Entries::of(&pool.own);
        Self { own: own.some(0..own.len()), ..Self::without_own(pool) }
    }

    /// The same without the entries of the own matrices, which [`Entries`] has.
    pub fn without_own<S: Bundle<f64>, O: Bundle<F8>>(pool: &Pool<S, O>) -> Self {
        let number = |share: &Share| match *share {
            Share::Shared(k) => k as i64,
            Share::Own(k) => -1 - k as i64,
        };
        Self {
            share: pool.share.iter().map(number).collect(),
            shared_sizes: pool.shared.iter().map(Bundle::size).collect(),
            own_sizes: pool.own.iter().map(Bundle::size).collect(),
            shared: pool.shared.iter().flat_map(Bundle::list).flat_map(|m| m.data.iter().copied()).collect(),
            own: vec![],
        }
    }

    /// The pool of these arrays, for `blocks` blocks of cells with `nodes` nodes; `None` if the arrays do not fit together.
    pub fn pool<S: Bundle<f64>, O: Bundle<F8>>(&self, blocks: usize, nodes: usize) -> Option<Pool<S, O>> {
        let (shared_count, own_count) = (self.shared_sizes.len() as i64, self.own_sizes.len() as i64);
        let fits = |k: &i64| if *k >= 0 { *k < shared_count } else { -1 - *k < own_count };
        if self.share.len() != blocks || !self.share.iter().all(fits) {
            return None;
        }
        let share = |k: &i64| if *k >= 0 { Share::Shared(*k as usize) } else { Share::Own((-1 - *k) as usize) };
        let (eights, rest) = self.own.as_chunks::<LANES>();
        let own: Vec<F8> = eights.iter().map(|lanes| F8(*lanes)).collect();
        rest.is_empty().then_some(())?;
        Some(Pool {
            share: self.share.iter().map(share).collect(),
            shared: cut(&self.shared_sizes, nodes, &self.shared)?,
            own: cut(&self.own_sizes, nodes, &own)?,
        })
    }
}

/// The entries of the own matrices of a pool, lane fastest, without a copy of all.
pub struct Entries<'a> {
    matrices: Vec<&'a [f64]>,
    /// The place behind the last entry of each matrix.
    ends: Vec<usize>,
}

impl<'a> Entries<'a> {
    /// Those of these matrices.
    pub fn of<O: Bundle<F8>>(own: &'a [O]) -> Self {
        let matrices: Vec<&[f64]> = own.iter().flat_map(Bundle::list).map(|matrix| as_f64(&matrix.data)).collect();
        let ends = matrices.iter().scan(0, |end, matrix| {
            *end += matrix.len();
            Some(*end)
        });
        Self { ends: ends.collect(), matrices }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Some of them.
    pub fn some(&self, range: Range<usize>) -> Vec<f64> {
        let mut out = Vec::with_capacity(range.len());
        let first = self.ends.partition_point(|end| *end <= range.start);
        for (matrix, end) in self.matrices.iter().zip(&self.ends).skip(first) {
            let start = end - matrix.len();
            if start >= range.end {
                break;
            }
            out.extend_from_slice(&matrix[range.start.max(start) - start..range.end.min(*end) - start]);
        }
        out
    }
}

/// Cuts entries into bundles of the given sizes; `None` if there are too few or too many entries.
fn cut<C: Coefficient, B: Bundle<C>>(sizes: &[usize], nodes: usize, mut entries: &[C]) -> Option<Vec<B>> {
    let mut out = Vec::with_capacity(sizes.len());
    for &size in sizes {
        let mut list = Vec::new();
        for (rows, columns) in B::shapes(size, nodes)? {
            let (head, tail) = entries.split_at_checked(rows.checked_mul(columns)?)?;
            list.push(Matrix::new(rows, columns, head.to_vec()));
            entries = tail;
        }
        out.push(B::from_list(list)?);
    }
    entries.is_empty().then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_of_matrices_in_any_range_are_those_of_all() {
        let matrix = |columns: usize, from: usize| {
            let numbers = (0..columns).map(|k| F8(std::array::from_fn(|lane| (from + LANES * k + lane) as f64)));
            Matrix::new(1, columns, numbers.collect())
        };
        let own = [matrix(2, 0), matrix(1, 16), matrix(3, 24)];
        let entries = Entries::of(&own);
        let all: Vec<f64> = (0..48).map(f64::from).collect();
        assert_eq!(entries.len(), all.len());
        for start in 0..=all.len() {
            (start..=all.len()).for_each(|end| assert_eq!(entries.some(start..end), all[start..end]));
        }
    }
}
