//! Which rank steps which blocks.

use dgmpm::BlockGraph;
use metis::option::{Seed, UFactor};
use metis::{Graph, Idx};

/// Up to so many parts METIS finds better ones by halving again and again, as its manual says.
const FEW: usize = 8;

/// Parts may be heavier than their mean by so many thousandths, or by a block.
const IMBALANCE: Idx = 5;

/// How the blocks of a body are divided among ranks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Partition {
    /// Runs of blocks in their order, which are strips of the body.
    Strips,
    /// By METIS, for few faces between parts.
    #[default]
    Metis,
}

impl Partition {
    /// Their names on the command line.
    pub const NAMES: [(&str, Self); 2] = [("strips", Self::Strips), ("metis", Self::Metis)];

    /// The part of each block; `None`: runs in their order. Every rank finds the same: METIS draws from a fixed seed.
    pub fn parts(self, graph: &BlockGraph, ranks: usize) -> Option<Vec<usize>> {
        match self {
            Self::Strips => None,
            Self::Metis => by_metis(graph, ranks),
        }
    }
}

/// `None` too where METIS counts no further, with 31 bits, and where there are fewer blocks than ranks.
fn by_metis(graph: &BlockGraph, ranks: usize) -> Option<Vec<usize>> {
    let of = |numbers: &[usize]| numbers.iter().map(|&k| Idx::try_from(k).ok()).collect::<Option<Vec<Idx>>>();
    let (first, near, faces) = (of(&graph.first)?, of(&graph.near)?, of(&graph.faces)?);
    let weights = small(&graph.weights);
    if weights.len() < ranks {
        return None;
    }
    let mut parts = vec![0; weights.len()];
    let problem = Graph::new(1, ranks as Idx, &first, &near).ok()?.set_adjwgt(&faces).set_vwgt(&weights);
    let problem = problem.set_option(Seed(1)).set_option(UFactor(IMBALANCE));
    match ranks <= FEW {
        true => problem.part_recursive(&mut parts),
        false => problem.part_kway(&mut parts),
    }
    .ok()?;
    parts.into_iter().map(|part| usize::try_from(part).ok()).collect()
}

/// Weights of the same ratios, to a thousandth of the mean, whose sum has 31 bits; 1 at least.
fn small(weights: &[u64]) -> Vec<Idx> {
    let total = weights.iter().map(|weight| u128::from(*weight)).sum::<u128>().max(1);
    let sum = (1000 * weights.len() as u128).min(1 << 30);
    weights.iter().map(|weight| ((u128::from(*weight) * sum / total) as Idx).max(1)).collect()
}
