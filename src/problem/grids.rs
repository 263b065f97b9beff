//! The meshes of `[[regrid]]`, made from the scene and the state at hand, and when one is due.

use crate::error::{Error, Result};
use crate::mesh::{Mesh, map};
use crate::observe::Solution;
use crate::operators::{Line, Sampling, certificate::certify};
use crate::registry::grids::{Present, Rule, fronts};
use crate::scene::Scene;
use crate::scene::regrid::Criteria;
use std::path::{Path, PathBuf};

/// A `[[regrid]]` of a scene, by number.
struct Numbered<'a>(&'a Scene, usize);

impl Rule for Numbered<'_> {
    fn resolve(&self, path: &str) -> PathBuf {
        self.0.resolve(Path::new(path))
    }

    fn is_alone(&self) -> bool {
        self.0.regrids.len() == 1
    }

    fn base(&self) -> Result<Mesh> {
        self.0.build_mesh()
    }

    fn accepts(&self, mesh: &Mesh) -> Result<()> {
        self.0.check_mesh(mesh)
    }

    fn has_room(&self, key: &str, cells: usize) -> Result<()> {
        self.0.check_room(&format!("regrid.{}.{key}", self.1), cells)
    }

    fn wrong(&self, key: &str, what: String, remedy: &str) -> Error {
        self.0.error(&format!("regrid.{}.{key}", self.1), what, remedy)
    }
}

impl Scene {
    /// The mesh of a `[[regrid]]` (by number), which has fired `count` times before; groups are checked.
    ///
    /// # Errors
    /// A mesh that cannot be made; groups that it lacks, with a list of those that it has.
    pub fn regrid_mesh(&self, rule: usize, count: usize, present: &Present) -> Result<Mesh> {
        let grid = &self.regrids[rule].grid;
        let mesh = (grid.build().make)(&grid.values, &Numbered(self, rule), count, present)?;
        let mesh = self.cut_mesh(mesh)?;
        self.check_exact_materials(&mesh)?;
        Ok(mesh)
    }

    /// Looks before the first step at what can be known then of all `[[regrid]]`: files, and changes of `first`, the mesh of
    /// the start.
    ///
    /// # Errors
    /// A file that cannot be read, or whose groups are not those of the scene; a shift that is too far.
    pub fn check_regrids(&self, first: &Mesh) -> Result<()> {
        let check = |(rule, regrid): (usize, &crate::scene::regrid::Regrid)| {
            (regrid.grid.build().check)(&regrid.grid.values, &Numbered(self, rule), first)
        };
        self.regrids.iter().enumerate().try_for_each(check)
    }

    /// Whether a `[[regrid]]` whose time has come is due by its criteria.
    pub fn regrid_is_due(&self, rule: usize, present: &Present) -> bool {
        let criteria = self.regrids[rule].criteria;
        let Criteria { certificate, distortion, front } = criteria;
        criteria.are_none()
            || certificate.is_some_and(|limit| self.worst_certificate(present) > limit)
            || distortion.is_some_and(|limit| worst_shape(present) < limit)
            || front.is_some_and(|share| !fronts(present, share).is_empty())
    }

    /// The largest face Lebesgue constant.
    fn worst_certificate(&self, present: &Present) -> f64 {
        let places = self.places(present.cloud, present.material);
        let sampling = self.needs(&places).sampling.unwrap_or(Sampling::Nodes);
        let all = certify(present.view.mesh, &Line::new(self.scheme.degree), sampling);
        // A fit that fails is worse than any limit.
        all.map_or(f64::INFINITY, |all| all.iter().map(|c| c.lebesgue).fold(0.0, f64::max))
    }
}

/// The smallest scaled Jacobian of all cells in the current configuration: X + u at the corners where the displacement is
/// known, else the corners moved by the cell's own F about its middle.
fn worst_shape(present: &Present) -> f64 {
    let view = present.view;
    let solution = Solution::of_state(view.scheme, view.state, present.material);
    let shape = |cell: usize| {
        let map = view.mesh.map(cell);
        let middle = map::position(&map, [0.5; 2]);
        let at: [[f64; 2]; 4] = std::array::from_fn(|k| {
            let there = solution.at(cell, map::CORNER_XI[k]);
            let x = map.corners[k];
            if solution.has_displacement() {
                return [x[0] + there.displacement[0], x[1] + there.displacement[1]];
            }
            let (f, r) = (solution.at(cell, [0.5; 2]).deformation, [x[0] - middle[0], x[1] - middle[1]]);
            [f[0] * r[0] + f[1] * r[1], f[2] * r[0] + f[3] * r[1]]
        });
        let of_corner = |xi| {
            let j = map::jacobian(&at, xi);
            map::determinant(&j) / (j[0][0].hypot(j[1][0]) * j[0][1].hypot(j[1][1]))
        };
        map::CORNER_XI.into_iter().map(of_corner).fold(f64::INFINITY, f64::min)
    };
    (0..view.mesh.cells.len()).map(shape).fold(f64::INFINITY, f64::min)
}
