//! Gradient noise after Perlin ("Improving Noise", SIGGRAPH 2002), with a hash in place of the
//! permutation table.
//!
//! Only sums, products and `floor`, so that every platform makes the same shapes, and no dependency
//! that would come along into every program which links the library.

/// Smooth noise in three dimensions: about -1 to 1, zero at whole coordinates, features one unit wide.
pub(super) fn gradient_noise(position: [f32; 3], seed: u32) -> f32 {
    let floor = position.map(f32::floor);
    let cell = floor.map(|x| x as i32);
    let [x, y, z]: [f32; 3] = std::array::from_fn(|axis| position[axis] - floor[axis]);
    let [u, v, w] = [x, y, z].map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let corner = |i: i32, j: i32, k: i32| {
        let hash = hash([cell[0].wrapping_add(i), cell[1].wrapping_add(j), cell[2].wrapping_add(k)], seed);
        slope(hash, x - i as f32, y - j as f32, z - k as f32)
    };
    let mix = |a: f32, b: f32, t: f32| a + t * (b - a);
    let edge = |j: i32, k: i32| mix(corner(0, j, k), corner(1, j, k), u);
    let side = |k: i32| mix(edge(0, k), edge(1, k), v);
    mix(side(0), side(1), w)
}

/// Octaves of noise, each of twice the frequency and half the height of the one before: about -1 to 1.
pub(super) fn fractal_noise(position: [f32; 3], octaves: u32, seed: u32) -> f32 {
    sum_octaves(position, octaves, seed, |noise| noise)
}

/// As [`fractal_noise`], but each octave is folded at zero, which makes sharp ridges: about -1 to 1.
pub(super) fn ridged_noise(position: [f32; 3], octaves: u32, seed: u32) -> f32 {
    sum_octaves(position, octaves, seed, |noise| 1.0 - 4.0 * noise.abs())
}

fn sum_octaves(position: [f32; 3], octaves: u32, seed: u32, shape: impl Fn(f32) -> f32) -> f32 {
    let mut sum = 0.0;
    let mut frequency = 1.0;
    for octave in 0..octaves {
        let noise = gradient_noise(position.map(|x| x * frequency), seed.wrapping_add(octave));
        sum += shape(noise) * 0.5 / frequency;
        frequency *= 2.0;
    }
    sum
}

/// The product of the offset with one of the twelve directions to the middles of a cube's edges.
fn slope(hash: u32, x: f32, y: f32, z: f32) -> f32 {
    let (a, b) = match hash >> 30 {
        0 => (x, y),
        1 => (y, z),
        2 => (z, x),
        _ => return if hash & 4 == 0 { x + y } else { z - y },
    };
    let a = if hash & 1 == 0 { a } else { -a };
    let b = if hash & 2 == 0 { b } else { -b };
    a + b
}

fn hash(cell: [i32; 3], seed: u32) -> u32 {
    // One odd factor an axis, then the finalizer of MurmurHash3, which lets each bit reach all others.
    let [x, y, z] = cell.map(|x| x as u32);
    let mut hash = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ z.wrapping_mul(0xC2B2_AE3D);
    hash ^= seed.wrapping_mul(0x27D4_EB2F);
    hash = (hash ^ hash >> 16).wrapping_mul(0x85EB_CA6B);
    hash = (hash ^ hash >> 13).wrapping_mul(0xC2B2_AE35);
    hash ^ hash >> 16
}
