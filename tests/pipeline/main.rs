//! The program as its users have it: every command on files in a folder, what it says and what it leaves.

mod clouds;
mod common;
mod errors;
mod fields;
mod notices;
mod regrid;
mod stages;
mod stops;
mod times;
mod variants;
