//! What a run begins from, read and checked before anything is written.

use super::args::SceneArgs;
use super::output::RunArgs;
use super::print::warn;
use super::{ranks, threads};
use crate::error::Result;
use crate::problem::{Body, Files, check_folder, check_run};
use crate::run::{Folder, Lock};
use crate::scene::Scene;
use std::path::Path;

/// Scene, body and folder: all that can be wrong is found before results on the disk are changed.
pub fn read(
    scene: &SceneArgs,
    files: &Files,
    operators: Option<&Path>,
    run: &RunArgs,
) -> Result<(Scene, Body, Folder, Option<Lock>)> {
    threads::start(run.threads)?;
    threads::kernel(run.kernel.as_deref())?;
    let scene = scene.load()?;
    scene.warnings().iter().for_each(warn);
    let (folder, writes) = (run.folder(&scene), ranks::writes());
    let refuse = || if run.force || !writes { Ok(()) } else { folder.refuse_results() };
    refuse()?;
    scene.settings()?;
    let body = files.body(&scene)?;
    check_run(&scene, &body, operators)?;
    let take = || check_folder((&scene, &body), files, operators, &folder).and_then(|()| folder.lock());
    let lock = writes.then(take).transpose()?;
    // Another run may have begun and ended in the meantime.
    refuse()?;
    Ok((scene, body, folder, lock))
}
