//! For `tools/ranks.sh`: the program with a source that panics on rank 1 after a time, on a thread of the step. And an example: a
//! program with laws or sources of its own runs on several ranks so.

#![forbid(unsafe_code)]

use dgmpm::registry::{ANY, Entry, Form, POSITIVE, Parameter, SOURCES};
use dgmpm::{Source, Varies};
use std::process::ExitCode;
use std::sync::Arc;

/// No acceleration, and a panic after a time, s.
struct Panic(f64);

impl Source for Panic {
    fn varies(&self) -> Varies {
        Varies::PLACE_AND_TIME
    }

    fn acceleration(&self, _: [f64; 2], time: f64, _: [f64; 2], _: usize) -> [f64; 2] {
        let rank = ["OMPI_COMM_WORLD_RANK", "PMI_RANK"].iter().find_map(|name| std::env::var(name).ok());
        assert!(time < self.0 || rank.as_deref() != Some("1"), "as it is meant");
        [0.0; 2]
    }
}

const AFTER: &[Parameter] = &[Parameter::required("after", "time of the panic", "s", Form::Number(POSITIVE))];

fn main() -> ExitCode {
    let added = SOURCES.add(Entry {
        name: "panic",
        about: "a panic on rank 1",
        parameters: AFTER,
        check: ANY,
        build: |of, _| Arc::new(Panic(of.number("after"))),
    });
    if let Err(why) = added {
        eprintln!("error: {why}");
        return ExitCode::from(why.exit_code());
    }
    dgmpm_ranks::main()
}
