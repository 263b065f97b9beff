//! Fingerprints of meshes and clouds: blake3 of the exact bits, as hexadecimal text.

use crate::cloud::Cloud;
use crate::mesh::{BoundaryEdge, Mesh, map};

/// Feeds counts, numbers and texts to blake3. Each list comes with its length, so that different contents never give
/// the same bytes.
#[derive(Debug, Default)]
pub struct Digest(blake3::Hasher);

impl Digest {
    /// A hash without any input yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Bytes, with their count before them.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        self.count(bytes.len());
        self.0.update(bytes);
        self
    }

    /// A text.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.bytes(text.as_bytes())
    }

    /// A count or an index.
    pub fn count(&mut self, count: usize) -> &mut Self {
        self.0.update(&(count as u64).to_le_bytes());
        self
    }

    /// Unsigned numbers.
    pub fn counts(&mut self, values: impl ExactSizeIterator<Item = u64>) -> &mut Self {
        self.words(values)
    }

    /// Real numbers, by their bits.
    pub fn reals(&mut self, values: impl ExactSizeIterator<Item = f64>) -> &mut Self {
        self.words(values.map(f64::to_bits))
    }

    /// The fingerprint: 64 hexadecimal digits.
    pub fn finish(&self) -> String {
        self.0.finalize().to_hex().to_string()
    }

    fn words(&mut self, values: impl ExactSizeIterator<Item = u64>) -> &mut Self {
        self.count(values.len());
        let mut buffer = Vec::with_capacity(8 * 1024);
        for value in values {
            buffer.extend_from_slice(&value.to_le_bytes());
            if buffer.len() >= 8 * 1024 {
                self.0.update(&buffer);
                buffer.clear();
            }
        }
        self.0.update(&buffer);
        self
    }
}

/// The fingerprint of a mesh: nodes, cells, groups, edges, original numbers, and curved edges where there are any.
pub fn of_mesh(mesh: &Mesh) -> String {
    let mut digest = Digest::new();
    digest.text("mesh").reals(mesh.nodes.as_flattened().iter().copied());
    digest.counts(mesh.cells.as_flattened().iter().map(|&n| n as u64));
    digest.counts(mesh.cell_group.iter().map(|&n| n as u64));
    digest.count(mesh.edges.len());
    for edge in &mesh.edges {
        digest.count(edge.cell).count(edge.face).count(edge.group);
    }
    for names in [&mesh.groups, &mesh.edge_groups] {
        digest.count(names.len());
        for name in names {
            digest.text(name);
        }
    }
    digest.counts(mesh.original.iter().copied());
    if mesh.curved_cells() > 0 {
        digest.text("bulges").reals(mesh.bulges.as_flattened().as_flattened().iter().copied());
    }
    digest.finish()
}

/// The fingerprint of what a mesh is, whatever the order of its nodes, cells and groups and the corner that a cell begins with: the
/// corners of each cell with the name of its group, and the ends of each edge of a group with that. Two files hold the same mesh where
/// it is the same.
pub fn of_places(mesh: &Mesh) -> String {
    type Place = [u64; 2];
    // -0.0 and 0.0 are one place; bits of numbers below 0 are sorted among themselves, which is an order too.
    let place = |node: usize| mesh.nodes[node].map(|x| (x + 0.0).to_bits());
    let mut cells: Vec<([Place; 4], Vec<Place>, &str)> = (0..mesh.cells.len())
        .map(|cell| {
            let mut corners = mesh.cells[cell].map(place);
            let first = (0..4).min_by_key(|&k| corners[k]).unwrap_or(0);
            corners.rotate_left(first);
            // The middles of its edges in the order of the corners, and its own.
            let map = mesh.map(cell);
            let middles = map::middles(&map).map(|x| x.map(|x| (x + 0.0).to_bits()));
            let mut curve = [2, 1, 3, 0, 4].map(|face| middles[face]);
            curve[..4].rotate_left(first);
            let curve = if map.bulge.is_some() { curve.to_vec() } else { vec![] };
            (corners, curve, mesh.groups[mesh.cell_group[cell]].as_str())
        })
        .collect();
    let edge = |edge: &BoundaryEdge| {
        let mut ends = mesh.face_nodes(edge.cell, edge.face).map(place);
        ends.sort_unstable();
        (ends, mesh.edge_groups[edge.group].as_str())
    };
    let mut edges: Vec<([[u64; 2]; 2], &str)> = mesh.edges.iter().map(edge).collect();
    cells.sort_unstable();
    edges.sort_unstable();
    // A crack has an edge of its group on both sides.
    edges.dedup();
    let mut digest = Digest::new();
    digest.text("places").count(cells.len());
    for (corners, curve, group) in cells {
        digest.counts(corners.as_flattened().iter().copied()).text(group);
        if !curve.is_empty() {
            digest.counts(curve.as_flattened().iter().copied());
        }
    }
    digest.count(edges.len());
    for (ends, group) in edges {
        digest.counts(ends.as_flattened().iter().copied()).text(group);
    }
    digest.finish()
}

/// The fingerprint of a cloud: points per cell and their parent coordinates.
pub fn of_cloud(cloud: &Cloud) -> String {
    let mut digest = Digest::new();
    digest.text("cloud").counts(cloud.first.iter().map(|&n| n as u64));
    digest.reals(cloud.xi.as_flattened().iter().copied());
    digest.finish()
}
