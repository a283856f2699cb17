//! Builds levels of detail, and picks one for each distance by the error that it makes on the screen.
//!
//! ```sh
//! cargo run --release --example levels
//! ```

use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Simplified, Target, build_levels, coarsest_within};

struct Camera {
    /// Vertical field of view, in radians.
    fov: f32,
    /// Of the screen, in pixels.
    height: f32,
}

impl Camera {
    /// The error, in units of the mesh, that covers so many pixels.
    ///
    /// At a distance d the camera sees a slice of the world that is 2 d tan(fov / 2) high, on a screen of
    /// `height` pixels. So one pixel is 2 d tan(fov / 2) / height.
    ///
    /// d is the distance to the nearest point of the object, such as that to the middle of its bounding
    /// sphere less the radius: there the error looks largest.
    fn error_of(&self, pixels: f32, distance: f32) -> f32 {
        pixels * 2.0 * distance * (self.fov / 2.0).tan() / self.height
    }
}

/// What to draw: the coarsest level that is wrong by a pixel at most, or else the mesh itself.
fn choose<'a>(mesh: &'a Mesh, levels: &'a [Simplified], camera: &Camera, distance: f32) -> &'a Mesh {
    let errors = levels.iter().map(|level| level.error);
    match coarsest_within(errors, camera.error_of(1.0, distance)) {
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
    let camera = Camera { fov: 1.0, height: 1080.0 };
    let mut last_triangles = stone.triangles().len();
    for distance in [0.5, 2.0, 8.0, 32.0, 128.0, 512.0] {
        let triangles = choose(&stone, &levels, &camera, distance).triangles().len();
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
