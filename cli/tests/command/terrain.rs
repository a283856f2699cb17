//! `decimesh terrain`, `decompose` and `extract`.

use decimesh::Mesh;

use crate::workbench::{Workbench, count, number};

const COLUMNS: usize = 70;
const ROWS: usize = 45;

/// Hills of a hundred metres and some roughness, all above -200.
fn height(column: usize, row: usize) -> f32 {
    let (x, y) = (column as f32, row as f32);
    let rough = (column * 7919 + row * 104_729) % 13;
    100.0 * (x * 0.13).sin() * (y * 0.17).cos() + rough as f32
}

/// The same heights in three files: raw, GeoTIFF's plain cousin (.npy), and a PNG of tenths above -500.
fn bench() -> Workbench {
    let bench = Workbench::new();
    let heights: Vec<f32> =
        (0..COLUMNS * ROWS).map(|sample| height(sample % COLUMNS, sample / COLUMNS)).collect();
    let bytes: Vec<u8> = heights.iter().flat_map(|height| height.to_le_bytes()).collect();
    std::fs::write(bench.path("hills.f32"), &bytes).unwrap();
    std::fs::write(bench.path("hills.bin"), &bytes).unwrap();
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({ROWS}, {COLUMNS}), }}\n");
    let length = (header.len() as u16).to_le_bytes();
    let npy = [b"\x93NUMPY\x01\0", &length[..], header.as_bytes(), &bytes].concat();
    std::fs::write(bench.path("hills.npy"), npy).unwrap();
    let tenths = heights.iter().flat_map(|height| (((height + 500.0) * 10.0).round() as u16).to_be_bytes());
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, COLUMNS as u32, ROWS as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&tenths.collect::<Vec<_>>()).unwrap();
    writer.finish().unwrap();
    std::fs::write(bench.path("hills.png"), png).unwrap();
    bench
}

/// The greatest vertical distance of any sample of the hills from a mesh that is `spacing` times as large.
fn largest_error(mesh: &Mesh, [dx, dy]: [f32; 2]) -> f64 {
    let place = |vertex: u32| {
        let [x, y, z] = mesh.positions()[vertex as usize];
        [f64::from(x / dx).round(), (ROWS - 1) as f64 - f64::from(y / dy).round(), f64::from(z)]
    };
    let mut largest = 0.0f64;
    let mut covered = vec![false; COLUMNS * ROWS];
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(place);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        // Rows count southwards.
        assert!(area < 0.0, "counter-clockwise from above");
        for sample in 0..COLUMNS * ROWS {
            let (x, y) = ((sample % COLUMNS) as f64, (sample / COLUMNS) as f64);
            let part =
                |p: [f64; 3], q: [f64; 3]| ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area;
            let parts = [part(b, c), part(c, a), part(a, b)];
            if parts.iter().all(|&part| part >= -1e-9) {
                let surface = parts[0] * a[2] + parts[1] * b[2] + parts[2] * c[2];
                let sample_height = height(sample % COLUMNS, sample / COLUMNS);
                largest = largest.max((surface - f64::from(sample_height)).abs());
                covered[sample] = true;
            }
        }
    }
    assert!(covered.iter().all(|&covered| covered));
    largest
}

#[test]
fn wishes_are_met_and_reported() {
    let bench = bench();
    let samples = COLUMNS * ROWS;
    for (wish, vertices) in [("--vertices 400", 400), ("--ratio 0.1", samples / 10)] {
        let text = bench.run_well(&format!("terrain hills.npy out.ply {wish} --report report.json"));
        assert!(text.contains("3,150 samples ->"), "{text}");
        let (report, mesh) = (bench.json("report.json"), bench.read("out.ply"));
        assert_eq!(count(&report, "samples"), samples);
        assert_eq!(count(&report, "vertices_out"), mesh.positions().len());
        assert_eq!(count(&report, "triangles_out"), mesh.triangles().len());
        assert!((vertices - 60..=vertices).contains(&mesh.positions().len()), "{}", mesh.positions().len());
        assert!((number(&report, "max") - largest_error(&mesh, [1.0; 2])).abs() < 1e-3);
        assert!(number(&report, "rms") > 0.0 && number(&report, "rms") < number(&report, "max"));
        let range = (0..samples).map(|sample| height(sample % COLUMNS, sample / COLUMNS));
        let range = range.clone().fold(f32::MIN, f32::max) - range.fold(f32::MAX, f32::min);
        let psnr = 20.0 * (f64::from(range) / number(&report, "rms")).log10();
        assert!((number(&report, "psnr_db") - psnr).abs() < 1e-6);
        assert!((0.0..1.0).contains(&number(&report, "certified_gap_db")));
        for name in ["seconds", "seconds_read", "seconds_write"] {
            assert!(number(&report, name) >= 0.0);
        }
        assert!(count(&report, "peak_bytes") > samples * 8);
    }
    bench.run_well("terrain hills.npy out.ply --rms 4 --report report.json --quiet");
    assert!(number(&bench.json("report.json"), "rms") <= 4.0);
    bench.run_well("terrain hills.npy out.ply --max-error 9 --report report.json --quiet");
    let largest = number(&bench.json("report.json"), "max");
    assert!(largest <= 9.0 && (largest - largest_error(&bench.read("out.ply"), [1.0; 2])).abs() < 1e-3);
    // All samples have no error, and what that is in decibels JSON cannot say.
    bench.run_well("terrain hills.npy out.ply --ratio 1 --report report.json --quiet");
    assert!(bench.json("report.json")["psnr_db"].is_null());
}

#[test]
fn all_files_of_the_same_heights_make_the_same_mesh() {
    let bench = bench();
    let raw = format!("--size {COLUMNS}x{ROWS}");
    bench.run_well("terrain hills.npy npy.glb --vertices 500 --spacing 30,25");
    bench.run_well(&format!("terrain hills.f32 f32.glb --vertices 500 --spacing 30,25 {raw}"));
    bench.run_well(&format!("terrain hills.bin bin.glb --vertices 500 --spacing 30,25 {raw} --sample f32"));
    for other in ["f32.glb", "bin.glb"] {
        assert_eq!(bench.bytes("npy.glb"), bench.bytes(other));
    }
    assert!(bench.read("npy.glb").attributes().uvs.is_some());
    assert!(largest_error(&bench.read("npy.glb"), [30.0, 25.0]) < 30.0);
    bench.run_well("terrain hills.png png.ply --ratio 1 --scale 0.1 --offset -500");
    assert!(largest_error(&bench.read("png.ply"), [1.0; 2]) < 0.051);
}

#[test]
fn voids_have_no_triangles() {
    let bench = bench();
    // The one sample at this height, and nothing else, is not known.
    let void = height(35, 20);
    bench.run_well(&format!("terrain hills.npy out.ply --ratio 1 --no-data {void:?} --report report.json"));
    let samples = count(&bench.json("report.json"), "samples");
    assert!(samples < COLUMNS * ROWS);
    assert!(bench.read("out.ply").positions().iter().all(|&[_, _, z]| z != void));
    let outcome = bench.run(&format!("terrain hills.npy out.ply --vertices 5 --no-data {void:?} --quiet"));
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""));
    assert!(outcome.stderr.contains("more than asked for: with fewer, triangles would lie over voids"));
}

#[test]
fn hierarchies_give_what_terrain_gives() {
    let bench = bench();
    let text = bench.run_well("decompose hills.npy hills.drd --spacing 3 --report report.json");
    assert!(text.contains("3,150 samples decomposed"), "{text}");
    assert_eq!(count(&bench.json("report.json"), "bytes"), bench.bytes("hills.drd").len());
    for wish in ["--vertices 300", "--ratio 0.4", "--rms 5", "--max-error 12"] {
        bench.run_well(&format!("terrain hills.npy direct.ply {wish} --spacing 3 --report direct.json"));
        bench.run_well(&format!("extract hills.drd stored.ply {wish} --report stored.json"));
        assert_eq!(bench.bytes("direct.ply"), bench.bytes("stored.ply"), "{wish}");
        let (direct, stored) = (bench.json("direct.json"), bench.json("stored.json"));
        for name in ["rms", "max", "psnr_db", "certified_gap_db", "vertices_out", "samples"] {
            assert_eq!(direct[name], stored[name], "{wish} {name}");
        }
    }
    bench.run_well("decompose hills.npy one.drd --spacing 3 --threads 1 --quiet");
    assert_eq!(bench.bytes("one.drd"), bench.bytes("hills.drd"));
}

#[test]
fn free_triangles_are_closer() {
    let bench = bench();
    let error = |line: &str| {
        bench.run_well(&format!("terrain hills.npy out.ply --vertices 400 --report report.json {line}"));
        let (report, mesh) = (bench.json("report.json"), bench.read("out.ply"));
        assert!(mesh.positions().len() <= 400 && mesh.attributes().uvs.is_some());
        assert!((number(&report, "max") - largest_error(&mesh, [1.0; 2])).abs() < 1e-3);
        number(&report, "rms")
    };
    let (nested, free, fitted) = (error(""), error("--tin"), error("--tin --least-squares"));
    assert!(fitted < free && free < nested, "{nested} {free} {fitted}");
    assert!(bench.json("report.json")["certified_gap_db"].is_null());
}

#[test]
fn curves_are_drawn() {
    let bench = bench();
    bench.run_well("terrain hills.npy out.ply --ratio 0.1 --plot curve.png");
    let decoder = png::Decoder::new(std::io::Cursor::new(bench.bytes("curve.png")));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    // Each curve is there, by its colour.
    for color in [[0, 158, 115], [213, 94, 0], [0, 114, 178]] {
        let there = pixels.as_chunks().0.iter().filter(|&pixel| *pixel == color).count();
        assert!(there > 500, "{there} pixels of {color:?}");
    }
    // Flat ground has no curve, and is no failure.
    std::fs::write(bench.path("flat.f32"), [0; 4 * 9]).unwrap();
    bench.run_well("terrain flat.f32 out.ply --ratio 1 --size 3x3 --plot flat.png");
    assert!(bench.bytes("flat.png").starts_with(b"\x89PNG"));
}

#[test]
fn failures_have_their_codes_and_change_nothing() {
    let bench = bench();
    let bytes = bench.bytes("hills.npy");
    std::fs::write(bench.path("cut.npy"), &bytes[..bytes.len() / 2]).unwrap();
    std::fs::write(bench.path("thin.f32"), [0; 20]).unwrap();
    bench.run_badly("terrain hills.npy out.ply", 2, "--vertices");
    bench.run_badly("terrain hills.npy out.ply --ratio 1 --rms 1", 2, "--ratio");
    bench.run_badly("terrain hills.f32 out.ply --ratio 1 --size 70", 2, "with an x between");
    bench.run_badly("terrain hills.f32 out.ply --ratio 1 --sample f32", 2, "--size");
    bench.run_badly("terrain missing.png out.ply --ratio 1", 3, "cannot read missing.png");
    bench.run_badly("terrain hills.ply out.ply --ratio 1", 3, "none of png, tif, tiff, npy");
    bench.run_badly("terrain hills.f32 out.ply --ratio 1", 3, "columns and rows are not told");
    bench.run_badly("terrain hills.f32 out.ply --ratio 1 --size 70x46", 3, "samples are promised");
    bench.run_badly("terrain cut.npy out.ply --ratio 1", 3, "cut.npy: byte");
    bench.run_badly("terrain hills.npy out.xyz --ratio 1", 4, "out.xyz");
    bench.run_badly("terrain hills.npy nowhere/out.ply --ratio 1", 4, "nowhere/out.ply");
    bench.run_badly("terrain hills.npy out.ply --ratio 1 --plot nowhere/a.png", 4, "nowhere/a.png");
    bench.run_badly("terrain hills.npy out.ply --ratio 1.5", 5, "ratio 1.5 is not allowed");
    bench.run_badly("terrain hills.npy out.ply --max-error -1", 5, "maximum error -1 is not allowed");
    bench.run_badly("terrain hills.npy out.ply --ratio 1 --spacing 0", 5, "must be positive and finite");
    bench.run_badly("terrain thin.f32 out.ply --ratio 1 --size 5x1", 5, "two of each are the least");
    bench.run_badly("terrain thin.f32 out.ply --ratio 1 --size 5x1 --no-data 0", 5, "thin.f32");
    bench.run_badly("terrain hills.npy out.ply --rms 1 --tin", 5, "--tin is for --vertices and --ratio");
    bench.run_badly("terrain hills.npy out.ply --ratio 2 --tin", 5, "ratio 2 is not allowed");
    bench.run_badly("terrain hills.npy out.ply --ratio 1 --least-squares", 2, "--tin");
    bench.run_badly("decompose hills.npy nowhere/out.drd", 4, "nowhere/out.drd");
    bench.run_badly("extract hills.npy out.ply --ratio 1", 3, "this is no hierarchy file");
    bench.run_badly("extract missing.drd out.ply --ratio 1", 3, "cannot read missing.drd");
    bench.run_well("decompose hills.npy hills.drd");
    bench.run_badly("extract hills.drd out.ply --rms -2", 5, "RMS -2 is not allowed");
}

#[test]
fn tiles_make_a_pyramid_without_cracks() {
    let bench = bench();
    bench.run_well(
        "terrain-tiles hills.npy tiles --ratio 0.3 --tile 16 --format ply --spacing 2 --report report.json",
    );
    let index = bench.json("tiles/tiles.json");
    let levels = index["levels"].as_array().unwrap();
    assert_eq!(levels.len(), 4);
    let tiles = |level: usize| levels[level]["tiles"].as_array().unwrap();
    assert_eq!((0..4).map(|level| tiles(level).len()).collect::<Vec<_>>(), [15, 6, 2, 1]);
    let mut finer = 0.0;
    for (level, record) in levels.iter().enumerate() {
        assert!(number(record, "rms") >= finer && number(record, "max") > number(record, "rms"));
        finer = number(record, "rms");
        // All triangles of a level together are one surface over the whole field, whose rim is that of the field.
        let mut edges = std::collections::HashMap::new();
        let mut area = 0.0;
        for tile in tiles(level) {
            let mesh = bench.read(&format!("tiles/{}", tile["file"].as_str().unwrap()));
            assert_eq!(count(tile, "triangles"), mesh.triangles().len());
            for triangle in mesh.triangles() {
                let corners = triangle.map(|vertex| mesh.positions()[vertex as usize]);
                let [a, b, c] = corners;
                area += f64::from((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
                let key = |corner: [f32; 3]| corner.map(f32::to_bits);
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((key(from), key(to))).or_insert(0) += 1;
                }
            }
        }
        assert_eq!(area, (4 * (COLUMNS - 1) * (ROWS - 1)) as f64);
        let (right, top) = (2.0 * (COLUMNS - 1) as f32, 2.0 * (ROWS - 1) as f32);
        for (&(from, to), &times) in &edges {
            assert_eq!(times, 1);
            let [from_x, from_y, _] = from.map(f32::from_bits);
            let [to_x, to_y, _] = to.map(f32::from_bits);
            let is_rim = (from_x == to_x && (from_x == 0.0 || from_x == right))
                || (from_y == to_y && (from_y == 0.0 || from_y == top));
            assert!(is_rim || edges.contains_key(&(to, from)), "a crack");
        }
    }
    // Threads, and whether the samples lie open in the file, change nothing.
    bench.run_well(
        "terrain-tiles hills.npy other --ratio 0.3 --tile 16 --format ply --spacing 2 --threads 3 --levels 1",
    );
    assert_eq!(bench.bytes("other/0/1-2.ply"), bench.bytes("tiles/0/1-2.ply"));
    assert_eq!(bench.json("other/tiles.json")["levels"].as_array().unwrap().len(), 1);
    bench.run_badly("terrain-tiles hills.npy other --ratio 0.3 --tile 17", 5, "must be a power of two");
    bench.run_badly("terrain-tiles hills.npy other --ratio 0", 5, "above 0 and at most 1");
    bench.run_badly("terrain-tiles hills.npy other --ratio 1 --format xyz", 2, "names no format");
    bench.run_badly("terrain-tiles missing.npy other --ratio 1", 3, "cannot read missing.npy");
}
