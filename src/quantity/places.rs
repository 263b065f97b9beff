//! Places of a body where quantities look at fields.

use super::Seen;
use crate::cloud::Locator;
use crate::error::Error;
use crate::mesh::{Mesh, map};
use crate::observe::{self, Samples};

/// A place that lies outside of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Outside {
    /// A sample of a line.
    #[error(transparent)]
    Line(observe::Outside),
    /// A point: its number among those asked for, from 0, and where it is, m.
    #[error("the point ({}, {}) lies outside of the mesh", .x[0], .x[1])]
    Point {
        /// Its number among those asked for.
        number: usize,
        /// Where it lies, m.
        x: [f64; 2],
    },
}

impl Outside {
    /// How to correct it.
    pub const REMEDY: &str = "choose a place inside of the body in its initial configuration";

    /// Which of two keys of the scene is at fault: those of the ends of a line, or of two points.
    pub fn key<'a>(&self, [first, second]: [&'a str; 2]) -> &'a str {
        let is_first = match self {
            Self::Line(outside) => outside.sample == 0,
            Self::Point { number, .. } => *number == 0,
        };
        if is_first { first } else { second }
    }
}

impl From<Outside> for Error {
    fn from(outside: Outside) -> Self {
        Error::input(outside.to_string(), Outside::REMEDY)
    }
}

/// Where to look.
#[derive(Debug, Clone, PartialEq)]
enum Where {
    /// In each cell the nodes, and points of the same lines on its faces and corners: (N+3)^2.
    Body,
    /// The same in the cells of a group, or on the edges of a group where no group of cells has the name.
    Group(String),
    /// Along a line, with equal distances.
    Line(Samples),
    /// At these points X, m.
    Points(Vec<[f64; 2]>),
}

/// A place in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The cell.
    pub cell: usize,
    /// Its parent coordinates.
    pub xi: [f64; 2],
    /// How far along the line it lies, m; 0 elsewhere.
    pub s: f64,
}

/// Places of a body, on its present mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    of: Where,
    degree: usize,
    /// By cell and parent coordinates.
    pub all: Vec<Place>,
}

impl Places {
    /// In each cell its nodes, and points on its faces and corners.
    pub fn body(seen: &Seen) -> Self {
        Self::everywhere(seen.mesh, seen.scheme.operators.degree)
    }

    /// The same for a degree.
    pub fn everywhere(mesh: &Mesh, degree: usize) -> Self {
        let mut places = Self { of: Where::Body, degree, all: vec![] };
        places.all = places.in_cells(mesh, |_| true);
        places
    }

    /// In each cell of a group its nodes, and points on its faces and corners. Where the name is that of a group of edges: on these
    /// edges the nodes of the face and its ends. Nothing where the mesh has neither.
    pub fn group(name: &str, mesh: &Mesh, degree: usize) -> Self {
        let mut places = Self { of: Where::Group(name.to_owned()), degree, all: vec![] };
        places.all = places.in_group(mesh, name);
        places
    }

    /// A line, in reference coordinates.
    ///
    /// # Errors
    /// A sample outside of the mesh.
    pub fn line(samples: Samples, mesh: &Mesh) -> Result<Self, Outside> {
        Self { of: Where::Line(samples), degree: 0, all: vec![] }.on(mesh)
    }

    /// Points, in reference coordinates.
    ///
    /// # Errors
    /// A point outside of the mesh.
    pub fn points(points: Vec<[f64; 2]>, mesh: &Mesh) -> Result<Self, Outside> {
        Self { of: Where::Points(points), degree: 0, all: vec![] }.on(mesh)
    }

    /// The same places on another mesh.
    ///
    /// # Errors
    /// A place outside of this mesh.
    pub fn on(mut self, mesh: &Mesh) -> Result<Self, Outside> {
        self.all = match &self.of {
            Where::Body => self.in_cells(mesh, |_| true),
            Where::Group(name) => self.in_group(mesh, name),
            Where::Line(samples) => {
                let found = samples.locate(mesh).map_err(Outside::Line)?;
                found.into_iter().map(|sample| Place { cell: sample.cell, xi: sample.xi, s: sample.s }).collect()
            }
            Where::Points(points) => {
                let locator = Locator::new(mesh);
                let find = |(number, &x): (usize, &[f64; 2])| {
                    let (cell, xi) = locator.find(x).ok_or(Outside::Point { number, x })?;
                    Ok(Place { cell, xi, s: 0.0 })
                };
                points.iter().enumerate().map(find).collect::<Result<_, _>>()?
            }
        };
        Ok(self)
    }

    /// As [`Places::on`], in place.
    ///
    /// # Errors
    /// A place outside of this mesh.
    pub fn move_to(&mut self, mesh: &Mesh) -> Result<(), Outside> {
        *self = self.clone().on(mesh)?;
        Ok(())
    }

    fn in_group(&self, mesh: &Mesh, name: &str) -> Vec<Place> {
        if let Some(group) = mesh.groups.iter().position(|known| known == name) {
            return self.in_cells(mesh, |cell| mesh.cell_group[cell] == group);
        }
        let Some(group) = mesh.edge_groups.iter().position(|known| known == name) else { return vec![] };
        let line = with_ends(&crate::basis::Lagrange::new(self.degree).nodes);
        let edges = mesh.edges.iter().filter(|edge| edge.group == group);
        let of = |edge: &crate::mesh::BoundaryEdge| {
            let (cell, face) = (edge.cell, edge.face);
            line.iter().map(|&along| Place { cell, xi: map::on_face(face, along), s: 0.0 }).collect::<Vec<_>>()
        };
        edges.flat_map(of).collect()
    }

    fn in_cells(&self, mesh: &Mesh, belongs: impl Fn(usize) -> bool) -> Vec<Place> {
        let line = with_ends(&crate::basis::Lagrange::new(self.degree).nodes);
        let xi: Vec<[f64; 2]> = line.iter().flat_map(|&a| line.iter().map(move |&b| [a, b])).collect();
        (0..mesh.cells.len())
            .filter(|cell| belongs(*cell))
            .flat_map(|cell| xi.iter().map(move |&xi| Place { cell, xi, s: 0.0 }))
            .collect()
    }

    /// Reference coordinates of a place, m.
    pub fn position(mesh: &Mesh, place: &Place) -> [f64; 2] {
        map::position(&mesh.map(place.cell), place.xi)
    }

    /// The same, by 1e-9 of the cell towards its middle: the exact solution at an edge of the cell is the one on its side.
    pub fn inside(mesh: &Mesh, place: &Place) -> [f64; 2] {
        map::position(&mesh.map(place.cell), place.xi.map(|xi| xi + 1e-9 * (0.5 - xi)))
    }
}

/// Nodes in [0, 1] and both ends.
pub fn with_ends(nodes: &[f64]) -> Vec<f64> {
    [&[0.0], nodes, &[1.0]].concat()
}
