//! Which expression of a scene is not finite: looked for once a run has lost stability, so that a run that goes well does
//! not pay for it.

use crate::expression::Expression;
use crate::mesh::Mesh;
use crate::operators::Neighbour;
use crate::registry::Chosen;
use crate::scene::Scene;
use crate::step::{Scheme, Site};
use std::collections::BTreeSet;

/// An expression of a boundary or a source whose value is not finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Culprit {
    /// Its key in the scene, such as `boundary.0.value.1`.
    pub key: String,
    /// Which expression, its value, where and when, in words.
    pub what: String,
}

/// An expression with its key and what it is.
struct Named<'a> {
    key: String,
    name: String,
    expression: &'a Expression,
}

impl Named<'_> {
    /// At X and any of some times.
    fn fault(&self, x: [f64; 2], times: &[f64]) -> Option<Culprit> {
        let Self { key, name, expression } = self;
        let (t, value) = times.iter().map(|&t| (t, expression.eval(x, t))).find(|(_, value)| !value.is_finite())?;
        let source = expression.source();
        let what = format!("{name} `{source}` is {value} at X = ({:.6}, {:.6}), t = {t:.9e} s", x[0], x[1]);
        Some(Culprit { key: key.clone(), what })
    }
}

impl Scene {
    /// The expression of a boundary or a source that is not finite at one of the `times` of a step, in the cell that lost
    /// stability or so near that it can have got there in this step; the nearest first.
    pub fn culprit(&self, mesh: &Mesh, scheme: &Scheme, cell: usize, times: &[f64]) -> Option<Culprit> {
        let sources: Vec<(Option<&String>, Vec<Named>)> = self.expressions_of_sources();
        // What comes in at a stage is in the neighbours at the next one.
        around(scheme, cell, scheme.stages() + 1).into_iter().find_map(|cell| {
            let boundary = self.culprit_at_faces(mesh, scheme, cell, times);
            boundary.or_else(|| {
                let group = &mesh.groups[mesh.cell_group[cell]];
                let acting = sources.iter().filter(|(of, _)| of.is_none_or(|of| of == group));
                acting.flat_map(|(_, both)| both).find_map(|named| {
                    let (block, lane) = scheme.operators.blocks.slot[cell];
                    let points = (0..scheme.operators.places(block, lane).len()).map(Site::Point);
                    let nodes = (0..scheme.operators.nodes()).map(Site::Node);
                    points.chain(nodes).find_map(|site| named.fault(scheme.position_of(cell, site), times))
                })
            })
        })
    }

    fn culprit_at_faces(&self, mesh: &Mesh, scheme: &Scheme, cell: usize, times: &[f64]) -> Option<Culprit> {
        let (block, lane) = scheme.operators.blocks.slot[cell];
        (0..4).find_map(|face| {
            let Neighbour::Boundary(group) = scheme.operators.blocks.neighbours[block][face][lane] else { return None };
            let all = self.expressions_of_boundary(&mesh.edge_groups[group]);
            all.iter().find_map(|named| {
                let sites = (0..scheme.operators.line.m).map(|point| Site::Face(face, point));
                sites.map(|site| scheme.position_of(cell, site)).find_map(|x| named.fault(x, times))
            })
        })
    }

    fn expressions_of_boundary(&self, group: &str) -> Vec<Named<'_>> {
        let Some(number) = self.boundaries.iter().position(|boundary| boundary.group == group) else { return vec![] };
        let of = format!(" `{group}`");
        all(&self.boundaries[number].condition, &format!("boundary.{number}"), &of)
    }

    fn expressions_of_sources(&self) -> Vec<(Option<&String>, Vec<Named<'_>>)> {
        let mut named = Vec::new();
        for (number, source) in self.sources.iter().enumerate() {
            let on = source.group.as_ref().map_or(String::new(), |group| format!(" on `{group}`"));
            named.push((source.group.as_ref(), all(&source.source, &format!("source.{number}"), &on)));
        }
        named
    }
}

/// All expressions of what a table has chosen; the parameter that they belong to is named by the line that describes it.
fn all<'a, B>(chosen: &'a Chosen<B>, table: &str, of: &str) -> Vec<Named<'a>> {
    let mut named = Vec::new();
    for (parameter, expressions) in chosen.expressions() {
        // What the line says of its use is no part of the name.
        let about = parameter.about.split(',').next().unwrap_or(parameter.about);
        for (k, expression) in expressions.iter().enumerate() {
            let (key, name) = match expressions.len() {
                1 => (format!("{table}.{}", parameter.name), format!("{about}{of}")),
                _ => {
                    let name = format!("component {} of {about}{of},", k + 1);
                    (format!("{table}.{}.{k}", parameter.name), name)
                }
            };
            named.push(Named { key, name, expression });
        }
    }
    named
}

/// The cells that are at most so many neighbours away from a cell, nearest first.
fn around(scheme: &Scheme, cell: usize, layers: usize) -> Vec<usize> {
    let blocks = &scheme.operators.blocks;
    let (mut order, mut seen, mut first) = (vec![cell], BTreeSet::from([cell]), 0);
    for _ in 0..layers {
        let end = order.len();
        for at in first..end {
            let (block, lane) = blocks.slot[order[at]];
            for neighbours in &blocks.neighbours[block] {
                let (Neighbour::Cell(across) | Neighbour::Interface(across, _)) = neighbours[lane] else { continue };
                let other = blocks.cells[across.face / 4][across.lane];
                if seen.insert(other) {
                    order.push(other);
                }
            }
        }
        first = end;
    }
    order
}
