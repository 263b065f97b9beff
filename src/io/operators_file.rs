//! `operators.h5`: the stored matrices, with a key: a hash of the input that they were built from.

use std::ops::Range;
use std::path::Path;

use super::certificates::Columns;
use super::hash::{self, Digest};
use super::hdf5;
use super::seal::{self, Seal};
use super::store::{ArrayRef, Format, Rows, Store, write_arrays};
use crate::error::Result;
use crate::mesh::{FACES, Link, Mesh};
use crate::operators::stored::{Entries, Flat};
use crate::operators::{Blocks, Certificate, Needs, Sampling, Stored};

/// The format of the stored matrices. Version 3: cells of a block follow each other, see [`Blocks`]. Version 4 adds the
/// certificates of the cells, for people who read the file (they are not read back). Version 5 has the blocks, and the complements of
/// congruent cells no longer depend on which of them comes first.
pub const FORMAT: Format =
    Format { name: "dgmpm operators", version: 5, remedy: "write it again by `dgmpm preprocess`" };

/// The first version whose matrices are those of today. Matrices of older files are built again.
const MATRICES: u32 = 5;

/// The cells of all blocks, one after the other.
const BLOCK_CELLS: &str = "block_cells";

/// The number of cells of each block.
const BLOCK_SIZES: &str = "block_sizes";

/// What blocks consist of.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// The law of each cell.
    pub material: &'a [usize],
    /// What is beyond the faces of each cell.
    pub links: &'a [[Link; FACES]],
}

/// The key: a hash of the mesh, the pairs of periodic groups, the cloud (or nodes), the degree, the law of each cell,
/// and the list of matrices that the run needs.
pub fn key(mesh: &Mesh, periodic: &[[usize; 2]], material: &[usize], needs: &Needs) -> String {
    let mut digest = Digest::new();
    digest.text(FORMAT.name).count(MATRICES as usize).text(&hash::of_mesh(mesh)).count(needs.degree);
    digest.counts(periodic.as_flattened().iter().map(|&group| group as u64));
    digest.counts(material.iter().map(|&m| m as u64));
    match needs.sampling {
        None => digest.text("none"),
        Some(Sampling::Nodes) => digest.text("nodes"),
        Some(Sampling::Cloud(cloud)) => digest.text(&hash::of_cloud(cloud)),
    };
    digest.count(usize::from(needs.curl_free)).finish()
}

/// Writes blocks and matrices under their key, with the certificates of the cells.
pub fn write(path: &Path, key: &str, blocks: &Blocks, stored: &Stored, certificates: &[Certificate]) -> Result<()> {
    let points = stored.points.as_ref().map(|pool| (Flat::without_own(pool), Entries::of(&pool.own)));
    let curl_free = stored.curl_free.as_ref().map(|pool| (Flat::without_own(pool), Entries::of(&pool.own)));
    let parts = [("points", &points), ("curl_free", &curl_free)];
    let some = parts
        .map(|(_, part)| move |range: Range<usize>| part.as_ref().map(|(_, own)| own.some(range)).unwrap_or_default());
    let cells = blocks.list();
    let mut arrays = vec![
        (BLOCK_CELLS.to_owned(), cells.len(), ArrayRef::Index(&cells)),
        (BLOCK_SIZES.to_owned(), blocks.len(), ArrayRef::Index(&blocks.count)),
    ];
    for ((name, part), some) in parts.iter().zip(&some) {
        let Some((flat, own)) = part else { continue };
        arrays.push((format!("{name}_share"), flat.share.len(), ArrayRef::I64(&flat.share)));
        arrays.push((format!("{name}_shared_sizes"), flat.shared_sizes.len(), ArrayRef::Index(&flat.shared_sizes)));
        arrays.push((format!("{name}_own_sizes"), flat.own_sizes.len(), ArrayRef::Index(&flat.own_sizes)));
        arrays.push((format!("{name}_shared"), flat.shared.len(), ArrayRef::F64(&flat.shared)));
        arrays.push((format!("{name}_own"), own.len(), ArrayRef::Rows(Rows(some))));
    }
    let mut arrays: Vec<_> = arrays.iter().map(|(name, len, array)| (name.as_str(), vec![*len], *array)).collect();
    let columns = Columns::of(certificates);
    arrays.extend(columns.arrays());
    write_arrays(path, FORMAT, &[("key", key.to_owned())], &arrays)
}

/// Whether new matrices may replace a file: yes if it holds matrices, or is a damaged store of any kind.
pub fn may_replace(path: &Path) -> bool {
    let ours = || hdf5::peek_attribute(path, "format").is_some_and(|name| name == FORMAT.name);
    matches!(seal::check(path), Ok(Seal::Broken)) || ours()
}

/// Reads blocks and matrices if they have this key; `None` if the file is missing or was built from other input.
///
/// # Errors
/// A file that is damaged.
pub fn read(path: &Path, key: &str, parts: Parts, needs: &Needs) -> Result<Option<(Blocks, Stored)>> {
    if !path.exists() {
        return Ok(None);
    }
    let mut store = Store::read(path, FORMAT)?;
    if store.attribute("key")? != key {
        return Ok(None);
    }
    let nodes = (needs.degree + 1).pow(2);
    let misfit = |store: &Store, name: &str| store.error(format!("the arrays of `{name}` do not fit together"));
    let (cells, sizes) = (store.indices(BLOCK_CELLS, &[])?, store.indices(BLOCK_SIZES, &[])?);
    let blocks = Blocks::stored(parts.material, parts.links, &cells, &sizes);
    let blocks = blocks.ok_or_else(|| store.error("the blocks do not have each cell once"))?;
    let mut out = Stored { points: None, curl_free: None };
    if needs.sampling.is_some() {
        let pool = flat(&mut store, "points")?.pool(blocks.len(), nodes);
        out.points = Some(pool.ok_or_else(|| misfit(&store, "points"))?);
    }
    if needs.curl_free {
        let pool = flat(&mut store, "curl_free")?.pool(blocks.len(), nodes);
        out.curl_free = Some(pool.ok_or_else(|| misfit(&store, "curl_free"))?);
    }
    Ok(Some((blocks, out)))
}

fn flat(store: &mut Store, name: &str) -> Result<Flat> {
    let share = store.take(&format!("{name}_share"))?.1;
    let hdf5::Values::I64(share) = share else {
        return Err(store.error(format!("`{name}_share` is not an array of integers")));
    };
    Ok(Flat {
        share,
        shared_sizes: store.indices(&format!("{name}_shared_sizes"), &[])?,
        own_sizes: store.indices(&format!("{name}_own_sizes"), &[])?,
        shared: store.reals(&format!("{name}_shared"), &[])?,
        own: store.reals(&format!("{name}_own"), &[])?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Cloud, Layout, seed};
    use crate::mesh::{links, rectangle};
    use crate::operators::Line;
    use crate::operators::certificate::certify;

    struct Case {
        mesh: Mesh,
        cloud: Cloud,
        links: Vec<[Link; FACES]>,
        blocks: Blocks,
    }

    impl Case {
        fn parts(&self) -> Parts<'_> {
            Parts { material: &MATERIAL, links: &self.links }
        }
    }

    const MATERIAL: [usize; 12] = [0; 12];

    /// 12 cells: two blocks, the second padded. A jittered cloud has matrices of its own in each cell.
    fn case(layout: Layout) -> Case {
        let mesh = rectangle([4.0, 3.0], [4, 3]).unwrap();
        let links = links(&mesh).unwrap();
        Case { cloud: seed(layout, 3, 12), mesh, blocks: Blocks::new(&MATERIAL, &links), links }
    }

    fn needs(cloud: &Cloud) -> Needs<'_> {
        Needs { degree: 2, sampling: Some(Sampling::Cloud(cloud)), curl_free: true, held: true }
    }

    fn build(case: &Case, needs: &Needs) -> Stored {
        Stored::build(&case.mesh, &case.blocks, &Line::new(needs.degree), needs).unwrap()
    }

    const JITTER: Layout = Layout::Jitter { seed: 1, amount: 0.2 };

    #[test]
    fn shared_and_own_matrices_come_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("operators.h5");
        for layout in [Layout::Paper, JITTER] {
            let case = case(layout);
            let needs = needs(&case.cloud);
            let stored = build(&case, &needs);
            let points = stored.points.as_ref().unwrap();
            assert_eq!((points.shared.len(), points.own.len()), if layout == JITTER { (0, 2) } else { (1, 0) });
            let key = key(&case.mesh, &[], &MATERIAL, &needs);
            write(&path, &key, &case.blocks, &stored, &[]).unwrap();
            // Every number is finite, so that equality is that of bits but for the sign of 0.
            let (blocks, back) = read(&path, &key, case.parts(), &needs).unwrap().unwrap();
            assert_eq!((&blocks, &back), (&case.blocks, &stored));
            let bits = |s: &Stored| {
                let flat = Flat::of(s.points.as_ref().unwrap());
                flat.own.iter().chain(&flat.shared).map(|v| v.to_bits()).collect::<Vec<_>>()
            };
            assert_eq!(bits(&back), bits(&stored));
        }
    }

    #[test]
    fn certificates_stand_beside_the_matrices_for_those_who_look() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("operators.h5");
        let case = case(Layout::Paper);
        let needs = needs(&case.cloud);
        let certificates = certify(&case.mesh, &Line::new(2), Sampling::Cloud(&case.cloud)).unwrap();
        write(&path, "a", &case.blocks, &build(&case, &needs), &certificates).unwrap();
        let mut store = Store::read(&path, FORMAT).unwrap();
        assert_eq!(store.indices("cell_points", &[]).unwrap(), [9; 12]);
        // The layout of the paper on a square cell: 26.6 (design section 2).
        assert!(store.reals("cell_face_lebesgue", &[]).unwrap().iter().all(|l| (l - 26.6).abs() < 0.01));
        assert!(read(&path, "a", case.parts(), &needs).unwrap().is_some());
    }

    #[test]
    fn the_key_tells_all_input_apart() {
        let (a, b) = (case(Layout::Paper), case(JITTER));
        let base = needs(&a.cloud);
        let mut other_mesh = a.mesh.clone();
        other_mesh.nodes[7][0] += 1e-15;
        let mut other_law = MATERIAL;
        other_law[3] = 1;
        let keys = [
            key(&a.mesh, &[], &MATERIAL, &base),
            key(&other_mesh, &[], &MATERIAL, &base),
            key(&a.mesh, &[], &other_law, &base),
            key(&a.mesh, &[[0, 1]], &MATERIAL, &base),
            key(&a.mesh, &[], &MATERIAL, &needs(&b.cloud)),
            key(&a.mesh, &[], &MATERIAL, &Needs { degree: 1, ..base }),
            key(&a.mesh, &[], &MATERIAL, &Needs { curl_free: false, ..base }),
            key(&a.mesh, &[], &MATERIAL, &Needs { sampling: Some(Sampling::Nodes), ..base }),
            key(&a.mesh, &[], &MATERIAL, &Needs { sampling: None, ..base }),
        ];
        for (i, one) in keys.iter().enumerate() {
            assert!(!keys[..i].contains(one), "key {i} is not new");
        }
        assert_eq!(keys[0], key(&a.mesh.clone(), &[], &MATERIAL, &needs(&a.cloud.clone())));
    }

    #[test]
    fn other_input_and_missing_files_give_nothing_and_damage_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("operators.h5");
        let case = case(Layout::Paper);
        let needs = needs(&case.cloud);
        let read = |key: &str| read(&path, key, case.parts(), &needs);
        assert_eq!(read("a").unwrap(), None);
        write(&path, "a", &case.blocks, &build(&case, &needs), &[]).unwrap();
        assert_eq!(read("b").unwrap(), None);
        assert!(read("a").unwrap().is_some() && may_replace(&path));
        let mut bytes = std::fs::read(&path).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        assert!(read("a").unwrap_err().to_string().contains("damaged"));
        assert!(may_replace(&path));
        std::fs::write(&path, "text").unwrap();
        assert!(!may_replace(&path) && !may_replace(&folder.path().join("none")));
    }

    #[test]
    fn matrices_that_do_not_fit_the_blocks_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("operators.h5");
        let case = case(Layout::Paper);
        let needs = needs(&case.cloud);
        let mut stored = build(&case, &needs);
        stored.points.as_mut().unwrap().share.pop();
        write(&path, "a", &case.blocks, &stored, &[]).unwrap();
        let message = read(&path, "a", case.parts(), &needs).unwrap_err().to_string();
        assert!(message.contains("do not fit together"), "{message}");
    }

    #[test]
    fn blocks_that_lack_a_cell_or_mix_laws_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("operators.h5");
        let case = case(Layout::Paper);
        let needs = needs(&case.cloud);
        let stored = build(&case, &needs);
        let mut twice = case.blocks.clone();
        twice.cells[0][0] = twice.cells[0][1];
        write(&path, "a", &twice, &stored, &[]).unwrap();
        let message = read(&path, "a", case.parts(), &needs).unwrap_err().to_string();
        assert!(message.contains("each cell once"), "{message}");
        let mut law = MATERIAL;
        law[case.blocks.cells[0][3]] = 1;
        write(&path, "a", &case.blocks, &stored, &[]).unwrap();
        assert!(read(&path, "a", Parts { material: &law, links: &case.links }, &needs).is_err());
    }
}
