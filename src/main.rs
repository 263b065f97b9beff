//! Parse, run, exit code.

fn main() -> std::process::ExitCode {
    dgmpm::main()
}
