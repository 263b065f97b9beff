//! The meshes of `[[regrid]]`, made from the scene and the state at hand.

use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::{gmsh, read_mesh};
use crate::mesh::{self, Mesh, map};
use crate::observe::{Solution, View};
use crate::operators::{Line, Sampling, certificate::certify};
use crate::regrid::TensorGrid;
use crate::scene::Scene;
use crate::scene::regrid::{Around, Criteria, NewMesh, Strip};

/// What a new grid may depend on.
#[derive(Clone, Copy)]
pub struct Present<'a> {
    /// The state.
    pub view: &'a View<'a>,
    /// Its points.
    pub cloud: &'a Cloud,
    /// The material of each cell.
    pub material: &'a [usize],
}

impl Scene {
    /// The mesh of a `[[regrid]]` (by number), which has fired `count` times before; groups are checked.
    ///
    /// # Errors
    /// A mesh that cannot be made; groups that it lacks, with a list of those that it has.
    pub fn regrid_mesh(&self, rule: usize, count: usize, present: &Present) -> Result<Mesh> {
        let key = |name: &str| format!("regrid.{rule}.{name}");
        let (now, time) = (present.view.mesh, present.view.state.time);
        let mesh = match &self.regrids[rule].grid {
            NewMesh::Files(files) => read_mesh(&self.resolve(&files[count % files.len()]))?,
            NewMesh::Rectangles(all) => {
                let (size, cells) = all[count % all.len()];
                mesh::rectangle(size, cells)?
            }
            NewMesh::Refine(k) => now.refined(*k),
            NewMesh::Coarsen(k) => self.coarsened(rule, now, *k)?,
            // There and back: nodes that went the same way each time would leave their cells.
            NewMesh::Shift(by) => {
                let sign = if count.is_multiple_of(2) { 1.0 } else { -1.0 };
                shifted(now, by.map(|by| sign * by)).map_err(|turned| self.too_far(rule, &turned))?
            }
            NewMesh::Strips(strips) => self.with_strips(strips, present).map_err(|what| {
                self.error(
                    &key("strips"),
                    what,
                    "strips need a mesh of the scene that is a grid of lines, of one group",
                )
            })?,
            NewMesh::Geometry { path, size } => {
                let size = size.as_ref().map(|size| move |x: [f64; 2]| size.eval(x, time));
                let size = size.as_ref().map(|size| size as &dyn Fn([f64; 2]) -> f64);
                let made = gmsh::program::mesh(&self.resolve(path), size, now);
                made.map_err(|(what, remedy)| self.error(&key("geo"), what, remedy))?
            }
        };
        self.check_mesh(&mesh)?;
        self.check_exact_materials(&mesh)?;
        Ok(mesh)
    }

    /// A shift that turns a cell inside out.
    fn too_far(&self, rule: usize, turned: &mesh::Error) -> Error {
        let remedy = "shift by a part of the smallest cell; each second time the nodes go back";
        self.error(&format!("regrid.{rule}.shift"), turned.to_string(), remedy)
    }

    /// Looks at the mesh files of all `[[regrid]]` before the first step, and at shifts of `first`, the mesh of the start.
    ///
    /// # Errors
    /// A file that cannot be read, or whose groups are not those of the scene; a shift that is too far.
    pub fn check_regrids(&self, first: &Mesh) -> Result<()> {
        // Another rule may change the cells before one is due that changes them further.
        let alone = self.regrids.len() == 1;
        for (rule, regrid) in self.regrids.iter().enumerate() {
            match &regrid.grid {
                NewMesh::Shift(by) if alone => {
                    shifted(first, *by).map_err(|turned| self.too_far(rule, &turned))?;
                }
                NewMesh::Coarsen(k) if alone => drop(self.coarsened(rule, first, *k)?),
                NewMesh::Files(files) => {
                    for file in files {
                        let mesh = read_mesh(&self.resolve(file))?;
                        let here = |why: Error| {
                            self.error(
                                &format!("regrid.{rule}.mesh"),
                                format!("{}: {why}", file.display()),
                                "give meshes of the same body with the same groups",
                            )
                        };
                        self.check_mesh(&mesh).map_err(here)?;
                    }
                }
                NewMesh::Geometry { path, .. } => {
                    if !gmsh::program::is_installed() {
                        let remedy = "install Gmsh (https://gmsh.info, or `pip install gmsh`), or give `mesh`";
                        return Err(self.error(
                            &format!("regrid.{rule}.geo"),
                            "there is no `gmsh` on the path",
                            remedy,
                        ));
                    }
                    if !self.resolve(path).is_file() {
                        let what = format!("there is no file {}", path.display());
                        return Err(self.error(
                            &format!("regrid.{rule}.geo"),
                            what,
                            "the path is relative to the scene",
                        ));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Whether a `[[regrid]]` whose time has come is due by its criteria.
    pub fn regrid_is_due(&self, rule: usize, present: &Present) -> bool {
        let Criteria { certificate, distortion, front } = self.regrids[rule].criteria;
        let all = certificate.is_none() && distortion.is_none() && front.is_none();
        all || certificate.is_some_and(|limit| self.worst_certificate(present) > limit)
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

    fn coarsened(&self, rule: usize, mesh: &Mesh, k: usize) -> Result<Mesh> {
        joined(mesh, k).map_err(|what| {
            let remedy = "coarsen grids of lines whose numbers of cells are multiples of it";
            self.error(&format!("regrid.{rule}.coarsen"), what, remedy)
        })
    }

    /// The scene's own mesh with finer strips. Lines of it stay, so that most cells are those of the last grid.
    fn with_strips(&self, strips: &[Strip], present: &Present) -> std::result::Result<Mesh, String> {
        let base = self.build_mesh().map_err(|why| why.to_string())?;
        let mut lines = TensorGrid::of(&base).ok_or("the mesh of the scene is not a grid of lines")?.lines;
        for strip in strips {
            let [behind, ahead] = strip.reach;
            let (low, high) = match &strip.around {
                Around::Position(at) => {
                    let at = at.eval([0.0; 2], present.view.state.time);
                    (at, at)
                }
                Around::Front { share } => {
                    let cells = fronts(present, *share);
                    let at = cells.iter().flat_map(|&cell| present.view.mesh.corners(cell).map(|x| x[strip.axis]));
                    at.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
                }
            };
            lines[strip.axis] = finer(&lines[strip.axis], [low - behind, high + ahead], strip.factor);
        }
        grid_of_lines(&base, lines)
    }
}

/// k x k cells of a grid of lines joined into one.
fn joined(mesh: &Mesh, k: usize) -> std::result::Result<Mesh, String> {
    let lines = TensorGrid::of(mesh).filter(|_| mesh.groups.len() == 1);
    let lines = lines.ok_or("the present mesh is not a grid of lines of one group")?.lines;
    let thin = |lines: &[f64]| -> std::result::Result<Vec<f64>, String> {
        let cells = lines.len() - 1;
        if !cells.is_multiple_of(k) {
            return Err(format!("{cells} cells cannot be joined by {k}"));
        }
        Ok(lines.iter().step_by(k).copied().collect())
    };
    let [x, y] = &lines;
    grid_of_lines(mesh, [thin(x)?, thin(y)?])
}

/// Lines with intervals that meet the open interval `within` cut into `factor` equal ones.
fn finer(lines: &[f64], within: [f64; 2], factor: usize) -> Vec<f64> {
    let mut out = vec![lines[0]];
    for pair in lines.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        // A strip that ends on a line does not reach beyond it: rounding is no reason to cut.
        let slack = 1e-9 * (b - a);
        if a < within[1] - slack && b > within[0] + slack {
            out.extend((1..factor).map(|k| a + (b - a) * (k as f64 / factor as f64)));
        }
        out.push(b);
    }
    out
}

/// The mesh of cells between lines, with the groups of `like`, whose four sides bear one group each.
fn grid_of_lines(like: &Mesh, lines: [Vec<f64>; 2]) -> std::result::Result<Mesh, String> {
    let [nx, ny] = [lines[0].len() - 1, lines[1].len() - 1];
    let mut mesh = mesh::rectangle([1.0, 1.0], [nx, ny]).map_err(|why| why.to_string())?;
    for (node, x) in mesh.nodes.iter_mut().enumerate() {
        *x = [lines[0][node % (nx + 1)], lines[1][node / (nx + 1)]];
    }
    // Sides left, right, bottom, top of the new mesh by the groups that stand there in the other.
    let ends = [0, 1].map(|axis| [lines[axis][0], lines[axis][lines[axis].len() - 1]]);
    let mut side = [None; 4];
    for edge in &like.edges {
        let x = like.face_nodes(edge.cell, edge.face).map(|node| like.nodes[node]);
        let on = |axis: usize, end: usize| {
            x.iter().all(|x| (x[axis] - ends[axis][end]).abs() <= 1e-12 * ends[axis][1].abs())
        };
        let Some(k) = (0..4).find(|&k| on(k / 2, k % 2)) else { continue };
        if side[k].is_some_and(|other| other != edge.group) {
            return Err("a side of the mesh has edges of two groups".to_owned());
        }
        side[k] = Some(edge.group);
    }
    let mut found = [0; 4];
    for (found, side) in found.iter_mut().zip(side) {
        *found = side.ok_or("a side of the mesh has no group")?;
    }
    mesh.edges.iter_mut().for_each(|edge| edge.group = found[edge.group]);
    mesh.edge_groups = like.edge_groups.clone();
    if like.groups.len() != 1 {
        return Err("the mesh has several groups of cells".to_owned());
    }
    mesh.groups = like.groups.clone();
    Ok(mesh)
}

/// Nodes that lie inside of one group of cells, moved.
fn shifted(mesh: &Mesh, by: [f64; 2]) -> std::result::Result<Mesh, mesh::Error> {
    let mut fixed = vec![false; mesh.nodes.len()];
    let links = mesh::links(mesh)?;
    for (cell, links) in links.iter().enumerate() {
        for (face, link) in links.iter().enumerate() {
            let inner = matches!(link, mesh::Link::Cell { cell: other, .. } if mesh.cell_group[*other] == mesh.cell_group[cell]);
            if !inner {
                mesh.face_nodes(cell, face).into_iter().for_each(|node| fixed[node] = true);
            }
        }
    }
    let mut out = mesh.clone();
    for (x, _) in out.nodes.iter_mut().zip(fixed).filter(|(_, fixed)| !fixed) {
        *x = [x[0] + by[0], x[1] + by[1]];
    }
    // A node that leaves its cells may leave them all counter-clockwise: turned cells are refused, too.
    let turned = (0..out.cells.len()).find(|&cell| map::h_e(&out.corners(cell)) <= 0.0);
    match turned {
        Some(cell) => Err(mesh::Error::Turned { cell: out.number(cell), at: out.corners(cell)[0] }),
        None => out.checked(),
    }
}

/// Cells within which velocity varies by more than a share of its range over the body.
fn fronts(present: &Present, share: f64) -> Vec<usize> {
    let solution = Solution::of_state(present.view.scheme, present.view.state, present.material);
    let n = present.view.scheme.operators.nodes();
    let range = |cells: &mut dyn Iterator<Item = usize>| {
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for cell in cells {
            let (start, density) = (cell * solution.components * n, solution.law(cell).density());
            for (k, range) in range.iter_mut().enumerate() {
                for p in &solution.u[start + (4 + k) * n..start + (5 + k) * n] {
                    *range = [range[0].min(p / density), range[1].max(p / density)];
                }
            }
        }
        (range[0][1] - range[0][0]).max(range[1][1] - range[1][0])
    };
    let cells = present.view.mesh.cells.len();
    let whole = range(&mut (0..cells));
    // Uniform motion has no front but rounding.
    let speed = present.view.survey.fastest;
    (0..cells).filter(|&cell| whole > 1e-12 * speed && range(&mut std::iter::once(cell)) > share * whole).collect()
}

/// The smallest scaled Jacobian of all cells in the current configuration: X + u at the corners where the displacement is
/// known, else the corners moved by the cell's own F about its middle.
fn worst_shape(present: &Present) -> f64 {
    let view = present.view;
    let solution = Solution::of_state(view.scheme, view.state, present.material);
    let shape = |cell: usize| {
        let corners = view.mesh.corners(cell);
        let middle = map::position(&corners, [0.5; 2]);
        let at: [[f64; 2]; 4] = std::array::from_fn(|k| {
            let there = solution.at(cell, map::CORNER_XI[k]);
            let x = corners[k];
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_cut_the_intervals_that_they_meet_and_no_others() {
        let lines = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(finer(&lines, [1.0, 2.0], 2), [0.0, 1.0, 1.5, 2.0, 3.0]);
        assert_eq!(finer(&lines, [0.5, 1.5], 4), [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 3.0]);
        assert_eq!(finer(&lines, [-3.0, -1.0], 2), lines);
        // No front was found.
        assert_eq!(finer(&lines, [f64::INFINITY, f64::NEG_INFINITY], 2), lines);
    }

    #[test]
    fn grids_of_lines_keep_the_groups_of_their_sides() {
        let mut like = mesh::rectangle([2.0, 1.0], [4, 2]).unwrap();
        like.edge_groups.rotate_left(1);
        like.edges.iter_mut().for_each(|edge| edge.group = (edge.group + 3) % 4);
        let mesh = grid_of_lines(&like, [vec![0.0, 0.5, 2.0], vec![0.0, 0.25, 0.5, 1.0]]).unwrap();
        assert_eq!((mesh.cells.len(), mesh.corners(5)[2]), (6, [2.0, 1.0]));
        for edge in &mesh.edges {
            let name = mesh.edge_groups[edge.group].as_str();
            let x = mesh.face_nodes(edge.cell, edge.face).map(|node| mesh.nodes[node]);
            let (axis, value) = [("left", 0, 0.0), ("right", 0, 2.0), ("bottom", 1, 0.0), ("top", 1, 1.0)]
                .into_iter()
                .find(|(known, ..)| *known == name)
                .map(|(_, axis, value)| (axis, value))
                .unwrap();
            assert!(x.iter().all(|x| x[axis] == value), "{name}: {x:?}");
        }
    }

    #[test]
    fn only_nodes_inside_of_a_group_are_shifted() {
        let mesh = mesh::rectangle([1.0, 1.0], [4, 4]).unwrap();
        let moved = shifted(&mesh, [0.05, -0.02]).unwrap();
        let changed = (0..25).filter(|&k| mesh.nodes[k] != moved.nodes[k]).count();
        assert_eq!((changed, moved.nodes[6]), (9, [0.3, 0.23]));
        assert!(shifted(&mesh, [0.3, 0.0]).is_err());
    }
}
