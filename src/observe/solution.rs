//! The discrete solution as a function of the point: polynomials of F and p, stresses by the law from that F. Internal variables are never
//! interpolated: a law that has some gives the stress of the nearest point of the cell where they stand, from F there. (From F of the
//! place itself, whose part that yields differs from that of the point, it would be far beyond the yield stress, or far below.)

use crate::basis::Lagrange;
use crate::cloud::Cloud;
use crate::io::snapshot::Snapshot;
use crate::material::Response;
use crate::state::{State, UNKNOWNS};
use crate::step::Law;
use crate::step::{Scheme, history};

/// The unknowns at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// F.
    pub deformation: [f64; 4],
    /// v, m/s.
    pub velocity: [f64; 2],
    /// u, m; zero where it is not integrated.
    pub displacement: [f64; 2],
    /// Internal variables of the nearest point of the cell.
    pub history: Vec<f64>,
    /// F from which the law gives the stress: that of the point of the internal variables, where the law has some.
    pub stressed: [f64; 4],
}

impl Point {
    /// The response of a law at this point.
    pub fn response(&self, law: &Law) -> Response {
        law.response(self.stressed, &self.history)
    }
}

/// Internal variables of all cells, and the points to which they belong.
#[derive(Debug, Clone, Default, PartialEq)]
struct Memory {
    /// The points where the law is evaluated between steps.
    places: Cloud,
    /// The first number of each cell in `values`.
    first: Vec<usize>,
    /// The values, in the order of [`Scheme::internal_of`].
    values: Vec<f64>,
}

impl Memory {
    /// The internal variables of cells with these laws; `None` if no law has memory. Points for which `values` is too
    /// short are virgin.
    fn new(laws: &[Law], material: &[usize], places: impl FnOnce() -> Cloud, values: Vec<f64>) -> Option<Self> {
        if !laws.iter().any(|law| law.has_memory()) {
            return None;
        }
        let (places, mut first, mut next) = (places(), Vec::with_capacity(material.len()), 0);
        for (cell, &law) in material.iter().enumerate() {
            first.push(next);
            next += laws[law].history_len() * places.of(cell).len();
        }
        Some(Self { places, first, values })
    }

    /// The point of a cell that is nearest to xi, and its internal variables; none where the law of the cell has none.
    fn at(&self, cell: usize, law: &Law, xi: [f64; 2]) -> Option<([f64; 2], Vec<f64>)> {
        let (mut out, count) = (law.virgin(), law.history_len());
        let points = Some(self.places.of(cell)).filter(|points| count > 0 && !points.is_empty())?;
        let point = history::nearest(points.iter().copied(), xi);
        let stored = self.values.iter().skip(self.first[cell] + count * point).take(count);
        out.iter_mut().zip(stored).for_each(|(out, value)| *out = *value);
        Some((points[point], out))
    }
}

/// Unknowns of all cells, in the order of the mesh.
#[derive(Debug, Clone)]
pub struct Solution<'a> {
    /// The nodal basis.
    pub basis: &'a Lagrange,
    /// The laws.
    pub laws: &'a [Law],
    /// The law of each cell.
    pub material: &'a [usize],
    /// The number of components: 6, or 8 with displacement.
    pub components: usize,
    /// `[cell][component][node]`.
    pub u: Vec<f64>,
    /// Internal variables; `None` if no law has memory.
    memory: Option<Memory>,
}

impl<'a> Solution<'a> {
    /// The solution of a state; `material` gives the law of each cell.
    pub fn of_state(scheme: &'a Scheme, state: &State, material: &'a [usize]) -> Self {
        let operators = &scheme.operators;
        Self {
            basis: &operators.line.basis,
            laws: &scheme.laws,
            material,
            components: state.components,
            u: state.unpack(&operators.blocks, operators.nodes()),
            memory: Memory::new(&scheme.laws, material, || scheme.places(), scheme.internal_of(state)),
        }
    }

    /// The solution of a snapshot; `places` are the points where the law is evaluated between steps ([`Scheme::places`]).
    pub fn of_snapshot(
        snapshot: &Snapshot,
        basis: &'a Lagrange,
        laws: &'a [Law],
        material: &'a [usize],
        places: &Cloud,
    ) -> Self {
        let nodes = basis.len() * basis.len();
        let components = if snapshot.displacement.is_empty() { UNKNOWNS } else { UNKNOWNS + 2 };
        let mut u = Vec::with_capacity(snapshot.u.len() + snapshot.displacement.len());
        for (cell, unknowns) in snapshot.u.chunks(UNKNOWNS * nodes).enumerate() {
            u.extend_from_slice(unknowns);
            if !snapshot.displacement.is_empty() {
                u.extend_from_slice(&snapshot.displacement[2 * nodes * cell..2 * nodes * (cell + 1)]);
            }
        }
        let memory = Memory::new(laws, material, || places.clone(), snapshot.internal.clone());
        Self { basis, laws, material, components, u, memory }
    }

    /// Whether the displacement is integrated.
    pub fn has_displacement(&self) -> bool {
        self.components > UNKNOWNS
    }

    /// The law of a cell.
    pub fn law(&self, cell: usize) -> &Law {
        &self.laws[self.material[cell]]
    }

    /// The unknowns at parent coordinates xi of a cell.
    pub fn at(&self, cell: usize, xi: [f64; 2]) -> Point {
        self.combine(cell, xi, &self.basis.values_2d(xi))
    }

    /// The unknowns at xi of a cell, from the weights of its nodes there.
    pub fn combine(&self, cell: usize, xi: [f64; 2], weights: &[f64]) -> Point {
        let n = weights.len();
        let start = cell * self.components * n;
        let by = |weights: &[f64], k: usize| -> f64 {
            let nodes = &self.u[start + k * n..start + (k + 1) * n];
            nodes.iter().zip(weights).map(|(u, w)| u * w).sum()
        };
        let value = |k: usize| by(weights, k);
        let law = self.law(cell);
        let (density, deformation) = (law.density(), [0, 1, 2, 3].map(value));
        let remembered = self.memory.as_ref().and_then(|memory| memory.at(cell, law, xi));
        let (history, stressed) = match remembered {
            None => (law.virgin(), deformation),
            Some((place, history)) => {
                let weights = self.basis.values_2d(place);
                (history, [0, 1, 2, 3].map(|k| by(&weights, k)))
            }
        };
        Point {
            deformation,
            velocity: [value(4) / density, value(5) / density],
            displacement: if self.has_displacement() { [value(6), value(7)] } else { [0.0; 2] },
            history,
            stressed,
        }
    }
}
