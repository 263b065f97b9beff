//! Datasets of numbers: packed in chunks where that pays, written at once or chunk by chunk.

use super::{CHUNK_BYTES, DEFLATE_LEVEL, SMALL_BYTES};
use hdf5_metno as h5;
use hdf5_metno::{H5Type, Hyperslab, SliceOrIndex};
use ndarray::ArrayViewD;
use std::ops::Range;

/// Writes one dataset (row-major, `shape` may be empty for a single number), packed where that pays.
/// The same values give the same bytes in the file: no time stamps.
pub fn put<T: H5Type>(group: &h5::Group, name: &str, shape: &[usize], values: &[T]) -> h5::Result<()> {
    check_count(name, shape, values.len())?;
    let (dataset, _) = new_dataset::<T>(group, name, shape)?;
    if values.is_empty() { Ok(()) } else { dataset.write_raw(values) }
}

/// The same for real numbers that `rows` makes, some rows of the first axis at a time: no more than those of a chunk are held.
pub fn put_rows(
    group: &h5::Group,
    name: &str,
    shape: &[usize],
    rows: &dyn Fn(Range<usize>) -> Vec<f64>,
) -> h5::Result<()> {
    let (dataset, chunk) = new_dataset::<f64>(group, name, shape)?;
    let count = shape.first().copied().unwrap_or(0);
    for start in (0..count).step_by(chunk.unwrap_or(count).max(1)) {
        let range = start..count.min(start + chunk.unwrap_or(count));
        let part = [&[range.len()], &shape[1..]].concat();
        let values = rows(range.clone());
        check_count(name, &part, values.len())?;
        let axes = shape[1..].iter().map(|&len| (0..len).into());
        let place: Vec<SliceOrIndex> = std::iter::once(range.into()).chain(axes).collect();
        let values = ArrayViewD::from_shape(part, &values).map_err(|why| h5::Error::from(why.to_string().as_str()))?;
        dataset.write_slice(values, Hyperslab::from(place))?;
    }
    Ok(())
}

fn check_count(name: &str, shape: &[usize], count: usize) -> h5::Result<()> {
    match shape.iter().product::<usize>() == count {
        true => Ok(()),
        false => Err(h5::Error::from(format!("array `{name}` of shape {shape:?} has {count} values").as_str())),
    }
}

/// A dataset without values, and how many rows each of its chunks has; none where it is stored in one piece.
fn new_dataset<T: H5Type>(group: &h5::Group, name: &str, shape: &[usize]) -> h5::Result<(h5::Dataset, Option<usize>)> {
    let count: usize = shape.iter().product();
    let mut builder = group.new_dataset::<T>().obj_track_times(false).create_intermediate_group(true);
    let row = count.checked_div(shape.first().copied().unwrap_or(1)).unwrap_or(0) * size_of::<T>();
    let mut rows = None;
    if count * size_of::<T>() > SMALL_BYTES && row > 0 {
        let mut chunk = shape.to_vec();
        chunk[0] = (CHUNK_BYTES / row).clamp(1, chunk[0]);
        rows = Some(chunk[0]);
        builder = builder.chunk(chunk);
        if h5::filters::deflate_available() {
            builder = builder.shuffle().deflate(DEFLATE_LEVEL);
        }
    }
    let dataset = if shape.is_empty() { builder.create(name)? } else { builder.shape(shape).create(name)? };
    Ok((dataset, rows))
}

#[cfg(test)]
mod tests {
    use super::super::{Kept, create_sealed};
    use super::*;

    #[test]
    fn an_array_that_is_written_chunk_by_chunk_has_the_bytes_of_one_that_is_written_at_once() {
        let folder = tempfile::tempdir().unwrap();
        // Stored in one piece, in one chunk, in eight chunks (more than the cache of HDF5 holds) of which the last is shorter.
        for rows in [0, 3, 100, 6000] {
            let shape = [rows, 6, 7];
            let all: Vec<f64> = (0..rows * 42).map(|k| (k as f64).sqrt()).collect();
            let bytes = |name: &str, fill: &dyn Fn(&h5::File) -> h5::Result<()>| {
                let path = folder.path().join(name);
                create_sealed(&path, Kept::Named, fill).unwrap();
                std::fs::read(path).unwrap()
            };
            let once = bytes("once", &|file| put(file, "numbers", &shape, &all));
            let some = |range: Range<usize>| all[42 * range.start..42 * range.end].to_vec();
            assert!(once == bytes("parts", &|file| put_rows(file, "numbers", &shape, &some)), "{rows} rows");
        }
    }

    #[test]
    fn a_piece_with_too_few_numbers_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let fill = |file: &h5::File| put_rows(file, "numbers", &[4, 2], &|range| vec![0.0; range.len()]);
        let why = create_sealed(&folder.path().join("short"), Kept::Named, fill).unwrap_err();
        assert!(why.to_string().contains("array `numbers` of shape [4, 2] has 4 values"), "{why}");
    }
}
