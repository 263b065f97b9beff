//! Runs that end before their end: lost stability, signals, folders that cannot be written.

use crate::common::Bench;
use std::time::{Duration, Instant};

#[test]
fn a_run_that_loses_stability_says_where_and_keeps_a_good_state() {
    let bench = Bench::new();
    // The right end is pushed through the clamped left one, 1 m away, 2.5 m far by the end.
    let crush = "--set boundary.0.kind=clamped --set boundary.1.kind=velocity --set boundary.1.value=[\"-5e8*t\",0.0]";
    for method in ["ader-dgmpm", "rk-dgfem"] {
        let message = bench.fail(3, &format!("run case.toml --force {crush} --set scheme.method={method}"));
        for words in ["step ", "t = ", "in cell ", ", at ", "X = (", "steps before, is in runs/case/snapshots/"] {
            assert!(message.contains(words), "{words}: {message}");
        }
        let summary = bench.summary("runs/case");
        assert_eq!(summary["status"].as_str(), Some("unstable"));
        let (last, loss) = (bench.last("runs/case"), &summary["loss"]);
        assert_eq!(
            (last.step as u64, Some(last.time)),
            (loss["kept_step"].as_u64().unwrap(), loss["kept_time"].as_f64())
        );
        let steps = summary["steps"].as_u64().unwrap();
        assert!(last.u.iter().all(|u| u.is_finite()) && last.time < 1e-4 && (last.step as u64) < steps);
        assert!(message.contains(&format!("error: step {}, ", steps + 1)), "{message}");
        bench.run("export runs/case");
    }
}

/// In `/proc` nobody makes files, not even who may write everywhere.
#[cfg(target_os = "linux")]
#[test]
fn an_output_folder_that_cannot_be_written_is_exit_code_5() {
    let bench = Bench::new();
    for arguments in
        ["run case.toml --out /proc/below", "seed case.toml --out /proc/a.h5", "preprocess case.toml --out /proc/o.h5"]
    {
        let message = bench.fail(5, arguments);
        assert!(message.starts_with("error: cannot write /proc/"), "{message}");
    }
}

/// Starts a run that would take very long and waits until it steps.
#[cfg(unix)]
fn long_run(bench: &Bench) -> std::process::Child {
    let long = "run case.toml --threads 1 --set time.end=1e3 --set output.0.at=[2e-5] --set output.1.at=[1e3]";
    let child =
        bench.command(long).stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    let stepping =
        || std::fs::read_dir(bench.path("runs/case/snapshots")).is_ok_and(|mut files| files.next().is_some());
    while !stepping() {
        // Two cores that others use too: it takes some .1 s.
        assert!(start.elapsed() < Duration::from_secs(60), "the run does not start");
        std::thread::sleep(Duration::from_millis(10));
    }
    child
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_state_and_exits_with_4() {
    let bench = Bench::new();
    for signal in ["INT", "TERM"] {
        let child = long_run(&bench);
        let id = child.id().to_string();
        let sent = std::process::Command::new("sh").args(["-c", &format!("kill -{signal} {id}")]).status().unwrap();
        assert!(sent.success());
        let output = child.wait_with_output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(4), "{signal}: {errors}");
        assert!(
            errors.contains("interrupted: at step") && errors.contains("state is in runs/case/snapshots/"),
            "{errors}"
        );
        let summary = bench.summary("runs/case");
        assert_eq!(summary["status"].as_str(), Some("interrupted"));
        assert_eq!(bench.last("runs/case").step as u64, summary["steps"].as_u64().unwrap());
        bench.run("export runs/case --format xdmf");
        std::fs::remove_dir_all(bench.path("runs")).unwrap();
    }
}
