//! What the command line says to the ranks.

#[allow(dead_code)]
#[path = "../src/arguments.rs"]
mod arguments;

use arguments::Arguments;
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
fn a_patience_that_is_no_time_is_a_fault() {
    for text in ["0", "-1", "soon", "nan", "inf", "1e12", ""] {
        assert!(parse(&format!("dgmpm-mpi run a.toml --patience {text}")).fault.is_some(), "{text}");
    }
}
