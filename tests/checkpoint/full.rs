//! No space for a file, at each kind of write: one message, exit code 5, no half file, and what was there before stays. The limit of the
//! shell on the size of a file takes the place of a full disk, which `make faults` has.
#![cfg(unix)]

use crate::common::Bench;
use std::process::Command;

/// Runs a command under a limit of so many KiB for each file; its message.
fn limited(bench: &Bench, kib: usize, arguments: &str) -> String {
    let shell = format!("ulimit -f {kib}; exec {} {arguments}", env!("CARGO_BIN_EXE_dgmpm"));
    let output = Command::new("bash").args(["-c", &shell]).current_dir(bench.path(".")).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(5), "{arguments}: {errors}");
    assert_eq!(errors.matches("error: ").count(), 1, "{arguments}: {errors}");
    errors
}

/// Files under temporary names.
fn parts(bench: &Bench) -> Vec<String> {
    let mut folders = vec![bench.path(".")];
    let mut out = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.is_dir() {
                true => folders.push(path),
                false => out.extend(path.to_str().filter(|name| name.ends_with(".part")).map(str::to_owned)),
            }
        }
    }
    out
}

#[test]
fn a_file_without_space_is_one_message_and_leaves_no_half_file() {
    let bench = Bench::new();
    bench.run("run case.toml --out r --set regrid=[]");
    bench.run("mesh rectangle --size 1,0.5 --cells 4,2 --out kept.h5");
    // The list of the folder of a run takes some KiB itself.
    for (kib, arguments, file) in [
        (1, "mesh rectangle --size 1,0.5 --cells 40,20 --out m.h5", "m.h5"),
        (1, "mesh rectangle --size 1,0.5 --cells 40,20 --out m.msh", "m.msh"),
        (1, "seed case.toml --out c.h5", "c.h5"),
        (1, "preprocess case.toml --out o.h5", "o.h5"),
        (8, "export r --format vtu", "r/export/grid_"),
        (8, "export r --format xdmf", "r/export/"),
        (1, "run case.toml --out s", "s/"),
    ] {
        let message = limited(&bench, kib, arguments);
        assert!(message.contains("cannot write ") && message.contains(file), "{arguments}: {message}");
        assert!(["m.h5", "m.msh", "c.h5", "o.h5"].iter().all(|name| !bench.path(name).exists()), "{arguments}");
    }
    let before = std::fs::read(bench.path("kept.h5")).unwrap();
    limited(&bench, 1, "mesh rectangle --size 2,1 --cells 40,20 --out kept.h5 --force");
    assert_eq!(std::fs::read(bench.path("kept.h5")).unwrap(), before, "the old file stays");
    assert_eq!(parts(&bench), [""; 0], "nothing is left under a temporary name");
    bench.run("verify r --steps 0");
}

/// Found by `make faults`: the state of a run that has not begun has no memory of its conditions yet, and keeping it was a panic.
#[test]
fn a_run_whose_outputs_cannot_be_made_is_one_message() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("r")).unwrap();
    std::fs::write(bench.path("r/tracks"), "mine").unwrap();
    let message = bench.fail(5, "run case.toml --out r");
    assert!(message.contains("cannot write r/tracks"), "{message}");
    assert_eq!(std::fs::read_to_string(bench.path("r/tracks")).unwrap(), "mine");
}

#[test]
fn a_folder_that_may_not_be_written_to_is_one_message() {
    let bench = Bench::new();
    // A user who is root may write into any folder, but for what the kernel shows there.
    for arguments in ["run case.toml --out /proc/r", "mesh rectangle --size 1,1 --cells 2,2 --out /proc/m.h5"] {
        let message = bench.fail(5, arguments);
        assert!(message.contains("cannot write /proc"), "{message}");
    }
}
