//! Meshes of several parts for tests.
#![allow(dead_code)] // each test file uses its part

use dgmpm::parts::io::gmsh;
use dgmpm::parts::mesh::{BoundaryEdge, Mesh};
use std::path::{Path, PathBuf};

/// Parts that share no node.
#[derive(Default)]
pub struct Parts(Mesh);

impl Parts {
    /// A rectangle with its lower left corner at a place, and the groups of its left, right, bottom and top side.
    pub fn rectangle(
        &mut self,
        at: [f64; 2],
        size: [f64; 2],
        cells: [usize; 2],
        group: &str,
        sides: &[String; 4],
    ) -> &mut Self {
        let place = |u: f64, v: f64| [at[0] + size[0] * u, at[1] + size[1] * v];
        self.block(place, cells, group, &sides.each_ref().map(|side| Some(side.as_str())));
        self
    }

    /// A rectangle whose left and right half are groups of so many cells each; all its sides are one group.
    pub fn halves(&mut self, size: [f64; 2], cells: [usize; 2], groups: [&str; 2], side: &str) -> &mut Self {
        let first = self.0.nodes.len();
        for (half, group) in groups.into_iter().enumerate() {
            let place = |u: f64, v: f64| [0.5 * size[0] * (u + half as f64), size[1] * v];
            let outside = |there: bool| there.then_some(side);
            self.block(place, cells, group, &[outside(half == 0), outside(half == 1), Some(side), Some(side)]);
        }
        self.merge(first, 1e-9 * size[0]);
        self
    }

    /// A disc of five blocks of n x n cells.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, n: usize, group: &str, side: &str) -> &mut Self {
        let first = self.0.nodes.len();
        let half = 0.42 * radius;
        let core = |u: f64, v: f64| [centre[0] + half * (2.0 * u - 1.0), centre[1] + half * (2.0 * v - 1.0)];
        self.block(core, [n, n], group, &[None; 4]);
        for quarter in 0..4 {
            let (s, c) = (quarter as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
            let sector = |u: f64, v: f64| {
                let angle = std::f64::consts::FRAC_PI_2 * (v - 0.5);
                let inner = [half, half * (2.0 * v - 1.0)];
                let outer = [radius * angle.cos(), radius * angle.sin()];
                let x = [0, 1].map(|k| inner[k] + (outer[k] - inner[k]) * u);
                [centre[0] + c * x[0] - s * x[1], centre[1] + s * x[0] + c * x[1]]
            };
            self.block(sector, [n, n], group, &[None, Some(side), None, None]);
        }
        self.merge(first, 1e-9 * radius);
        self
    }

    /// Faces of cells as a group of edges.
    pub fn group(&mut self, faces: impl Iterator<Item = (usize, usize)>, name: &str) -> &mut Self {
        let group = self.edge_group(name);
        self.0.edges.extend(faces.map(|(cell, face)| BoundaryEdge { cell, face, group }));
        self
    }

    /// A structured rectangle whose first `count` edges of a group along its middle line from the left are split: the upper cells get
    /// nodes of their own, but at the last node.
    pub fn split_by_hand(mut self, count: usize, name: &str) -> Self {
        let group = self.edge_group(name);
        let faces: Vec<BoundaryEdge> = self.0.edges.iter().filter(|edge| edge.group == group).copied().collect();
        assert_eq!(faces.len(), count);
        let mut copies = std::collections::BTreeMap::new();
        for edge in &faces {
            let node = self.0.cells[edge.cell][3];
            copies.insert(node, self.0.nodes.len());
            self.0.nodes.push(self.0.nodes[node]);
        }
        let line = self.0.nodes[*copies.keys().next().unwrap()][1];
        for (cell, corners) in self.0.cells.clone().iter().enumerate() {
            let above = corners.iter().map(|&node| self.0.nodes[node][1]).sum::<f64>() / 4.0 > line;
            if !above {
                continue;
            }
            for corner in &mut self.0.cells[cell] {
                *corner = copies.get(corner).copied().unwrap_or(*corner);
            }
            let bottom = [0, 1].map(|k| self.0.cells[cell][k]);
            if bottom.iter().any(|node| copies.values().any(|copy| copy == node)) {
                self.0.edges.push(BoundaryEdge { cell, face: 2, group });
            }
        }
        self
    }

    /// Writes `mesh.msh` into a folder.
    pub fn write(&self, folder: &Path) -> PathBuf {
        let path = folder.join("mesh.msh");
        gmsh::write(&self.0, &path).unwrap();
        path
    }

    fn edge_group(&mut self, name: &str) -> usize {
        let known = self.0.edge_groups.iter().position(|known| known == name);
        known.unwrap_or_else(|| {
            self.0.edge_groups.push(name.to_owned());
            self.0.edge_groups.len() - 1
        })
    }

    /// A block of cells, u and v from 0 to 1, with the groups of the sides u = 0, u = 1, v = 0, v = 1.
    fn block(
        &mut self,
        place: impl Fn(f64, f64) -> [f64; 2],
        [nx, ny]: [usize; 2],
        group: &str,
        sides: &[Option<&str>; 4],
    ) {
        let (first, cell) = (self.0.nodes.len(), self.0.cells.len());
        for j in 0..=ny {
            self.0.nodes.extend((0..=nx).map(|i| place(i as f64 / nx as f64, j as f64 / ny as f64)));
        }
        let known = self.0.groups.iter().position(|known| known == group);
        let number = known.unwrap_or_else(|| {
            self.0.groups.push(group.to_owned());
            self.0.groups.len() - 1
        });
        let node = |i: usize, j: usize| first + j * (nx + 1) + i;
        for j in 0..ny {
            for i in 0..nx {
                self.0.cells.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
                self.0.cell_group.push(number);
                self.0.original.push(self.0.cells.len() as u64);
            }
        }
        for (face, side) in sides.iter().enumerate() {
            let Some(side) = side else { continue };
            let group = self.edge_group(side);
            let of_side = |i: usize, j: usize| [i == 0, i + 1 == nx, j == 0, j + 1 == ny][face];
            let all = (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))).filter(|&(i, j)| of_side(i, j));
            let edges = all.map(|(i, j)| BoundaryEdge { cell: cell + j * nx + i, face, group });
            self.0.edges.extend(edges.collect::<Vec<_>>());
        }
    }

    /// Makes one node of those from `first` on that are in one place.
    fn merge(&mut self, first: usize, near: f64) {
        let mut kept: Vec<usize> = (0..first).collect();
        let mut new: Vec<usize> = kept.clone();
        for node in first..self.0.nodes.len() {
            let x = self.0.nodes[node];
            let close = |other: &&usize| {
                let y = self.0.nodes[**other];
                (x[0] - y[0]).hypot(x[1] - y[1]) < near
            };
            match kept[first..].iter().position(|other| close(&other)) {
                Some(at) => new.push(first + at),
                None => {
                    new.push(kept.len());
                    kept.push(node);
                }
            }
        }
        self.0.nodes = kept.iter().map(|&node| self.0.nodes[node]).collect();
        self.0.cells.iter_mut().flatten().for_each(|corner| *corner = new[*corner]);
    }
}
