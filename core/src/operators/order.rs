//! Orders of the nodes of a graph such that neighbours are near each other in the order.

/// The nodes in their own order, or in the order of Cuthill and McKee if neighbours are nearer in it. The two are
/// compared by the median over all nodes: at periodic edges neighbours are far apart in any order, but there are few of
/// them.
pub fn reduce_bandwidth(graph: &[Vec<usize>]) -> Vec<usize> {
    let own: Vec<usize> = (0..graph.len()).collect();
    let other = cuthill_mckee(graph);
    let mut place = own.clone();
    other.iter().enumerate().for_each(|(k, &node)| place[node] = k);
    if reach(graph, &place) < reach(graph, &own) { other } else { own }
}

/// The distance of a node from its farthest neighbour in the order, the median over all nodes. `place` is the place of
/// each node in the order.
fn reach(graph: &[Vec<usize>], place: &[usize]) -> usize {
    let of = |(node, neighbours): (usize, &Vec<usize>)| {
        neighbours.iter().map(|&other| place[node].abs_diff(place[other])).max().unwrap_or(0)
    };
    middle(graph.iter().enumerate().map(of))
}

/// The median of some numbers; 0 for an empty list.
pub fn middle(numbers: impl Iterator<Item = usize>) -> usize {
    let mut all: Vec<usize> = numbers.collect();
    all.sort_unstable();
    all.get(all.len() / 2).copied().unwrap_or(0)
}

/// Cuthill and McKee's order: breadth first from a node at the edge of the graph, neighbours by their degree. Parts
/// that are not connected follow each other. (Proc. 24th Nat. Conf. ACM, 1969.)
pub fn cuthill_mckee(graph: &[Vec<usize>]) -> Vec<usize> {
    let mut order = Vec::with_capacity(graph.len());
    let mut seen = vec![false; graph.len()];
    for first in 0..graph.len() {
        if seen[first] {
            continue;
        }
        // The last node of a search lies at the edge of the graph. Two searches give a node that is nearly as far out
        // as possible.
        let mut start = first;
        for _ in 0..2 {
            let mut visited = seen.clone();
            start = *search(graph, start, &mut visited).last().unwrap_or(&start);
        }
        order.extend(search(graph, start, &mut seen));
    }
    order
}

/// Breadth first from `start` over the nodes that are not `seen` yet.
fn search(graph: &[Vec<usize>], start: usize, seen: &mut [bool]) -> Vec<usize> {
    let (mut order, mut next) = (vec![start], 0);
    seen[start] = true;
    while let Some(&node) = order.get(next) {
        next += 1;
        let first = order.len();
        for &other in &graph[node] {
            if !std::mem::replace(&mut seen[other], true) {
                order.push(other);
            }
        }
        order[first..].sort_by_key(|&other| (graph[other].len(), other));
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of n nodes, numbered around.
    fn ring(n: usize) -> Vec<Vec<usize>> {
        (0..n).map(|k| vec![(k + 1) % n, (k + n - 1) % n]).collect()
    }

    fn places(order: &[usize]) -> Vec<usize> {
        let mut place = vec![usize::MAX; order.len()];
        order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        place
    }

    /// The same with its nodes numbered in strides.
    fn scattered(n: usize, stride: usize) -> Vec<Vec<usize>> {
        let mut graph = vec![vec![]; n];
        let name = |k: usize| k * stride % n;
        ring(n).iter().enumerate().for_each(|(k, near)| graph[name(k)] = near.iter().map(|&k| name(k)).collect());
        graph
    }

    #[test]
    fn the_order_of_cuthill_and_mckee_unrolls_a_ring_and_keeps_parts_apart() {
        let mut graph = scattered(20, 7);
        // Both ways around at once: two places apart at most, one at the ends.
        let order = cuthill_mckee(&graph);
        assert_eq!(reach(&graph, &places(&order)), 2);
        assert_eq!(reduce_bandwidth(&graph), order);
        graph.extend(ring(5).into_iter().map(|around| around.into_iter().map(|k| k + 20).collect()));
        let order = cuthill_mckee(&graph);
        assert!(order[..20].iter().all(|&k| k < 20) && order.len() == 25);
    }

    #[test]
    fn the_seam_of_a_ring_or_a_line_does_not_move_it_out_of_its_order() {
        assert_eq!(reduce_bandwidth(&ring(20)), (0..20).collect::<Vec<_>>());
        let line: Vec<Vec<usize>> = vec![vec![1], vec![0, 2], vec![1]];
        assert_eq!(reduce_bandwidth(&line), [0, 1, 2]);
    }
}
