//! Face topology from shared nodes.

use std::collections::{BTreeSet, HashMap};

use super::{Error, FACE_CORNERS, Link, Mesh};

/// Nodes that are closer than this part of the edges there count as one place. It is far above the rounding of coordinates
/// (1e-16 of the size of the mesh), and far below any intended edge.
const SAME_PLACE: f64 = 1e-6;

/// For each cell the other side of its faces 0..4: another cell, or a boundary group.
///
/// Two faces are neighbours if they have both nodes in common. Errors are: an edge of more than two cells; a boundary
/// edge in two groups or in no group; a node that hangs on the inside of a boundary edge without a group; and two nodes
/// in one place, unless all boundary edges at both nodes have groups (two bodies in contact, a crack). An edge between
/// two cells is no boundary, even if it has a group.
pub fn links(mesh: &Mesh) -> Result<Vec<[Link; 4]>, Error> {
    mesh.consistent()?;
    let tags = tags(mesh)?;
    let mut links = vec![[Link::Boundary(usize::MAX); 4]; mesh.cells.len()];
    let mut free = Vec::new();
    let faces = sorted_faces(mesh);
    for same in faces.chunk_by(|a, b| a.nodes == b.nodes) {
        match same {
            [one] => free.push(*one),
            [a, b] if a.cell != b.cell => {
                let flip = first_node(mesh, a) != first_node(mesh, b);
                links[a.cell][a.face] = Link::Cell { cell: b.cell, face: b.face, flip };
                links[b.cell][b.face] = Link::Cell { cell: a.cell, face: a.face, flip };
            }
            _ => {
                let cells = same.iter().map(|f| mesh.number(f.cell)).collect();
                return Err(Error::Crowded { at: ends(mesh, &same[0]), cells });
            }
        }
    }
    free.sort_unstable_by_key(|f| (f.cell, f.face));
    let mut untagged = Vec::new();
    for face in &free {
        match tags.get(&(face.cell, face.face)) {
            Some(&group) => links[face.cell][face.face] = Link::Boundary(group),
            None => untagged.push(*face),
        }
    }
    no_duplicates(mesh, &free, &untagged)?;
    no_hanging_nodes(mesh, &free, &untagged)?;
    match untagged.first() {
        Some(face) => {
            Err(Error::Untagged { count: untagged.len(), at: ends(mesh, face), cell: mesh.number(face.cell) })
        }
        None => Ok(links),
    }
}

/// For each cell the cells that share its faces 0..4; the groups of edges do not matter. `None` at the edge of the
/// body, and where more than two cells meet.
pub fn neighbours(mesh: &Mesh) -> Vec<[Option<usize>; 4]> {
    let mut out = vec![[None; 4]; mesh.cells.len()];
    for same in sorted_faces(mesh).chunk_by(|a, b| a.nodes == b.nodes) {
        if let [a, b] = same {
            out[a.cell][a.face] = Some(b.cell);
            out[b.cell][b.face] = Some(a.cell);
        }
    }
    out
}

/// A face with its nodes in ascending order.
#[derive(Clone, Copy)]
struct Face {
    nodes: [usize; 2],
    cell: usize,
    face: usize,
}

fn sorted_faces(mesh: &Mesh) -> Vec<Face> {
    let mut faces = Vec::with_capacity(4 * mesh.cells.len());
    for cell in 0..mesh.cells.len() {
        for face in 0..4 {
            let [a, b] = mesh.face_nodes(cell, face);
            faces.push(Face { nodes: [a.min(b), a.max(b)], cell, face });
        }
    }
    faces.sort_unstable_by_key(|f| (f.nodes, f.cell, f.face));
    faces
}

fn first_node(mesh: &Mesh, face: &Face) -> usize {
    mesh.cells[face.cell][FACE_CORNERS[face.face][0]]
}

fn ends(mesh: &Mesh, face: &Face) -> [[f64; 2]; 2] {
    mesh.face_nodes(face.cell, face.face).map(|node| mesh.nodes[node])
}

/// The group of each face that has one.
fn tags(mesh: &Mesh) -> Result<HashMap<(usize, usize), usize>, Error> {
    let mut tags = HashMap::with_capacity(mesh.edges.len());
    for edge in &mesh.edges {
        match tags.insert((edge.cell, edge.face), edge.group) {
            Some(other) if other != edge.group => {
                return Err(Error::TwoGroups {
                    at: mesh.face_nodes(edge.cell, edge.face).map(|node| mesh.nodes[node]),
                    cell: mesh.number(edge.cell),
                    groups: [other, edge.group].map(|group| mesh.edge_groups[group].clone()),
                });
            }
            _ => {}
        }
    }
    Ok(tags)
}

/// An error if two nodes are in one place, unless all boundary edges at both have groups.
fn no_duplicates(mesh: &Mesh, free: &[Face], untagged: &[Face]) -> Result<(), Error> {
    // Per node: a cell of it, the shortest edge there, and whether it may share its place.
    let mut owner = vec![usize::MAX; mesh.nodes.len()];
    let mut shortest = vec![f64::INFINITY; mesh.nodes.len()];
    for (cell, nodes) in mesh.cells.iter().enumerate() {
        for k in 0..4 {
            let (a, b) = (nodes[k], nodes[(k + 1) % 4]);
            let length = distance(mesh.nodes[a], mesh.nodes[b]);
            owner[a] = owner[a].min(cell);
            shortest[a] = shortest[a].min(length);
            shortest[b] = shortest[b].min(length);
        }
    }
    let mut may_share = vec![false; mesh.nodes.len()];
    free.iter().flat_map(|f| f.nodes).for_each(|node| may_share[node] = true);
    untagged.iter().flat_map(|f| f.nodes).for_each(|node| may_share[node] = false);

    let used: Vec<usize> = (0..mesh.nodes.len()).filter(|&n| owner[n] != usize::MAX).collect();
    let reach = SAME_PLACE * used.iter().map(|&n| shortest[n]).fold(0.0, f64::max);
    let close = |a: usize, b: usize| {
        let limit = SAME_PLACE * shortest[a].min(shortest[b]);
        distance(mesh.nodes[a], mesh.nodes[b]) <= limit && !(may_share[a] && may_share[b])
    };
    let pairs = close_pairs(mesh, &used, 16.0 * reach, close);
    match pairs.first() {
        Some(&(a, b)) => {
            let cells = [a, b].map(|node| mesh.number(owner[node]));
            Err(Error::Duplicate { count: pairs.len(), at: mesh.nodes[a], cells })
        }
        None => Ok(()),
    }
}

/// All pairs of nodes that are `close`. Nodes that are further apart than `width / 2` must not be `close`.
///
/// Nodes are sorted by square buckets of that width, four times with buckets shifted by one half in x, in y and in
/// both, so that each pair shares a bucket at least once.
fn close_pairs(
    mesh: &Mesh,
    used: &[usize],
    width: f64,
    close: impl Fn(usize, usize) -> bool,
) -> BTreeSet<(usize, usize)> {
    let mut pairs = BTreeSet::new();
    let mut sorted: Vec<([i64; 2], usize)> = Vec::with_capacity(used.len());
    for shift in [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]] {
        // `as` saturates, so coordinates that are huge or not finite share the outermost buckets.
        let bucket = |node: usize| [0, 1].map(|i| (mesh.nodes[node][i] / width + shift[i]).floor() as i64);
        sorted.clear();
        sorted.extend(used.iter().map(|&node| (bucket(node), node)));
        sorted.sort_unstable();
        for same in sorted.chunk_by(|a, b| a.0 == b.0) {
            for (k, &(_, a)) in same.iter().enumerate() {
                pairs.extend(same[k + 1..].iter().map(|&(_, b)| (a, b)).filter(|&(a, b)| close(a, b)));
            }
        }
    }
    pairs
}

/// An error if a boundary node lies on the inside of a boundary edge without a group.
fn no_hanging_nodes(mesh: &Mesh, free: &[Face], untagged: &[Face]) -> Result<(), Error> {
    let longest = untagged.iter().map(|f| length(mesh, f)).fold(0.0, f64::max);
    if longest == 0.0 {
        return Ok(());
    }
    let mut grid = Grid::new(longest, free.len());
    // Each boundary node is the end of two boundary edges; it is entered into the grid once.
    let mut seen = vec![false; mesh.nodes.len()];
    for (index, face) in free.iter().enumerate() {
        for (end, node) in face.nodes.into_iter().enumerate() {
            if !std::mem::replace(&mut seen[node], true) {
                grid.insert(mesh.nodes[node], 2 * index + end);
            }
        }
    }
    for face in untagged {
        let [a, b] = ends(mesh, face);
        let mut found = None;
        grid.near(a, b, SAME_PLACE * length(mesh, face), |entry| {
            if inside(a, b, mesh.nodes[free[entry / 2].nodes[entry % 2]]) {
                found = Some(entry);
            }
        });
        if let Some(entry) = found {
            let other = free[entry / 2];
            let at = mesh.nodes[other.nodes[entry % 2]];
            let (owner, cell) = (mesh.number(other.cell), mesh.number(face.cell));
            return Err(Error::Hanging { at, owner, edge: [a, b], cell });
        }
    }
    Ok(())
}

/// Whether x lies on the segment from a to b and at neither end.
fn inside(a: [f64; 2], b: [f64; 2], x: [f64; 2]) -> bool {
    let (d, r) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]]);
    let squared = d[0] * d[0] + d[1] * d[1];
    let along = (r[0] * d[0] + r[1] * d[1]) / squared;
    let across = (r[0] * d[1] - r[1] * d[0]).abs() / squared;
    along > SAME_PLACE && along < 1.0 - SAME_PLACE && across < SAME_PLACE
}

fn length(mesh: &Mesh, face: &Face) -> f64 {
    distance(mesh.nodes[face.nodes[0]], mesh.nodes[face.nodes[1]])
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A spatial hash: entries by the square bucket that they lie in.
struct Grid {
    width: f64,
    buckets: HashMap<[i64; 2], Vec<usize>>,
}

impl Grid {
    fn new(width: f64, entries: usize) -> Self {
        Self { width, buckets: HashMap::with_capacity(entries) }
    }

    fn bucket(&self, x: [f64; 2]) -> [i64; 2] {
        // `as` saturates, so coordinates that are huge or not finite share the outermost buckets.
        x.map(|x| (x / self.width).floor() as i64)
    }

    fn insert(&mut self, x: [f64; 2], entry: usize) {
        self.buckets.entry(self.bucket(x)).or_default().push(entry);
    }

    /// All entries of the buckets that the box around a and b, widened by `reach`, touches.
    fn near(&self, a: [f64; 2], b: [f64; 2], reach: f64, mut take: impl FnMut(usize)) {
        let low = self.bucket([a[0].min(b[0]) - reach, a[1].min(b[1]) - reach]);
        let high = self.bucket([a[0].max(b[0]) + reach, a[1].max(b[1]) + reach]);
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                self.buckets.get(&[i, j]).into_iter().flatten().for_each(|&entry| take(entry));
            }
        }
    }
}

#[cfg(test)]
mod tests;
