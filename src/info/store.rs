//! The HDF5 files of the program, by the format that they name.

use super::{Info, READ, mesh_facts};
use crate::error::Result;
use crate::io::checkpoint::{self, Checkpoint};
use crate::io::hdf5::{Reader, Values};
use crate::io::snapshot::{self, Snapshot};
use crate::io::store::Store;
use crate::io::{cloud_file, mesh_file, operators_file};
use std::path::Path;

/// What an HDF5 file holds.
///
/// # Errors
/// A file that is damaged, or is not of this program.
pub(super) fn info(path: &Path) -> Result<Info> {
    let reader = Reader::open(path, READ)?;
    let names = reader.attribute_names()?;
    let text = |name: &str| names.iter().any(|known| known == name).then(|| reader.attribute(name)).transpose();
    let format = text("format")?.unwrap_or_default();
    let info = match &format[..] {
        name if name == mesh_file::FORMAT.name => mesh_facts(Info::new("mesh"), &mesh_file::read_mesh(path)?),
        name if name == cloud_file::FORMAT.name => cloud(Store::read(path, cloud_file::FORMAT)?)?,
        name if name == operators_file::FORMAT.name => operators(Store::read(path, operators_file::FORMAT)?)?,
        name if name == snapshot::FORMAT.name => state(Info::new("snapshot"), &Snapshot::read(path)?),
        name if name == checkpoint::FORMAT.name => kept(&Checkpoint::read(path)?),
        "" => {
            let all = reader.names()?;
            match all.iter().any(|name| name == "VTKHDF") {
                true => series(&reader)?,
                false => Info::new("HDF5 file of an export, which an .xdmf file names").with("arrays", all),
            }
        }
        other => Info::new(format!("HDF5 file of the format `{other}`")).with("arrays", reader.names()?),
    };
    let info = info.maybe("version", text("version")?);
    let keys = [
        "positions",
        "program",
        "commit",
        "kernel",
        "scene_hash",
        "operators_hash",
        "mesh_hash",
        "points_hash",
        "laws_hash",
    ];
    let found = keys.into_iter().map(|key| Ok((key, text(key)?))).collect::<Result<Vec<_>>>()?;
    Ok(found.into_iter().fold(info, |info, (key, text)| info.maybe(key, text.filter(|text| !text.is_empty()))))
}

/// A series for ParaView; other programs write files of one time too, which have no list of them.
fn series(reader: &Reader) -> Result<Info> {
    let info = Info::new("VTKHDF: a series for ParaView, all times in one file");
    let Ok((_, Values::F64(times))) = reader.get_within("VTKHDF/Steps/Values") else { return Ok(info) };
    let ends = times.first().zip(times.last()).map(|(first, last)| serde_json::json!([first, last]));
    Ok(info.with("times", times.len()).maybe("t_from_to_s", ends))
}

/// The first length of an array.
fn length(store: &Store, name: &str) -> Option<usize> {
    store.shape(name).ok().and_then(|shape| shape.first().copied())
}

fn cloud(mut store: Store) -> Result<Info> {
    let cells = length(&store, "first").unwrap_or(1).saturating_sub(1);
    let points = length(&store, "xi").unwrap_or(0);
    let fields: Vec<String> = store.names().filter_map(|name| name.strip_prefix("field_")).map(str::to_owned).collect();
    let is_there = store.names().any(|name| name == "virtual");
    let virtual_points =
        if is_there { store.indices("virtual", &[])?.into_iter().filter(|flag| *flag != 0).count() } else { 0 };
    let mesh = store.attribute("mesh")?.to_owned();
    let info = Info::new("cloud of material points").with("cells", cells).with("points", points);
    Ok(info.with("virtual_points", virtual_points).with("fields", fields).with("mesh", mesh))
}

fn operators(store: Store) -> Result<Info> {
    let numbers = |name: &str| length(&store, name).unwrap_or(0);
    let parts = [("points", "matrices at points"), ("curl_free", "control of the curl")];
    let there = parts.into_iter().filter(|(name, _)| store.shape(&format!("{name}_shared")).is_ok());
    let there: Vec<&str> = there.map(|(_, words)| words).collect();
    let info = Info::new("operators: the stored matrices").with("cells", numbers("block_cells"));
    Ok(info.with("blocks", numbers("block_sizes")).with("parts", there).with("key", store.attribute("key")?))
}

fn state(info: Info, snapshot: &Snapshot) -> Info {
    let Snapshot { time, step, degree, displacement, internal, .. } = snapshot;
    info.with("time_s", *time)
        .with("step", *step)
        .with("degree", *degree)
        .with("cells", snapshot.cells())
        .with("displacement", !displacement.is_empty())
        .with("internal_variables", internal.len())
        .with("mesh_file", snapshot.grid.mesh.clone())
        .with("cloud_file", snapshot.grid.cloud.clone())
}

fn kept(checkpoint: &Checkpoint) -> Info {
    let parts: Vec<&String> = checkpoint.parts.keys().collect();
    let title = checkpoint.scene.lines().find_map(|line| line.strip_prefix("title = "));
    let info =
        state(Info::new("checkpoint").maybe("title", title.map(|text| text.trim_matches('"'))), &checkpoint.snapshot);
    info.with("parts", serde_json::json!(parts))
}
