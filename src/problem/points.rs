//! From a scene to the material points, and to those that the scheme samples on.

use crate::cloud::{Cloud, Locator, from_points, seed};
use crate::error::{Error, Place, Result};
use crate::io::grid::Field;
use crate::io::{cloud_file, points, store};
use crate::mesh::Mesh;
use crate::operators::carry::{Cause, Deficient};
use crate::operators::certificate::{Certificate, Class, certify};
use crate::operators::{Line, Sampling, carry};
use crate::registry::layouts::{InCell, Points};
use crate::scene::{Cloud as Choice, Histories, Material, Scene};
use std::borrow::Cow;
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

/// The material points of a run. The scheme samples at them, but for cells of a law with memory: see [`Scene::places`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sampled {
    /// Its points.
    pub cloud: Cloud,
    /// Whether each of them is virtual (on a Gauss node, as its cell cannot carry the degree); empty where none is.
    pub virtual_points: Vec<bool>,
    /// For each of them the given point that it is or that is nearest; empty where they are the given points.
    pub source: Vec<usize>,
    /// The cells that have virtual points in place of the given ones, and those that sample on others than their points.
    pub deficient: Vec<Deficient>,
    /// The certificate of each cell on what the scheme samples there, without dt.
    pub certificates: Vec<Certificate>,
}

impl Scene {
    /// The material points.
    ///
    /// # Errors
    /// A cloud file that does not fit the mesh; more points than the memory holds.
    pub fn build_cloud(&self, mesh: &Mesh) -> Result<Cloud> {
        Ok(self.given_points(mesh)?.cloud)
    }

    /// The material points, with what a file says of them.
    ///
    /// # Errors
    /// A cloud file that does not fit the mesh; more points than the memory holds.
    pub fn given_points(&self, mesh: &Mesh) -> Result<Given> {
        self.check_room("mesh", mesh.cells.len())?;
        match self.cloud_path() {
            Some(_) => {
                read_points(&self.existing("cloud.path", Path::new(self.cloud.layout.values.text("path")))?, mesh)
            }
            None => Ok(Given { cloud: self.seeded(mesh)?, ..Given::default() }),
        }
    }

    /// The material points of a scene without a cloud file.
    fn seeded(&self, mesh: &Mesh) -> Result<Cloud> {
        let material = self.material_of_cells(mesh);
        // Materials of one pattern are one body to it.
        let mut bodies: Vec<(&Choice, Cloud)> = Vec::new();
        for (number, choice) in self.materials.iter().map(|m| &m.cloud).enumerate() {
            if let Points::Body(points) = choice.layout.build().points
                && bodies.iter().all(|(known, _)| *known != choice)
            {
                let member: Vec<bool> = material.iter().map(|&m| self.materials[m].cloud == *choice).collect();
                self.check_room_of_points(mesh, &member, number)?;
                bodies.push((choice, points(&choice.layout.values, mesh, &member, choice.per_direction)));
            }
        }
        let degree = self.scheme.degree;
        let usual = move |k: usize, cell: usize| seed::default_layout(degree).points(k, cell);
        let in_cell = |m: &Material| match m.cloud.layout.build().points {
            Points::Cells(points) => Some(points(&m.cloud.layout.values)),
            Points::Body(_) => None,
            // Only [cloud] can name a file, and it has none here.
            Points::File => Some(Box::new(usual) as _),
        };
        let in_cell: Vec<Option<InCell>> = self.materials.iter().map(in_cell).collect();
        let push = |cell: usize, xi: &mut Vec<[f64; 2]>| {
            let choice = &self.materials[material[cell]].cloud;
            match &in_cell[material[cell]] {
                Some(points) => xi.extend(points(choice.per_direction, cell)),
                None => {
                    let own = bodies.iter().filter(|(known, _)| *known == choice);
                    own.for_each(|(_, cloud)| xi.extend_from_slice(cloud.of(cell)));
                }
            }
        };
        Ok(Cloud::of_cells(mesh.cells.len(), push))
    }

    /// The material points of the run: where the method has points, virtual ones stand in cells that cannot carry the
    /// degree. Cells of a law with memory keep theirs, whatever the scheme samples on.
    ///
    /// # Errors
    /// A part of the body without any point.
    pub fn sample(&self, mesh: &Mesh, cloud: Cloud) -> Result<Sampled> {
        let line = Line::new(self.scheme.degree);
        if !self.scheme.method.has_points() {
            let certificates = certify(mesh, &line, Sampling::Nodes)?;
            return Ok(Sampled { cloud, certificates, ..Sampled::default() });
        }
        let memory = self.on_nodes(&self.material_of_cells(mesh));
        let found = carry(mesh, &line, &cloud, &self.limits_of_cells(), &memory)?;
        let mut certificates = found.certificates;
        for (certificate, _) in certificates.iter_mut().zip(&memory).filter(|(_, memory)| **memory) {
            certificate.class = Class::Nodes;
        }
        let (deficient, cause) = (found.deficient, Cause::Memory);
        if deficient.iter().all(|cell| cell.cause == cause) {
            return Ok(Sampled { cloud, deficient, certificates, ..Sampled::default() });
        }
        let mut out = Sampled { cloud: Cloud { first: vec![0], xi: vec![] }, certificates, ..Sampled::default() };
        for cell in 0..mesh.cells.len() {
            let points = found.cloud.first[cell]..found.cloud.first[cell + 1];
            let (xi, source) = match memory.get(cell) {
                Some(true) => (cloud.of(cell), (cloud.first[cell]..cloud.first[cell + 1]).collect()),
                _ => (found.cloud.of(cell), found.source[points.clone()].to_vec()),
            };
            let is_virtual = memory.get(cell) != Some(&true) && found.kept[points].contains(&false);
            out.virtual_points.resize(out.virtual_points.len() + xi.len(), is_virtual);
            out.source.extend(source);
            out.cloud.xi.extend_from_slice(xi);
            out.cloud.first.push(out.cloud.xi.len());
        }
        Ok(Sampled { deficient, ..out })
    }

    /// Whether each cell samples on its Gauss nodes although the method has points: its law has memory, and the scene does
    /// not keep the histories at the points. Empty: no cell does. `material` has the number of the material of each cell.
    pub fn on_nodes(&self, material: &[usize]) -> Vec<bool> {
        let of = |m: &Material| m.histories == Some(Histories::Nodes);
        if !self.scheme.method.has_points() || !self.materials.iter().any(of) {
            return vec![];
        }
        material.iter().map(|&m| of(&self.materials[m])).collect()
    }

    /// Where the scheme samples and internal variables stand, as [`Scheme::places`](crate::step::Scheme::places) has it: the
    /// material points, or the Gauss nodes where the method has no points or the law has memory.
    pub fn places<'a>(&self, cloud: &'a Cloud, material: &[usize]) -> Cow<'a, Cloud> {
        let on_nodes = match self.scheme.method.has_points() {
            true => self.on_nodes(material),
            false => vec![true; material.len()],
        };
        if !on_nodes.contains(&true) {
            return Cow::Borrowed(cloud);
        }
        let nodes = Line::new(self.scheme.degree).nodes();
        let push = |cell: usize, xi: &mut Vec<[f64; 2]>| {
            xi.extend_from_slice(if on_nodes[cell] { &nodes } else { cloud.of(cell) });
        };
        Cow::Owned(Cloud::of_cells(material.len(), push))
    }
}
