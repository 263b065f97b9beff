//! A start from fields at the nodes of a mesh of another program.

use super::common::{Bench, SCENE};
use dgmpm::Problem;
use dgmpm::parts::mesh::map;

/// Nodes and quadrilaterals, none of them a parallelogram, that cover the body of [`SCENE`] and more.
fn grid(n: usize) -> (Vec<[f64; 2]>, Vec<[usize; 4]>) {
    let (nx, ny) = (2 * n, n);
    let at = |i: usize, j: usize| {
        let (x, y) = (-0.1 + 1.2 * i as f64 / nx as f64, -0.1 + 0.7 * j as f64 / ny as f64);
        [x + 0.1 * x * y, y - 0.05 * x * y]
    };
    let nodes = (0..=ny).flat_map(|j| (0..=nx).map(move |i| at(i, j))).collect();
    let corner = |i: usize, j: usize| j * (nx + 1) + i;
    let cell = |i, j| [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
    (nodes, (0..ny).flat_map(|j| (0..nx).map(move |i| cell(i, j))).collect())
}

/// A row of numbers at a node.
type At<'a> = &'a dyn Fn([f64; 2]) -> Vec<f64>;

/// A VTU file of text.
fn vtu((nodes, cells): &(Vec<[f64; 2]>, Vec<[usize; 4]>), data: &[(&str, At)]) -> String {
    let array = |kind: &str, name: &str, size: usize, text: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{size}\" format=\"ascii\">{text}</DataArray>"
        )
    };
    let numbers = |all: &[f64]| all.iter().map(|x| format!("{x:?} ")).collect::<String>();
    let arrays: String = data
        .iter()
        .map(|(name, of)| {
            let rows: Vec<Vec<f64>> = nodes.iter().map(|x| of(*x)).collect();
            array("Float64", name, rows[0].len(), &numbers(&rows.concat()))
        })
        .collect();
    let points: Vec<f64> = nodes.iter().flat_map(|x| [x[0], x[1], 0.0]).collect();
    let corners: String = cells.iter().flatten().map(|node| format!("{node} ")).collect();
    let ends: String = (1..=cells.len()).map(|k| format!("{} ", 4 * k)).collect();
    format!(
        "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid>\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"><PointData>{arrays}</PointData><Points>{}</Points><Cells>{}{}{}</Cells></Piece>\
         </UnstructuredGrid></VTKFile>",
        nodes.len(),
        cells.len(),
        array("Float64", "Points", 3, &numbers(&points)),
        array("Int64", "connectivity", 1, &corners),
        array("Int64", "offsets", 1, &ends),
        array("UInt8", "types", 1, &"9 ".repeat(cells.len())),
    )
}

/// A folder with a scene whose `[initial]` is `keys`.
fn bench(keys: &str) -> Bench {
    let bench = Bench::new();
    bench.write("case.toml", SCENE.replace("velocity = [\"-200\", \"0\"]", keys));
    bench
}

/// The largest differences of F, v and u of the start from what is exact, over all grid nodes.
fn differences(bench: &Bench, sets: &[&str], exact: impl Fn([f64; 2]) -> ([f64; 4], [f64; 2], [f64; 2])) -> [f64; 3] {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let problem = Problem::load(&bench.path("case.toml"), &sets).unwrap();
    let (line, n) = (&problem.scheme.operators.line, problem.scheme.operators.nodes());
    let all = problem.state.unpack(&problem.scheme.operators.blocks, n);
    let mesh = &problem.body.mesh;
    let size = all.len() / mesh.cells.len();
    let mut worst = [0.0_f64; 3];
    for (cell, values) in all.chunks(size).enumerate() {
        for (a, xi) in line.nodes().into_iter().enumerate() {
            let (f, v, u) = exact(map::position(&mesh.map(cell), xi));
            let momentum = v.map(|v| v * 7800.0);
            for (k, wanted) in f.into_iter().chain(momentum).chain(u).enumerate().take(size / n) {
                let scale = if (4..6).contains(&k) { 7800.0 } else { 1.0 };
                let kind = [0, 0, 0, 0, 1, 1, 2, 2][k];
                worst[kind] = worst[kind].max((values[k * n + a] - wanted).abs() / scale);
            }
        }
    }
    worst
}

#[test]
fn linear_fields_of_another_mesh_come_in_exactly() {
    let bench = bench("fields = \"before.vtu\"");
    let velocity = |[x, y]: [f64; 2]| [10.0 + 3.0 * x - 2.0 * y, 5.0 * x + y - 7.0];
    let displacement = |[x, y]: [f64; 2]| [2e-3 + 1e-2 * x - 3e-3 * y, 4e-3 * x + 2e-2 * y];
    let f = [1.01, -3e-3, 4e-3, 1.02];
    let exact = |x| (f, velocity(x), displacement(x));
    let of_velocity: At = &|x| velocity(x).to_vec();
    // Two components, as meshio has them, and three, as VTK has them.
    let of_displacement: At = &|x| [&displacement(x)[..], &[0.0]].concat();
    bench.write("before.vtu", vtu(&grid(3), &[("velocity", of_velocity), ("displacement", of_displacement)]));
    let asked = r#"output.0.fields=["displacement","velocity"]"#;
    let found = differences(&bench, &[asked, "scheme.degree=3"], exact);
    // Rounding of sums of a dozen numbers of up to 10.
    assert!(found[0] < 1e-13 && found[1] < 1e-13 * 10.0 && found[2] < 1e-13, "{found:?}");
    // Of F itself, 4 or 9 numbers; the displacement is then not looked at for F.
    for wide in [false, true] {
        let tensor: At = &|_| match wide {
            false => f.to_vec(),
            true => vec![f[0], f[1], 0.0, f[2], f[3], 0.0, 0.0, 0.0, 1.0],
        };
        bench.write("before.vtu", vtu(&grid(2), &[("deformation", tensor), ("speed", of_velocity)]));
        let found = differences(&bench, &["initial.velocity_field=speed"], exact);
        assert!(found[0] < 1e-13 && found[1] < 1e-13 * 10.0, "{found:?}");
    }
    // What the file does not have stays as the scene says: here at rest, there an expression.
    bench.write("before.vtu", vtu(&grid(2), &[("u", of_displacement)]));
    let found = differences(&bench, &["initial.displacement_field=u"], |_| (f, [0.0; 2], [0.0; 2]));
    assert!(found[0] < 1e-13 && found[1] == 0.0, "{found:?}");
    let sets = ["initial.displacement_field=u", r#"initial.velocity=["3","y"]"#];
    let found = differences(&bench, &sets, |x| (f, [3.0, x[1]], [0.0; 2]));
    assert!(found[0] < 1e-13 && found[1] < 1e-15, "{found:?}");
}

#[test]
fn smooth_fields_of_another_mesh_come_in_with_order_2_in_its_cells() {
    let bench = bench("fields = \"before.vtu\"");
    let velocity = |[x, y]: [f64; 2]| [(3.0 * x + y).sin(), (2.0 * x * y).cos()];
    let displacement = |[x, y]: [f64; 2]| [0.01 * (2.0 * x).sin() * (3.0 * y).cos(), 0.02 * (x + 2.0 * y).sin()];
    let f = |[x, y]: [f64; 2]| {
        let c = (x + 2.0 * y).cos();
        let slope = [0.02 * (2.0 * x).cos() * (3.0 * y).cos(), -0.03 * (2.0 * x).sin() * (3.0 * y).sin()];
        [1.0 + slope[0], slope[1], 0.02 * c, 1.0 + 0.04 * c]
    };
    let error = |n: usize| {
        let data: [(&str, At); 2] =
            [("velocity", &|x| velocity(x).to_vec()), ("displacement", &|x| displacement(x).to_vec())];
        bench.write("before.vtu", vtu(&grid(n), &data));
        differences(&bench, &["scheme.degree=2"], |x| (f(x), velocity(x), displacement(x)))
    };
    let (coarse, fine) = (error(8), error(16));
    for k in 0..2 {
        // 4, less what the largest over scattered nodes and terms of third order take.
        assert!(coarse[k] / fine[k] > 3.3 && fine[k] < 0.05, "{k}: {coarse:?} {fine:?}");
    }
}

#[test]
fn a_node_a_little_outside_of_the_mesh_of_the_file_takes_the_values_of_the_nearest_cell_and_the_run_says_so() {
    let bench = bench("fields = \"before.vtu\"");
    // The mesh ends at 0.979 below, its cells are 0.13 wide: the outer nodes at 0.983 lie 0.03 of a cell outside.
    let (mut nodes, cells) = grid(4);
    nodes.iter_mut().for_each(|x| x[0] *= 0.89);
    let velocity = |[x, y]: [f64; 2]| [10.0 + 3.0 * x - 2.0 * y, 5.0 * x + y - 7.0];
    let displacement = |[x, y]: [f64; 2]| [2e-3 + 1e-2 * x - 3e-3 * y, 4e-3 * x + 2e-2 * y];
    let data: [(&str, At); 2] =
        [("velocity", &|x| velocity(x).to_vec()), ("displacement", &|x| displacement(x).to_vec())];
    bench.write("before.vtu", vtu(&(nodes, cells), &data));
    let sets = ["scheme.degree=3"];
    let found = differences(&bench, &sets, |x| ([1.01, -3e-3, 4e-3, 1.02], velocity(x), displacement(x)));
    // Rounding, times what lies outside.
    assert!(found[0] < 1e-13 && found[1] < 1e-13 * 20.0, "{found:?}");
    let said = bench.run("run case.toml --set scheme.degree=3");
    assert!(said.contains("note: outside of the mesh of before.vtu: 1 grid node, by up to 1e-2 of a cell;"), "{said}");
}

/// A series of two times in XDMF, its numbers as text, whose steps stand on the mesh before them: as DOLFINx and meshio have it.
fn series() -> String {
    let (nodes, cells) = grid(2);
    let text = |all: &[f64]| all.iter().map(|x| format!("{x:?} ")).collect::<String>();
    let item = |rows: usize, columns: usize, kind: &str, text: &str| {
        format!("<DataItem DataType=\"{kind}\" Dimensions=\"{rows} {columns}\" Format=\"XML\">{text}</DataItem>")
    };
    let step = |time: f64| {
        let values: Vec<f64> = nodes.iter().flat_map(|x| [1e4 * time, x[1]]).collect();
        let numbers = item(nodes.len(), 2, "Float", &text(&values));
        format!(
            "<Grid Name=\"f\"><xi:include xpointer=\"x\"/><Time Value=\"{time}\"/>\
             <Attribute Name=\"f\" AttributeType=\"Vector\" Center=\"Node\">{numbers}</Attribute></Grid>"
        )
    };
    let corners: String = cells.iter().flatten().map(|node| format!("{node} ")).collect();
    format!(
        "<?xml version=\"1.0\"?><Xdmf Version=\"3.0\" xmlns:xi=\"https://www.w3.org/2001/XInclude\"><Domain>\
         <Grid Name=\"mesh\" GridType=\"Uniform\"><Topology TopologyType=\"Quadrilateral\" NumberOfElements=\"{}\">{}</Topology>\
         <Geometry GeometryType=\"XY\">{}</Geometry></Grid>\
         <Grid Name=\"f\" GridType=\"Collection\" CollectionType=\"Temporal\">{}{}</Grid></Domain></Xdmf>",
        cells.len(),
        item(cells.len(), 4, "Int", &corners),
        item(nodes.len(), 2, "Float", &text(nodes.as_flattened())),
        step(0.001),
        step(0.02),
    )
}

#[test]
fn of_a_series_the_last_time_is_taken_or_the_one_that_is_asked_for() {
    let bench = bench("fields = \"before.xdmf\"\nvelocity_field = \"f\"");
    bench.write("before.xdmf", series());
    for (sets, first) in
        [(&[][..], 200.0), (&["initial.fields_time=1e-3"], 10.0), (&["initial.fields_time=0.02"], 200.0)]
    {
        let found = differences(&bench, sets, |x| ([1.0, 0.0, 0.0, 1.0], [first, x[1]], [0.0; 2]));
        assert!(found[0] == 0.0 && found[1] < 1e-12, "{sets:?}: {found:?}");
    }
    let message = bench.fail(2, "run case.toml --set initial.fields_time=5e-3");
    assert!(
        message.contains("it has no fields at 0.005 s") && message.contains("2 times from 0.001 s to 0.02 s"),
        "{message}"
    );
    assert!(message.contains("the nearest is fields_time = 0.001"), "{message}");
}

#[test]
fn the_folder_of_a_run_starts_again_from_its_copy_of_the_fields() {
    let bench = bench("fields = \"before.vtu\"\nvelocity_field = \"v\"");
    let data: [(&str, At); 3] = [
        ("v", &|[x, y]| vec![-200.0 + x, y * y]),
        ("displacement", &|[x, y]| vec![1e-3 * x * y, 0.0]),
        ("temperature", &|_| vec![300.0]),
    ];
    bench.write("before.vtu", vtu(&grid(4), &data));
    bench.run("run case.toml --set output.0.every_steps=1");
    let first = bench.snapshots("runs/case").remove(0);
    assert!(bench.run("run case.toml --resume --set output.0.every_steps=1").contains("has this run, done"));
    let moved: [(&str, At); 1] = [("v", &|[x, y]| vec![-200.0 + x, y])];
    bench.write("before.vtu", vtu(&grid(4), &moved));
    let message = bench.fail(2, "run case.toml --resume --set output.0.every_steps=1");
    assert!(message.contains("case.toml:11:10") && message.contains("its initial.vtu differs"), "{message}");
    std::fs::remove_file(bench.path("before.vtu")).unwrap();
    bench.run("verify runs/case");
    bench.run("run runs/case/scene.toml --out runs/same");
    let again = bench.snapshots("runs/same").remove(0);
    let bits = |u: &[f64]| u.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert!(bits(&first.u) == bits(&again.u), "the start is another one");
    // Only what is taken is kept.
    let info = bench.run("info runs/case/initial.vtu");
    assert!(info.contains("velocity, displacement") && !info.contains("temperature"), "{info}");
    // A file that is not dgmpm's under this name is left alone.
    bench.write("before.vtu", vtu(&grid(4), &data));
    std::fs::create_dir_all(bench.path("runs/own")).unwrap();
    bench.write("runs/own/initial.vtu", "mine");
    let message = bench.fail(2, "run case.toml --out runs/own");
    assert!(message.contains("initial.vtu is in the way"), "{message}");
}

#[test]
fn fields_that_cannot_start_a_run_are_refused_with_their_place() {
    let bench = bench("fields = \"before.vtu\"");
    let one: At = &|_| vec![1.0];
    let two: At = &|_| vec![1.0, 2.0];
    let four: At = &|_| vec![1.0, 0.0, 0.0, -1.0];
    let refused = |text: &str, sets: &str, what: &[&str]| {
        bench.write("before.vtu", text);
        let message = bench.fail(2, &format!("run case.toml {sets}"));
        assert!(what.iter().all(|what| message.contains(what)) && message.lines().count() == 2, "{what:?}: {message}");
        assert!(!bench.path("runs/case/summary.json").exists());
    };
    let good = vtu(&grid(2), &[("velocity", two)]);
    refused(
        &vtu(&grid(2), &[("speed", two)]),
        "",
        &["case.toml:11:10", "no field that the start could take", "speed (2)"],
    );
    refused(&vtu(&grid(2), &[]), "", &["no field that the start could take", "data at cells are not read"]);
    refused(&good, "--set initial.velocity_field=velocty", &["has no data `velocty`", "did you mean `velocity`"]);
    refused(
        &vtu(&grid(2), &[("velocity", one)]),
        "",
        &["before.vtu: ", "have 1 number(s) at a node", "velocity has 2 or 3"],
    );
    refused(&vtu(&grid(2), &[("deformation", two)]), "", &["have 2 number(s)", "deformation has 4 or 9"]);
    refused(&vtu(&grid(2), &[("deformation", four)]), "", &["J = -1", "in cell 1"]);
    let deep: At = &|_| vec![1.0, 2.0, 3.0];
    refused(&vtu(&grid(2), &[("velocity", deep)]), "", &["leaves the plane at node 0"]);
    refused(&good.replace("1.0 2.0 1.0", "nan 2.0 1.0"), "", &["`velocity` is [NaN, 2.0] at node 0"]);
    // A mesh that ends before the body: the cell and the place.
    let (mut nodes, cells) = grid(2);
    nodes.iter_mut().for_each(|x| x[0] *= 0.5);
    let short = vtu(&(nodes, cells), &[("velocity", two)]);
    refused(
        &short,
        "",
        &["case.toml:11:10", "a grid node of cell 3 at X = (0.697", "give a file whose mesh covers the body"],
    );
    refused(&good.replace("9 9 9", "5 9 9"), "", &["before.vtu: ", "triangles"]);
    refused("", "", &["before.vtu: the file is empty"]);
    refused("x,y\n0,0\n", "", &["before.vtu: "]);
    refused(&good, "--set initial.fields=other.vtu", &["there is no file", "other.vtu"]);
    refused(&good, "--set initial.fields_time=1", &["a VTU file has one time only"]);
    let both = |sets: &str, what: &str| refused(&good, sets, &[what, "keep one"]);
    both("--set initial.velocity=[1,2] --set initial.velocity_field=velocity", "both `velocity` and `velocity_field`");
    both("--set initial.displacement_field=u --set initial.deformation_field=F", "both `deformation_field` and");
    both("--set initial.snapshot=a.h5", "both `snapshot` and `fields`");
    bench.write("case.toml", SCENE.replace("velocity = [\"-200\", \"0\"]", "velocity_field = \"v\""));
    refused(&good, "", &["there is no `fields`"]);
}

#[test]
fn an_export_of_a_higher_degree_is_no_file_of_bilinear_fields_and_the_message_says_what_is() {
    let bench = Bench::new();
    bench.run("run case.toml --set scheme.degree=2");
    bench.run("export runs/case");
    let scene = SCENE.replace("velocity = [\"-200\", \"0\"]", "fields = \"before.vtu\"");
    bench.write("on.toml", scene);
    let list = std::fs::read_dir(bench.path("runs/case/export")).unwrap().map(|file| file.unwrap().path());
    let grid = list.filter(|path| path.file_name().unwrap().to_str().unwrap().starts_with("grid_0")).min().unwrap();
    std::fs::copy(grid, bench.path("before.vtu")).unwrap();
    let message = bench.fail(2, "run on.toml");
    assert!(message.contains("of a higher degree than 1") && message.contains("from = \"cloud\""), "{message}");
    let message = bench.fail(2, "run on.toml --set initial.fields=runs/case/export/series.xdmf");
    assert!(message.contains("a series of fields of dgmpm") && message.contains("from = \"cloud\""), "{message}");
}
