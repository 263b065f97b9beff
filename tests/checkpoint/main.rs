//! Runs that are stopped, killed or full of faults: they go on to the same bits, or say in one message why they do not.

#[path = "../bodies/mod.rs"]
mod bodies;
mod again;
mod bits;
mod common;
mod faults;
mod folders;
mod full;
mod order;
mod ranks;
mod signals;
mod verify;
