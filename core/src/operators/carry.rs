//! Cells whose points cannot carry Q_N, and the virtual points that take their place (design section 8).
//!
//! A lower order in such a cell, or a fit of minimum norm, is unstable. With the predictor's points on the Gauss nodes
//! the cell is computed as in ADER-DGFEM: order and stability stay, and nothing is lost, because the master copy of the
//! unknowns is on the grid. Internal variables come from the nearest points, and are never interpolated.
//!
//! Cells of a law with memory also sample on their Gauss nodes, wherever their points are, unless the scene keeps the
//! histories at the points. The reason: P is sampled at the points and interpolated. The power of the interpolated P
//! against grad v is the rate of the energy of the points only if points and nodes are the same. If they differ,
//! the flow of the law makes energy, because its P is rough from point to point (a Taylor bar 4 to 80 % and more, with
//! histories at the nodes none).

use super::certificate::{Certificate, Class, of_points};
use super::{Line, Sampling};
use crate::cloud::{self, Cloud, Tree};
use crate::error::Error;
use crate::mesh::{Mesh, map};
use rayon::prelude::*;

/// The limits for the points of a cell. Beyond them virtual points replace the points.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Limits {
    /// Largest Lebesgue constant over face points and Gauss nodes: the factor by which the fit can amplify errors of P
    /// at the points.
    pub lebesgue: f64,
    /// Largest condition number of the fit: the factor by which it can amplify rounding.
    pub condition: f64,
    /// Whether the limits hold for lattices too. The user has chosen a lattice deliberately. So, unless the scene gives
    /// limits, a lattice is replaced only if its rank is too small.
    pub lattices: bool,
}

impl Limits {
    /// The condition number that a cell may have: eleven digits are left. Random points within the limits below have at most
    /// 300, the layout of the paper 1.3e3 for N = 6.
    pub const CONDITION: f64 = 1e5;

    /// Lebesgue constants for N = 0..6: 10, 30, 60, 150 for N = 1..4 by the design, measured on the manufactured
    /// problem; above N = 4 by the factor 3.3, by which those of midpoints grow (50.6, 161, 539 for N = 4, 5, 6). A
    /// jitter of .2 stays below.
    pub const LEBESGUE: [f64; 7] = [10.0, 10.0, 30.0, 60.0, 150.0, 500.0, 1650.0];

    /// The limits of degree N.
    pub fn of_degree(degree: usize) -> Self {
        let lebesgue = Self::LEBESGUE[degree.min(Self::LEBESGUE.len() - 1)];
        Self { lebesgue, condition: Self::CONDITION, lattices: false }
    }

    /// The reason why a cell cannot carry Q_N with (N+1)^2 = `needed`; `None` if it can.
    pub fn cause(&self, cell: &Certificate, needed: usize) -> Option<Cause> {
        match () {
            _ if cell.points < needed => Some(Cause::Few),
            _ if cell.rank < needed => Some(Cause::Rank),
            _ if cell.class == Class::Lattice && !self.lattices => None,
            _ if cell.lebesgue.max(cell.inside) > self.lebesgue => Some(Cause::Lebesgue),
            _ if cell.condition > self.condition => Some(Cause::Condition),
            _ => None,
        }
    }
}

/// The reason why the scheme does not sample at the points of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// There are fewer than (N+1)^2.
    Few,
    /// They are badly placed: a polynomial of Q_N vanishes at all of them.
    Rank,
    /// The Lebesgue constant is beyond the limit.
    Lebesgue,
    /// The condition number is beyond the limit.
    Condition,
    /// Nothing is wrong with them: the law has memory, and they are not the Gauss nodes.
    Memory,
}

/// A cell in which the scheme samples on virtual points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deficient {
    /// The cell.
    pub cell: usize,
    /// The reason.
    pub cause: Cause,
    /// The certificate of the given points.
    pub given: Certificate,
}

/// The cloud on which the scheme samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Carried {
    /// Its points.
    pub cloud: Cloud,
    /// For each of its points a point of the given cloud: the same point, or the nearest in X in its group of cells
    /// (the first of several that are equally near).
    pub source: Vec<usize>,
    /// For each of its points, whether it is that point itself. If not, it is virtual.
    pub kept: Vec<bool>,
    /// The cells with virtual points, in rising order, with the reason.
    pub deficient: Vec<Deficient>,
    /// The certificate of each cell on what the scheme samples there, without dt.
    pub certificates: Vec<Certificate>,
}

/// Whether points are the Gauss nodes, in their order: to 1e-9 of the cell, which is what text files keep.
pub fn stand_on_nodes(nodes: &[[f64; 2]], xi: &[[f64; 2]]) -> bool {
    let near = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-9;
    xi.len() == nodes.len() && xi.iter().zip(nodes).all(near)
}

/// Puts virtual points on the Gauss nodes of all cells whose points cannot carry Q_N, and of all cells that `memory`
/// marks (their law has memory; an empty list marks no cell). These points are the nodes to the bit.
///
/// # Errors
/// A deficient cell in a group of cells without any point: its internal variables are unknown.
pub fn carry(mesh: &Mesh, line: &Line, cloud: &Cloud, limits: &Limits, memory: &[bool]) -> Result<Carried, Error> {
    let nodes = line.nodes();
    let (class, examples) = Sampling::Cloud(cloud).classes(&nodes, mesh.cells.len());
    let fits = examples.par_iter().map(|&cell| of_points(line, cloud.of(cell))).collect::<Result<Vec<_>, _>>()?;
    let causes: Vec<_> = fits.iter().map(|fit| limits.cause(fit, nodes.len())).collect();
    let on_nodes: Vec<bool> = examples.iter().map(|&cell| stand_on_nodes(&nodes, cloud.of(cell))).collect();
    let has_memory = |cell: usize| memory.get(cell) == Some(&true);
    let cause = |cell: usize| match has_memory(cell) {
        true => (!on_nodes[class[cell]]).then_some(Cause::Memory),
        false => causes[class[cell]],
    };
    let h = |cell: usize| map::h_e(&mesh.map(cell));
    let found = |cell: usize| {
        let given = Certificate { h: h(cell), ..fits[class[cell]] };
        cause(cell).map(|cause| Deficient { cell, cause, given })
    };
    let deficient: Vec<Deficient> = (0..mesh.cells.len()).filter_map(found).collect();
    if deficient.is_empty() && !memory.contains(&true) {
        let (source, kept) = ((0..cloud.len()).collect(), vec![true; cloud.len()]);
        let certificates = (0..mesh.cells.len()).map(|cell| Certificate { h: h(cell), ..fits[class[cell]] }).collect();
        return Ok(Carried { cloud: cloud.clone(), source, kept, deficient, certificates });
    }
    let of_nodes = of_points(line, &nodes)?;
    let certificate = |cell: usize| {
        let on_nodes = cause(cell).is_some() || has_memory(cell);
        Certificate { h: h(cell), ..if on_nodes { of_nodes } else { fits[class[cell]] } }
    };
    let certificates = (0..mesh.cells.len()).map(certificate).collect();
    let trees = trees(mesh, cloud, &deficient.iter().map(|d| d.cell).collect::<Vec<_>>())?;
    let cloud_of_none = Cloud { first: vec![0], xi: vec![] };
    let mut out = Carried { cloud: cloud_of_none, source: vec![], kept: vec![], deficient, certificates };
    for cell in 0..mesh.cells.len() {
        let given = cloud.first[cell]..cloud.first[cell + 1];
        let count = match (cause(cell), &trees[mesh.cell_group[cell]]) {
            (Some(_), Some(tree)) => {
                let map = mesh.map(cell);
                out.source.extend(nodes.iter().map(|&xi| nearest(tree, map::position(&map, xi))));
                out.cloud.xi.extend(&nodes);
                nodes.len()
            }
            _ => {
                out.source.extend(given.clone());
                out.cloud.xi.extend_from_slice(if has_memory(cell) { &nodes } else { cloud.of(cell) });
                given.len()
            }
        };
        out.kept.resize(out.kept.len() + count, cause(cell).is_none());
        out.cloud.first.push(out.cloud.xi.len());
    }
    Ok(out)
}

/// For each group of cells that has one of the `deficient` cells (their points cannot carry Q_N), the points of the group.
///
/// # Errors
/// One of these groups has no point.
pub(super) fn trees(mesh: &Mesh, cloud: &Cloud, deficient: &[usize]) -> Result<Vec<Option<Tree>>, Error> {
    let mut asked = vec![None; mesh.groups.len()];
    for &cell in deficient {
        asked[mesh.cell_group[cell]].get_or_insert(cell);
    }
    let is_asked: Vec<bool> = asked.iter().map(Option::is_some).collect();
    let trees = cloud::trees(mesh, cloud, &mesh.cell_group, &is_asked);
    for (group, tree) in trees.iter().enumerate() {
        if let (Some(cell), Some(0)) = (asked[group], tree.as_ref().map(Tree::size)) {
            return Err(Error::input(
                format!(
                    "the group \"{}\" (cell {} and others) holds no material point",
                    mesh.groups[group],
                    mesh.number(cell)
                ),
                "put points into each group of cells: its internal variables come from its points",
            ));
        }
    }
    Ok(trees)
}

/// The number of the nearest point; the first of several that are equally near.
fn nearest(tree: &Tree, x: [f64; 2]) -> usize {
    tree.nearest_neighbors(&x).into_iter().map(|point| point.data).min().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Layout, seed};
    use crate::mesh::rectangle;

    /// The paper's layout on 4 x 4 squares for S2, with what `change` makes of the points of each cell.
    fn cloud(change: impl Fn(usize, Vec<[f64; 2]>) -> Vec<[f64; 2]>) -> (Mesh, Cloud) {
        let mesh = rectangle([4.0, 4.0], [4, 4]).unwrap();
        let whole = seed(Layout::Paper, 3, 16);
        let mut cloud = Cloud { first: vec![0], xi: vec![] };
        for cell in 0..16 {
            cloud.xi.extend(change(cell, whole.of(cell).to_vec()));
            cloud.first.push(cloud.xi.len());
        }
        (mesh, cloud)
    }

    fn carried(mesh: &Mesh, cloud: &Cloud) -> Carried {
        carry(mesh, &Line::new(2), cloud, &Limits::of_degree(2), &[]).unwrap()
    }

    #[test]
    fn a_cloud_that_carries_its_degree_is_kept_point_for_point() {
        let (mesh, cloud) = cloud(|_, xi| xi);
        let found = carried(&mesh, &cloud);
        assert_eq!(found.cloud, cloud);
        assert!(found.deficient.is_empty() && found.kept.iter().all(|k| *k));
        assert!(found.source.iter().enumerate().all(|(p, s)| p == *s));
    }

    #[test]
    fn deficient_cells_get_the_gauss_nodes_and_the_other_cells_keep_their_points() {
        // Cell 2 is empty, cell 5 has eight points, in cell 9 all are on a line, in cell 12 they are in a corner.
        let (mesh, cloud) = cloud(|cell, mut xi| match cell {
            2 => vec![],
            5 => xi.split_off(1),
            9 => xi.iter().map(|x| [x[0], x[0]]).collect(),
            // Scattered, so that it is no lattice.
            12 => xi.iter().map(|x| [0.3 * x[0] + 0.01 * x[1], 0.3 * x[1]]).collect(),
            _ => xi,
        });
        let found = carried(&mesh, &cloud);
        let why: Vec<_> = found.deficient.iter().map(|d| (d.cell, d.cause)).collect();
        assert_eq!(why, [(2, Cause::Few), (5, Cause::Few), (9, Cause::Rank), (12, Cause::Lebesgue)]);
        let nodes = Line::new(2).nodes();
        for cell in 0..16 {
            let points = found.cloud.first[cell]..found.cloud.first[cell + 1];
            let virtual_cell = why.iter().any(|(d, _)| *d == cell);
            assert_eq!(found.cloud.of(cell), if virtual_cell { &nodes[..] } else { cloud.of(cell) });
            assert!(found.kept[points.clone()].iter().all(|kept| *kept != virtual_cell));
            if !virtual_cell {
                assert!(points.clone().zip(cloud.first[cell]..).all(|(p, given)| found.source[p] == given));
            }
        }
    }

    #[test]
    fn virtual_points_name_the_nearest_given_point_of_their_group_even_across_cells() {
        let (mut mesh, cloud) = cloud(|cell, xi| if cell == 5 { vec![] } else { xi });
        // The right half is another material.
        mesh.groups.push("right".into());
        (0..16).for_each(|cell| mesh.cell_group[cell] = usize::from(cell % 4 >= 2));
        let found = carried(&mesh, &cloud);
        let of_cell = |p: usize| (0..16).find(|&c| (cloud.first[c]..cloud.first[c + 1]).contains(&p)).unwrap();
        let at = |p: usize| map::position(&mesh.map(of_cell(p)), cloud.xi[p]);
        for (k, &xi) in found.cloud.of(5).iter().enumerate() {
            let x = map::position(&mesh.map(5), xi);
            let distance = |p: usize| (at(p)[0] - x[0]).hypot(at(p)[1] - x[1]);
            let source = found.source[found.cloud.first[5] + k];
            assert!(of_cell(source) % 4 < 2);
            let same_group = (0..cloud.len()).filter(|&p| of_cell(p) % 4 < 2);
            let least = same_group.map(distance).fold(f64::INFINITY, f64::min);
            // Rounding of positions of size 4.
            assert!(distance(source) <= least + 1e-15, "{k}");
        }
    }

    #[test]
    fn lattices_are_replaced_only_where_the_limits_ask_for_it() {
        let mesh = rectangle([1.0, 1.0], [2, 2]).unwrap();
        let (line, cloud) = (Line::new(3), seed(Layout::Paper, 4, 4));
        // Lambda = 124 against a limit of 60.
        let limits = Limits::of_degree(3);
        assert!(carry(&mesh, &line, &cloud, &limits, &[]).unwrap().deficient.is_empty());
        let strict = carry(&mesh, &line, &cloud, &Limits { lattices: true, ..limits }, &[]).unwrap();
        assert!(strict.deficient.iter().all(|d| d.cause == Cause::Lebesgue && (d.given.lebesgue - 124.0).abs() < 1.0));
        assert_eq!(strict.deficient.len(), 4);
    }

    #[test]
    fn cells_with_memory_sample_on_their_nodes_and_the_others_keep_their_points() {
        // Cell 5 has eight points and memory, cell 6 eight without, cells 8 to 11 memory and the nodes up to rounding.
        let nodes = Line::new(2).nodes();
        let (mesh, cloud) = cloud(|cell, mut xi| match cell {
            5 | 6 => xi.split_off(1),
            8..12 => nodes.iter().map(|x| [x[0] + 1e-13, x[1]]).collect(),
            _ => xi,
        });
        let memory: Vec<bool> = (0..16).map(|cell| [1, 5, 8, 9, 10, 11].contains(&cell)).collect();
        let found = carry(&mesh, &Line::new(2), &cloud, &Limits::of_degree(2), &memory).unwrap();
        let why: Vec<_> = found.deficient.iter().map(|d| (d.cell, d.cause)).collect();
        assert_eq!(why, [(1, Cause::Memory), (5, Cause::Memory), (6, Cause::Few)]);
        #[allow(clippy::needless_range_loop)]
        for cell in 0..16 {
            let points = found.cloud.first[cell]..found.cloud.first[cell + 1];
            let on_nodes = memory[cell] || cell == 6;
            // To the bit: their matrices are the identity.
            assert_eq!(found.cloud.of(cell), if on_nodes { &nodes[..] } else { cloud.of(cell) });
            let replaced = [1, 5, 6].contains(&cell);
            assert!(found.kept[points.clone()].iter().all(|kept| *kept != replaced));
            if !replaced {
                assert!(points.zip(cloud.first[cell]..).all(|(p, given)| found.source[p] == given));
            }
        }
        // The paper's points are .25, .5, .75: each node is nearest to its own.
        let first = cloud.first[1];
        assert_eq!(found.source[found.cloud.first[1]..found.cloud.first[2]], (first..first + 9).collect::<Vec<_>>());
    }

    #[test]
    fn points_near_the_faces_alone_are_seen_not_to_carry_what_vanishes_there() {
        // x (1 - x) y (1 - y) is nearly zero at all of them: faces see nothing of it, nodes do.
        let ring: Vec<[f64; 2]> = (0..40)
            .map(|k| {
                let (side, along) = (k % 4, (k / 4) as f64 / 10.0 + 0.03);
                let inset = 0.002 * (1.0 + (k as f64 * 1.3).sin());
                [[along, inset], [1.0 - inset, along], [along, 1.0 - inset], [inset, along]][side]
            })
            .collect();
        let found = of_points(&Line::new(2), &ring).unwrap();
        assert!(found.rank == 9 && found.lebesgue < 30.0, "{found:?}");
        assert_eq!(Limits::of_degree(2).cause(&found, 9), Some(Cause::Lebesgue));
    }

    #[test]
    fn a_group_without_any_point_is_named() {
        let (mesh, cloud) = cloud(|_, _| vec![]);
        let why = carry(&mesh, &Line::new(2), &cloud, &Limits::of_degree(2), &[]).unwrap_err();
        assert!(why.to_string().contains("\"body\"") && why.exit_code() == 2, "{why}");
    }
}
