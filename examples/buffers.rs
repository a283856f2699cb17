//! Simplifies the buffers of an engine: fewer indices over the same vertices, so that all levels of detail
//! share one vertex buffer.
//!
//! ```sh
//! cargo run --release --example buffers
//! ```

use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Placement, StoppedBy, Target, simplify};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // What an engine has: positions, and three indices a triangle.
    let hills = shapes::height_field(200, |x, y| 0.06 * (25.0 * x).sin() + 0.04 * (20.0 * y).cos())?;
    let positions: &[[f32; 3]] = hills.positions();
    let indices: &[u32] = hills.triangles().as_flattened();

    let mesh = Mesh::from_buffers(positions, indices)?;
    let options = Options {
        placement: Placement::Existing,
        // The next tile of the landscape still fits.
        lock_boundary: true,
        track_sources: true,
        ..Options::new(Target::Ratio(0.1))
    };
    let result = simplify(&mesh, &options, &mut Monitor::silent())?;

    // A result has vertices of its own; their sources are those of the engine.
    let sources = result.sources.ok_or("no sources")?;
    let corners = result.mesh.triangles().as_flattened();
    let fewer: Vec<u32> = corners.iter().map(|&vertex| sources[vertex as usize]).collect();
    println!(
        "{} triangles became {}, within about {:.5}; {} vertices of the border stayed",
        indices.len() / 3,
        fewer.len() / 3,
        result.error,
        result.locked
    );

    // A target that cannot be met is no error; the result says so.
    if result.stopped_by != StoppedBy::Target {
        return Err("the target was missed".into());
    }
    let is_engines =
        |(&own, &engines): (&u32, &u32)| result.mesh.positions()[own as usize] == positions[engines as usize];
    if !corners.iter().zip(&fewer).all(is_engines) {
        return Err("a vertex is not one of the engine's".into());
    }
    Ok(())
}
