//! Cells in blocks of 8 lanes of one law.

use super::order;
use super::sides::{Across, Gathered, Neighbour, Plan, Side, joined};
use crate::lane::{F8, LANES};
use crate::mesh::{FACES, Link};
use std::ops::Range;

/// The blocks; the last one of a law is padded with its last cell.
///
/// A block holds eight cells of one law that follow each other in an order: that of the mesh or that of Cuthill and
/// McKee, whichever has neighbours nearer to each other. The blocks follow each other in such an order too. So the data
/// that a step has begun and not finished belongs to a small part of the mesh. Everywhere else cells keep their
/// numbers, and the bits of a run do not depend on the order of the blocks: sums over them are exact
/// ([`crate::sum`]). They depend on which cells share a block, since a block of congruent cells takes shorter ways than a mixed
/// one: so the blocks are those of the whole mesh and are stored with the operators.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocks {
    /// The cell of each lane (padding repeats the last real one).
    pub cells: Vec<[usize; LANES]>,
    /// Number of real cells in each block.
    pub count: Vec<usize>,
    /// The law of each block.
    pub material: Vec<usize>,
    /// Block and lane of each cell.
    pub slot: Vec<(usize, usize)>,
    /// The other side of each block, local face and lane.
    pub neighbours: Vec<[[Neighbour; LANES]; FACES]>,
    /// For each block and local face, how its other side is read.
    pub plan: Vec<[Plan; FACES]>,
    /// Other sides at different places. The other side of a lane at a boundary, or of a padding lane, is this lane itself.
    pub gathered: Vec<Gathered>,
}

impl Blocks {
    /// Blocks for cells with the given laws and links.
    pub fn new(material: &[usize], links: &[[Link; FACES]]) -> Self {
        let graph: Vec<Vec<usize>> = links.iter().map(|links| cells_of(links).collect()).collect();
        let own = Self::in_order(material, links, (0..links.len()).collect());
        if own.gathered.is_empty() {
            return own;
        }
        // The rows of a structured mesh are a good order, even if its bandwidth is large.
        let other = Self::in_order(material, links, order::cuthill_mckee(&graph));
        if 10 * other.gathered.len() < 9 * own.gathered.len() || own.reach() > 2 * other.reach() { other } else { own }
    }

    /// Blocks of the cells of each law in an `order`, side by side.
    fn in_order(material: &[usize], links: &[[Link; FACES]], order: Vec<usize>) -> Self {
        let mut of_law = vec![vec![]; material.iter().max().map_or(0, |last| last + 1)];
        order.into_iter().for_each(|cell| of_law[material[cell]].push(cell));
        let lists: Vec<&[usize]> = of_law.iter().flat_map(|cells: &Vec<usize>| cells.chunks(LANES)).collect();
        let mut of = vec![0; material.len()];
        lists.iter().enumerate().for_each(|(block, list)| list.iter().for_each(|&cell| of[cell] = block));
        let around = |(block, list): (usize, &&[usize])| {
            let all = list.iter().flat_map(|&cell| cells_of(&links[cell])).map(|cell| of[cell]);
            let mut all: Vec<usize> = all.filter(|&other| other != block).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let graph: Vec<Vec<usize>> = lists.iter().enumerate().map(around).collect();
        Self::of_lists(material, links, &lists, &order::reduce_bandwidth(&graph))
    }

    /// The blocks that consist of `sizes[k]` cells each, the next ones of `cells`; `None` if these are not all cells, each once, in
    /// blocks of one law.
    pub fn stored(material: &[usize], links: &[[Link; FACES]], cells: &[usize], sizes: &[usize]) -> Option<Self> {
        let mut seen = vec![false; material.len()];
        let once = |&cell: &usize| seen.get_mut(cell).is_some_and(|seen| !std::mem::replace(seen, true));
        if cells.len() != material.len() || !cells.iter().all(once) {
            return None;
        }
        let (mut lists, mut rest) = (Vec::with_capacity(sizes.len()), cells);
        for &size in sizes {
            let (list, behind) = rest.split_at_checked(size).filter(|_| (1..=LANES).contains(&size))?;
            list.iter().all(|&cell| material[cell] == material[list[0]]).then_some(())?;
            lists.push(list);
            rest = behind;
        }
        let order: Vec<usize> = (0..lists.len()).collect();
        rest.is_empty().then(|| Self::of_lists(material, links, &lists, &order))
    }

    /// The cells of all blocks, one after the other, without padding.
    pub fn list(&self) -> Vec<usize> {
        self.cells.iter().zip(&self.count).flat_map(|(cells, &count)| cells[..count].iter().copied()).collect()
    }

    /// The distance of a block from its farthest neighbour, the median over all blocks, as in [`order::reduce_bandwidth`].
    fn reach(&self) -> usize {
        let of = |(block, neighbours): (usize, &[[Neighbour; LANES]; FACES])| {
            let far = neighbours.iter().flatten().map(|neighbour| match neighbour {
                Neighbour::Cell(across) | Neighbour::Interface(across, _) => block.abs_diff(across.face / FACES),
                Neighbour::Boundary(_) | Neighbour::Padding => 0,
            });
            far.max().unwrap_or(0)
        };
        order::middle(self.neighbours.iter().enumerate().map(of))
    }

    /// Blocks of `lists` of cells of one law, in an `order`.
    fn of_lists(material: &[usize], links: &[[Link; FACES]], lists: &[&[usize]], order: &[usize]) -> Self {
        let mut blocks = Self {
            cells: vec![],
            count: vec![],
            material: vec![],
            slot: vec![(0, 0); material.len()],
            neighbours: vec![],
            plan: vec![],
            gathered: vec![],
        };
        for list in order.iter().map(|&k| &lists[k]) {
            for (lane, &cell) in list.iter().enumerate() {
                blocks.slot[cell] = (blocks.cells.len(), lane);
            }
            blocks.cells.push(std::array::from_fn(|lane| list[lane.min(list.len() - 1)]));
            blocks.count.push(list.len());
            blocks.material.push(material[list[0]]);
        }
        blocks.neighbours = (0..blocks.len()).map(|b| blocks.neighbours_of(b, material, links)).collect();
        for block in 0..blocks.len() {
            let plan = std::array::from_fn(|face| blocks.plan_of(block, face));
            blocks.plan.push(plan);
        }
        blocks
    }

    fn plan_of(&mut self, block: usize, face: usize) -> Plan {
        let lanes = self.neighbours[block][face];
        let has_boundary_or_interface =
            lanes.iter().any(|n| matches!(n, Neighbour::Boundary(_) | Neighbour::Interface(..)));
        let own = |lane: usize| Across { face: FACES * block + face, lane, flip: false };
        // A padding lane stays at rest only if its other side is the lane itself. So a block with padding is never aligned.
        let (mut across, mut source, mut aligned) = ([own(0); LANES], None, self.count[block] == LANES);
        for (lane, neighbour) in lanes.iter().enumerate() {
            match *neighbour {
                Neighbour::Cell(there) | Neighbour::Interface(there, _) => {
                    across[lane] = there;
                    aligned &= there.lane == lane && !there.flip && *source.get_or_insert(there.face) == there.face;
                }
                Neighbour::Boundary(_) | Neighbour::Padding => across[lane] = own(lane),
            }
        }
        if aligned {
            return Plan { side: Side::Aligned(source.unwrap_or(FACES * block + face)), has_boundary_or_interface };
        }
        if let Some(side) = joined(&across, &lanes).filter(|_| self.count[block] == LANES) {
            return Plan { side, has_boundary_or_interface };
        }
        self.gathered.push(Gathered::of(&across));
        Plan { side: Side::Gathered(self.gathered.len() - 1), has_boundary_or_interface }
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there is no block.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        std::mem::size_of_val(&self.neighbours[..])
            + std::mem::size_of_val(&self.cells[..])
            + std::mem::size_of_val(&self.plan[..])
            + std::mem::size_of_val(&self.gathered[..])
    }

    fn neighbours_of(&self, block: usize, material: &[usize], links: &[[Link; FACES]]) -> [[Neighbour; LANES]; FACES] {
        let law = self.material[block];
        std::array::from_fn(|face| {
            std::array::from_fn(|lane| {
                if lane >= self.count[block] {
                    return Neighbour::Padding;
                }
                match links[self.cells[block][lane]][face] {
                    Link::Boundary(group) => Neighbour::Boundary(group),
                    Link::Cell { cell, face, flip } => {
                        let (block, lane) = self.slot[cell];
                        let across = Across { face: FACES * block + face, lane, flip };
                        if material[cell] == law {
                            Neighbour::Cell(across)
                        } else {
                            Neighbour::Interface(across, material[cell])
                        }
                    }
                }
            })
        })
    }

    /// Numbers per cell, `[cell][stride]`, to blocks, `[block][stride]`; padding lanes get `padding(k)`.
    pub fn pack(&self, values: &[f64], stride: usize, padding: impl Fn(usize) -> f64) -> Vec<F8> {
        let mut out = Vec::with_capacity(self.len() * stride);
        for (cells, &count) in self.cells.iter().zip(&self.count) {
            for k in 0..stride {
                out.push(F8(std::array::from_fn(|lane| {
                    if lane < count { values[cells[lane] * stride + k] } else { padding(k) }
                })));
            }
        }
        out
    }

    /// The inverse of [`Blocks::pack`].
    pub fn unpack(&self, values: &[F8], stride: usize) -> Vec<f64> {
        self.unpack_some(values, stride, 0..stride, 0..self.slot.len())
    }

    /// Some of the numbers of some cells; [`Blocks::unpack`] has all.
    pub fn unpack_some(&self, values: &[F8], stride: usize, some: Range<usize>, cells: Range<usize>) -> Vec<f64> {
        let mut out = Vec::with_capacity(cells.len() * some.len());
        for &(block, lane) in &self.slot[cells] {
            out.extend(some.clone().map(|k| values[block * stride + k].0[lane]));
        }
        out
    }
}

/// The cells across the faces of a cell.
fn cells_of(links: &[Link; FACES]) -> impl Iterator<Item = usize> {
    links.iter().filter_map(Link::cell)
}
