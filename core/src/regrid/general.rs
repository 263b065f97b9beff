//! The projection between any two grids: intersections of cells by clipping, quadrature on the pieces, inverse maps in both
//! cells. Curved cells are clipped as the quadrilaterals of their corners, and their fields are taken where the points of the
//! quadrature are by their curved maps, inside or a little outside: uniform states and totals are kept, and at curved edges the
//! projection is of order 2.

use super::clip::Polygon;
use super::nodal::{Nodal, Values, combine, gather, scatter, spread};
use super::{Field, Grid, LARGEST_DIFFERENCE, Share, Taken, Transfer, integral, is_momentum};
use crate::cloud::Locator;
use crate::error::Error;
use crate::mesh::FACE_CORNERS;
use crate::mesh::map::{self, CellMap, Corners, Map};
use crate::quadrature::gauss_legendre;
use crate::sum::{ExactSum, exact_sum};
use rayon::prelude::*;

/// A cell counts as covered if its uncovered area is below this part of it, which allows for rounding of some clipped areas.
const COVERED: f64 = 1e-11;
/// Pieces below this part of a cell count as rounding and are ignored.
const NO_PIECE: f64 = 1e-14;
/// If the uncovered part of a cell is at most this part of it, the polynomial of its largest piece is continued there.
/// If it is more, the mean is used there.
const EXTENDED: f64 = 0.3;

/// Projects `field` onto the new cells that `same` does not name, into `u`. Returns the share of each cell in the sums.
///
/// # Errors
/// A new cell of a material that the old grid lacks.
pub(super) fn project<const M: usize>(
    old: &Grid,
    new: &Grid,
    field: &Field,
    same: &[Option<usize>],
    u: &mut [f64],
) -> Result<Vec<Share>, Error> {
    let locator = Locator::new(old.mesh);
    let job = Job {
        old,
        new,
        field,
        nodal: Nodal::<M>::new(field.basis),
        locator,
        exact: gauss_legendre(2 * M - 1),
        fine: gauss_legendre(2 * M + 2),
    };
    let stride = field.components * M * M;
    let shares =
        u.par_chunks_exact_mut(stride).enumerate().map_init(Scratch::default, |scratch, (cell, u)| match same[cell] {
            Some(twin) => {
                u.copy_from_slice(&field.u[stride * twin..stride * (twin + 1)]);
                let area = map::area(&new.mesh.corners(cell));
                let total = integral(new, field, cell, u);
                Ok(Share { taken: vec![Taken { old: twin, area, total }], ..Share::default() })
            }
            None => job.cell(cell, scratch, u),
        });
    shares.collect()
}

/// The data that all new cells share.
struct Job<'a, const M: usize> {
    old: &'a Grid<'a>,
    new: &'a Grid<'a>,
    field: &'a Field<'a>,
    nodal: Nodal<M>,
    locator: Locator,
    /// Gauss points per direction on a piece of two parallelograms. Phi_a U_old has the degree 4N there, and the map of
    /// the piece adds one.
    exact: (Vec<f64>, Vec<f64>),
    /// Gauss points per direction on other pieces, where inverse maps are no polynomials. On cells distorted by a
    /// fifth, kinetic energy rose by 1.4e-11 (S3) with 2N + 2 points, see `tests`.
    fine: (Vec<f64>, Vec<f64>),
}

/// The working memory of a thread.
#[derive(Default)]
struct Scratch {
    candidates: Vec<usize>,
    samples: Vec<Sample>,
}

/// A point of the quadrature.
#[derive(Clone, Copy)]
struct Sample {
    weight: f64,
    /// Its parent coordinates in the new cell.
    xi: [f64; 2],
    value: Values,
}

impl<const M: usize> Job<'_, M> {
    fn cell(&self, cell: usize, scratch: &mut Scratch, u: &mut [f64]) -> Result<Share, Error> {
        let map = self.new.mesh.map(cell);
        let area = map::area(&map.corners);
        let mut share = self.sample(cell, &map, area, scratch);
        let covered: f64 = share.taken.iter().map(|taken| taken.area).sum();
        let hole = (1.0 - covered / area).max(0.0);
        let base = self.base(cell, &map, &share.taken, hole)?;
        // M^-1 int Phi_a (U_old - base) + base: a uniform state is exact for any quadrature, and the part that no old
        // cell covers gets the values of the base.
        let mut values = [[[0.0; 8]; M]; M];
        for sample in &scratch.samples {
            let (x, y) = (self.nodal.at(sample.xi[0]), self.nodal.at(sample.xi[1]));
            let below = base.at(&self.nodal, map::position(&map, sample.xi));
            let value: Values = std::array::from_fn(|k| sample.weight * (sample.value[k] - below[k]));
            spread(&value, &x, &y, &mut values);
        }
        for (i, j) in (0..M).flat_map(|i| (0..M).map(move |j| (i, j))) {
            let xi = self.field.basis.node_2d(i * M + j);
            let mass = super::mass(self.new.mesh, cell, self.field.basis, i * M + j);
            let below = base.at(&self.nodal, map::position(&map, xi));
            (0..8).for_each(|k| values[i][j][k] = values[i][j][k] / mass + below[k]);
        }
        let scale = &self.field.scale[self.new.material[cell]];
        for sample in &scratch.samples {
            let after = combine(&values, &self.nodal.at(sample.xi[0]), &self.nodal.at(sample.xi[1]));
            share.add(sample.weight, &sample.value, &after, scale);
        }
        if hole > COVERED {
            share.uncovered = area - covered;
        }
        scatter::<M>(&values, |a| a, u);
        Ok(share)
    }

    /// U_old at the points of the quadrature on all pieces of a new cell.
    fn sample(&self, cell: usize, map: &CellMap, area: f64, scratch: &mut Scratch) -> Share {
        let Scratch { candidates, samples } = scratch;
        samples.clear();
        candidates.clear();
        let bound =
            |pick: fn(f64, f64) -> f64| [0, 1].map(|i| map.corners.iter().map(|x| x[i]).reduce(pick).unwrap_or(0.0));
        self.locator.overlapping(bound(f64::min), bound(f64::max), candidates);
        candidates.sort_unstable();
        // Relative to a corner, so that cells far from the origin lose no digits.
        let back = map.corners[0].map(|x| -x);
        let own = map.moved(back);
        let mut share = Share::default();
        for &old in candidates.iter().filter(|&&old| self.old.material[old] == self.new.material[cell]) {
            let other = self.old.mesh.map(old).moved(back);
            let piece = Polygon::quad(own.corners).clipped(&other.corners);
            let common = piece.area();
            if common <= NO_PIECE * area {
                continue;
            }
            let first = samples.len();
            self.sample_piece(&piece, [&own, &other], old, samples);
            let mut total = [0.0; 8];
            samples[first..].iter().for_each(|s| (0..8).for_each(|k| total[k] += s.weight * s.value[k]));
            share.taken.push(Taken { old, area: common, total });
        }
        share
    }

    fn sample_piece(&self, piece: &Polygon, cells: [&CellMap; 2], old: usize, samples: &mut Vec<Sample>) {
        let stride = self.field.components * M * M;
        let there = gather::<M>(&self.field.u[stride * old..stride * (old + 1)], |a| a);
        let (nodes, weights) = if cells.iter().all(|cell| is_affine(cell)) { &self.exact } else { &self.fine };
        piece.quads(|pick| {
            let x = pick.map(|k| piece.corners()[k]);
            // Parent coordinates at the corners of the piece are first guesses inside.
            let guesses = cells.map(|cell| x.map(|x| map::parent(cell, x).unwrap_or([0.5; 2])));
            for (q, r) in (0..nodes.len()).flat_map(|q| (0..nodes.len()).map(move |r| (q, r))) {
                let at = [nodes[q], nodes[r]];
                let weight = weights[q] * weights[r] * map::determinant(&map::jacobian(&x, at));
                let point = map::position(&x, at);
                let [xi, eta] = [0, 1].map(|k| improved(cells[k], point, map::position(&guesses[k], at)));
                let value = combine(&there, &self.nodal.at(eta[0]), &self.nodal.at(eta[1]));
                samples.push(Sample { weight, xi, value });
            }
        });
    }

    /// The base of the projection: the mean over the pieces. If a part of the cell is not covered, it is the polynomial
    /// of the largest piece, or the mean of the nearest cell.
    fn base(&self, cell: usize, map: &CellMap, taken: &[Taken], hole: f64) -> Result<Base<M>, Error> {
        let stride = self.field.components * M * M;
        let unknowns = |old: usize| &self.field.u[stride * old..stride * (old + 1)];
        // The piece of a curved cell is not the cell: what differs is small against the polynomial, and not against the mean.
        if (hole > COVERED || map.bulge.is_some()) && hole < EXTENDED {
            let largest = taken.iter().max_by(|a, b| a.area.total_cmp(&b.area).then(b.old.cmp(&a.old)));
            if let Some(largest) = largest {
                let map = self.old.mesh.map(largest.old);
                return Ok(Base::Polynomial(map, Box::new(gather::<M>(unknowns(largest.old), |a| a))));
            }
        }
        let area: f64 = taken.iter().map(|taken| taken.area).sum();
        if area > 0.0 {
            return Ok(Base::Mean(std::array::from_fn(|k| {
                taken.iter().map(|taken| taken.total[k]).sum::<f64>() / area
            })));
        }
        let near = self.nearest(map, self.new.material[cell]).ok_or_else(|| {
            let group = &self.new.mesh.groups[self.new.mesh.cell_group[cell]];
            let what =
                format!("cell {} of group {group} has a material that the old grid lacks", self.new.mesh.number(cell));
            Error::input(what, "give a mesh with the groups of the old one")
        })?;
        let area = map::area(&self.old.mesh.map(near));
        Ok(Base::Mean(integral(self.old, self.field, near, unknowns(near)).map(|total| total / area)))
    }

    /// The old cell of a material with the nearest centre. (Only for new cells that no old cell touches; there are few.)
    fn nearest(&self, map: &CellMap, material: usize) -> Option<usize> {
        let centre = map::position(map, [0.5; 2]);
        let distance = |old: usize| {
            let other = map::position(&self.old.mesh.map(old), [0.5; 2]);
            (other[0] - centre[0]).hypot(other[1] - centre[1])
        };
        let cells = (0..self.old.mesh.cells.len()).filter(|&old| self.old.material[old] == material);
        cells.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }
}

/// The base of the projection.
enum Base<const M: usize> {
    Mean(Values),
    /// The polynomial of a cell with this map, continued outside the cell.
    Polynomial(CellMap, Box<[[Values; M]; M]>),
}

impl<const M: usize> Base<M> {
    #[inline(always)]
    fn at(&self, nodal: &Nodal<M>, x: [f64; 2]) -> Values {
        match self {
            Base::Mean(mean) => *mean,
            Base::Polynomial(map, values) => {
                // Far outside, beyond the fold of the map, the nearest corner is used instead.
                let xi = map::parent(map, x).unwrap_or([0.5; 2]).map(|xi| xi.clamp(-1.0, 2.0));
                combine(values, &nodal.at(xi[0]), &nodal.at(xi[1]))
            }
        }
    }
}

/// Whether a cell is a parallelogram, up to rounding.
fn is_affine(cell: &CellMap) -> bool {
    let [a, b, c, d]: &Corners = &cell.corners;
    let size = (0..2).map(|i| (c[i] - a[i]).abs()).fold(0.0, f64::max);
    cell.bulge.is_none() && (0..2).all(|i| (a[i] - b[i] + c[i] - d[i]).abs() <= 1e-13 * size)
}

/// Parent coordinates of x by Newton's method. The first guess is exact for a parallelogram.
#[inline(always)]
fn improved(cell: &impl Map, x: [f64; 2], mut xi: [f64; 2]) -> [f64; 2] {
    for _ in 0..12 {
        let at = map::position(cell, xi);
        let k = map::jacobian(cell, xi);
        let (det, rest) = (map::determinant(&k), [x[0] - at[0], x[1] - at[1]]);
        let step = [(k[1][1] * rest[0] - k[0][1] * rest[1]) / det, (k[0][0] * rest[1] - k[1][0] * rest[0]) / det];
        xi = [xi[0] + step[0], xi[1] + step[1]];
        // Convergence is quadratic: the next change would be below rounding.
        if step[0].abs().max(step[1].abs()) < 1e-9 {
            break;
        }
    }
    xi
}

/// Makes the totals exact. On cells that are no parallelograms U_old(X) is no polynomial, and its quadrature over the
/// pieces of an old cell differs from its integral by some 1e-10. Each new cell gets its share of this difference. If
/// the grids do not cover the same region, totals of momentum and means of everything else are restored for each
/// material.
///
/// # Errors
/// The two grids differ by too much.
pub(super) fn settle(old: &Grid, new: &Grid, field: &Field, shares: &[Share], out: &mut Transfer) -> Result<(), Error> {
    let n = field.basis.len() * field.basis.len();
    let stride = field.components * n;
    let areas: Vec<f64> = (0..old.mesh.cells.len()).map(|cell| map::area(&old.mesh.corners(cell))).collect();
    let (mut left, mut gap) = (areas.clone(), vec![[0.0; 8]; areas.len()]);
    for (cell, gap) in gap.iter_mut().enumerate() {
        *gap = integral(old, field, cell, &field.u[stride * cell..stride * (cell + 1)]);
    }
    for taken in shares.iter().flat_map(|share| &share.taken) {
        left[taken.old] -= taken.area;
        (0..8).for_each(|k| gap[taken.old][k] -= taken.total[k]);
    }
    // Chords and curves enclose different areas: what is missing of a curved cell is no error of the quadrature.
    let is_curved = [old, new].iter().any(|grid| grid.mesh.curved_cells() > 0);
    let is_covered = |cell: usize| !is_curved && left[cell].abs() <= COVERED * areas[cell];
    out.uncovered = [
        exact_sum(shares.iter().map(|share| share.uncovered)),
        exact_sum((0..areas.len()).filter(|&cell| left[cell].abs() > COVERED * areas[cell]).map(|cell| left[cell])),
    ];
    let whole = exact_sum(areas.iter().copied());
    refuse(out.uncovered, whole, beside_chords(old) + beside_chords(new))?;
    if is_curved {
        refuse_areas(
            [old, new].map(|grid| exact_sum((0..grid.mesh.cells.len()).map(|cell| map::area(&grid.mesh.map(cell))))),
        )?;
    }
    let same = &out.same;
    out.u.par_chunks_exact_mut(stride).enumerate().filter(|(cell, _)| same[*cell].is_none()).for_each(|(cell, u)| {
        let area = map::area(&new.mesh.corners(cell));
        for taken in shares[cell].taken.iter().filter(|taken| is_covered(taken.old)) {
            let part = taken.area / areas[taken.old] / area;
            for (k, u) in u.chunks_exact_mut(n).enumerate() {
                u.iter_mut().for_each(|u| *u += part * gap[taken.old][k]);
            }
        }
    });
    if is_curved || out.uncovered != [0.0; 2] {
        restore(old, new, field, out);
    }
    Ok(())
}

/// The area between the edges of the cells of a grid and their chords, m^2.
fn beside_chords(grid: &Grid) -> f64 {
    let of_cell = |cell: usize| {
        let CellMap { corners, bulge } = grid.mesh.map(cell);
        let of_face = |(face, [a, b]): (usize, &[usize; 2])| {
            let (d, chord) = (bulge.unwrap_or_default()[face], [0, 1].map(|k| corners[*b][k] - corners[*a][k]));
            2.0 / 3.0 * (chord[0] * d[1] - chord[1] * d[0]).abs()
        };
        FACE_CORNERS.iter().enumerate().map(of_face).sum::<f64>()
    };
    exact_sum((0..grid.mesh.bulges.len()).map(of_cell))
}

/// Refuses grids whose areas, with their curved edges, differ by more than a share.
fn refuse_areas([old, new]: [f64; 2]) -> Result<(), Error> {
    if (new - old).abs() <= LARGEST_DIFFERENCE * old {
        return Ok(());
    }
    let what = format!(
        "the new grid is not a grid of the same body: with its curved edges its area is {new:.3e} m^2, and that of the old grid is {old:.3e} m^2"
    );
    Err(Error::input(what, "give a mesh of the same body whose curved edges are of order 2 as well, or a finer one"))
}

/// Refuses grids that differ by more than a share of the area and what curved edges explain.
fn refuse(uncovered: [f64; 2], whole: f64, curved: f64) -> Result<(), Error> {
    if uncovered[0].max(uncovered[1]) <= LARGEST_DIFFERENCE * whole + curved {
        return Ok(());
    }
    // Rounding makes a share that is covered wholly a little less than nothing.
    let [new, old] = uncovered.map(|area| area.max(0.0) + 0.0);
    let what = format!(
        "the new grid is not a grid of the same body: {:.3e} m^2 of it lie outside of the old grid, and it does not cover {:.3e} m^2 of the old grid (area {whole:.3e} m^2)",
        new, old
    );
    let remedy = format!(
        "give a mesh of the same body in its initial configuration with the same groups; only the edges at a curved boundary may differ, by at most {LARGEST_DIFFERENCE} of the area"
    );
    Err(Error::input(what, remedy))
}

/// Adds constants to the new cells of each material (not to copies), so that its total momentum and its means are restored.
fn restore(old: &Grid, new: &Grid, field: &Field, out: &mut Transfer) {
    let n = field.basis.len() * field.basis.len();
    let stride = field.components * n;
    let total = |grid: &Grid, u: &[f64], material: usize, of: &dyn Fn(usize) -> bool| {
        let (mut sum, mut area) = (<[ExactSum; 8]>::default(), ExactSum::default());
        for cell in (0..grid.material.len()).filter(|&cell| grid.material[cell] == material && of(cell)) {
            let own = integral(grid, field, cell, &u[stride * cell..stride * (cell + 1)]);
            sum.iter_mut().zip(own).for_each(|(sum, own)| sum.add(own));
            area.add(map::area(&grid.mesh.map(cell)));
        }
        (sum.map(|sum| sum.value()), area.value())
    };
    for material in 0..field.scale.len() {
        let (before, old_area) = total(old, field.u, material, &|_| true);
        let (after, new_area) = total(new, &out.u, material, &|_| true);
        let (_, free) = total(new, &out.u, material, &|cell| out.same[cell].is_none());
        if free == 0.0 {
            continue;
        }
        for cell in (0..new.material.len()).filter(|&c| new.material[c] == material && out.same[c].is_none()) {
            for (k, u) in out.u[stride * cell..stride * (cell + 1)].chunks_exact_mut(n).enumerate() {
                let wanted = if is_momentum(k) { before[k] } else { before[k] / old_area * new_area };
                u.iter_mut().for_each(|u| *u += (wanted - after[k]) / free);
            }
        }
    }
}
