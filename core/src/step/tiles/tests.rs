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

/// What a tile has under way.
struct Memory {
    rates: Vec<Vec<u64>>,
    traces: Vec<u64>,
}

impl Memory {
    /// Plays a phase with the values that a step would have, from what tiles have `seen`; what the tile shows after it.
    fn play(
        &mut self,
        events: &[Event],
        plan: &Plan,
        graph: &[Vec<usize>],
        seen: &[Vec<u64>],
        next: &mut [Option<u64>],
    ) -> Vec<u64> {
        let mut shown = vec![];
        for event in events {
            let (block, stage) = (event.block as usize, event.stage as usize);
            let rates = &mut self.rates[event.rates as usize];
            let slot = |block: usize| plan.slots[stage * graph.len() + block];
            if event.begins {
                rates[stage] = begun(block, &rates[..stage]);
                let (slot, trace) = (slot(block), mix(rates[stage], stage as u64));
                if slot.store == 0 {
                    self.traces[slot.index as usize] = trace;
                } else {
                    assert_eq!(slot.index as usize, shown.len());
                    shown.push(trace);
                }
                continue;
            }
            let trace = |block: usize| match slot(block) {
                Slot { store: 0, index } => self.traces[index as usize],
                Slot { store, index } => seen.get(store as usize - 1).unwrap_or(&shown)[index as usize],
            };
            rates[stage] = mix(rates[stage], graph[block].iter().fold(0, |sum, &other| mix(sum, trace(other))));
            if stage + 1 == rates.len() {
                assert!(next[block].replace(begun(block, rates)).is_none(), "block {block} is finished twice");
            }
        }
        shown
    }
}

/// Plays a plan: in each phase a tile sees what all have shown before it.
fn play(graph: &[Vec<usize>], stages: usize, plan: &Plan) -> Vec<Option<u64>> {
    play_on_ranks(graph, stages, plan, plan.tiles.len())
}

/// The same with so many tiles on each rank: where the plan overlaps, a tile of another rank has not seen what was shown in the phase before.
fn play_on_ranks(graph: &[Vec<usize>], stages: usize, plan: &Plan, per_rank: usize) -> Vec<Option<u64>> {
    let mut next = vec![None; graph.len()];
    let memory = |tile: &Tile| Memory { rates: vec![vec![0; stages]; tile.rates], traces: vec![0; tile.traces] };
    let mut memories: Vec<Memory> = plan.tiles.iter().map(memory).collect();
    let mut seen: Vec<Vec<u64>> = vec![];
    for phase in 0..plan.phases() {
        let mut shown = vec![];
        for (number, (memory, tile)) in memories.iter_mut().zip(&plan.tiles).enumerate() {
            let events = &tile.events[tile.phases[phase].clone()];
            assert!(events.iter().all(|event| tile.range.contains(&(event.block as usize))));
            let mut seen = seen.clone();
            let last = seen.len().saturating_sub(plan.tiles.len());
            for (other, seen) in seen[last..].iter_mut().enumerate() {
                if plan.overlaps && other / per_rank != number / per_rank {
                    // Still under way: no value that a block could have.
                    seen.fill(u64::MAX);
                }
            }
            shown.push(memory.play(events, plan, graph, &seen, &mut next));
        }
        seen.extend(shown);
    }
    assert!(seen.iter().map(Vec::len).eq(plan.shown.iter().copied()));
    next
}

/// Blocks of one weight.
fn equal(graph: &[Vec<usize>]) -> Vec<u64> {
    vec![1000; graph.len()]
}

/// Checks the plan for so many tiles of blocks of these weights, whether it is worth it or not.
fn check(graph: &[Vec<usize>], weights: &[u64], stages: usize, tiles: usize) -> Plan {
    let plan = Plan::of_tiles(graph, weights, stages, tiles);
    assert!(
        plan.tiles.len() == tiles.min(graph.len()) && plan.phases() <= if tiles > 1 { graph.len() * stages } else { 1 }
    );
    assert_eq!(play(graph, stages, &plan), stage_by_stage(graph, stages));
    let events: usize = plan.tiles.iter().map(|tile| tile.events.len()).sum();
    assert_eq!(events, 2 * stages * graph.len(), "something is done twice");
    assert!(plan.tiles.iter().all(|tile| tile.phases.last().is_some_and(|phase| phase.end == tile.events.len())));
    let by_stages = plan.clone().by_stages(stages);
    assert_eq!(by_stages.phases(), 2 * stages);
    assert_eq!(play(graph, stages, &by_stages), stage_by_stage(graph, stages));
    plan
}

/// Checks the plan for ranks of so many tiles each.
fn check_on_ranks(graph: &[Vec<usize>], stages: usize, [ranks, tiles]: [usize; 2]) -> Plan {
    let plan = Plan::of_ranks(graph, &equal(graph), stages, [ranks, tiles]);
    assert_eq!(plan.overlaps, plan.tiles.len() > tiles);
    assert_eq!(play_on_ranks(graph, stages, &plan, tiles), stage_by_stage(graph, stages));
    let events: usize = plan.tiles.iter().map(|tile| tile.events.len()).sum();
    assert_eq!(events, 2 * stages * graph.len(), "something is done twice");
    // What is shown in the last phase would reach nobody.
    assert!(!plan.overlaps || plan.shown.iter().rev().take(plan.tiles.len()).all(|shown| *shown == 0));
    plan
}

/// Weights of so many blocks, most of them alike and some a thousand times as heavy as others.
fn any_weights(blocks: usize) -> impl Strategy<Value = Vec<u64>> {
    let weight = prop_oneof![4 => Just(700), 2 => 1u64..5000, 1 => 10_000u64..1_000_000];
    prop::collection::vec(weight, blocks)
}

proptest! {
    #[test]
    fn every_plan_of_a_row_gives_what_all_blocks_give_stage_by_stage(
        n in 1usize..80, reach in 1usize..5, ring: bool, stages in 1usize..6, tiles in 1usize..6) {
        let graph = row(n, reach, ring);
        check(&graph, &equal(&graph), stages, tiles);
    }

    #[test]
    fn every_plan_of_a_sheet_gives_what_all_blocks_give_stage_by_stage(
        rows in 1usize..60, width in 1usize..5, ring: bool, stages in 1usize..6, tiles in 1usize..6) {
        let graph = sheet(rows, width, ring);
        check(&graph, &equal(&graph), stages, tiles);
    }

    #[test]
    fn every_plan_of_any_graph_gives_what_all_blocks_give_stage_by_stage(
        n in 1usize..200, reach in 1usize..3, ring: bool, stages in 1usize..4, tiles in 1usize..6,
        links in prop::collection::vec((0usize..200, 0usize..200), 0..6), weights in any_weights(200)) {
        check(&tangled(n, reach, ring, &links), &weights[..n], stages, tiles);
    }

    #[test]
    fn every_plan_on_ranks_gives_what_all_blocks_give_stage_by_stage(
        n in 1usize..200, reach in 1usize..3, ring: bool, stages in 1usize..6, ranks in 1usize..5, tiles in 1usize..4,
        links in prop::collection::vec((0usize..200, 0usize..200), 0..6)) {
        check_on_ranks(&tangled(n, reach, ring, &links), stages, [ranks, tiles]);
    }

    #[test]
    fn tiles_are_all_blocks_in_their_order_and_none_is_heavier_than_the_mean_and_the_heaviest_block(
        weights in (0usize..300).prop_flat_map(any_weights), tiles in 1usize..40) {
        let runs = divide(&weights, tiles);
        prop_assert_eq!(runs.len(), tiles.min(weights.len()));
        let all: Vec<usize> = runs.iter().flat_map(Clone::clone).collect();
        prop_assert_eq!(all, (0..weights.len()).collect::<Vec<_>>());
        prop_assert!(runs.iter().all(|run| !run.is_empty()));
        let sum = |run: &Range<usize>| weights[run.clone()].iter().sum::<u64>();
        let (most, count) = (runs.iter().map(sum).max().unwrap_or(0), runs.len() as u64);
        let heaviest = weights.iter().max().copied().unwrap_or(0);
        prop_assert!(count * most <= sum(&(0..weights.len())) + count * heaviest, "{:?}", runs);
    }
}

#[test]
fn slots_are_as_few_as_the_blocks_under_way() {
    let plan = Plan::new(&row(1000, 4, false), &[1000; 1000], 4, 1);
    let [tile] = &plan.tiles[..] else { panic!("one thread has one tile") };
    // A stage follows the one before it by the reach of 4, and a trace is read by blocks up to 4 behind and before.
    assert!(tile.rates <= 4 * 5 + 4 && tile.traces <= 4 * 10, "{} {}", tile.rates, tile.traces);
    assert_eq!(tile.events.len(), 2 * 4 * 1000);
    assert_eq!(plan.shown, [0]);
}

#[test]
fn tiles_meet_once_for_each_stage_at_both_ends_and_show_a_layer_each_time() {
    for tiles in [2, 3, 4] {
        for ring in [false, true] {
            let (graph, stages) = (sheet(25 * tiles, 4, ring), 5);
            let plan = check(&graph, &equal(&graph), stages, tiles);
            // Where two tiles begin, and where two end: not of a chain of two.
            let rounds = if ring || tiles > 2 { 2 } else { 1 };
            assert_eq!([plan.tiles.len(), plan.phases()], [tiles, rounds * (stages + 1)]);
            for tile in 0..tiles {
                let seams = if ring || (tile > 0 && tile + 1 < tiles) { 2 } else { 1 };
                let shown: Vec<_> = plan.shown.iter().skip(tile).step_by(tiles).copied().collect();
                assert!(shown.iter().all(|&shown| shown <= if tiles == 3 { 8 } else { 4 }), "{shown:?}");
                assert_eq!(shown.iter().sum::<usize>(), seams * 4 * stages);
            }
        }
    }
}

#[test]
fn messages_of_ranks_travel_while_most_blocks_are_stepped() {
    for (ring, stages) in [(false, 1), (true, 1), (false, 4), (true, 4)] {
        let graph = sheet(200, 4, ring);
        let plan = check_on_ranks(&graph, stages, [2, 1]);
        assert_eq!(plan.phases(), 2 * stages + 1);
        for tile in &plan.tiles {
            let events = |phases: &dyn Fn(usize) -> bool| -> usize {
                (0..plan.phases()).filter(|phase| phases(*phase)).map(|phase| tile.phases[phase].len()).sum()
            };
            // Messages travel in odd phases; even ones hold the layers at the seams: one more than stages at each of up to two seams,
            // of 100 rows.
            let (hidden, all) = (events(&|phase| phase % 2 == 1), 2 * stages * 400);
            assert!(hidden * 100 >= all * (100 - 2 * (stages + 1)), "{ring} {stages}: {hidden} of {all}");
        }
    }
}

#[test]
fn so_many_tiles_as_are_worth_it() {
    let count = |graph: &[Vec<usize>], threads| Plan::new(graph, &equal(graph), 3, threads).tiles.len();
    assert_eq!(count(&sheet(50, 10, true), 1), 1);
    assert_eq!(count(&sheet(50, 10, true), 2), 2);
    assert_eq!(count(&sheet(50, 10, true), 3), 3);
    // Too little for two to be quicker: they would meet more than they do.
    assert_eq!(count(&row(6, 1, false), 2), 1);
}

#[test]
fn blocks_of_equal_weight_are_divided_to_one_block() {
    for (blocks, tiles) in [(1000, 3), (9, 4), (5, 3), (7, 7), (100, 16)] {
        let sizes: Vec<usize> = divide(&vec![640; blocks], tiles).iter().map(|run| run.len()).collect();
        assert!(sizes.iter().all(|size| [blocks / tiles, blocks.div_ceil(tiles)].contains(size)), "{sizes:?}");
    }
}

#[test]
fn a_tile_of_heavy_blocks_has_fewer_of_them() {
    // Half of the blocks are four times as heavy: of two tiles the second has 5/8 of these.
    let weights: Vec<u64> = (0..160).map(|block| if block < 80 { 500 } else { 2000 }).collect();
    assert_eq!(divide(&weights, 2), [0..110, 110..160]);
    // A block that is heavier than all others together has a tile of its own, and no tile is empty.
    assert_eq!(divide(&[1, 1, 100_000, 1, 1], 3), [0..2, 2..3, 3..5]);
    assert_eq!(divide(&[100_000, 1, 1], 3), [0..1, 1..2, 2..3]);
    assert!(divide(&[], 3).is_empty());
}
