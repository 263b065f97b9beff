//! Which rank has which blocks, where the engine that carries messages divides the graph of the blocks.
//!
//! A rank has a run of blocks in their order. So parts that are no runs become an order of the blocks: part by part, and in each part as
//! they were. No bit depends on it ([`crate::operators::Blocks`]).

use super::Scheme;
use crate::exchange::BlockGraph;
use crate::mesh::{FACES, Link, Mesh};
use crate::operators::{Blocks, Neighbour, Operators};
use std::collections::BTreeMap;

/// Blocks divided among ranks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Partition {
    /// The blocks, those of rank 0 first.
    pub order: Vec<usize>,
    /// Where those of each rank begin in this order, and the end of the last one.
    pub first: Vec<usize>,
}

impl Partition {
    /// From the part of each block; `None` where a part has fewer than `least` blocks, or there is no such part.
    fn of(parts: &[usize], ranks: usize, least: usize) -> Option<Self> {
        let mut own = vec![vec![]; ranks];
        for (block, &part) in parts.iter().enumerate() {
            own.get_mut(part)?.push(block);
        }
        let ends = own.iter().scan(0, |end, blocks| {
            *end += blocks.len();
            Some(*end)
        });
        let first = [0].into_iter().chain(ends).collect();
        own.iter().all(|blocks| blocks.len() >= least.max(1)).then(|| Self { order: own.concat(), first })
    }
}

/// The number that a block had before the blocks were ordered by a partition: what is first by it is the same for any ranks.
pub(super) fn first_number(partition: Option<&Partition>, block: usize) -> usize {
    partition.map_or(block, |partition| partition.order[block])
}

impl Scheme {
    /// [`first_number`] of a block.
    pub(super) fn first_number(&self, block: usize) -> usize {
        first_number(self.partition.as_ref(), block)
    }

    /// The block that had this number before any partition.
    pub(super) fn of_first_number(&self, number: usize) -> usize {
        let Some(Partition { order, .. }) = &self.partition else { return number };
        order.iter().position(|block| *block == number).unwrap_or(number)
    }

    /// How the engine divides the blocks; `None` where the scheme runs alone, where the engine leaves the blocks in their order, and where
    /// a rank would have fewer blocks than threads.
    pub fn partition(&self) -> Option<Partition> {
        let exchange = self.exchange().filter(|exchange| exchange.ranks() > 1)?;
        let blocks = &self.operators.blocks;
        let parts = exchange.parts(&block_graph(blocks, self.weights()))?;
        let parts = Some(parts).filter(|parts| parts.len() == blocks.len())?;
        Partition::of(&parts, exchange.ranks(), rayon::current_num_threads())
    }

    /// On operators whose blocks are in the order of a partition.
    #[must_use]
    pub fn with_partition(self, partition: Partition) -> Self {
        Self { partition: Some(partition), ..self }
    }

    /// What blocks have, `many` each, in the order in which they were before any partition: that of checkpoints, which ranks divided in
    /// another way go on from.
    pub(super) fn in_first_order<T: Copy>(&self, own: &[T], many: usize) -> Vec<T> {
        let Some(Partition { order, .. }) = &self.partition else { return own.to_vec() };
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &block)| place[block] = k);
        place.iter().flat_map(|k| &own[many * k..many * (k + 1)]).copied().collect()
    }

    /// The inverse of [`Scheme::in_first_order`].
    pub(super) fn in_own_order<T: Copy>(&self, first: &[T], many: usize) -> Vec<T> {
        let Some(Partition { order, .. }) = &self.partition else { return first.to_vec() };
        order.iter().flat_map(|block| &first[many * block..many * (block + 1)]).copied().collect()
    }
}

impl Operators {
    /// The same with the blocks in another order: place k has block `order[k]`.
    #[must_use]
    pub fn in_order(self, mesh: &Mesh, links: &[[Link; FACES]], material: &[usize], order: &[usize]) -> Self {
        let Self { blocks, .. } = &self;
        let cells: Vec<usize> =
            order.iter().flat_map(|&b| blocks.cells[b][..blocks.count[b]].iter().copied()).collect();
        let sizes: Vec<usize> = order.iter().map(|&b| blocks.count[b]).collect();
        match Blocks::stored(material, links, &cells, &sizes) {
            Some(blocks) => self.with_blocks(mesh, blocks, order),
            None => self,
        }
    }
}

/// Each edge weighs as many faces of cells as its blocks have in common, twice: both read the other's.
fn block_graph(blocks: &Blocks, weights: Vec<u64>) -> BlockGraph {
    let mut read = vec![BTreeMap::<usize, usize>::new(); blocks.len()];
    for (block, neighbours) in blocks.neighbours.iter().enumerate() {
        for neighbour in neighbours.iter().flatten() {
            let (Neighbour::Cell(across) | Neighbour::Interface(across, _)) = neighbour else { continue };
            let other = across.face / FACES;
            if other != block {
                // Both blocks have the edge, with what either reads of the other.
                *read[block].entry(other).or_default() += 1;
                *read[other].entry(block).or_default() += 1;
            }
        }
    }
    let mut graph = BlockGraph { first: vec![0], near: vec![], faces: vec![], weights };
    for edges in read {
        for (other, faces) in edges {
            graph.near.push(other);
            graph.faces.push(faces);
        }
        graph.first.push(graph.near.len());
    }
    graph
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Kind, midpoints, scheme, wall};
    use super::*;
    use crate::mesh::{links, rectangle};

    #[test]
    fn parts_become_an_order_and_parts_that_are_missing_or_too_small_none() {
        let partition = Partition::of(&[1, 0, 1, 0, 0], 2, 2).unwrap();
        assert_eq!((&partition.order[..], &partition.first[..]), (&[1, 3, 4, 0, 2][..], &[0, 3, 5][..]));
        assert_eq!(Partition::of(&[1, 0, 1, 0, 0], 2, 3), None);
        assert_eq!(Partition::of(&[1, 0], 3, 1), None);
        assert_eq!(Partition::of(&[3, 0, 1], 3, 1), None);
    }

    #[test]
    fn an_edge_of_the_graph_counts_the_faces_of_cells_that_both_blocks_read() {
        // Rows of eight cells, one a block: each reads eight upper faces of the one below and eight lower ones of the one above.
        let mesh = rectangle([1.0, 1.0], [8, 3]).unwrap();
        let scheme = scheme(&mesh, Kind::RkDgfem, 1, &midpoints(&mesh, 1), wall);
        let graph = block_graph(&scheme.operators.blocks, vec![1; 3]);
        assert_eq!((&graph.first[..], &graph.near[..]), (&[0, 1, 3, 4][..], &[1, 0, 2, 1][..]));
        assert_eq!(graph.faces, [16; 4]);
    }

    #[test]
    fn operators_in_another_order_are_those_of_the_same_cells() {
        let mesh = rectangle([2.0, 1.0], [12, 7]).unwrap();
        let (links, material) = (links(&mesh).unwrap(), vec![0; 84]);
        let cloud = crate::cloud::seed::seed(crate::cloud::Layout::Jitter { seed: 1, amount: 0.2 }, 3, 84);
        let usual = scheme(&mesh, Kind::AderDgmpm, 2, &cloud, wall).operators;
        let order: Vec<usize> = (0..usual.blocks.len()).rev().collect();
        let turned = usual.clone().in_order(&mesh, &links, &material, &order);
        for cell in 0..84 {
            let [(a, lane), (b, same)] = [&usual, &turned].map(|operators| operators.blocks.slot[cell]);
            assert!(lane == same && order[b] == a);
            assert_eq!(usual.node_weights(a, lane), turned.node_weights(b, lane));
            assert_eq!(usual.places(a, lane), turned.places(b, lane));
            let matrix = |operators: &Operators, block| operators.points.as_ref().unwrap().to_nodes(block, lane);
            assert_eq!(matrix(&usual, a), matrix(&turned, b));
        }
        assert_eq!(turned.in_order(&mesh, &links, &material, &order), usual);
    }
}
