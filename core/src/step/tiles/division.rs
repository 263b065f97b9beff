//! Which blocks a tile has: runs of blocks in their order, of nearly equal weight.

use std::ops::Range;

/// Divides blocks of these weights into so many runs that follow each other; into one for each block where there are fewer blocks.
/// Each run has a block, and ends where the sum of the weights is nearest to its share of the whole: none is heavier than the mean of
/// all and the heaviest block together.
///
/// Numbers are whole, so that all ranks find the same runs, whatever processors they have.
pub fn divide(weights: &[u64], tiles: usize) -> Vec<Range<usize>> {
    let (blocks, tiles) = (weights.len(), tiles.min(weights.len()));
    let total: u128 = weights.iter().map(|weight| u128::from(*weight)).sum();
    let (mut runs, mut end, mut before) = (Vec::with_capacity(tiles), 0, 0_u128);
    for tile in 1..=tiles {
        let start = end;
        while end < blocks - (tiles - tile) {
            let weight = u128::from(weights[end]);
            // Where its middle lies beyond the end of the share, the share ends before the block.
            let is_beyond = (2 * before + weight) * tiles as u128 > 2 * tile as u128 * total;
            if end > start && is_beyond {
                break;
            }
            (before, end) = (before + weight, end + 1);
        }
        runs.push(start..end);
    }
    runs
}
