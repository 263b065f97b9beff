//! Signals, kills, two runs in one folder, folders that go away.
#![cfg(unix)]

use crate::common::{Bench, assert_same};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longer than any test waits.
const LONG: &str = "run case.toml --out r --threads 1 --set time.end=1e3 --set regrid=[] --set output=[{kind=\"ledger\"}] --set quantity=[]";

fn start(bench: &Bench, arguments: &str) -> Child {
    // Under `nohup`, and in the background of a script, programs are started with some of these signals ignored, and it would stay so.
    let mut command = Command::new("/usr/bin/env");
    command.args(["--default-signal=INT,TERM,HUP,USR1", env!("CARGO_BIN_EXE_dgmpm")]);
    command.args(arguments.split_whitespace()).current_dir(bench.path("."));
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until something holds; two cores that others use too.
fn wait(what: &str, holds: impl Fn() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn rows(bench: &Bench) -> usize {
    std::fs::read_to_string(bench.path("r/ledger.csv")).map_or(0, |text| text.lines().count())
}

fn checkpoints(bench: &Bench) -> Vec<String> {
    let files = std::fs::read_dir(bench.path("r/checkpoints")).into_iter().flatten().flatten();
    let mut names: Vec<String> = files.map(|file| file.file_name().into_string().unwrap()).collect();
    names.retain(|name| name.ends_with(".h5"));
    names.sort();
    names
}

fn send(child: &Child, signal: &str) {
    let sent = Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status().unwrap();
    assert!(sent.success());
}

/// The message of a process that ended with a code.
fn ended(mut child: Child, code: i32) -> String {
    // What it says until its end is less than a pipe holds.
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{errors}");
    errors
}

#[test]
fn signals_keep_the_run_also_of_a_scene_without_checkpoints() {
    let bench = Bench::new();
    let text = crate::common::SCENE.replace("[checkpoint]\nevery_steps = 3\n", "");
    std::fs::write(bench.path("case.toml"), text).unwrap();
    for signal in ["TERM", "INT", "HUP"] {
        let _ = std::fs::remove_dir_all(bench.path("r"));
        let child = start(&bench, LONG);
        wait("it steps", || rows(&bench) > 5);
        assert!(checkpoints(&bench).is_empty(), "nothing asks for one");
        send(&child, "USR1");
        wait("SIGUSR1 saves", || checkpoints(&bench).len() == 1);
        let before = rows(&bench);
        wait("and goes on", || rows(&bench) > before + 2);
        send(&child, signal);
        let errors = ended(child, 4);
        assert!(errors.contains("go on by: dgmpm resume r"), "{signal}: {errors}");
        assert_eq!(checkpoints(&bench).len(), 2);
    }
    let step = checkpoints(&bench)[1].trim_end_matches(".h5").parse::<usize>().unwrap();
    let child = start(&bench, "resume r");
    wait("it goes on", || rows(&bench) > step + 3);
    send(&child, "TERM");
    ended(child, 4);
}

#[test]
fn a_second_run_in_the_folder_is_refused_and_a_dead_one_holds_no_lock() {
    let bench = Bench::new();
    let mut child = start(&bench, LONG);
    wait("it steps", || rows(&bench) > 5);
    for second in ["run case.toml --out r --force", "resume r"] {
        let message = bench.fail(2, second);
        assert!(message.contains("another run is writing into r"), "{message}");
    }
    child.kill().unwrap();
    child.wait().unwrap();
    bench.run("run case.toml --out r --force --set output=[] --set regrid=[] --set quantity=[]");
}

#[test]
fn a_folder_that_is_removed_ends_the_run_and_is_not_made_anew() {
    let bench = Bench::new();
    let child = start(&bench, LONG);
    wait("it steps", || rows(&bench) > 5);
    // At once: while files go one by one, what cannot be written depends on the moment.
    std::fs::rename(bench.path("r"), bench.path("gone")).unwrap();
    let errors = ended(child, 5);
    assert!(errors.contains("removed during the run") && errors.matches("error: ").count() == 1, "{errors}");
    assert!(!bench.path("r").exists());
}

#[test]
fn a_file_beyond_the_limit_of_the_shell_is_one_message_and_leaves_whole_rows() {
    let bench = Bench::new();
    let program = env!("CARGO_BIN_EXE_dgmpm");
    let shell =
        format!("ulimit -f 40; exec {program} {} --set checkpoint.every_steps=1000000", LONG.replace('"', "\\\""));
    let mut command = Command::new("bash");
    let output = command.args(["-c", &shell]).current_dir(bench.path(".")).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(5), "{errors}");
    assert!(errors.contains("cannot write r/ledger.csv") && errors.matches("error: ").count() == 1, "{errors}");
    let text = std::fs::read_to_string(bench.path("r/ledger.csv")).unwrap();
    let columns = text.lines().next().unwrap().split(',').count();
    assert!(text.ends_with('\n') && text.lines().all(|row| row.split(',').count() == columns), "no torn row");
}

/// Kills a run when it has some rows, again and again, and lets it go on; none where it came to its end before a kill.
fn killed(bench: &Bench, scene: &str) -> Option<()> {
    let _ = std::fs::remove_dir_all(bench.path("r"));
    let mut child = start(bench, &format!("run {scene} --out r"));
    for wanted in [8, 20, 35] {
        wait("it steps", || rows(bench) > wanted && checkpoints(bench).len() == 2);
        child.kill().unwrap();
        if child.wait().unwrap().success() {
            return None;
        }
        child = start(bench, "resume r");
    }
    ended(child, 0);
    Some(())
}

#[test]
fn kills_at_any_moment_lose_nothing() {
    let bench = Bench::new();
    // `make faults` does a hundred.
    let scene = "case.toml --set checkpoint.every_steps=1";
    bench.run(&format!("run {scene} --out whole"));
    // This process may sleep while the run goes on to its end.
    let tries = (0..20).find_map(|_| killed(&bench, scene));
    assert!(tries.is_some(), "the run was never killed in its midst");
    assert_same("killed", &bench.path("whole"), &bench.path("r"));
}
