//! The program: one file or folder a subcommand, arguments and `run`.

mod args;
mod bench;
mod check;
mod command;
mod dispatch;
mod effects;
mod export;
mod info;
mod interrupt;
mod keep;
mod line;
mod mesh;
mod new;
mod output;
mod pages;
mod pipeline;
mod plot;
mod preprocess;
mod print;
mod process;
mod progress;
mod ranks;
mod read;
mod regrid;
mod report;
mod resume;
mod run;
mod seed;
mod solve;
mod stability;
mod study;
mod summary;
mod threads;
mod verify;

pub use process::{main, main_on};

use line::Cli;
