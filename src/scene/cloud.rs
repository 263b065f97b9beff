//! From a scene to the material points, and to those that the scheme samples on.

use super::{Body, Cloud as Choice, Layout, Method, Scene};
use crate::cloud::{Cloud, Locator, Pattern, body, from_points, seed};
use crate::error::{Error, Place, Result};
use crate::io::grid::Field;
use crate::io::{cloud_file, points, store};
use crate::mesh::Mesh;
use crate::operators::carry::Deficient;
use crate::operators::{Line, carry};
use std::path::Path;

/// Points as a file or a scene gives them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Given {
    /// Where they are.
    pub cloud: Cloud,
    /// Whether each of them is virtual already; empty where none is.
    pub virtual_points: Vec<bool>,
    /// Fields at them, of a file.
    pub fields: Vec<Field>,
}

/// Reads points: `.h5` as written by `dgmpm seed` or a run, else positions and fields from VTU or CSV.
///
/// # Errors
/// A file that cannot be read; points outside of the mesh, with their numbers.
pub fn read_points(path: &Path, mesh: &Mesh) -> Result<Given> {
    if store::is_meant_as_store(path) {
        let (cloud, more) = cloud_file::read_with(path, mesh)?;
        return Ok(Given { cloud, virtual_points: more.virtual_points, fields: more.fields });
    }
    let (points, mut fields) = points::read_with_fields(path)?;
    let located = from_points(mesh, &Locator::new(mesh), &points);
    let (cloud, order) =
        located.map_err(|why| Error::at(Place::file(path), why.to_string(), "give points inside of the mesh, in m"))?;
    for field in &mut fields {
        let n = field.kind.components();
        field.values = order.iter().flat_map(|&p| &field.values[n * p..n * (p + 1)]).copied().collect();
    }
    Ok(Given { cloud, virtual_points: vec![], fields })
}

/// The cloud that the scheme samples on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sampled {
    /// Its points.
    pub cloud: Cloud,
    /// Whether each of them is virtual (on a Gauss node, as its cell cannot carry the degree); empty where none is.
    pub virtual_points: Vec<bool>,
    /// For each of them the given point that it is or that is nearest; empty where they are the given points.
    pub source: Vec<usize>,
    /// The cells that have virtual points in place of the given ones.
    pub deficient: Vec<Deficient>,
}

impl Sampled {
    /// Points as they are.
    pub fn as_given(cloud: Cloud) -> Self {
        Self { cloud, ..Self::default() }
    }
}

impl Scene {
    /// The material points.
    ///
    /// # Errors
    /// A cloud file that does not fit the mesh.
    pub fn build_cloud(&self, mesh: &Mesh) -> Result<Cloud> {
        Ok(self.given_points(mesh)?.cloud)
    }

    /// The material points, with what a file says of them.
    ///
    /// # Errors
    /// A cloud file that does not fit the mesh.
    pub fn given_points(&self, mesh: &Mesh) -> Result<Given> {
        match &self.cloud.layout {
            Layout::File(path) => read_points(&self.resolve(path), mesh),
            _ => Ok(Given { cloud: self.seeded(mesh), ..Given::default() }),
        }
    }

    /// The material points of a scene without a cloud file.
    fn seeded(&self, mesh: &Mesh) -> Cloud {
        let material = self.material_of_cells(mesh);
        // Materials of one pattern are one body to it.
        let mut bodies: Vec<(&Choice, Cloud)> = Vec::new();
        for choice in self.materials.iter().map(|m| &m.cloud) {
            if let Layout::Body(body) = &choice.layout
                && bodies.iter().all(|(known, _)| *known != choice)
            {
                let member: Vec<bool> = material.iter().map(|&m| self.materials[m].cloud == *choice).collect();
                bodies.push((choice, body.pattern(mesh, &member, choice.per_direction).seed(mesh, &member)));
            }
        }
        let push = |cell: usize, xi: &mut Vec<[f64; 2]>| {
            let choice = &self.materials[material[cell]].cloud;
            match choice.layout {
                Layout::InCells(layout) => xi.extend(layout.points(choice.per_direction, cell)),
                Layout::Body(_) => {
                    let own = bodies.iter().filter(|(known, _)| *known == choice);
                    own.for_each(|(_, cloud)| xi.extend_from_slice(cloud.of(cell)));
                }
                // Only [cloud] can name a file, and it has none here.
                Layout::File(_) => {
                    xi.extend(seed::default_layout(self.scheme.degree).points(choice.per_direction, cell));
                }
            }
        };
        Cloud::of_cells(mesh.cells.len(), push)
    }

    /// The points that the scheme samples on: where the method has points, virtual ones stand in cells that cannot carry
    /// the degree.
    ///
    /// # Errors
    /// A part of the body without any point.
    pub fn sample(&self, mesh: &Mesh, cloud: Cloud) -> Result<Sampled> {
        if self.scheme.method != Method::AderDgmpm {
            return Ok(Sampled::as_given(cloud));
        }
        let found = carry(mesh, &Line::new(self.scheme.degree), &cloud, &self.limits)?;
        if found.deficient.is_empty() {
            return Ok(Sampled::as_given(cloud));
        }
        let virtual_points = found.kept.iter().map(|kept| !kept).collect();
        Ok(Sampled { cloud: found.cloud, virtual_points, source: found.source, deficient: found.deficient })
    }
}

impl Body {
    /// The `angle` of a lattice that names none, degrees: not that of any usual grid, nor of its diagonals.
    pub const ANGLE: f64 = 30.0;

    /// The pattern with its spacing: where the scene gives none, as many points as k^2 a cell in the mean.
    fn pattern(&self, mesh: &Mesh, member: &[bool], k: usize) -> Pattern {
        let usual = || body::mean_spacing(mesh, member, k);
        match *self {
            Body::PoissonDisk { seed, spacing } => {
                Pattern::PoissonDisk { seed, spacing: spacing.unwrap_or_else(|| Pattern::DISK * usual()) }
            }
            Body::Rotated { angle, spacing } => Pattern::Rotated { angle, spacing: spacing.unwrap_or_else(usual) },
        }
    }
}
