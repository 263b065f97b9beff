//! How the work of the steps was divided among threads and ranks: as it was estimated, and as it was.

use crate::exchange::Exchange;

/// What threads and ranks had to do in the steps of a run. The blocks of a step are divided into one tile for each thread of each
/// rank. Empty where all blocks are one tile.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shares {
    /// By tile. What those of other ranks took is not known here.
    tiles: Vec<Seconds>,
    /// By rank; empty until [`Shares::gather`] has asked all of them.
    ranks: Vec<Part>,
    /// The messages of this rank, and those by rank.
    own_messages: Messages,
    messages: Vec<Messages>,
}

/// Seconds in which a rank packed the traces that it sends, waited for those of others, and unpacked these. What travels while blocks are
/// stepped is not waited for.
pub type Messages = [f64; 3];

/// Seconds in the phases of steps, without those in which a tile waits for others: as they were estimated before the first step, and
/// as they were measured.
pub type Seconds = [f64; 2];

/// What some tiles had to do together.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Part {
    /// The most of one of them.
    slowest: Seconds,
    /// All of them.
    sum: Seconds,
}

impl Part {
    fn and(self, other: Part) -> Part {
        let each = |of: fn(f64, f64) -> f64, one: Seconds, two: Seconds| [of(one[0], two[0]), of(one[1], two[1])];
        let slowest = each(f64::max, self.slowest, other.slowest);
        Part { slowest, sum: each(|a, b| a + b, self.sum, other.sum) }
    }

    fn of(tiles: &[Seconds]) -> Part {
        let part = |tile: &Seconds| Part { slowest: *tile, sum: *tile };
        tiles.iter().map(part).fold(Part::default(), Part::and)
    }
}

/// The most that one of several has to do over the mean of all: 1 where all have as much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Imbalance {
    /// As it was estimated.
    pub predicted: f64,
    /// As it was measured.
    pub measured: f64,
}

impl Imbalance {
    fn new(Part { slowest, sum }: Part, count: usize) -> Self {
        let over = |k: usize| if sum[k] > 0.0 { count as f64 * slowest[k] / sum[k] } else { 1.0 };
        Self { predicted: over(0), measured: over(1) }
    }
}

impl Shares {
    /// Adds a step in which the tiles had so much to do.
    pub(super) fn add(&mut self, step: impl ExactSizeIterator<Item = Seconds>) {
        // Another grid may have more tiles.
        self.tiles.resize(self.tiles.len().max(step.len()), [0.0; 2]);
        self.tiles.iter_mut().zip(step).for_each(|(sum, step)| *sum = [sum[0] + step[0], sum[1] + step[1]]);
    }

    /// Adds the messages of a step.
    pub(super) fn add_messages(&mut self, step: Messages) {
        self.own_messages.iter_mut().zip(step).for_each(|(sum, step)| *sum += step);
    }

    /// Gives all ranks what each of them has measured. All ranks call it, each with the same number of `threads`.
    pub fn gather(&mut self, exchange: &dyn Exchange, threads: usize) {
        const NUMBERS: usize = 7;
        let first = (exchange.rank() * threads).min(self.tiles.len());
        let own = Part::of(&self.tiles[first..self.tiles.len().min(first + threads)]);
        let mut all = vec![[0.0; NUMBERS]; exchange.ranks()];
        let ([a, b], [c, d], [e, f, g]) = (own.slowest, own.sum, self.own_messages);
        all[exchange.rank()] = [a, b, c, d, e, f, g];
        let ends: Vec<usize> = (0..=exchange.ranks()).map(|rank| NUMBERS * rank).collect();
        exchange.gather(all.as_flattened_mut(), &ends);
        let part = |[a, b, c, d, ..]: &[f64; NUMBERS]| Part { slowest: [*a, *b], sum: [*c, *d] };
        self.ranks = all.iter().map(part).collect();
        self.messages = all.iter().map(|[.., e, f, g]| [*e, *f, *g]).collect();
    }

    /// The messages of each rank; none where there is one.
    pub fn messages(&self) -> &[Messages] {
        if self.messages.len() > 1 { &self.messages } else { &[] }
    }

    /// That of the threads, over all ranks; none where all blocks are one tile.
    pub fn of_threads(&self) -> Option<Imbalance> {
        let all = match self.ranks.is_empty() {
            true => Part::of(&self.tiles),
            false => self.ranks.iter().copied().fold(Part::default(), Part::and),
        };
        (self.tiles.len() > 1).then(|| Imbalance::new(all, self.tiles.len()))
    }

    /// That of the ranks; none where there is one.
    pub fn of_ranks(&self) -> Option<Imbalance> {
        let sums: Vec<Seconds> = self.ranks.iter().map(|rank| rank.sum).collect();
        (sums.len() > 1).then(|| Imbalance::new(Part::of(&sums), sums.len()))
    }

    /// Measured seconds: of each rank where there are several, else of each tile.
    pub fn seconds(&self) -> Vec<f64> {
        match self.ranks.len() {
            0 | 1 => self.tiles.iter().map(|tile| tile[1]).collect(),
            _ => self.ranks.iter().map(|rank| rank.sum[1]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_imbalance_is_the_most_over_the_mean_of_all_steps() {
        let mut shares = Shares::default();
        assert_eq!(shares.of_threads(), None);
        shares.add([[1.0, 2.0], [3.0, 4.0]].into_iter());
        shares.add([[1.0, 2.0], [3.0, 0.0]].into_iter());
        // 2 and 6 of 8; 4 and 4 of 8.
        assert_eq!(shares.of_threads(), Some(Imbalance { predicted: 1.5, measured: 1.0 }));
        assert_eq!((shares.of_ranks(), shares.seconds()), (None, vec![4.0, 4.0]));
        // Another grid with three tiles: 2, 6 and 4 of 12.
        shares.add([[0.0, 0.0], [0.0, 0.0], [4.0, 4.0]].into_iter());
        assert_eq!(shares.of_threads(), Some(Imbalance { predicted: 1.5, measured: 1.0 }));
    }
}
