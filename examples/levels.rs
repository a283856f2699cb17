//! Builds levels of detail, and picks one for each distance by the error that it makes on the screen.
//!
//! ```sh
//! cargo run --release --example levels
//! ```

use decimesh::lod::View;
use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Simplified, Target, build_levels, coarsest_within};

/// What to draw: the coarsest level that is wrong by a pixel at most, or else the mesh itself.
fn choose<'a>(mesh: &'a Mesh, levels: &'a [Simplified], view: View, distance: f32) -> &'a Mesh {
    let errors = levels.iter().map(|level| level.error);
    match coarsest_within(errors, view.error_at(distance, 1.0)) {
        Some(level) => &levels[level].mesh,
        None => mesh,
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stone = shapes::bumpy_sphere(80, 1);

    // Each level has about 40 % of the triangles of the one before.
    let targets = [0.4, 0.16, 0.064, 0.0256, 0.01].map(Target::Ratio);
    let levels = build_levels(&stone, &targets, &Options::new(targets[0]), &mut Monitor::silent())?;
    println!("level  triangles  error\n    -  {:9}  0", stone.triangles().len());
    for (number, level) in levels.iter().enumerate() {
        println!("{number:5}  {:9}  {:.5}", level.mesh.triangles().len(), level.error);
    }

    // What a renderer does each frame, for each object.
    let view = View { fov: 1.0, height: 1080.0 };
    let mut last_triangles = stone.triangles().len();
    for distance in [0.5, 2.0, 8.0, 32.0, 128.0, 512.0] {
        let triangles = choose(&stone, &levels, view, distance).triangles().len();
        println!("from {distance} away, draw {triangles} triangles");
        if triangles > last_triangles {
            return Err("more triangles from farther away".into());
        }
        last_triangles = triangles;
    }
    if last_triangles > stone.triangles().len() / 50 {
        return Err("too many triangles from far away".into());
    }
    Ok(())
}
