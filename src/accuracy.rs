//! The error of a state against an exact solution, by grid quadrature with N + 3 points per direction.

use crate::exact::Exact;
use crate::mesh::{Mesh, map};
use crate::observe::Solution;
use crate::quadrature::gauss_legendre;
use crate::state::State;
use crate::step::Law;
use crate::step::Scheme;
use crate::sum::exact_sum;

/// Norms of an error e over the body, with |e| the Euclidean norm of its components in the plane.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Norms {
    /// int |e| dX.
    pub l1: f64,
    /// sqrt(int |e|^2 dX).
    pub l2: f64,
    /// max |e| over the quadrature points.
    pub linf: f64,
}

impl Norms {
    fn add(&mut self, error: &[f64], weight: f64) {
        let square: f64 = error.iter().map(|e| e * e).sum();
        self.l1 += weight * square.sqrt();
        self.l2 += weight * square;
        self.linf = self.linf.max(square.sqrt());
    }

    /// Of sums over cells, those over all.
    fn sum(cells: &[Sums], of: fn(&Errors) -> &Norms) -> Self {
        let cells = cells.iter().map(|cell| of(&cell.errors));
        Self {
            l1: exact_sum(cells.clone().map(|norms| norms.l1)),
            l2: exact_sum(cells.clone().map(|norms| norms.l2)),
            linf: cells.map(|norms| norms.linf).fold(0.0, f64::max),
        }
    }
}

/// Errors of a state.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Errors {
    /// Of F.
    pub deformation: Norms,
    /// Of v, m/s.
    pub velocity: Norms,
    /// Of P, Pa.
    pub piola: Norms,
    /// sqrt(int |F - F_ex|^2 + |v - v_ex|^2 / c_p^2 dX), c_p at F = 1.
    pub distance: f64,
    /// `distance` over sqrt(int |F_ex - 1|^2 + |v_ex|^2 / c_p^2 dX): the standard measure where one number is meant.
    pub standard: f64,
    /// The same in L1: int e dX / int s dX with e^2 = |F - F_ex|^2 + |v - v_ex|^2 / c_p^2 and s^2 = |F_ex - 1|^2 + |v_ex|^2 / c_p^2 at
    /// each point. At a shock it falls as h, where `standard` falls as sqrt(h).
    pub standard_l1: f64,
}

/// Sums over a cell: the fields of the norms before their roots and quotients.
#[derive(Default)]
struct Sums {
    errors: Errors,
    /// int |F_ex - 1|^2 + |v_ex|^2 / c_p^2 dX is in `errors.standard`; this is int s dX.
    size_l1: f64,
}

impl Errors {
    /// From sums over cells to norms, whatever the order of the cells.
    fn of_cells(cells: &[Sums]) -> Self {
        let sum = |of: fn(&Sums) -> f64| exact_sum(cells.iter().map(of));
        let (standard_l1, size_l1) = (sum(|cell| cell.errors.standard_l1), sum(|cell| cell.size_l1));
        let sums = Self {
            deformation: Norms::sum(cells, |errors| &errors.deformation),
            velocity: Norms::sum(cells, |errors| &errors.velocity),
            piola: Norms::sum(cells, |errors| &errors.piola),
            distance: sum(|cell| cell.errors.distance),
            standard: sum(|cell| cell.errors.standard),
            standard_l1: if size_l1 > 0.0 { standard_l1 / size_l1 } else { standard_l1 },
        };
        sums.rooted()
    }

    /// From sums of squares to norms.
    fn rooted(mut self) -> Self {
        for norms in [&mut self.deformation, &mut self.velocity, &mut self.piola] {
            norms.l2 = norms.l2.sqrt();
        }
        // A solution at rest and unstrained has no size to compare with.
        let size = if self.standard > 0.0 { self.standard.sqrt() } else { 1.0 };
        self.distance = self.distance.sqrt();
        self.standard = self.distance / size;
        self
    }

    /// The fields with their names.
    pub fn fields(&self) -> [(&'static str, Norms); 3] {
        [("deformation", self.deformation), ("velocity", self.velocity), ("piola", self.piola)]
    }
}

/// The errors of `state` at its time; `material` gives the law of each cell.
pub fn errors(exact: &dyn Exact, mesh: &Mesh, scheme: &Scheme, state: &State, material: &[usize]) -> Errors {
    let solution = Solution::of_state(scheme, state, material);
    let order = solution.basis.len() + 2;
    compare(mesh, order, &|cell| solution.law(cell), &|cell, xi, x| {
        let found = solution.at(cell, xi);
        let internal = exact.internal(x, state.time).unwrap_or_else(|| solution.law(cell).virgin());
        let expected = (exact.deformation(x, state.time), exact.velocity(x, state.time), internal);
        [(found.deformation, found.velocity, found.history), expected]
    })
}

/// F, v (m/s) and internal variables at a point.
pub type Values = ([f64; 4], [f64; 2], Vec<f64>);

/// Errors between two solutions by quadrature with `order` points per direction in the cells of a mesh: `at(cell, xi, X)`
/// gives what was found and what is expected there, `law` the law of a cell.
pub fn compare<'a>(
    mesh: &Mesh,
    order: usize,
    law: &dyn Fn(usize) -> &'a Law,
    at: &dyn Fn(usize, [f64; 2], [f64; 2]) -> [Values; 2],
) -> Errors {
    let (points, weights) = gauss_legendre(order);
    let xi: Vec<[f64; 2]> = points.iter().flat_map(|&a| points.iter().map(move |&b| [a, b])).collect();
    let weights: Vec<f64> = weights.iter().flat_map(|a| weights.iter().map(move |b| a * b)).collect();
    let of_cell = |cell: usize| {
        let mut sums = Sums::default();
        let sum = &mut sums.errors;
        let (map, law) = (mesh.map(cell), law(cell));
        let slowness = 1.0 / law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0];
        for (&xi, weight) in xi.iter().zip(&weights) {
            let weight = weight * map::determinant(&map::jacobian(&map, xi)).abs();
            let [(found_f, found_v, found_internal), (f, v, internal)] = at(cell, xi, map::position(&map, xi));
            let (found_p, p) = (law.response(found_f, &found_internal).piola, law.response(f, &internal).piola);
            let error_f: [f64; 4] = std::array::from_fn(|k| found_f[k] - f[k]);
            let error_v = [found_v[0] - v[0], found_v[1] - v[1]];
            let error_p: [f64; 4] = std::array::from_fn(|k| found_p[k] - p[k]);
            sum.deformation.add(&error_f, weight);
            sum.velocity.add(&error_v, weight);
            sum.piola.add(&error_p, weight);
            let error = measure(error_f, error_v, slowness);
            let size = measure([f[0] - 1.0, f[1], f[2], f[3] - 1.0], v, slowness);
            sum.distance += weight * error;
            sum.standard += weight * size;
            sum.standard_l1 += weight * error.sqrt();
            sums.size_l1 += weight * size.sqrt();
        }
        sums
    };
    Errors::of_cells(&(0..mesh.cells.len()).map(of_cell).collect::<Vec<_>>())
}

/// |f|^2 + |v|^2 / c_p^2.
fn measure(f: [f64; 4], v: [f64; 2], slowness: f64) -> f64 {
    f.iter().map(|f| f * f).sum::<f64>() + v.iter().map(|v| (v * slowness).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::NeoHookean;

    #[test]
    fn an_error_in_half_of_the_body_counts_by_half_in_l1_and_by_its_root_in_the_standard_measure() {
        let (mesh, law) =
            (crate::mesh::rectangle([2.0, 1.0], [2, 1]).unwrap(), Law::from(NeoHookean::new(2e11, 0.3, 7800.0)));
        // F11 is 1.3 where it should be 1.1, in one of two cells: an error of 2 by the size of F - 1.
        let errors = compare(&mesh, 3, &|_| &law, &|cell, _, _| {
            let at = |f: f64| ([f, 0.0, 0.0, 1.0], [0.0; 2], vec![]);
            [at(if cell == 0 { 1.3 } else { 1.1 }), at(1.1)]
        });
        // Sums of a few numbers: roundings.
        assert!((errors.standard_l1 - 1.0).abs() < 1e-12, "{}", errors.standard_l1);
        assert!((errors.standard - 2.0_f64.sqrt()).abs() < 1e-12, "{}", errors.standard);
    }
}
