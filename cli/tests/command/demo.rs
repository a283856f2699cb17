//! `decimesh demo`.

use crate::workbench::Workbench;

#[test]
fn demo_leaves_levels_and_a_picture() {
    let bench = Workbench::new();
    let text = bench.run_well("demo out --triangles 12000 --width 200");
    assert!(text.contains("RMS") && text.contains("demo.png"), "{text}");
    assert_eq!(
        bench.files(),
        ["out", "out/demo.png", "out/statue.ply", "out/statue_1.ply", "out/statue_2.ply"]
    );
    let statue = bench.read("out/statue.ply").triangles().len();
    for (level, reduction) in [(1, 10), (2, 100)] {
        let triangles = bench.read(&format!("out/statue_{level}.ply")).triangles().len();
        assert!((statue / reduction - 1..=statue / reduction).contains(&triangles), "{triangles}");
    }

    let mut reader =
        png::Decoder::new(std::io::Cursor::new(bench.bytes("out/demo.png"))).read_info().unwrap();
    assert_eq!(reader.info().width, 200);
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    // The statue is coloured, the background all but grey: both are to be seen.
    let colorful = |pixel: &&[u8]| pixel[0].abs_diff(pixel[2]) > 40;
    let share = pixels.chunks(3).filter(colorful).count() as f64 / (pixels.len() / 3) as f64;
    assert!((0.05..0.8).contains(&share), "{share}");
}

#[test]
fn failures_have_their_codes_and_change_nothing() {
    let bench = Workbench::new();
    std::fs::write(bench.path("file"), "in the way").unwrap();
    bench.run_badly("demo file --triangles 12000", 4, "cannot write file");
    bench.run_badly("demo out --triangles 10", 2, "--triangles");
}
