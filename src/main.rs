//! Parse, run, exit code.

#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    // Set by `make build`; a build without it says "unknown" in the files that it writes.
    dgmpm::from_commit(option_env!("DGMPM_COMMIT"));
    dgmpm::main()
}
