//! Bad files that are binary, large or special: made, not stored.

use super::{Bench, arguments};
use dgmpm::parts::io::{mesh_file, seal};
use std::fs::write;

/// Numbers without a pattern, always the same.
fn noise(count: usize) -> Vec<u8> {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as u8
    };
    std::iter::repeat_with(next).take(count).collect()
}

/// Makes the files; each with the arguments that must fail.
pub fn cases(bench: &Bench) -> Vec<(String, Vec<String>)> {
    let mut cases = Vec::new();
    let mut add = |name: &str, bytes: Vec<u8>| {
        write(bench.path(name), bytes).unwrap();
        cases.push((name.to_owned(), arguments(name)));
    };
    texts(bench, &mut add);
    for ending in ["msh", "toml", "csv", "vtu", "h5"] {
        add(&format!("noise.{ending}"), noise(5000));
    }
    add("big_endian.msh", b"$MeshFormat\n4.1 1 8\n\0\0\0\x01\n$EndMeshFormat\n".to_vec());
    let binary = b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Nodes\n";
    add("binary_huge.msh", [&binary[..], &[0xff; 40]].concat());
    stores(&mut add);
    meshes(bench, &mut add);
    special(bench, &mut cases);
    let own = |name: &str, all: &[&str]| (name.to_owned(), all.iter().map(|word| (*word).to_owned()).collect());
    cases.push(own("4294836225 cells", &["mesh", "rectangle", "--size", "1,1", "--cells", "65535,65535"]));
    cases.push(own("mesh.rectangle.cells", &["run", "good.toml", "--set", "mesh.rectangle.cells=[99999,99999]"]));
    // A later grid is looked at before the first step.
    let later = "regrid=[{at=[5e-5],rectangle={size=[1,0.5],cells=[99999,99999]}}]";
    cases.push(own("5e-5],rectangle", &["run", "good.toml", "--set", later, "--out", "never"]));
    cases
}

fn texts(bench: &Bench, add: &mut impl FnMut(&str, Vec<u8>)) {
    let scene = std::fs::read_to_string(bench.path("good.toml")).unwrap();
    let with = |old: &str, new: &str| scene.replacen(old, new, 1).into_bytes();
    add("latin_1.toml", [&b"# caf\xe9\n"[..], scene.as_bytes()].concat());
    add("zeros.toml", vec![0; 1000]);
    add("too_large.toml", vec![b'#'; 5 << 20]);
    add("deep_lists.toml", format!("a = {}", "[".repeat(100_000)).into_bytes());
    add("deep_tables.toml", format!("a = {}", "{b=".repeat(100_000)).into_bytes());
    add("deep_key.toml", format!("{}a = 1", "a.".repeat(250_000)).into_bytes());
    add("many_keys.toml", (0..40_000).map(|k| format!("k{k} = 1\n")).collect::<String>().into_bytes());
    add("deep_expression.toml", with("\"-200\"", &format!("\"{}x\"", "(".repeat(200_000))));
    add("deep_signs.toml", with("\"-200\"", &format!("\"{}x\"", "-".repeat(15_000))));
    add("long_expression.toml", with("\"-200\"", &format!("\"{}x\"", "x+".repeat(100_000))));
    add("changed_after_the_run.toml", {
        let sealed = seal::text(&scene, seal::TOML);
        sealed.replace("1e-4", "2e-4").into_bytes()
    });
    add("one_long_line.csv", vec![b'1'; 4 << 20]);
    let names: Vec<String> = (0..100_000).map(|k| format!("n{k}")).collect();
    add("many_columns.csv", names.join(",").into_bytes());
    add("latin_1.csv", b"x,y\n0.5,0.25 \xb5m\n".to_vec());
    let attributes: String = (0..100_000).map(|k| format!(" a{k}=\"1\"")).collect();
    add("many_attributes.vtu", format!("<VTKFile{attributes}>").into_bytes());
    let good = std::fs::read_to_string(bench.path("good.vtu")).unwrap();
    add(
        "many_attributes_within.vtu",
        good.replace("<Points>", &format!("<Points>\n<DataArray{attributes}/>")).into_bytes(),
    );
    add("deep.vtu", good.replace("<Points>", &"<a>".repeat(300_000)).into_bytes());
    add("many_elements.vtu", good.replace("<Points>", &"<a/>".repeat(300_000)).into_bytes());
}

/// Meshes of other programs.
fn meshes(bench: &Bench, add: &mut impl FnMut(&str, Vec<u8>)) {
    let read = |name: &str| std::fs::read_to_string(bench.path(name)).unwrap();
    let (vtu, xdmf) = (read("good_mesh.vtu"), read("good_mesh.xdmf"));
    for (name, old, new) in [
        ("triangle_mesh.vtu", ">9 9<", ">9 5<"),
        ("solids_mesh.vtu", ">9 9<", ">9 12<"),
        ("curved_mesh.vtu", ">9 9<", ">9 23<"),
        ("unknown_kind_mesh.vtu", ">9 9<", ">9 99<"),
        ("unknown_node_mesh.vtu", ">0 1 4 3 ", ">0 1 4 77 "),
        ("negative_node_mesh.vtu", ">0 1 4 3 ", ">0 1 4 -3 "),
        ("huge_offset_mesh.vtu", ">4 8<", ">4 8000000000000000<"),
        ("falling_offset_mesh.vtu", ">4 8<", ">4 3<"),
        ("not_plane_mesh.vtu", ">0 0 0 1 0 0", ">0 0 0 1 0 3"),
        ("real_group_mesh.vtu", "\"cell_tags\" format=\"ascii\">1 2", "\"cell_tags\" format=\"ascii\">1 2.5"),
        ("several_data_mesh.vtu", "cell_tags", "some"),
        ("crossed_mesh.vtu", ">0 1 4 3 ", ">0 1 3 4 "),
        ("polydata_mesh.vtu", "type=\"UnstructuredGrid\"", "type=\"PolyData\""),
        ("no_types_mesh.vtu", "\"types\"", "\"kinds\""),
        ("lz4_mesh.vtu", "version=\"0.1\"", "version=\"0.1\" compressor=\"vtkLZ4DataCompressor\""),
    ] {
        assert!(vtu.contains(old), "{name}");
        add(name, vtu.replacen(old, new, 1).into_bytes());
    }
    let hdf = |place: &str| format!("<DataItem Format=\"HDF\" Dimensions=\"6 2\">{place}</DataItem>");
    let item = "<DataItem Format=\"XML\" Dimensions=\"6 2\">0 0 1 0 2 0 0 1 1 1 2 1</DataItem>";
    for (name, old, new) in [
        ("numbers_missing.xdmf", item, &hdf("nowhere.h5:/x")[..]),
        ("numbers_in_text.xdmf", item, &hdf("good.toml:/x")),
        ("numbers_of_others.xdmf", item, &hdf("others.h5:/x")),
        ("numbers_elsewhere.xdmf", item, &hdf("../secret.h5:/x")),
        ("numbers_at_the_root.xdmf", item, &hdf("/etc/passwd:/x")),
        ("numbers_nowhere.xdmf", item, &hdf("x")),
        ("numbers_as_bytes.xdmf", "Format=\"XML\"", "Format=\"Binary\""),
        ("numbers_of_a_function.xdmf", "<DataItem", "<DataItem ItemType=\"Function\""),
        ("word_for_a_number.xdmf", ">0 0 1 0", ">0 0 one 0"),
        ("odd_points.xdmf", ">0 0 1 0", ">0 1 0"),
        ("odd_cells.xdmf", ">0 1 4 3 ", ">0 1 4 "),
        ("other_geometry.xdmf", "\"XY\"", "\"ORIGIN_DXDY\""),
        ("other_topology.xdmf", "\"Quadrilateral\"", "\"2DSMesh\""),
        ("cut_mixed.xdmf", "\"Quadrilateral\"", "\"Mixed\""),
        ("cut_off.xdmf", "</Topology>", ""),
        ("no_domain.xdmf", "Domain", "Area"),
        ("series_of_fields.xdmf", "Name=\"mesh\"", "Name=\"series\""),
    ] {
        assert!(xdmf.contains(old), "{name}");
        add(name, xdmf.replace(old, new).into_bytes());
    }
    // A kilobyte of zlib for each megabyte of zeros.
    add("bomb_mesh.vtu", bomb());
    add("deep.xdmf", format!("<Xdmf><Domain>{}", "<Grid>".repeat(300_000)).into_bytes());
    add("many_elements.xdmf", format!("<Xdmf><Domain>{}</Domain></Xdmf>", "<Grid/>".repeat(300_000)).into_bytes());
    add("legacy.vtk", b"# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\n".to_vec());
    add("others.h5", {
        let path = bench.path("others.h5");
        hdf5_metno::File::create(&path).unwrap().new_dataset::<f64>().shape([6, 2]).create("x").unwrap();
        std::fs::read(&path).unwrap()
    });
}

/// A VTU file of 10^8 cells, whose compressed arrays are all zeros.
fn bomb() -> Vec<u8> {
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    std::io::copy(&mut std::io::Read::take(std::io::repeat(0), 10 << 20), &mut packed).unwrap();
    let block = packed.finish().unwrap();
    let header = [10_u32, 10 << 20, 10 << 20].into_iter().chain([block.len() as u32; 10]);
    let bytes = [header.flat_map(u32::to_le_bytes).collect::<Vec<u8>>(), block.repeat(10)].concat();
    let array = |kind: &str, name: &str, components: usize| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"0\"/>"
        )
    };
    let head = format!(
        "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" \
         NumberOfCells=\"100000000\"><Points>{}</Points><Cells>{}{}{}</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_",
        array("Float64", "Points", 3),
        array("UInt8", "connectivity", 1),
        array("UInt8", "offsets", 1),
        array("UInt8", "types", 1)
    );
    [head.into_bytes(), bytes, b"</AppendedData></VTKFile>".to_vec()].concat()
}

/// Files that should be stores of the program.
fn stores(add: &mut impl FnMut(&str, Vec<u8>)) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.h5");
    let good = dgmpm::rectangle([2.0, 1.0], [2, 1]).unwrap();
    let bytes = |change: fn(&mut dgmpm::Mesh)| {
        let mut mesh = good.clone();
        change(&mut mesh);
        mesh_file::write_mesh(&path, &mesh).unwrap();
        std::fs::read(&path).unwrap()
    };
    add("inverted_cell.h5", bytes(|mesh| mesh.cells[1].swap(1, 3)));
    add("collapsed_cell.h5", bytes(|mesh| mesh.nodes[1] = mesh.nodes[0]));
    add("zero_area.h5", bytes(|mesh| mesh.nodes.iter_mut().for_each(|x| x[1] = 0.0)));
    add("concave_cell.h5", bytes(|mesh| mesh.nodes[4] = [0.2, 0.2]));
    add("nan.h5", bytes(|mesh| mesh.nodes[3][0] = f64::NAN));
    add("no_cells.h5", bytes(|mesh| *mesh = dgmpm::Mesh::default()));
    let whole = bytes(|_| ());
    add("truncated.h5", whole[..whole.len() / 2].to_vec());
    add("without_seal.h5", whole[..whole.len() - 77].to_vec());
    add("damaged.h5", {
        let mut damaged = whole.clone();
        damaged[1000] ^= 1;
        damaged
    });
    add("empty.h5", vec![]);
    add("signature_alone.h5", [&whole[..8], &[0xff; 3000]].concat());
}

/// What is no file.
fn special(bench: &Bench, cases: &mut Vec<(String, Vec<String>)>) {
    std::fs::create_dir(bench.path("folder.msh")).unwrap();
    std::fs::create_dir(bench.path("folder.toml")).unwrap();
    std::os::unix::fs::symlink("nowhere.msh", bench.path("dangling.msh")).unwrap();
    std::os::unix::fs::symlink("loop.toml", bench.path("loop.toml")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", bench.path("endless.toml")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", bench.path("endless.csv")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", bench.path("endless.vtu")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", bench.path("endless.h5")).unwrap();
    // A pipe without a writer: who opens it waits.
    let made = std::process::Command::new("mkfifo").arg(bench.path("pipe.msh")).status().unwrap();
    assert!(made.success());
    let names = [
        "folder.msh",
        "folder.toml",
        "dangling.msh",
        "loop.toml",
        "endless.toml",
        "endless.csv",
        "endless.vtu",
        "endless.h5",
        "pipe.msh",
    ];
    cases.extend(names.map(|name| (name.to_owned(), arguments(name))));
}
