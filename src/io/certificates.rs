//! Certificates of cells as arrays of a store: `cell_class` (0 lattice, 1 dense, 2 deficient, 3 nodes), `cell_points`,
//! `cell_rank`, `cell_condition`, `cell_face_lebesgue`, `cell_node_lebesgue`, `cell_h` (m) and `cell_dt` (s; NaN where no
//! state was known), each with one entry a cell.

use super::store::{ArrayRef, Store};
use crate::error::Result;
use crate::operators::{Certificate, Class};

/// Certificates of all cells: one list for each figure.
#[derive(Debug, Default)]
pub(super) struct Columns {
    whole: [Vec<usize>; 3],
    real: [Vec<f64>; 5],
}

const WHOLE: [&str; 3] = ["cell_class", "cell_points", "cell_rank"];
const REAL: [&str; 5] = ["cell_condition", "cell_face_lebesgue", "cell_node_lebesgue", "cell_h", "cell_dt"];

impl Columns {
    /// The lists of these certificates.
    pub(super) fn of(all: &[Certificate]) -> Self {
        let mut out = Self::default();
        for cell in all {
            let class = Class::NAMES.iter().position(|(_, class)| *class == cell.class).unwrap_or_default();
            [class, cell.points, cell.rank].into_iter().zip(&mut out.whole).for_each(|(x, list)| list.push(x));
            let real = [cell.condition, cell.lebesgue, cell.inside, cell.h, cell.dt];
            real.into_iter().zip(&mut out.real).for_each(|(x, list)| list.push(x));
        }
        out
    }

    /// The arrays to write; an empty list if there are no certificates.
    pub(super) fn arrays(&self) -> Vec<(&'static str, Vec<usize>, ArrayRef<'_>)> {
        if self.whole[0].is_empty() {
            return vec![];
        }
        let whole = WHOLE.iter().zip(&self.whole).map(|(name, list)| (*name, vec![list.len()], ArrayRef::Index(list)));
        let real = REAL.iter().zip(&self.real).map(|(name, list)| (*name, vec![list.len()], ArrayRef::F64(list)));
        whole.chain(real).collect()
    }
}

/// Reads certificates back; `None` if the file holds no certificates.
pub(super) fn read(store: &mut Store, cells: usize) -> Result<Vec<Certificate>> {
    if !store.names().any(|name| name == WHOLE[0]) {
        return Ok(vec![]);
    }
    let whole = WHOLE.map(|name| store.indices(name, &[]));
    let real = REAL.map(|name| store.reals(name, &[]));
    let ([class, points, rank], [condition, lebesgue, inside, h, dt]) = (all(whole)?, all(real)?);
    let lengths = [class.len(), points.len(), rank.len(), condition.len(), lebesgue.len(), inside.len(), h.len()];
    if lengths.iter().any(|length| *length != cells) || dt.len() != cells {
        return Err(store.error(format!("the certificates are not those of {cells} cells")));
    }
    let cell = |c: usize| {
        let class = Class::NAMES.get(class[c]).map(|(_, class)| *class)?;
        let (points, rank, condition) = (points[c], rank[c], condition[c]);
        Some(Certificate {
            class,
            points,
            rank,
            condition,
            lebesgue: lebesgue[c],
            inside: inside[c],
            h: h[c],
            dt: dt[c],
        })
    };
    let found: Option<Vec<_>> = (0..cells).map(cell).collect();
    found.ok_or_else(|| store.error("`cell_class` holds a number that is no class"))
}

/// All values, or the first error.
fn all<T, const N: usize>(values: [Result<Vec<T>>; N]) -> Result<[Vec<T>; N]> {
    let mut out = [const { Vec::new() }; N];
    for (place, value) in out.iter_mut().zip(values) {
        *place = value?;
    }
    Ok(out)
}
