use super::*;
use proptest::prelude::*;

/// A graph of n blocks in a row, each of which touches those up to `reach` away, closed to a ring or not.
fn row(n: usize, reach: usize, ring: bool) -> Vec<Vec<usize>> {
    let near = |a: usize, b: usize| {
        let d = a.abs_diff(b);
        d <= reach || (ring && n - d <= reach)
    };
    (0..n).map(|a| (0..n).filter(|&b| near(a, b)).collect()).collect()
}

/// A row with some more links.
fn tangled(n: usize, reach: usize, ring: bool, links: &[(usize, usize)]) -> Vec<Vec<usize>> {
    let mut graph = row(n, reach, ring);
    for (a, b) in links.iter().map(|(a, b)| (a % n, b % n)) {
        graph[a].push(b);
        graph[b].push(a);
    }
    graph.iter_mut().for_each(|near| {
        near.sort_unstable();
        near.dedup();
    });
    graph
}

/// Rows of blocks one behind the other, the first and the last of them linked or not.
fn sheet(rows: usize, width: usize, ring: bool) -> Vec<Vec<usize>> {
    let (along, across) = (row(width, 1, true), row(rows, 1, ring));
    let near = |block: usize| {
        let (r, c) = (block / width, block % width);
        let mut near: Vec<_> = along[c].iter().map(|c| r * width + c).collect();
        near.extend(across[r].iter().map(|r| r * width + c));
        near.sort_unstable();
        near.dedup();
        near
    };
    (0..rows * width).map(near).collect()
}

fn mix(a: u64, b: u64) -> u64 {
    (a ^ b.rotate_left(17)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31)
}

/// The rates of a block that begins a stage, of which `before` are known.
fn begun(block: usize, before: &[u64]) -> u64 {
    before.iter().fold(block as u64 + 1, |sum, rate| mix(sum, *rate))
}

/// What all blocks have after the last stage, by the definition: here the history of each.
fn stage_by_stage(graph: &[Vec<usize>], stages: usize) -> Vec<Option<u64>> {
    let mut rates: Vec<Vec<u64>> = vec![vec![]; graph.len()];
    for stage in 0..stages {
        rates.iter_mut().enumerate().for_each(|(block, rates)| rates.push(begun(block, rates)));
        let traces: Vec<u64> = rates.iter().map(|rates| mix(rates[stage], stage as u64)).collect();
        for (rates, near) in rates.iter_mut().zip(graph) {
            rates[stage] = mix(rates[stage], near.iter().fold(0, |sum, &other| mix(sum, traces[other])));
        }
    }
    rates.iter().enumerate().map(|(block, rates)| Some(begun(block, rates))).collect()
}

/// The stores of a pass, and the blocks of which it has made the new state.
struct Memory {
    rates: [Vec<Vec<u64>>; STORES],
    traces: [Vec<u64>; STORES],
    made: Vec<(usize, usize)>,
}

impl Memory {
    fn new(pass: &Pass, stages: usize) -> Self {
        let rates = pass.rates.map(|slots| vec![vec![0; stages]; slots]);
        Self { rates, traces: pass.traces.map(|slots| vec![0; slots]), made: vec![] }
    }

    /// Plays a pass with the values that a step would have.
    fn play(&mut self, pass: &Pass, graph: &[Vec<usize>], slots: &[Slot], next: &mut [Option<u64>]) {
        for event in &pass.events {
            let (block, stage, store) = (event.block as usize, event.stage as usize, event.rates.store());
            let rates = &mut self.rates[store][event.rates.index()];
            let slot = |block: usize| slots[stage * graph.len() + block];
            if event.begins {
                rates[stage] = begun(block, &rates[..stage]);
                self.traces[slot(block).store()][slot(block).index()] = mix(rates[stage], stage as u64);
                continue;
            }
            let trace = |block: usize| self.traces[slot(block).store()][slot(block).index()];
            rates[stage] = mix(rates[stage], graph[block].iter().fold(0, |sum, &other| mix(sum, trace(other))));
            if stage + 1 == rates.len() {
                assert!(next[block].replace(begun(block, rates)).is_none(), "block {block} is finished twice");
                self.made.push((block, store));
            }
        }
    }
}

/// Plays both phases, with pieces handed over between them, and checks that all that is made lies where it is handed out.
fn play(graph: &[Vec<usize>], stages: usize, plan: &Plan) -> Vec<Option<u64>> {
    let mut next = vec![None; graph.len()];
    let [mut tiles, mut seams] = [&plan.tiles, &plan.seams]
        .map(|passes| passes.iter().map(|pass| Memory::new(pass, stages)).collect::<Vec<_>>());
    for ((memory, pass), range) in tiles.iter_mut().zip(&plan.tiles).zip(&plan.ranges) {
        memory.play(pass, graph, &plan.slots, &mut next);
        assert!(memory.made.iter().all(|(block, _)| range.contains(block)));
    }
    for piece in &plan.pieces {
        let (tile, seam, k) = (&mut tiles[piece.tile], &mut seams[piece.seam], piece.store);
        assert!(seam.rates[k].is_empty() && seam.traces[k].is_empty(), "two pieces in store {k}");
        std::mem::swap(&mut tile.rates[k], &mut seam.rates[k]);
        std::mem::swap(&mut tile.traces[k], &mut seam.traces[k]);
    }
    for (number, (memory, pass)) in seams.iter_mut().zip(&plan.seams).enumerate() {
        memory.play(pass, graph, &plan.slots, &mut next);
        for (block, store) in &memory.made {
            let own = |piece: &&Piece| piece.seam == number && piece.store == *store;
            assert!(plan.pieces.iter().find(own).is_some_and(|piece| piece.range.contains(block)));
        }
    }
    assert!(plan.pieces.windows(2).all(|two| two[0].range.end <= two[1].range.start));
    next
}

fn check(graph: &[Vec<usize>], stages: usize, threads: usize) -> Plan {
    let plan = Plan::new(graph, stages, threads);
    assert!(plan.tiles.len() <= threads && plan.seams.len() <= plan.tiles.len());
    assert_eq!(play(graph, stages, &plan), stage_by_stage(graph, stages));
    let events: usize = plan.tiles.iter().chain(&plan.seams).map(|pass| pass.events.len()).sum();
    assert_eq!(events, 2 * stages * graph.len(), "something is done twice");
    plan
}

proptest! {
    #[test]
    fn every_plan_of_a_row_gives_what_all_blocks_give_stage_by_stage(
        n in 1usize..80, reach in 1usize..5, ring: bool, stages in 1usize..6, threads in 1usize..6) {
        check(&row(n, reach, ring), stages, threads);
    }

    #[test]
    fn every_plan_of_a_sheet_gives_what_all_blocks_give_stage_by_stage(
        rows in 1usize..60, width in 1usize..5, ring: bool, stages in 1usize..6, threads in 1usize..6) {
        check(&sheet(rows, width, ring), stages, threads);
    }

    #[test]
    fn every_plan_of_any_graph_gives_what_all_blocks_give_stage_by_stage(
        n in 1usize..200, reach in 1usize..3, ring: bool, stages in 1usize..4, threads in 1usize..6,
        links in prop::collection::vec((0usize..200, 0usize..200), 0..6)) {
        check(&tangled(n, reach, ring, &links), stages, threads);
    }
}

#[test]
fn slots_are_as_few_as_the_blocks_under_way() {
    let plan = Plan::new(&row(1000, 4, false), 4, 1);
    let [tile] = &plan.tiles[..] else { panic!("one thread has one tile") };
    // A stage follows the one before it by the reach of 4, and a trace is read by blocks up to 4 behind and before.
    assert!(tile.rates[0] <= 4 * 5 + 4 && tile.traces[0] <= 4 * 10, "{:?} {:?}", tile.rates, tile.traces);
    assert_eq!(tile.events.len(), 2 * 4 * 1000);
    assert!(plan.seams.is_empty() && plan.pieces.is_empty());
}

#[test]
fn a_ring_has_as_many_seams_as_tiles_and_a_chain_one_less() {
    for tiles in [2, 3, 4] {
        for ring in [false, true] {
            let plan = check(&sheet(25 * tiles, 4, ring), 5, tiles);
            let seams = if ring { tiles } else { tiles - 1 };
            assert_eq!([plan.tiles.len(), plan.seams.len(), plan.pieces.len()], [tiles, seams, 2 * seams]);
            // In the first phase each row next to a seam begins one stage and finishes none, the next one more.
            let left: usize = plan.seams.iter().map(|seam| seam.events.len()).sum();
            assert_eq!(left, seams * 2 * 4 * (9 + 7 + 5 + 3 + 1));
        }
    }
}

#[test]
fn blocks_that_all_touch_each_other_are_one_tile() {
    assert_eq!(Plan::new(&row(4, 3, false), 3, 2).tiles.len(), 1);
}

#[test]
fn seams_that_do_not_lie_side_by_side_are_one() {
    // Two chains, of the even and of the odd blocks.
    let graph: Vec<Vec<usize>> =
        (0..200).map(|a: usize| (0..200).filter(|&b| matches!(a.abs_diff(b), 0 | 2)).collect()).collect();
    let plan = check(&graph, 2, 2);
    assert_eq!([plan.tiles.len(), plan.seams.len(), plan.pieces.len()], [2, 1, 2]);
}
