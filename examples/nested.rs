//! Builds levels of detail that share one vertex buffer, and draws one and the next with a morph between.
//!
//! ```sh
//! cargo run --release --example nested
//! ```

use decimesh::lod::{NestedLevels, Player, Progressive, View};
use decimesh::mesh::shapes;
use decimesh::{Monitor, Options, Target};

/// What goes to the GPU for `level`, between itself (`morph` 0) and the next coarser one (1).
fn positions(levels: &NestedLevels, level: usize, morph: f32) -> Vec<[f32; 3]> {
    let all = levels.mesh().positions();
    let goals = levels.levels()[level].morphs.iter().map(|&vertex| all[vertex as usize]);
    let between = |from: &[f32; 3], goal: [f32; 3]| {
        std::array::from_fn(|axis| from[axis] + morph * (goal[axis] - from[axis]))
    };
    all.iter().zip(goals).map(|(from, goal)| between(from, goal)).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stone = shapes::bumpy_sphere(80, 1);
    let targets = [0.4, 0.16, 0.064, 0.0256, 0.01].map(Target::Ratio);
    let options = Options::new(targets[0]);
    let levels = NestedLevels::build(&stone, &targets, &options, &mut Monitor::silent())?;

    // The vertex buffer is uploaded once, in the order of `levels.mesh()`. A level needs its prefix only: a
    // program that streams loads the coarse end first.
    println!("level  triangles  vertices  error");
    for (number, level) in levels.levels().iter().enumerate() {
        let triangles = levels.triangles(number);
        println!("{number:5}  {:9}  {:8}  {:.5}", triangles.len(), level.vertices, level.error);
    }

    // What a renderer does each frame, for each object: an error of a pixel is not seen.
    let view = View { fov: 1.0, height: 1080.0 };
    for distance in [2.0, 8.0, 32.0, 128.0] {
        let level = levels.coarsest_within(view.error_at(distance, 1.0));
        println!("from {distance} away, draw level {level}");
    }
    let halfway = positions(&levels, 1, 0.5);
    println!("level 1, half way to level 2: {} vertices", halfway.len());

    // Every count in between, from the same collapses: a player goes from level to level by what changes.
    let progressive = Progressive::build(&stone, &targets, &options, &mut Monitor::silent())?;
    let mut player = Player::new(&progressive);
    for triangles in [1000, 20_000, 5000] {
        player.go_to(progressive.step_within(triangles));
        println!("at most {triangles}: {} triangles", player.triangles().len());
        if player.triangles().len() > triangles {
            return Err("more triangles than asked for".into());
        }
    }
    Ok(())
}
