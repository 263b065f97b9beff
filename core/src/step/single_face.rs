//! A face of one cell.

use super::block::Block;
use crate::boundary::FacePoint;
use crate::mesh::map::{self, CellMap};
use crate::operators::{BlockMetric, Neighbour};
use crate::riemann::Medium;

/// A face of one cell at a boundary or at another material: what its points share.
pub(super) struct SingleFace<'a> {
    /// The block of the cell.
    pub block: Block<'a>,
    /// The number of the face in its cell, and the lane of the cell.
    pub face: usize,
    pub lane: usize,
    /// What is beyond.
    pub neighbour: Neighbour,
    /// Unit outward normal and length (m) of a straight face; that of its chord where it is curved.
    straight: ([f64; 2], f64),
    metric: BlockMetric<'a>,
    map: CellMap,
    medium: Medium<f64>,
}

impl SingleFace<'_> {
    /// The unit outward normal at a point, and the length of the face there, m.
    #[inline(always)]
    pub fn normal_and_length(&self, point: usize) -> ([f64; 2], f64) {
        if self.metric.curved.is_some() { self.metric.at_face_of(self.lane, self.face, point) } else { self.straight }
    }

    /// A point of the face.
    #[inline(always)]
    pub fn point(&self, point: usize) -> FacePoint {
        let along = self.block.scheme.operators.line.basis.nodes[point];
        let x = map::position(&self.map, map::on_face(self.face, along));
        FacePoint { x, normal: self.normal_and_length(point).0, medium: self.medium }
    }
}

impl<'a> Block<'a> {
    /// The face of the cell in a lane; none between cells of one material.
    #[inline(always)]
    pub(super) fn single_face(&self, face: usize, lane: usize) -> Option<SingleFace<'a>> {
        let neighbour = self.scheme.operators.blocks.neighbours[self.number][face][lane];
        if matches!(neighbour, Neighbour::Cell(_) | Neighbour::Padding) {
            return None;
        }
        let metric = self.metric();
        let straight = metric.straight.lane(lane);
        Some(SingleFace {
            block: *self,
            face,
            lane,
            neighbour,
            straight: (straight.normal(face), straight.length(face)),
            metric,
            map: self.scheme.operators.geometry.map_of(self.number, lane),
            medium: self.medium(),
        })
    }

    /// The points of a face of the cell in a lane; none between cells of one material.
    pub(super) fn face_points(&self, face: usize, lane: usize) -> Vec<FacePoint> {
        let points = 0..self.scheme.operators.line.m;
        self.single_face(face, lane).map_or_else(Vec::new, |face| points.map(|point| face.point(point)).collect())
    }
}
