//! What is left between tiles.

use super::order::Order;
use super::{Piece, STORES};
use std::collections::BTreeMap;
use std::ops::Range;

/// The second phase: parts of what is left that need nothing from each other.
#[derive(Default)]
pub struct Seams {
    /// By block, its seam, if it is not done or has traces that are still to be read; else [`NONE`].
    pub part: Vec<usize>,
    /// By block, whether all stages were finished in the first phase.
    pub done: Vec<bool>,
    /// In the order of the blocks.
    pub pieces: Vec<Piece>,
}

/// No seam.
const NONE: usize = usize::MAX;

/// The blocks from the first to the last one of each tile and seam.
type Hulls = BTreeMap<(usize, usize), Range<usize>>;

impl Seams {
    /// Those of a first phase: as many as there are, or, where they are too many for the stores, a single one. Nothing where
    /// that does not do, either.
    pub fn new(order: &Order) -> Option<Self> {
        let done: Vec<bool> = order.finished.iter().map(|&finished| finished == order.stages).collect();
        let mut part = components(order.graph, &done);
        loop {
            let hulls = hulls(&order.ranges, &part, &done);
            if let Some((from, to)) = overlap(&hulls) {
                part.iter_mut().filter(|seam| **seam == from).for_each(|seam| *seam = to);
                continue;
            }
            if let Some(pieces) = numbered(hulls, order.ranges.len(), &mut part) {
                return Some(Self { part, done, pieces });
            }
            if part.iter().all(|&seam| seam == NONE || seam == 0) {
                return None;
            }
            part.iter_mut().filter(|seam| **seam != NONE).for_each(|seam| *seam = 0);
        }
    }

    /// For each seam its blocks that are not done, along the seam: what one needs is then in the cache from those before it.
    pub fn lists(&self, graph: &[Vec<usize>]) -> Vec<Vec<usize>> {
        let count = self.pieces.iter().map(|piece| piece.seam + 1).max().unwrap_or(0);
        let mut lists = vec![vec![]; count];
        let mut seen = self.done.clone();
        for first in 0..seen.len() {
            if seen[first] {
                continue;
            }
            seen[first] = true;
            let list = &mut lists[self.part[first]];
            let mut next = list.len();
            list.push(first);
            while next < list.len() {
                for &near in &graph[list[next]] {
                    if !std::mem::replace(&mut seen[near], true) {
                        list.push(near);
                    }
                }
                next += 1;
            }
        }
        lists
    }
}

/// By block the number of a seam: blocks that are not done hang together with all that touch them.
fn components(graph: &[Vec<usize>], done: &[bool]) -> Vec<usize> {
    let mut part = vec![NONE; graph.len()];
    let mut readers = vec![vec![]; graph.len()];
    let left = (0..graph.len()).filter(|&block| !done[block]);
    left.clone().for_each(|block| graph[block].iter().for_each(|&near| readers[near].push(block)));
    for first in left {
        if part[first] != NONE {
            continue;
        }
        let mut list = vec![first];
        while let Some(block) = list.pop() {
            if std::mem::replace(&mut part[block], first) == NONE {
                let own: &[usize] = if done[block] { &[] } else { &graph[block] };
                list.extend(own.iter().chain(&readers[block]).filter(|&&near| part[near] == NONE));
            }
        }
    }
    part
}

/// Those of the blocks that are not done.
fn hulls(tiles: &[Range<usize>], part: &[usize], done: &[bool]) -> Hulls {
    let mut hulls = Hulls::new();
    for (tile, range) in tiles.iter().enumerate() {
        for block in range.clone().filter(|&block| !done[block]) {
            hulls.entry((tile, part[block])).or_insert(block..block).end = block + 1;
        }
    }
    hulls
}

/// Two seams of which what they leave behind does not lie side by side: they must be one.
fn overlap(hulls: &Hulls) -> Option<(usize, usize)> {
    let mut all: Vec<_> = hulls.iter().map(|((_, seam), range)| (range.start, range.end, *seam)).collect();
    all.sort_unstable();
    all.windows(2).find(|pair| pair[1].0 < pair[0].1).map(|pair| (pair[1].2, pair[0].2))
}

/// The pieces, in the order of the blocks, with seams numbered from 0 on (also in `part`) and stores that are of another
/// number than the others of the tile and of the seam. Nothing where there are too few, or more seams than `most`.
fn numbered(hulls: Hulls, most: usize, part: &mut [usize]) -> Option<Vec<Piece>> {
    let mut names: Vec<usize> = hulls.keys().map(|(_, seam)| *seam).collect();
    names.sort_unstable();
    names.dedup();
    if names.len() > most {
        return None;
    }
    let number = |name: usize| names.binary_search(&name).unwrap_or(NONE);
    let mut pieces: Vec<Piece> = Vec::new();
    for ((tile, name), range) in hulls {
        let seam = number(name);
        let near = |piece: &&Piece| piece.tile == tile || piece.seam == seam;
        let is_free = |store: &usize| pieces.iter().filter(near).all(|piece| piece.store != *store);
        let store = (1..STORES).find(is_free)?;
        pieces.push(Piece { tile, seam, store, range });
    }
    pieces.sort_unstable_by_key(|piece| piece.range.start);
    part.iter_mut().for_each(|seam| *seam = number(*seam));
    Some(pieces)
}
