//! A first scene for a mesh, `dgmpm new`: which group meets a wall, how fast, and for how long.

use crate::error::{Error, Result};
use crate::mesh::faces::neighbours;
use crate::mesh::{self, BoundaryEdge, Mesh, map};
use crate::registry::{LAWS, Value, Values};
use crate::scene::draft::{Condition, Draft, LAW, STEEL, number, quoted};

/// The speed of the example as a share of the wave speed: strains of a hundredth.
const SHARE: f64 = 0.01;
/// How often a wave goes through the body until the end: twice there and back.
const TRANSITS: f64 = 4.0;
/// Snapshots of the example.
const SNAPSHOTS: f64 = 20.0;
/// Nodes that are nearer to a straight line than this share of the body are on it.
const FLAT: f64 = 1e-6;
/// Groups of a round body that come within this share of the body to the wall may touch it.
const NEAR: f64 = 0.25;

/// A name for edges of the boundary that have none.
const UNNAMED: &str = "boundary";

/// The mesh with all edges of its boundary in a group, and how many got one here: those without a group become `boundary`.
///
/// # Errors
/// A mesh that is wrong in another way.
pub fn tagged(mut mesh: Mesh) -> Result<(Mesh, usize)> {
    match mesh::links(&mesh) {
        Ok(_) => return Ok((mesh, 0)),
        Err(mesh::Error::Untagged { .. }) => {}
        Err(why) => return Err(why.into()),
    }
    let own: std::collections::HashSet<_> = mesh.edges.iter().map(|edge| (edge.cell, edge.face)).collect();
    let name = |k: usize| if k == 0 { UNNAMED.to_owned() } else { format!("{UNNAMED}_{k}") };
    let free = (0..).map(name).find(|name| !mesh.edge_groups.contains(name)).unwrap_or_default();
    mesh.edge_groups.push(free);
    let group = mesh.edge_groups.len() - 1;
    let before = mesh.edges.len();
    for (cell, across) in neighbours(&mesh).into_iter().enumerate() {
        let bare = |face: &usize| across[*face].is_none() && !own.contains(&(cell, *face));
        mesh.edges.extend((0..4).filter(bare).map(|face| BoundaryEdge { cell, face, group }));
    }
    mesh::links(&mesh)?;
    let added = mesh.edges.len() - before;
    Ok((mesh, added))
}

/// A first scene for a mesh whose file a scene names `file`: two bodies that meet, or a body that flies against a rigid wall.
///
/// # Errors
/// A mesh without a group on its boundary.
pub fn draft(mesh: &Mesh, file: &str) -> Result<Draft> {
    let counts = mesh.edge_counts();
    // A condition on edges inside of the body would cut it there.
    let of = |is_inside: bool| {
        let all = counts.iter().enumerate().filter(move |(_, count)| (count.inner > 0) == is_inside);
        all.filter(move |(_, count)| is_inside || count.boundary > 0).map(|(group, _)| group).collect()
    };
    let (on_boundary, inside): (Vec<usize>, Vec<usize>) = (of(false), of(true));
    if on_boundary.is_empty() {
        return Err(Error::input(
            "the mesh has no group of edges on its boundary",
            "name one there (a physical curve)",
        ));
    }
    let inside = inside.into_iter().map(|group| mesh.edge_groups[group].clone()).collect();
    let shape = Shape { mesh, groups: on_boundary };
    let story = shape.meeting().or_else(|| shape.flat_wall()).unwrap_or_else(|| shape.round_wall());
    Ok(Draft { inside, ..story.told(&shape, file) })
}

/// The wave speed of the example's material, m/s.
fn wave_speed() -> f64 {
    let mut values = Values::default();
    STEEL.iter().for_each(|(name, value)| values.set(name, Value::Number(*value)));
    let law = LAWS.find(LAW).unwrap_or(LAWS.first());
    let law = (law.build)(&values);
    law.largest_speeds([1.0, 0.0, 0.0, 1.0], &law.virgin())[0]
}

/// The largest of 1, 2, 5 times a power of ten up to a number above 0.
fn rounded_down(x: f64) -> f64 {
    let decade = 10_f64.powf(x.log10().floor());
    [5.0, 2.0].into_iter().find(|k| k * decade <= x).unwrap_or(1.0) * decade
}

/// Two digits of a number above 0, rounded up.
fn rounded_up(x: f64) -> f64 {
    let decade = x.log10().floor() as i32 - 1;
    format!("{}e{decade}", (x / 10_f64.powi(decade)).ceil()).parse().unwrap_or(x)
}

/// Four digits of a number.
fn four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// A mesh with those of its groups that lie on the boundary.
struct Shape<'a> {
    mesh: &'a Mesh,
    groups: Vec<usize>,
}

/// What happens in the example.
struct Story {
    title: String,
    conditions: Vec<Condition>,
    velocity: [String; 2],
    what: String,
    /// The axis of the motion, 0 or 1.
    axis: usize,
    /// Time until bodies meet, s.
    delay: f64,
    /// The group that is hit.
    hit: String,
    /// Which end of the axis is far from it: -1 or 1.
    far: f64,
}

/// The sides of a body: axis, direction out of it, name.
const SIDES: [(usize, f64, &str); 4] =
    [(0, -1.0, "to the left"), (1, -1.0, "downwards"), (0, 1.0, "to the right"), (1, 1.0, "upwards")];

impl Shape<'_> {
    /// The nodes of the boundary edges of a group.
    fn nodes(&self, group: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
        let edges = self.mesh.edges.iter().filter(move |edge| edge.group == group);
        edges.flat_map(|edge| self.mesh.face_nodes(edge.cell, edge.face)).map(|node| self.mesh.nodes[node])
    }

    fn size(&self) -> [f64; 2] {
        let [low, high] = self.mesh.extent();
        [high[0] - low[0], high[1] - low[1]]
    }

    /// How far a group is from a side of the box around the body, nearest and farthest node.
    fn distance(&self, group: usize, axis: usize, sign: f64) -> [f64; 2] {
        let [low, high] = self.mesh.extent();
        let wall = if sign > 0.0 { high[axis] } else { low[axis] };
        let start = [f64::INFINITY, 0.0];
        self.nodes(group).map(|x| (x[axis] - wall).abs()).fold(start, |[a, b], d| [a.min(d), b.max(d)])
    }

    /// All groups of the boundary, with the condition that `of` has for them, else free.
    fn conditions(&self, of: impl Fn(usize) -> Option<Condition>) -> Vec<Condition> {
        let free = |group: usize| Condition {
            group: self.mesh.edge_groups[group].clone(),
            kind: "free",
            ..Condition::default()
        };
        self.groups.iter().map(|&group| of(group).unwrap_or_else(|| free(group))).collect()
    }

    fn speed() -> f64 {
        rounded_down(SHARE * wave_speed())
    }

    /// A body with a straight side flies with it against a wall.
    fn flat_wall(&self) -> Option<Story> {
        let scale = self.size()[0].max(self.size()[1]);
        let is_flat = |group: usize, axis, sign| self.distance(group, axis, sign)[1] <= FLAT * scale;
        let found = SIDES.into_iter().find_map(|(axis, sign, where_to)| {
            let group = self.groups.iter().copied().find(|&group| is_flat(group, axis, sign))?;
            Some((axis, sign, where_to, group))
        });
        let (axis, sign, where_to, group) = found?;
        let hit = self.mesh.edge_groups[group].clone();
        let why = "the rigid wall; the body presses on it and may leave it".to_owned();
        let condition = Condition { group: hit.clone(), kind: "unilateral", keys: vec![], why };
        let conditions = self.conditions(|other| (other == group).then(|| condition.clone()));
        Some(Self::against(axis, sign, where_to, conditions, hit))
    }

    /// A body without a straight side flies to the left against a half-plane.
    fn round_wall(&self) -> Story {
        let ([low, high], (axis, sign, where_to)) = (self.mesh.extent(), SIDES[0]);
        let point = format!("[{}, {}]", number(low[0]), number(0.5 * (low[1] + high[1])));
        let near = |group: usize| self.distance(group, axis, sign)[0] <= NEAR * self.size()[axis];
        let condition = |group: usize| Condition {
            group: self.mesh.edge_groups[group].clone(),
            kind: "half-plane",
            keys: vec![("point", point.clone()), ("normal", "[1.0, 0.0]".to_owned())],
            why: "the rigid wall, which begins left of the body".to_owned(),
        };
        let conditions = self.conditions(|group| near(group).then(|| condition(group)));
        let hit = conditions.iter().find(|condition| condition.kind != "free");
        let hit = hit.map_or_else(String::new, |condition| condition.group.clone());
        Self::against(axis, sign, where_to, conditions, hit)
    }

    fn against(axis: usize, sign: f64, where_to: &str, conditions: Vec<Condition>, hit: String) -> Story {
        let mut velocity = ["0".to_owned(), "0".to_owned()];
        velocity[axis] = number(sign * Self::speed());
        let title = format!("A body of steel flies {where_to} against a rigid wall");
        let what = format!("All of the body moves {where_to}, at a hundredth of its wave speed.");
        Story { title, conditions, velocity, what, axis, delay: 0.0, hit, far: -sign }
    }

    /// Two bodies on both sides of a straight line meet.
    fn meeting(&self) -> Option<Story> {
        let part = self.parts();
        let part_of = |group: usize| {
            let mut parts = self.mesh.edges.iter().filter(|edge| edge.group == group).map(|edge| part[edge.cell]);
            let first = parts.next()?;
            parts.all(|other| other == first).then_some(first)
        };
        if part.iter().max() != Some(&1) {
            return None;
        }
        let of_group: Option<Vec<usize>> = self.groups.iter().map(|&group| part_of(group)).collect();
        // One group around both bodies meets itself.
        let around = if let [only] = self.groups[..] { Some(only).filter(|_| of_group.is_none()) } else { None };
        let range = |which: usize, axis: usize| {
            let cells = (0..part.len()).filter(|&cell| part[cell] == which);
            let all = cells.flat_map(|cell| self.mesh.corners(cell)).map(|x| x[axis]);
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let found = [0, 1].into_iter().find_map(|axis| {
            let [a, b] = [0, 1].map(|which| range(which, axis));
            let apart = |low: [f64; 2], high: [f64; 2]| low[1] <= high[0] + FLAT * self.size()[axis];
            if apart(a, b) { Some((axis, 0, [a[1], b[0]])) } else { apart(b, a).then_some((axis, 1, [b[1], a[0]])) }
        });
        let (axis, below, gap) = found?;
        if let Some(around) = around {
            return Some(self.met(axis, [around; 2], gap));
        }
        let of_group = of_group?;
        // Of each body the group that comes nearest to the other one.
        let facing = |which: usize, at: f64| {
            let own = self.groups.iter().zip(&of_group).filter(|(_, part)| **part == which).map(|(group, _)| *group);
            // Of the middles of edges: a group that ends at the corner of the facing one has a node there, too.
            let edges = |group: usize| self.mesh.edges.iter().filter(move |edge| edge.group == group);
            let middle = |edge: &BoundaryEdge| map::position(&self.mesh.map(edge.cell), map::on_face(edge.face, 0.5));
            let off =
                |group: usize| edges(group).map(|edge| (middle(edge)[axis] - at).abs()).fold(f64::INFINITY, f64::min);
            own.min_by(|&a, &b| off(a).total_cmp(&off(b)))
        };
        let [lower, upper] = [facing(below, gap[0])?, facing(1 - below, gap[1])?];
        Some(self.met(axis, [lower, upper], gap))
    }

    fn met(&self, axis: usize, [lower, upper]: [usize; 2], gap: [f64; 2]) -> Story {
        let names = [lower, upper].map(|group| self.mesh.edge_groups[group].clone());
        let mut keys = vec![("friction", number(0.0))];
        if lower != upper {
            keys.insert(0, ("partner", quoted(&names[1])));
        }
        let condition = Condition { group: names[0].clone(), kind: "contact", keys, why: String::new() };
        let mut conditions = self.conditions(|group| (group == lower).then(|| condition.clone()));
        // The partner has the condition of its pair.
        conditions.retain(|condition| lower == upper || condition.group != names[1]);
        let (speed, letter) = (Self::speed(), ["x", "y"][axis]);
        let middle = 0.5 * (gap[0] + gap[1]);
        let mut velocity = ["0".to_owned(), "0".to_owned()];
        let line = if middle < 0.0 {
            format!("{letter} + {}", number(-middle))
        } else {
            format!("{letter} - {}", number(middle))
        };
        velocity[axis] = format!("{speed} - {}*step({line})", 2.0 * speed);
        let title = "Two bodies of steel fly against each other".to_owned();
        let what = format!("Each moves towards the other, at {} of its wave speed.", "a hundredth");
        let delay = (gap[1] - gap[0]).max(0.0) / (2.0 * speed);
        Story { title, conditions, velocity, what, axis, delay, hit: names[0].clone(), far: -1.0 }
    }

    /// The number of the part of each cell: cells that are connected through edges.
    fn parts(&self) -> Vec<usize> {
        let (near, mut part) = (neighbours(self.mesh), vec![usize::MAX; self.mesh.cells.len()]);
        let (mut open, mut count) = (Vec::new(), 0);
        for first in 0..part.len() {
            if part[first] != usize::MAX {
                continue;
            }
            (part[first], count) = (count, count + 1);
            open.push(first);
            while let Some(cell) = open.pop() {
                for other in
                    near[cell].into_iter().flatten().filter(|&other| part[other] == usize::MAX).collect::<Vec<_>>()
                {
                    part[other] = count - 1;
                    open.push(other);
                }
            }
        }
        part
    }

    /// The middle of the cell that is farthest along an axis.
    fn farthest(&self, axis: usize, sign: f64) -> [f64; 2] {
        let middles = (0..self.mesh.cells.len()).map(|cell| map::position(&self.mesh.map(cell), [0.5; 2]));
        middles.max_by(|a, b| (sign * a[axis]).total_cmp(&(sign * b[axis]))).unwrap_or_default()
    }
}

impl Story {
    fn told(self, shape: &Shape, file: &str) -> Draft {
        let c = wave_speed();
        let transit = shape.size()[self.axis] / c;
        let end = rounded_up(self.delay + TRANSITS * transit);
        let before =
            if self.delay > 0.0 { format!("{:.2e} s until they meet, and then ", self.delay) } else { String::new() };
        let why = format!(
            "{before}{TRANSITS} times the {transit:.2e} s that a wave of {c:.0} m/s needs from one end to the other."
        );
        // Rounded, so that no noise of the mesh file stands in the scene.
        let point = shape.farthest(self.axis, self.far);
        let scale = shape.size()[0].max(shape.size()[1]);
        let digits = 10_f64.powf(4.0 - scale.log10().floor());
        let point = point.map(|x| (x * digits).round() / digits);
        Draft {
            title: self.title,
            mesh: file.to_owned(),
            groups: shape.mesh.groups.clone(),
            boundaries: self.conditions,
            inside: vec![],
            velocity: (self.velocity, self.what),
            end: (end, capital(&why)),
            every: four_digits(end / SNAPSHOTS),
            force: self.hit,
            probe: (point, "In the cell at the far end.".to_owned()),
        }
    }
}

/// A sentence begins with a capital letter.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    #[test]
    fn numbers_are_round() {
        assert_eq!([58.7, 20.0, 1.99, 0.051].map(rounded_down), [50.0, 20.0, 1.0, 0.05]);
        assert_eq!([6.81e-4, 1.0, 1.001].map(rounded_up), [6.9e-4, 1.0, 1.1]);
    }

    #[test]
    fn edges_without_a_group_get_one_and_others_keep_theirs() {
        let mut mesh = rectangle([2.0, 1.0], [2, 2]).unwrap();
        let right = mesh.edge_groups.iter().position(|name| name == "right").unwrap();
        mesh.edges.retain(|edge| edge.group != right);
        let (mesh, count) = tagged(mesh).unwrap();
        assert_eq!((count, mesh.edge_groups.last().unwrap().as_str()), (2, "boundary"));
        let (again, count) = tagged(mesh.clone()).unwrap();
        assert_eq!((count, again), (0, mesh));
    }

    #[test]
    fn bodies_meet_in_the_groups_that_face_each_other_in_any_order_of_the_groups() {
        let mut mesh = rectangle([1.0, 3.0], [4, 3]).unwrap();
        // Without the row in the middle: bodies below y = 1 and above y = 2.
        for cell in (4..8).rev() {
            mesh.cells.remove(cell);
            mesh.cell_group.remove(cell);
        }
        mesh.original = vec![];
        mesh.edge_groups = ["ends", "top", "bottom", "rim"].map(str::to_owned).to_vec();
        let group = |cell: usize, face: usize| if cell >= 4 { 3 } else { [0, 0, 2, 1][face] };
        let is_edge = |cell: usize, face: usize| face >= 2 || [0, 3][face] == cell % 4;
        let all =
            (0..8).flat_map(|cell| (0..4).map(move |face| (cell, face))).filter(|&(cell, face)| is_edge(cell, face));
        mesh.edges = all.map(|(cell, face)| BoundaryEdge { cell, face, group: group(cell, face) }).collect();
        let draft = draft(&mesh, "a.msh").unwrap();
        let contact = draft.boundaries.iter().find(|condition| condition.kind == "contact").unwrap();
        assert_eq!((&contact.group[..], &contact.keys[0]), ("top", &("partner", "\"rim\"".to_owned())));
    }

    #[test]
    fn two_bodies_in_one_group_meet_in_contact_of_the_group_with_itself() {
        let mut mesh = rectangle([3.0, 1.0], [3, 1]).unwrap();
        // Without the cell in the middle.
        mesh.cells.remove(1);
        mesh.cell_group.remove(1);
        mesh.original = vec![];
        mesh.edge_groups = vec!["around".to_owned()];
        mesh.edges = (0..2).flat_map(|cell| (0..4).map(move |face| BoundaryEdge { cell, face, group: 0 })).collect();
        let draft = draft(&mesh, "a.msh").unwrap();
        let [Condition { kind, keys, .. }] = &draft.boundaries[..] else { panic!("{:?}", draft.boundaries) };
        assert_eq!((*kind, keys.len(), keys[0].0), ("contact", 1, "friction"));
        assert!(draft.velocity.0[0].contains("step"), "{:?}", draft.velocity);
    }

    #[test]
    fn a_wall_is_at_a_straight_side_and_a_body_that_has_none_meets_a_half_plane() {
        let mesh = rectangle([2.0, 1.0], [2, 2]).unwrap();
        let first = draft(&mesh, "a.msh").unwrap();
        let kind = |draft: &Draft, group: &str| draft.boundaries.iter().find(|b| b.group == group).unwrap().kind;
        assert_eq!([kind(&first, "left"), kind(&first, "right")], ["unilateral", "free"]);
        // A wave of the steel goes through 2 m in .34 ms; the end is 4 times that.
        assert!((first.end.0 - 1.4e-3).abs() < 1e-12 && first.velocity.0 == ["-50.0", "0"], "{first:?}");
        // One group around the body is not straight.
        let mut one = mesh.clone();
        one.edge_groups = vec!["all".to_owned()];
        one.edges.iter_mut().for_each(|edge| edge.group = 0);
        assert_eq!(kind(&draft(&one, "a.msh").unwrap(), "all"), "half-plane");
        let mut none = mesh;
        (none.edges, none.edge_groups) = (vec![], vec![]);
        assert!(draft(&none, "a.msh").is_err());
    }
}
