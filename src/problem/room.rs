//! Whether what a scene asks for has room in the memory of this machine. It is looked at before it is made: a system without
//! free memory ends the program without a word.

use crate::error::{Error, Result};
use crate::file::memory::available;
use crate::mesh::{Mesh, map};
use crate::registry::layouts::Points;
use crate::scene::{Cloud, Mesh as Source, Scene};
use crate::state::UNKNOWNS;
use crate::step::Method;

/// Bytes of a cell in the mesh, its links and blocks.
const MESH: f64 = 500.0;

const GIB: f64 = (1_u64 << 30) as f64;

/// Whether a mesh of so many cells has room, before it is made.
///
/// # Errors
/// More memory than is free.
pub fn check_mesh(cells: usize) -> Result<()> {
    let (needed, available) = (cells as f64 * MESH, available() as f64);
    if needed <= available {
        return Ok(());
    }
    let (needed, available) = (needed / GIB, available / GIB);
    let what = format!("{cells} cells need about {needed:.1} GiB of memory, and {available:.1} GiB are free");
    Err(Error::input(what, "give fewer cells"))
}

/// Cells that are to be made.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// How many.
    pub cells: usize,
    /// Material points in a cell, in the mean.
    pub points: f64,
    /// Whether each cell has points of its own, and so matrices of its own.
    pub own_points: bool,
    /// Whether each cell has a shape of its own.
    pub own_shape: bool,
}

impl Wanted {
    /// Bytes of state, work and matrices of a run of the scene: at the least.
    pub fn bytes(&self, scene: &Scene) -> f64 {
        let m = (scene.scheme.degree + 1) as f64;
        let (n, np) = (m * m, self.points);
        let stages = match scene.integration() {
            Method::RungeKutta(tableau) => tableau.stages() as f64,
            Method::Ader { .. } => 1.0,
        };
        // State, its start, its copy at the end, the next one, the numbers before they are packed; rates.
        let unknowns = (UNKNOWNS + 2) as f64 * n * (5.0 + stages);
        // A trace has at most eleven numbers.
        let geometry = 6.0 * n + 4.0 * m * 11.0 + 6.0 * np;
        // One copy of each class while they are built, one in blocks.
        let if_own = |own: bool, numbers: f64| if own { 2.0 * numbers } else { 0.0 };
        let own = if_own(self.own_points, 2.0 * n * np + 2.0 * np * np) + if_own(self.own_shape, 2.0 * n * n);
        // Traces of the displacement of unequal cells.
        let own = own + if_own(self.own_shape, 4.0 * m * n);
        self.cells as f64 * (MESH + 8.0 * (unknowns + geometry + own))
    }

    /// What it needs and what is free, GiB, where that is too little.
    pub fn lacks(&self, scene: &Scene) -> Option<[f64; 2]> {
        let (needed, available) = (self.bytes(scene), available() as f64);
        (needed > available).then_some([needed / GIB, available / GIB])
    }
}

impl Scene {
    /// Whether so many cells have room, before they are made; `key` asks for them.
    ///
    /// # Errors
    /// More memory than is free.
    pub fn check_room(&self, key: &str, cells: usize) -> Result<()> {
        let has_points = self.scheme.method.has_points();
        let per_cell = |cloud: &Cloud| if cloud.layout.build().is_file() { 0 } else { cloud.per_direction.pow(2) };
        // The least of all materials: how many cells each has is not known yet.
        let least = self.materials.iter().map(|material| per_cell(&material.cloud)).min().unwrap_or(0);
        let wanted = Wanted {
            cells,
            points: if has_points { least as f64 } else { 0.0 },
            own_points: has_points && self.materials.iter().all(|material| !material.cloud.layout.build().is_lattice),
            own_shape: matches!(self.mesh, Source::File(_)),
        };
        match wanted.lacks(self) {
            None => Ok(()),
            Some([needed, available]) => {
                let what = format!(
                    "{cells} cells of degree {} need about {needed:.1} GiB of memory, and {available:.1} GiB are free",
                    self.scheme.degree
                );
                Err(self.error(key, what, "give fewer cells, or a lower degree"))
            }
        }
    }

    /// Whether the points of a pattern of the body have room, before they are made; `number` is that of a material.
    ///
    /// # Errors
    /// More memory than is free.
    pub(super) fn check_room_of_points(&self, mesh: &Mesh, member: &[bool], number: usize) -> Result<()> {
        let cloud = &self.materials[number].cloud;
        let (Points::Body(_), Some(spacing)) = (&cloud.layout.build().points, cloud.layout.values.maybe("spacing"))
        else {
            return Ok(());
        };
        let cells = member.iter().filter(|is| **is).count();
        let own = (0..mesh.cells.len()).filter(|&cell| member[cell]);
        let area: f64 = own.map(|cell| map::area(&mesh.map(cell))).sum();
        // A disk pattern has .64 and more of the points of a square lattice.
        let points = 0.64 * area / (spacing * spacing);
        let wanted = Wanted { cells, points: points / cells.max(1) as f64, own_points: true, own_shape: false };
        let Some([needed, available]) = wanted.lacks(self) else { return Ok(()) };
        let (own, general) = (format!("material.{number}.spacing"), "cloud.spacing".to_owned());
        let key = if self.gives(&own) { own } else { general };
        let what = format!(
            "{points:.1e} points at a distance of {spacing:e} m need about {needed:.1e} GiB of memory, and {available:.1} GiB \
             are free"
        );
        Err(self.error(&key, what, "give a larger distance, or leave it out: per_direction then says how many points"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn scene(more: &str) -> Scene {
        let sides = ["left", "right", "bottom", "top"].map(|group| format!("{{group=\"{group}\",kind=\"free\"}}"));
        let text = format!(
            "boundary = [{}]\n[mesh]\nrectangle = {{ size = [1, 1], cells = [8, 8] }}\n[[material]]\nlaw = \"neo-hookean\"\n\
             young = 1\npoisson = 0\ndensity = 1\n[scheme]\nmethod = \"ader-dgmpm\"\ndegree = 2\n[time]\nend = 1\n{more}",
            sides.join(",")
        );
        Scene::parse(&text, Path::new("case.toml"), &[]).unwrap()
    }

    fn refused(more: &str) -> String {
        let scene = scene(more);
        scene.build_mesh().and_then(|mesh| scene.given_points(&mesh).map(drop)).unwrap_err().to_string()
    }

    #[test]
    fn what_no_machine_holds_is_refused_at_its_key_before_it_is_made() {
        // 1e10 cells are 3e13 bytes, 6e13 points of 64 cells have matrices of 1e28 numbers.
        let cells = scene("").with(&["mesh.rectangle.cells=[100000, 100000]".to_owned()]).unwrap();
        let why = cells.build_mesh().unwrap_err().to_string();
        assert!(
            why.contains("mesh.rectangle.cells=") && why.contains("10000000000 cells of degree 2 need about"),
            "{why}"
        );
        for layout in ["poisson-disk", "rotated"] {
            let why = refused(&format!("[cloud]\nlayout = \"{layout}\"\nspacing = 1e-7\n"));
            assert!(why.starts_with("case.toml:16:11: 6.4e13 points at a distance of 1e-7 m need"), "{why}");
        }
        let body = scene("").build_mesh().unwrap();
        assert!(scene("[cloud]\nlayout = \"rotated\"\nspacing = 0.05\n").given_points(&body).is_ok());
    }

    #[test]
    fn the_estimate_is_below_what_a_problem_takes_and_not_far_from_it() {
        for more in ["", "[cloud]\nlayout = \"jitter\"\n"] {
            let scene = scene(more);
            let problem = crate::problem::Problem::new(&scene).unwrap();
            let taken = problem.cost().map_err(|_| ()).unwrap().bytes as f64;
            let own_points = !more.is_empty();
            let wanted = Wanted { cells: 64, points: 9.0, own_points, own_shape: false };
            // The rest is mesh, links and what is copied while it is built, of which a finished problem knows nothing.
            let share = taken / wanted.bytes(&scene);
            assert!((0.2..1.5).contains(&share), "{more}: {share}");
        }
    }
}
