//! A mesh as rows of a table.

use super::Mesh;
use super::parts::EdgeCount;
use super::quality::Quality;
use crate::format::{Row, row};

impl Mesh {
    /// Counts, sizes, quality and groups.
    pub fn rows(&self) -> Vec<Row> {
        let (quality, counts) = (Quality::of(self), self.edge_counts());
        let (jacobian, worst) = quality.scaled_jacobian;
        let mut rows = vec![
            row("nodes", self.nodes.len().to_string()),
            row("cells", self.cells.len().to_string()),
            row("boundary edges", counts.iter().map(|count| count.boundary).sum::<usize>().to_string()),
            row("area", format!("{:.6e} m^2", quality.area)),
            row("h_e", format!("{:.4e} .. {:.4e} m", quality.smallest_h_e.0, quality.largest_h_e.0)),
            row("smallest h_e in", format!("cell {}", self.number(quality.smallest_h_e.1))),
            row("smallest scaled Jacobian", format!("{jacobian:.4} in cell {}", self.number(worst))),
            row("mean scaled Jacobian", format!("{:.4}", quality.mean_scaled_jacobian)),
            row("largest aspect", format!("{:.3} in cell {}", quality.aspect.0, self.number(quality.aspect.1))),
        ];
        if self.curved_cells() > 0 {
            rows.insert(2, row("cells with curved edges", self.curved_cells().to_string()));
        }
        for (group, name) in self.groups.iter().enumerate() {
            let count = self.cell_group.iter().filter(|&&g| g == group).count();
            rows.push(row(format!("cells of `{name}`"), count.to_string()));
        }
        for (name, EdgeCount { inner, boundary }) in self.edge_groups.iter().zip(counts) {
            let text = match (inner, boundary) {
                (0, _) => boundary.to_string(),
                (_, 0) => format!("{inner}, all inside of the body"),
                _ => format!("{}, {inner} of them inside of the body", inner + boundary),
            };
            rows.push(row(format!("edges of `{name}`"), text));
        }
        rows
    }
}
