//! The matrices that are worth storing, and their flat form for a file.

use super::curl_free::CurlPool;
use super::points::PointPool;
use super::{Blocks, CurlFree, Line, Matrix, Needs, PointMatrices, Points, Pool, Share};
use crate::error::Error;
use crate::lane::{Coefficient, F8, LANES, as_f64};
use crate::mesh::Mesh;

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
        let number = |share: &Share| match *share {
            Share::Shared(k) => k as i64,
            Share::Own(k) => -1 - k as i64,
        };
        Self {
            share: pool.share.iter().map(number).collect(),
            shared_sizes: pool.shared.iter().map(Bundle::size).collect(),
            own_sizes: pool.own.iter().map(Bundle::size).collect(),
            shared: pool.shared.iter().flat_map(Bundle::list).flat_map(|m| m.data.iter().copied()).collect(),
            own: pool.own.iter().flat_map(Bundle::list).flat_map(|m| as_f64(&m.data).iter().copied()).collect(),
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
