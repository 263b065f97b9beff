//! `dgmpm-mpi`: the program `dgmpm` on several ranks.

#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    dgmpm::from_commit(option_env!("DGMPM_COMMIT"));
    dgmpm_ranks::main()
}
