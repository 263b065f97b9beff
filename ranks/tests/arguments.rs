//! What the command line says to the ranks.

#[allow(dead_code)]
#[path = "../src/arguments.rs"]
mod arguments;
#[allow(dead_code)]
#[path = "../src/partition.rs"]
mod partition;

use arguments::Arguments;
use dgmpm::BlockGraph;
use partition::Partition;
use std::ffi::OsString;
use std::time::Duration;

fn parse(line: &str) -> Arguments {
    Arguments::parse(line.split_whitespace().map(OsString::from))
}

#[test]
fn what_is_meant_for_the_ranks_is_taken_and_the_rest_stays_in_its_order() {
    let parsed = parse("dgmpm-mpi run --patience 2.5 a.toml --meter --set x=1");
    assert_eq!(parsed.rest, ["dgmpm-mpi", "run", "a.toml", "--set", "x=1"]);
    assert!(parsed.meter && !parsed.help && parsed.fault.is_none());
    assert_eq!(parsed.patience, Duration::from_millis(2500));
    assert_eq!(parse("dgmpm-mpi --patience=7 check").patience, Duration::from_secs(7));
}

#[test]
fn the_partition_is_that_of_metis_or_one_of_the_names() {
    assert_eq!(parse("dgmpm-mpi run a.toml").partition, Partition::Metis);
    assert_eq!(parse("dgmpm-mpi run --partition strips a.toml").partition, Partition::Strips);
    assert_eq!(parse("dgmpm-mpi --partition=metis run a.toml").rest, ["dgmpm-mpi", "run", "a.toml"]);
    for text in ["--partition", "--partition=", "--partition scotch"] {
        assert!(parse(&format!("dgmpm-mpi run a.toml {text}")).fault.is_some(), "{text}");
    }
}

/// Blocks in `n` rows of `n`, each with an edge to those beside it.
fn square(n: usize, weight: impl Fn(usize) -> u64) -> BlockGraph {
    let mut graph =
        BlockGraph { first: vec![0], near: vec![], faces: vec![], weights: (0..n * n).map(weight).collect() };
    for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
        let beside = [
            (i > 0, i.wrapping_sub(1), j),
            (j > 0, i, j.wrapping_sub(1)),
            (j + 1 < n, i, j + 1),
            (i + 1 < n, i + 1, j),
        ];
        graph.near.extend(beside.iter().filter(|(is, ..)| *is).map(|(_, i, j)| n * i + j));
        graph.first.push(graph.near.len());
    }
    graph.faces = vec![2; graph.near.len()];
    graph
}

#[test]
fn metis_divides_a_square_into_squares_of_equal_weight() {
    let n = 24;
    // The right half is three times as heavy.
    let graph = square(n, |k| if k % n < n / 2 { 1_000_000 } else { 3_000_000 });
    let parts = Partition::Metis.parts(&graph, 4).unwrap();
    let weight = |part: usize| (0..n * n).filter(|&k| parts[k] == part).map(|k| graph.weights[k]).sum::<u64>();
    let all: u64 = graph.weights.iter().sum();
    // 5 thousandths and the heaviest block.
    assert!((0..4).all(|part| 4 * weight(part) <= all + all / 200 + 4 * 3_000_000), "{:?}", [0, 1, 2, 3].map(weight));
    let cut =
        (0..n * n).flat_map(|k| graph.near[graph.first[k]..graph.first[k + 1]].iter().map(move |&other| (k, other)));
    let cut = cut.filter(|&(k, other)| k < other && parts[k] != parts[other]).count();
    // Three straight cuts have 72 edges; two crossed ones of equal weight have 24 + 12 + 16 at best, and METIS is near it.
    assert!(cut < 66, "{cut}");
    assert_eq!(Partition::Metis.parts(&graph, 4).unwrap(), parts);
    assert_eq!(Partition::Strips.parts(&graph, 4), None);
    assert_eq!(Partition::Metis.parts(&square(1, |_| 1), 2), None);
}

#[test]
fn a_patience_that_is_no_time_is_a_fault() {
    for text in ["0", "-1", "soon", "nan", "inf", "1e12", ""] {
        assert!(parse(&format!("dgmpm-mpi run a.toml --patience {text}")).fault.is_some(), "{text}");
    }
}
