//! Material points at a change of grid. They stay at their X, with their internal variables, if the new cells can carry
//! them. New points take the internal variables of the nearest old point of their material. Nothing is interpolated.

use super::Grid;
use crate::cloud::{Cloud, Locator, locate::on_lattice, trees};
use crate::error::Error;
use crate::mesh::{Mesh, map};
use crate::operators::certificate::{Certificate, certify};
use crate::operators::{Limits, Line, Sampling};
use rayon::prelude::*;

names! {
    /// What becomes of the points of new cells.
    Policy {
        /// They stay where they are; a cell that cannot carry them gets points at its Gauss nodes instead.
        Keep = "keep",
        /// As keep. But a cell with too few points gets additional points of the layout. A cell with more than twice as
        /// many points as it needs keeps only those that are nearest to its Gauss nodes.
        Enrich = "enrich",
        /// New cells get the layout of the scene. Congruent cells then share their matrices.
        Layout = "layout",
    }
}

/// The points of the new grid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placed {
    /// The points.
    pub cloud: Cloud,
    /// For each point an old point: the same point, or the nearest in X of its material. Empty if no law has internal
    /// variables.
    pub source: Vec<usize>,
    /// For each point, whether it is that old point itself.
    pub kept: Vec<bool>,
    /// For each point, whether it is virtual: on a Gauss node of a cell whose points could not carry the degree. Empty:
    /// none is.
    pub virtual_points: Vec<bool>,
    /// The number of old points that lie outside the new mesh and are lost.
    pub outside: usize,
}

/// The settings for the points of the new cells.
#[derive(Debug, Clone, Copy)]
pub struct Requirements<'a> {
    /// The nodal basis.
    pub line: &'a Line,
    /// What becomes of the points.
    pub policy: Policy,
    /// Points of the scene's layout in all cells of the new mesh.
    pub fresh: &'a Cloud,
    /// Whether the method samples at the points. If not, a cell may have any points.
    pub samples: bool,
    /// The limits for the points of a cell. Beyond them virtual points on the Gauss nodes replace the points.
    pub limits: &'a Limits,
    /// Which of the old points are virtual, on Gauss nodes. An empty list: none.
    pub virtual_points: &'a [bool],
    /// Whether a law has internal variables. Then an old point is found for each new point.
    pub histories: bool,
    /// The new cells that sample on their Gauss nodes in any case (laws with memory). Their points need not carry the
    /// degree. Empty: none.
    pub on_nodes: &'a [bool],
}

/// A point of a new cell.
#[derive(Debug, Clone, Copy)]
struct Located {
    xi: [f64; 2],
    /// The old point, if it is one.
    old: Option<usize>,
    /// Whether it is virtual: on a Gauss node, because the points of the cell cannot carry the degree.
    is_virtual: bool,
}

/// Places the points of `cloud` in the new grid; `same` names the old cell that a new one equals.
///
/// # Errors
/// A material without any old point.
pub fn place(
    old: &Grid,
    cloud: &Cloud,
    new: &Grid,
    same: &[Option<usize>],
    required: &Requirements,
) -> Result<Placed, Error> {
    let (mut located, outside) = match required.policy {
        Policy::Layout => (of_layout(cloud, same, required.fresh), 0),
        Policy::Keep | Policy::Enrich => stay(old, cloud, new, same),
    };
    // Two kinds of cells are not checked: those whose points have not changed, which can carry what they could before;
    // and those whose points need not carry the degree.
    let changed: Vec<bool> = located
        .iter()
        .zip(same)
        .map(|(located, same)| same.is_none_or(|twin| cloud.of(twin).len() != located.len()))
        .enumerate()
        .map(|(cell, changed)| changed && required.on_nodes.get(cell) != Some(&true))
        .collect();
    if required.samples {
        if required.policy == Policy::Enrich {
            enrich(&mut located, &changed, new, required)?;
        }
        if required.policy != Policy::Layout {
            let deficient = deficient(&located, &changed, new, required)?;
            for cell in deficient {
                located[cell] =
                    required.line.nodes().into_iter().map(|xi| Located { xi, old: None, is_virtual: true }).collect();
            }
        }
    }
    let source = if required.histories { sources(old, cloud, new, &located)? } else { vec![] };
    let mut out = Placed { cloud: Cloud { first: vec![0], xi: vec![] }, source, outside, ..Placed::default() };
    let was_virtual =
        |point_at: &Located| point_at.old.is_some_and(|old| required.virtual_points.get(old) == Some(&true));
    for located in &located {
        out.virtual_points.extend(located.iter().map(|point_at| point_at.is_virtual || was_virtual(point_at)));
        out.kept.extend(located.iter().map(|point_at| point_at.old.is_some()));
        out.cloud.xi.extend(located.iter().map(|point_at| point_at.xi));
        out.cloud.first.push(out.cloud.xi.len());
    }
    if !out.virtual_points.contains(&true) {
        out.virtual_points.clear();
    }
    Ok(out)
}

/// Cells that are copies keep their points. Other cells get the points of the layout.
fn of_layout(cloud: &Cloud, same: &[Option<usize>], fresh: &Cloud) -> Vec<Vec<Located>> {
    let of = |(cell, same): (usize, &Option<usize>)| match same {
        Some(twin) => own(cloud, *twin),
        None => fresh.of(cell).iter().map(|&xi| Located { xi, old: None, is_virtual: false }).collect(),
    };
    same.iter().enumerate().map(of).collect()
}

/// The points of a cell that stays, with their parent coordinates to the bit.
fn own(cloud: &Cloud, cell: usize) -> Vec<Located> {
    let numbered = cloud.of(cell).iter().zip(cloud.first[cell]..);
    numbered.map(|(&xi, point)| Located { xi, old: Some(point), is_virtual: false }).collect()
}

/// All points at their X in the new cells, and the number of points outside the new mesh.
fn stay(old: &Grid, cloud: &Cloud, new: &Grid, same: &[Option<usize>]) -> (Vec<Vec<Located>>, usize) {
    let mut stays = vec![false; old.mesh.cells.len()];
    let mut located: Vec<Vec<Located>> = vec![vec![]; same.len()];
    for (cell, twin) in same.iter().enumerate().filter_map(|(cell, same)| Some((cell, (*same)?))) {
        stays[twin] = true;
        located[cell] = own(cloud, twin);
    }
    let moving: Vec<(usize, usize)> = (0..stays.len())
        .filter(|&cell| !stays[cell])
        .flat_map(|cell| (cloud.first[cell]..cloud.first[cell + 1]).map(move |point| (cell, point)))
        .collect();
    if moving.is_empty() {
        return (located, 0);
    }
    let locator = Locator::new(new.mesh);
    let find = |&(cell, point): &(usize, usize)| {
        let found = locator.find(map::position(&old.mesh.map(cell), cloud.xi[point]))?;
        // A point on an edge between two materials stays in its own material: in the lowest cell of that material there.
        (new.material[found.0] == old.material[cell]).then_some((found, point))
    };
    let found: Vec<_> = moving.par_iter().map(find).collect();
    for ((cell, xi), point) in found.iter().flatten() {
        located[*cell].push(Located { xi: xi.map(on_lattice), old: Some(*point), is_virtual: false });
    }
    (located, found.iter().filter(|found| found.is_none()).count())
}

/// Changed cells whose points cannot carry Q_N.
fn deficient(
    located: &[Vec<Located>],
    changed: &[bool],
    new: &Grid,
    required: &Requirements,
) -> Result<Vec<usize>, Error> {
    // For the other cells a list of one point is enough and makes no work.
    let look = |cell: usize| if changed[cell] { &located[cell][..] } else { &[] };
    let mut cloud = Cloud { first: vec![0], xi: vec![] };
    for cell in 0..located.len() {
        cloud.xi.extend(look(cell).iter().map(|point_at| point_at.xi));
        cloud.first.push(cloud.xi.len());
    }
    let certificates = certify(new.mesh, required.line, Sampling::Cloud(&cloud))?;
    let cannot = |cell: &usize| changed[*cell] && !carries(&certificates[*cell], required);
    Ok((0..located.len()).filter(cannot).collect())
}

fn carries(certificate: &Certificate, required: &Requirements) -> bool {
    required.limits.cause(certificate, required.line.m * required.line.m).is_none()
}

/// Adds points of the layout if there are too few. If there are too many, those nearest to the Gauss nodes stay,
/// because they amplify errors least at the faces.
fn enrich(located: &mut [Vec<Located>], changed: &[bool], new: &Grid, required: &Requirements) -> Result<(), Error> {
    let gap = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    for cell in deficient(located, changed, new, required)? {
        // Half of the spacing of the layout. A point of the layout that is nearer than this to a present point adds nothing.
        let near = 0.5 / (required.fresh.of(cell).len() as f64).sqrt();
        for &xi in required.fresh.of(cell) {
            if located[cell].iter().all(|point_at| gap(point_at.xi, xi) > near) {
                located[cell].push(Located { xi, old: None, is_virtual: false });
            }
        }
    }
    let nodes = required.line.nodes();
    for cell in (0..located.len()).filter(|&cell| changed[cell]) {
        let (wanted, own) = (&nodes, &located[cell]);
        if own.len() <= 2 * wanted.len().max(required.fresh.of(cell).len()) {
            continue;
        }
        let nearest = |xi: &[f64; 2]| {
            (0..own.len()).min_by(|&a, &b| gap(own[a].xi, *xi).total_cmp(&gap(own[b].xi, *xi))).unwrap_or(0)
        };
        let mut chosen: Vec<usize> = wanted.iter().map(nearest).collect();
        chosen.sort_unstable();
        chosen.dedup();
        let thinned: Vec<Located> = chosen.into_iter().map(|k| own[k]).collect();
        let cloud = Cloud { first: vec![0, thinned.len()], xi: thinned.iter().map(|point_at| point_at.xi).collect() };
        let map = new.mesh.map(cell);
        let bulges = map.bulge.into_iter().collect();
        let one = Mesh { nodes: map.corners.to_vec(), cells: vec![[0, 1, 2, 3]], bulges, ..Mesh::default() };
        if carries(&certify(&one, required.line, Sampling::Cloud(&cloud))?[0], required) {
            located[cell] = thinned;
        }
    }
    Ok(())
}

/// For each point the old point that it is, or the nearest old point.
fn sources(old: &Grid, cloud: &Cloud, new: &Grid, located: &[Vec<Located>]) -> Result<Vec<usize>, Error> {
    let is_new = |located: &Vec<Located>| located.iter().any(|point_at| point_at.old.is_none());
    let asked = vec![located.iter().any(is_new); old.material.iter().max().map_or(0, |last| last + 1)];
    let trees = trees(old.mesh, cloud, old.material, &asked);
    let of = |cell: usize| -> Result<Vec<usize>, Error> {
        let map = new.mesh.map(cell);
        let source = |point_at: &Located| {
            let near = || trees.get(new.material[cell])?.as_ref()?.nearest_neighbor(map::position(&map, point_at.xi));
            point_at.old.or_else(|| near().map(|point| point.data)).ok_or_else(|| {
                let what = format!("cell {} has a material that no old point has", new.mesh.number(cell));
                Error::input(what, "give a mesh with the groups of the old one")
            })
        };
        located[cell].iter().map(source).collect()
    };
    let all = (0..located.len()).into_par_iter().map(of).collect::<Result<Vec<_>, Error>>()?;
    Ok(all.concat())
}

/// Internal variables of the new points: cells in the order of the mesh, points in the order of the cloud. `internal`
/// has those of the old `places` in this order; `count` is the number of variables of each material.
pub fn histories(old: &Grid, places: &Cloud, placed: &Placed, internal: &[f64], count: &[usize]) -> Vec<f64> {
    let mut ranges = Vec::with_capacity(places.len());
    let mut next = 0;
    for (cell, &material) in old.material.iter().enumerate() {
        for _ in places.of(cell) {
            ranges.push(next..next + count[material]);
            next += count[material];
        }
    }
    placed.source.iter().flat_map(|&point| &internal[ranges[point].clone()]).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Layout, seed};
    use crate::mesh::rectangle;
    use crate::regrid::same_cells;

    const JITTER: Layout = Layout::Jitter { seed: 3, amount: 0.4 };

    struct Case {
        old: Mesh,
        cloud: Cloud,
        new: Mesh,
    }

    fn placed(case: &Case, policy: Policy) -> (Placed, Vec<Option<usize>>) {
        let material = [vec![0; case.old.cells.len()], vec![0; case.new.cells.len()]];
        let (old, new) =
            (Grid { mesh: &case.old, material: &material[0] }, Grid { mesh: &case.new, material: &material[1] });
        let same = same_cells(&old, &new);
        let fresh = seed(Layout::Paper, 3, case.new.cells.len());
        let line = Line::new(2);
        let (limits, virtual_points) = (Limits::of_degree(2), &[][..]);
        let required = Requirements {
            line: &line,
            policy,
            fresh: &fresh,
            samples: true,
            limits: &limits,
            virtual_points,
            histories: true,
            on_nodes: &[],
        };
        (place(&old, &case.cloud, &new, &same, &required).unwrap(), same)
    }

    fn positions(mesh: &Mesh, cloud: &Cloud) -> Vec<[f64; 2]> {
        let of = |cell: usize| cloud.of(cell).iter().map(move |&xi| map::position(&mesh.map(cell), xi));
        (0..mesh.cells.len()).flat_map(of).collect()
    }

    /// 8 x 8 cells with a dense cloud, and 8 x 8 cells of which a column is cut in two.
    fn case(layout: Layout, k: usize) -> Case {
        let old = rectangle([1.0, 1.0], [8, 8]).unwrap();
        let mut new = rectangle([1.0, 1.0], [9, 8]).unwrap();
        new.nodes.iter_mut().enumerate().for_each(|(node, x)| {
            x[0] = [0.0, 0.125, 0.25, 0.375, 0.4375, 0.5, 0.625, 0.75, 0.875, 1.0][node % 10];
        });
        Case { cloud: seed(layout, k, 64), old, new }
    }

    #[test]
    fn the_same_grid_keeps_its_cloud_to_the_bit() {
        for policy in Policy::NAMES.iter().map(|(_, policy)| *policy) {
            let same = Case { new: case(JITTER, 3).old, ..case(JITTER, 3) };
            let (placed, _) = placed(&same, policy);
            assert_eq!(placed.cloud, same.cloud);
            assert_eq!(placed.source, (0..same.cloud.len()).collect::<Vec<_>>());
            assert!(placed.kept.iter().all(|kept| *kept));
        }
    }

    #[test]
    fn points_stay_where_they_are_and_keep_their_histories_to_the_bit() {
        // 8 x 8 jittered points a cell: 32 in each half, more than 9.
        let case = case(JITTER, 8);
        let (placed, same) = placed(&case, Policy::Keep);
        let (before, after) = (positions(&case.old, &case.cloud), positions(&case.new, &placed.cloud));
        assert_eq!((after.len(), placed.outside), (before.len(), 0));
        let material = vec![0; 64];
        let internal: Vec<f64> = (0..2 * before.len()).map(|k| (k as f64).sin()).collect();
        let moved = histories(&Grid { mesh: &case.old, material: &material }, &case.cloud, &placed, &internal, &[2]);
        for (p, &old) in placed.source.iter().enumerate() {
            assert!(placed.kept[p]);
            // Located to 2^-41 of the cell.
            let gap = (after[p][0] - before[old][0]).hypot(after[p][1] - before[old][1]);
            assert!(gap < 1e-12, "{gap:e}");
            assert_eq!(moved[2 * p..2 * p + 2], internal[2 * old..2 * old + 2]);
        }
        let mut all = placed.source.clone();
        all.sort_unstable();
        assert_eq!(all, (0..before.len()).collect::<Vec<_>>());
        for (cell, twin) in same.iter().enumerate().filter_map(|(cell, same)| Some((cell, (*same)?))) {
            assert_eq!(placed.cloud.of(cell), case.cloud.of(twin));
        }
    }

    #[test]
    fn cells_that_cannot_carry_their_points_get_gauss_nodes_with_the_nearest_histories() {
        // 3 x 3 points: a half has 3 or 6 of them, degree 2 needs 9.
        let case = case(Layout::Paper, 3);
        let (placed, same) = placed(&case, Policy::Keep);
        let (before, after) = (positions(&case.old, &case.cloud), positions(&case.new, &placed.cloud));
        for (cell, same) in same.iter().enumerate() {
            let points = placed.cloud.first[cell]..placed.cloud.first[cell + 1];
            if same.is_some() {
                assert!(placed.kept[points.clone()].iter().all(|kept| *kept));
                continue;
            }
            assert_eq!(placed.cloud.of(cell), Line::new(2).nodes());
            for p in points {
                let distance = |k: usize| (after[p][0] - before[k][0]).hypot(after[p][1] - before[k][1]);
                let nearest = (0..before.len()).map(distance).fold(f64::INFINITY, f64::min);
                assert!(!placed.kept[p] && distance(placed.source[p]) <= nearest);
            }
        }
    }

    #[test]
    fn enriched_cells_keep_their_points_and_crowded_ones_are_thinned() {
        let case = case(Layout::Paper, 3);
        let (few, same) = placed(&case, Policy::Enrich);
        for cell in (0..72).filter(|&cell| same[cell].is_none()) {
            let points = few.cloud.first[cell]..few.cloud.first[cell + 1];
            let kept = few.kept[points.clone()].iter().filter(|kept| **kept).count();
            assert!(points.len() >= 9 && kept >= 3, "{kept} of {}", points.len());
        }
        let dense = self::case(JITTER, 8);
        let (many, same) = placed(&dense, Policy::Enrich);
        for cell in (0..72).filter(|&cell| same[cell].is_none()) {
            let points = many.cloud.first[cell]..many.cloud.first[cell + 1];
            assert!(points.len() <= 18 && many.kept[points].iter().all(|kept| *kept));
        }
    }

    #[test]
    fn a_layout_fills_new_cells_and_leaves_the_others() {
        let case = case(JITTER, 3);
        let (placed, same) = placed(&case, Policy::Layout);
        let fresh = seed(Layout::Paper, 3, 72);
        for (cell, same) in same.iter().enumerate() {
            let wanted = same.map_or(fresh.of(cell), |twin| case.cloud.of(twin));
            assert_eq!(placed.cloud.of(cell), wanted);
        }
    }
}
