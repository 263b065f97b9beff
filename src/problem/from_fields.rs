//! A start from fields at the nodes of a mesh of another program: v, and F itself or the displacement whose gradient makes it.
//!
//! The grid nodes of the scheme take the bilinear interpolation of the file in the cell of the file in which they lie. F = I + du/dX
//! comes from the gradient at the nodes of the file, see [`recover::gradient`]: fields that are linear come in exactly, others with
//! order 2 in the size of the cells of the file.

use crate::cloud::Locator;
use crate::error::{Error, Place, Result};
use crate::format;
use crate::io::nodal::{self, Nodal};
use crate::io::unstructured::AtNodes;
use crate::mesh::{Mesh, map, recover};
use crate::names::did_you_mean;
use crate::operators::Line;
use crate::scene::{Fields, Scene};
use std::path::Path;

/// A third component of a vector beyond this share of the largest is a motion out of the plane.
const PLANE: f64 = 1e-9;

/// Cells of the file by which a node may lie outside of its mesh: where a boundary is curved, meshes of other sizes differ by as much. On a
/// circle of 12 cells it is 0.07.
const GAP: f64 = 0.1;

/// What a start takes from a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Given {
    mesh: Mesh,
    /// v at the nodes of the file, in m/s.
    velocity: Option<Vec<[f64; 2]>>,
    /// u, in m.
    displacement: Option<Vec<[f64; 2]>>,
    /// F as 11, 12, 21, 22, where the file has it.
    deformation: Option<Vec<[f64; 4]>>,
}

/// What holds at a point of the body; none where the file does not say it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Values {
    /// v, in m/s.
    pub velocity: Option<[f64; 2]>,
    /// u, in m.
    pub displacement: Option<[f64; 2]>,
    /// F as 11, 12, 21, 22.
    pub deformation: Option<[f64; 4]>,
}

/// Fields of a file that can be asked at any point of its mesh, and near it.
pub(super) struct Sampler {
    locator: Locator,
    given: Given,
    /// The largest side of the box around a cell, m.
    largest: f64,
}

impl Scene {
    /// Reads what the start takes from the file that a scene names.
    ///
    /// # Errors
    /// A file that cannot be read; a field that is missing, has another number of components, or is not finite.
    pub(super) fn given_fields(&self, fields: &Fields) -> Result<Given> {
        let path = self.existing("initial.fields", &fields.path)?;
        let nodal = nodal::read(&path, fields.time)?;
        let taken = Taken { scene: self, path: &path, nodal: &nodal };
        let free = ["initial.velocity", "initial.deformation"].map(|key| !self.gives(key));
        let velocity = taken.field("velocity", fields.velocity.as_deref(), free[0], &[2, 3])?;
        // Where one of both is named, the other is not looked for.
        let [by_f, by_u] = [fields.displacement.is_none(), fields.deformation.is_none()].map(|other| other && free[1]);
        let deformation = taken.field("deformation", fields.deformation.as_deref(), by_f, &[4, 9])?;
        let displacement = taken.field("displacement", fields.displacement.as_deref(), by_u, &[2, 3])?;
        if velocity.is_none() && displacement.is_none() && deformation.is_none() {
            return Err(taken.nothing());
        }
        let vector = |data: Option<&AtNodes>| data.map(|data| taken.vector(data)).transpose();
        let (velocity, displacement) = (vector(velocity)?, vector(displacement)?);
        let deformation = deformation.map(|data| taken.tensor(data)).transpose()?;
        Ok(Given { mesh: nodal.mesh, velocity, displacement, deformation })
    }

    /// The fields of the start, where it takes them from a file.
    ///
    /// # Errors
    /// As for [`Scene::given_fields`].
    pub(super) fn sampler(&self) -> Result<Option<Sampler>> {
        self.initial.fields.as_ref().map(|fields| Ok(Sampler::of(self.given_fields(fields)?))).transpose()
    }

    /// Values of the file at a point of a cell of the body.
    ///
    /// # Errors
    /// A point outside of the mesh of the file, or J <= 0 there.
    pub(super) fn sampled(&self, fields: &Sampler, x: [f64; 2], cell: u64) -> Result<Values> {
        let Some(values) = fields.at(x) else {
            let [low, high] = fields.given.mesh.extent();
            let what = format!(
                "the mesh of the file ends before the body: a grid node of cell {cell} at X = ({}, {}) is in no cell of the file, \
                 and farther from all than {GAP} of a cell",
                x[0], x[1]
            );
            let remedy = format!(
                "give a file whose mesh covers the body, in the initial configuration and in m; it fills [{}, {}] x [{}, {}]",
                low[0], high[0], low[1], high[1]
            );
            return Err(self.error("initial.fields", what, remedy));
        };
        match values.deformation.map(|[a, b, c, d]| a * d - b * c) {
            Some(j) if j <= 0.0 => {
                let what = format!("F of the file has J = {j} at X = ({}, {}) in cell {cell}", x[0], x[1]);
                Err(self.error("initial.fields", what, "give fields of a body of which no part is turned inside out"))
            }
            _ => Ok(values),
        }
    }

    /// How many grid nodes of a mesh lie beside that of the file, and take the values of its nearest cells; none where all lie in it.
    pub(super) fn notice_of_fields(&self, mesh: &Mesh) -> Option<String> {
        // What is wrong with the file has ended the run before.
        let (fields, nodes) = (self.sampler().ok()??, Line::new(self.scheme.degree).nodes());
        let (mut count, mut farthest) = (0, 0.0_f64);
        for (cell, xi) in (0..mesh.cells.len()).flat_map(|cell| nodes.iter().map(move |xi| (cell, *xi))) {
            let x = map::position(&mesh.map(cell), xi);
            if fields.locator.find(x).is_none() {
                (count, farthest) = (count + 1, fields.beside(x).map_or(farthest, |near| farthest.max(near.0)));
            }
        }
        let file = self.initial.fields.as_ref()?.path.display().to_string();
        (count > 0).then(|| {
            let nodes = format::count(count, "grid node");
            format!("outside of the mesh of {file}: {nodes}, by up to {farthest:.0e} of a cell; the nearest cells give the values there")
        })
    }

    /// Whether two files give the same start: that of the scene, and its copy in the folder of a run.
    pub(super) fn same_fields(&self, copy: &Path) -> Result<bool> {
        let Some(fields) = &self.initial.fields else { return Ok(true) };
        let copy = Fields { path: copy.canonicalize().unwrap_or_else(|_| copy.to_owned()), ..Fields::default() };
        Ok(self.given_fields(fields)? == self.given_fields(&copy)?)
    }

    /// Writes what the start takes from its file, under the usual names.
    ///
    /// # Errors
    /// Files that cannot be read or written.
    pub(super) fn store_fields(&self, target: &Path) -> Result<()> {
        let Some(fields) = &self.initial.fields else { return Ok(()) };
        let Given { mesh, velocity, displacement, deformation } = self.given_fields(fields)?;
        let mut all = Vec::new();
        all.extend(velocity.map(|values| nodal::vector("velocity", &values)));
        all.extend(displacement.map(|values| nodal::vector("displacement", &values)));
        all.extend(deformation.map(|values| nodal::tensor("deformation", &values)));
        nodal::write(target, &mesh, &all)
    }
}

/// A file from which fields are taken.
struct Taken<'a> {
    scene: &'a Scene,
    path: &'a Path,
    nodal: &'a Nodal,
}

impl<'a> Taken<'a> {
    /// The data of a name, or of the usual one where that is `free`; their components are checked.
    fn field(&self, usual: &str, name: Option<&str>, free: bool, sizes: &[usize]) -> Result<Option<&'a AtNodes>> {
        if name.is_none() && !free {
            return Ok(None);
        }
        let (wanted, key) = (name.unwrap_or(usual), format!("initial.{usual}_field"));
        let Some(data) = self.nodal.data.iter().find(|data| data.name == wanted) else {
            let Some(name) = name else { return Ok(None) };
            let known: Vec<&str> = self.nodal.data.iter().map(|data| data.name.as_str()).collect();
            let what = format!("{} has no data `{name}` at its nodes", self.path.display());
            return Err(self.scene.error(&key, what, format!("{}{}", did_you_mean(name, &known), self.known())));
        };
        if !sizes.contains(&data.components) {
            let what = format!("the data `{wanted}` of the file have {} number(s) at a node", data.components);
            let remedy = format!("{usual} has {} or {}", sizes[0], sizes[1]);
            return Err(Error::at(Place::file(self.path), what, remedy));
        }
        let used = self.nodal.mesh.cells.iter().flatten();
        let row = |node: usize| &data.values[data.components * node..data.components * (node + 1)];
        if let Some(&node) = used.into_iter().find(|&&node| row(node).iter().any(|x| !x.is_finite())) {
            let what = format!("`{wanted}` is {:?} at node {node} (from 0)", row(node));
            return Err(Error::at(
                Place::file(self.path),
                what,
                "give numbers that are finite at all nodes of the cells",
            ));
        }
        Ok(Some(data))
    }

    fn known(&self) -> String {
        let all: Vec<String> =
            self.nodal.data.iter().map(|data| format!("{} ({})", data.name, data.components)).collect();
        match &all[..] {
            [] => "it has no data at its nodes; data at cells are not read".to_owned(),
            all => format!("it has, with the numbers at a node: {}", all.join(", ")),
        }
    }

    fn nothing(&self) -> Error {
        let what = format!("{} has no field that the start could take", self.path.display());
        let remedy = format!("name some by velocity_field, displacement_field or deformation_field: {}", self.known());
        self.scene.error("initial.fields", what, remedy)
    }

    fn vector(&self, data: &AtNodes) -> Result<Vec<[f64; 2]>> {
        let rows = data.values.chunks_exact(data.components);
        let size = data.values.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        if let Some(node) = rows.clone().position(|row| row.get(2).is_some_and(|z| z.abs() > PLANE * size)) {
            let what = format!("`{}` leaves the plane at node {node} (from 0)", data.name);
            return Err(Error::at(Place::file(self.path), what, "give a field in the plane: its third component is 0"));
        }
        Ok(rows.map(|row| [row[0], row[1]]).collect())
    }

    fn tensor(&self, data: &AtNodes) -> Result<Vec<[f64; 4]>> {
        let places = if data.components == 4 { [0, 1, 2, 3] } else { [0, 1, 3, 4] };
        Ok(data.values.chunks_exact(data.components).map(|row| places.map(|k| row[k])).collect())
    }
}

impl Sampler {
    fn of(mut given: Given) -> Self {
        if let (None, Some(displacement)) = (&given.deformation, &given.displacement) {
            let gradient = recover::gradient(&given.mesh, displacement);
            given.deformation = Some(gradient.into_iter().map(|[a, b, c, d]| [1.0 + a, b, c, 1.0 + d]).collect());
        }
        let sides = (0..given.mesh.cells.len()).flat_map(|cell| {
            let corners = given.mesh.corners(cell);
            let of =
                |axis: usize, pick: fn(f64, f64) -> f64| corners.iter().map(|x| x[axis]).reduce(pick).unwrap_or(0.0);
            [0, 1].map(|axis| of(axis, f64::max) - of(axis, f64::min))
        });
        let largest = sides.fold(0.0, f64::max);
        Self { locator: Locator::new(&given.mesh), given, largest }
    }

    /// The cell of which a point outside of the mesh is nearest, by parent coordinates: how far outside it is, the cell, and the parent
    /// coordinates there. None beyond [`GAP`].
    fn beside(&self, x: [f64; 2]) -> Option<(f64, usize, [f64; 2])> {
        let (reach, mut near) = (GAP * self.largest, Vec::new());
        self.locator.overlapping(x.map(|x| x - reach), x.map(|x| x + reach), &mut near);
        near.sort_unstable();
        let found = near.into_iter().filter_map(|cell| {
            let xi = map::parent(&self.given.mesh.map(cell), x)?;
            let outside = xi.iter().fold(0.0, |outside: f64, xi| outside.max(-xi).max(xi - 1.0));
            (outside <= GAP).then_some((outside, cell, xi))
        });
        found.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The bilinear interpolation at a point, or what the nearest cell gives there; none farther outside of the mesh.
    fn at(&self, x: [f64; 2]) -> Option<Values> {
        let (cell, [r, s]) = self.locator.find(x).or_else(|| self.beside(x).map(|(_, cell, xi)| (cell, xi)))?;
        let nodes = self.given.mesh.cells[cell];
        let weights = [(1.0 - r) * (1.0 - s), r * (1.0 - s), r * s, (1.0 - r) * s];
        Some(Values {
            velocity: interpolated(self.given.velocity.as_deref(), nodes, weights),
            displacement: interpolated(self.given.displacement.as_deref(), nodes, weights),
            deformation: interpolated(self.given.deformation.as_deref(), nodes, weights),
        })
    }
}

fn interpolated<const N: usize>(values: Option<&[[f64; N]]>, nodes: [usize; 4], weights: [f64; 4]) -> Option<[f64; N]> {
    let values = values?;
    Some(std::array::from_fn(|k| (0..4).map(|corner| weights[corner] * values[nodes[corner]][k]).sum()))
}
