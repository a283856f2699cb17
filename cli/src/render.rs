//! A picture of meshes side by side: a small ray tracer with a soft key light, sky light and the
//! edges of the triangles where they are large enough to be seen.
//!
//! Meshes face the viewer with their +z axis, +x up, and are turned a little.

use std::f32::consts::TAU;
use std::path::Path;
use std::time::Duration;

use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};
use decimesh::{Cancelled, Mesh, Monitor};
use glam::{Quat, Vec2, Vec3A, vec2, vec3a};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use rayon::prelude::*;

use crate::failure::Failure;
use crate::progress::Progress;
use crate::report::write_atomically;

/// A mesh to draw, and what to write below it.
pub(crate) struct Exhibit<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) title: String,
    pub(crate) subtitle: String,
}

/// Rows of red, green, blue, from the top.
struct Picture {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

/// Samples a pixel.
const SAMPLES: usize = 16;
/// Rows between two reports of progress.
const BAND: usize = 16;

/// How the meshes are turned about the vertical, and how steeply the camera looks down.
const YAW: f32 = 0.38;
const PITCH: f32 = 0.20;

const SKIN: Vec3A = vec3a(0.70, 0.33, 0.19);
const KEY_COLOR: Vec3A = vec3a(1.62, 1.48, 1.26);
const FILL: Vec3A = vec3a(0.80, 0.10, 0.59);
const FILL_COLOR: Vec3A = vec3a(0.32, 0.40, 0.56);
const SKY_COLOR: Vec3A = vec3a(0.34, 0.39, 0.47);
const GROUND_COLOR: Vec3A = vec3a(0.25, 0.22, 0.20);
const INK: [f32; 3] = [52.0, 56.0, 66.0];
/// Share of the light that a shadow on the floor takes away.
const FLOOR_SHADOW: f32 = 0.42;
/// Share of it that blocked sky takes away.
const FLOOR_OCCLUSION: f32 = 0.55;
/// Pixels around a pixel that tell of its floor's light.
const FLOOR_RADIUS: usize = 4;
/// Radius of the key light's disc at distance 1: the softness of shadows.
const KEY_RADIUS: f32 = 0.10;
/// Sky light that is blocked farther away than this share of the height still counts as open.
const SKY_REACH: f32 = 0.6;
/// Edges are drawn fully where triangles' mean edge is longer than the second, and not at all below
/// the first. In pixels.
const EDGE_LENGTHS: [f32; 2] = [2.0, 14.0];
const EDGE_WIDTH: f32 = 1.1;
/// Share of the light that an edge takes away.
const EDGE_INK: f32 = 0.62;

/// Draws `exhibits` in a row, and writes them as a PNG at `path`. The first one sets the scale of all.
pub(crate) fn write(
    exhibits: &[Exhibit],
    width: usize,
    path: &Path,
    progress: &Progress,
) -> Result<(), Failure> {
    let picture = progress
        .during("drawing", |monitor| draw(exhibits, width, monitor))
        .map_err(|error| Failure::Unexpected(error.to_string()))?;
    let png = picture.png().map_err(|error| Failure::Unexpected(error.to_string()))?;
    write_atomically(path, &png)
}

fn draw(exhibits: &[Exhibit], width: usize, monitor: &mut Monitor) -> Result<Picture, Cancelled> {
    let scene = Scene::new(exhibits, width);
    let height = scene.height_in_pixels();
    let mut seen = Vec::with_capacity(width * height);
    for band in (0..height).step_by(BAND) {
        let rows = band..height.min(band + BAND);
        let places = rows.into_par_iter().flat_map_iter(|y| (0..width).map(move |x| (x, y)));
        seen.par_extend(places.map(|(x, y)| scene.look(x, y)));
        monitor.report(band as f32 / height as f32)?;
    }
    let pixels = (0..width * height).into_par_iter().map(|k| {
        let floor = floor_light(&seen, width, k);
        let color = seen[k].surface + scene.background(k % width, k / width) * floor * seen[k].floor_share();
        color.to_array().map(encode)
    });
    let pixels = pixels.collect();
    let mut picture = Picture { width, height, pixels };
    for (column, exhibit) in exhibits.iter().enumerate() {
        let middle = (column as f32 + 0.5) * width as f32 / exhibits.len() as f32;
        let unit = scene.caption_size();
        picture.write(&exhibit.title, middle, height as f32 - 2.25 * unit, unit);
        picture.write(&exhibit.subtitle, middle, height as f32 - 1.05 * unit, 0.72 * unit);
    }
    Ok(picture)
}

impl Picture {
    /// The picture as a PNG file's bytes.
    fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_compression(png::Compression::High);
        encoder.write_header()?.write_image_data(self.pixels.as_flattened())?;
        Ok(bytes)
    }

    /// Writes one line of text, its baseline at `baseline` and its middle at `middle`.
    fn write(&mut self, text: &str, middle: f32, baseline: f32, size: f32) {
        let Ok(font) = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT) else { return };
        let font = font.as_scaled(PxScale::from(size));
        let mut glyphs: Vec<Glyph> = Vec::new();
        let mut end = 0.0;
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            end += glyphs.last().map_or(0.0, |last| font.kern(last.id, id));
            glyphs.push(id.with_scale_and_position(font.scale(), point(end, baseline)));
            end += font.h_advance(id);
        }
        for mut glyph in glyphs {
            glyph.position.x += middle - end / 2.0;
            let Some(outline) = font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|x, y, coverage| {
                let (x, y) = (corner.x as i64 + i64::from(x), corner.y as i64 + i64::from(y));
                if (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y) {
                    let pixel = &mut self.pixels[y as usize * self.width + x as usize];
                    for (channel, ink) in pixel.iter_mut().zip(INK) {
                        *channel = (f32::from(*channel) * (1.0 - coverage) + ink * coverage) as u8;
                    }
                }
            });
        }
    }
}

/// All meshes in one space: x to the right, y up, z to the viewer; the floor is at y = 0, the first
/// mesh is 1 high.
struct Scene {
    triangles: Vec<Triangle>,
    tree: CwBvh,
    /// For each mesh, the first triangle after it, and how strongly its edges are drawn.
    meshes: Vec<(usize, f32)>,
    camera: Camera,
    key: Vec3A,
}

/// What the samples of a pixel saw.
#[derive(Clone, Copy, Default)]
struct Seen {
    /// Light from meshes, their share of the pixel taken into account.
    surface: Vec3A,
    /// Sum over the samples that saw the floor.
    floor_light: f32,
    floor_samples: f32,
}

impl Seen {
    fn floor_share(&self) -> f32 {
        self.floor_samples / SAMPLES as f32
    }
}

/// An orthographic camera: all meshes are seen from the same side.
struct Camera {
    right: Vec3A,
    up: Vec3A,
    forward: Vec3A,
    /// On the image plane, the left upper corner of the picture.
    corner: Vec2,
    pixel: f32,
    size: Vec2,
}

impl Scene {
    fn new(exhibits: &[Exhibit], width: usize) -> Self {
        let turn = Quat::from_rotation_y(YAW);
        let upright = |[x, y, z]: [f32; 3]| turn * vec3a(-y, x, z);
        let triangles = |exhibit: &Exhibit| -> Vec<Triangle> {
            let positions = exhibit.mesh.positions();
            let corners = exhibit.mesh.triangles().iter().map(|t| t.map(|v| upright(positions[v as usize])));
            corners.map(|[v0, v1, v2]| Triangle { v0, v1, v2 }).collect()
        };
        let mut groups: Vec<Vec<Triangle>> = exhibits.iter().map(triangles).collect();
        let (low, high) = bounds(groups.first().map_or(&[], Vec::as_slice));
        let scale = 1.0 / (high.y - low.y).max(f32::MIN_POSITIVE);
        let pitch = ((high.x - low.x) * scale * 1.13).max(0.35);
        let foot = vec3a((low.x + high.x) / 2.0, low.y, (low.z + high.z) / 2.0);
        let half_depth = (high.z - low.z) / 2.0 * scale;
        for (column, group) in groups.iter_mut().enumerate() {
            let place = vec3a((column as f32 + 0.5) * pitch, 0.0, 0.0);
            for corner in group.iter_mut().flat_map(|t| [&mut t.v0, &mut t.v1, &mut t.v2]) {
                *corner = (*corner - foot) * scale + place;
            }
        }
        let camera = Camera::new(width, pitch * exhibits.len() as f32, half_depth);
        let mut meshes = Vec::new();
        let mut end = 0;
        for group in &groups {
            end += group.len();
            meshes.push((end, edge_strength(group, camera.pixel)));
        }
        let triangles = groups.concat();
        let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::fast_build(), &mut Duration::default());
        Self { triangles, tree, meshes, camera, key: vec3a(-0.55, 1.0, 0.62).normalize() }
    }

    fn height_in_pixels(&self) -> usize {
        (self.camera.size.y / self.camera.pixel) as usize
    }

    fn caption_size(&self) -> f32 {
        0.058 / self.camera.pixel
    }

    /// What is seen through a pixel.
    fn look(&self, x: usize, y: usize) -> Seen {
        let samples = Samples::of_pixel(x, y);
        let mut seen = Seen::default();
        for k in 0..SAMPLES {
            let place = vec2(x as f32, y as f32) + samples.at(Samples::PLACE, k);
            let random = [samples.at(Samples::KEY, k), samples.at(Samples::SKY, k)];
            let ray = self.camera.ray(place);
            let mut hit = RayHit::none();
            let intersect = |ray: &Ray, k: usize| self.triangles[self.index(k)].intersect(ray);
            if self.tree.ray_traverse(ray, &mut hit, intersect) {
                let index = self.index(hit.primitive_id as usize);
                seen.surface += self.shade(index, &ray, hit.t, place, random) / SAMPLES as f32;
            } else {
                let floor = ray.origin - ray.direction * (ray.origin.y / ray.direction.y);
                let [key, sky] = self.light(floor, Vec3A::Y, random);
                seen.floor_light += 1.0 - FLOOR_SHADOW * (1.0 - key) - FLOOR_OCCLUSION * (1.0 - sky);
                seen.floor_samples += 1.0;
            }
        }
        seen
    }

    /// The light that comes from a place on a triangle to the camera.
    fn shade(&self, index: usize, ray: &Ray, distance: f32, place: Vec2, random: [Vec2; 2]) -> Vec3A {
        let triangle = &self.triangles[index];
        let normal = triangle.compute_normal();
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        let [key, sky] = self.light(ray.origin + ray.direction * distance, normal, random);
        let ambient = GROUND_COLOR.lerp(SKY_COLOR, 0.5 + 0.5 * normal.y);
        let fill = FILL_COLOR * normal.dot(FILL).max(0.0);
        let light = KEY_COLOR * (key * normal.dot(self.key).max(0.0)) + (ambient + fill) * sky;
        let mesh = self.meshes.partition_point(|&(end, _)| end <= index);
        let ink = if self.on_edge(triangle, place) { EDGE_INK * self.meshes[mesh].1 } else { 0.0 };
        SKIN * light * (1.0 - ink)
    }

    /// How much of the key light and of the sky reaches `place`, each 0 to 1.
    fn light(&self, place: Vec3A, normal: Vec3A, random: [Vec2; 2]) -> [f32; 2] {
        const OFFSET: f32 = 1e-4;
        let origin = place + normal * OFFSET;
        let free = |direction: Vec3A, reach: f32| {
            let ray = Ray::new(origin, direction, OFFSET, reach);
            self.tree.ray_traverse_miss(ray, |ray, k| self.triangles[self.index(k)].intersect(ray))
        };
        let (across, along) = self.key.any_orthonormal_pair();
        let disc = in_disc(random[0]) * KEY_RADIUS;
        let key = normal.dot(self.key) > 0.0
            && free((self.key + across * disc.x + along * disc.y).normalize(), 1e3);
        // A disc lifted to the hemisphere above it: directions as likely as the cosine to the normal.
        let disc = in_disc(random[1]);
        let (across, along) = normal.any_orthonormal_pair();
        let rise = (1.0 - disc.length_squared()).max(0.0).sqrt();
        let sky = free((across * disc.x + along * disc.y + normal * rise).normalize(), SKY_REACH);
        [f32::from(u8::from(key)), f32::from(u8::from(sky))]
    }

    /// Whether `place` lies on an edge of `triangle` as drawn.
    fn on_edge(&self, triangle: &Triangle, place: Vec2) -> bool {
        let corners = [triangle.v0, triangle.v1, triangle.v2].map(|corner| self.camera.project(corner));
        (0..3).any(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let along = b - a;
            let t = ((place - a).dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
            (a + along * t).distance(place) < EDGE_WIDTH / 2.0
        })
    }

    fn index(&self, position: usize) -> usize {
        self.tree.primitive_indices[position] as usize
    }

    /// A wall that is lighter behind the meshes and a little darker towards the corners.
    fn background(&self, x: usize, y: usize) -> Vec3A {
        let size = self.camera.size / self.camera.pixel;
        let place = vec2(x as f32, y as f32);
        let from_middle = (place / size - vec2(0.5, 0.42)) * vec2(1.0, 0.9);
        let shade = (from_middle.length_squared() * 1.3).min(1.0);
        vec3a(0.90, 0.905, 0.91).lerp(vec3a(0.60, 0.63, 0.68), shade)
    }
}

impl Camera {
    /// A camera that sees the row of `length` in `width` pixels, meshes of height 1 and a caption.
    fn new(width: usize, length: f32, half_depth: f32) -> Self {
        let (sin, cos) = PITCH.sin_cos();
        let pixel = length / width as f32;
        let (top, bottom) = (cos + half_depth * sin + 0.09, half_depth * sin + 0.24);
        Self {
            right: Vec3A::X,
            up: vec3a(0.0, cos, -sin),
            forward: vec3a(0.0, -sin, -cos),
            corner: vec2(0.0, top),
            pixel,
            size: vec2(length, top + bottom),
        }
    }

    fn ray(&self, place: Vec2) -> Ray {
        const BACK: f32 = 10.0;
        let on_plane = self.corner + vec2(place.x, -place.y) * self.pixel;
        let origin = self.right * on_plane.x + self.up * on_plane.y - self.forward * BACK;
        Ray::new_inf(origin, self.forward)
    }

    /// Where a point of the scene appears in the picture.
    fn project(&self, point: Vec3A) -> Vec2 {
        let on_plane = vec2(point.dot(self.right), point.dot(self.up)) - self.corner;
        vec2(on_plane.x, -on_plane.y) / self.pixel
    }
}

fn bounds(triangles: &[Triangle]) -> (Vec3A, Vec3A) {
    let none = (Vec3A::splat(f32::INFINITY), Vec3A::splat(f32::NEG_INFINITY));
    let corners = triangles.iter().flat_map(|t| [t.v0, t.v1, t.v2]);
    corners.fold(none, |(low, high), corner| (low.min(corner), high.max(corner)))
}

/// 0 where edges would only make the surface darker, 1 where triangles are large.
fn edge_strength(triangles: &[Triangle], pixel: f32) -> f32 {
    let length: f64 = triangles.iter().map(|t| f64::from(t.v0.distance(t.v1))).sum();
    let mean = (length / triangles.len().max(1) as f64) as f32 / pixel;
    let [none, full] = EDGE_LENGTHS;
    let t = ((mean - none) / (full - none)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The floor's light at pixel `k`. It changes slowly, so what neighbours saw takes the noise out of it.
fn floor_light(seen: &[Seen], width: usize, k: usize) -> f32 {
    let (x, y) = (k % width, k / width);
    let columns = x.saturating_sub(FLOOR_RADIUS)..(x + FLOOR_RADIUS + 1).min(width);
    let rows = y.saturating_sub(FLOOR_RADIUS)..(y + FLOOR_RADIUS + 1).min(seen.len() / width);
    let near = rows.flat_map(|row| &seen[row * width..][columns.clone()]);
    let (light, samples) = near
        .fold((0.0, 0.0), |(light, samples), seen| (light + seen.floor_light, samples + seen.floor_samples));
    light / f32::max(samples, 1.0)
}

fn in_disc(square: Vec2) -> Vec2 {
    let (sin, cos) = (square.x * TAU).sin_cos();
    vec2(cos, sin) * square.y.sqrt()
}

/// Linear light to an sRGB byte, with a shoulder so that highlights do not burn out.
fn encode(linear: f32) -> u8 {
    let x = if linear > 0.6 { 0.6 + 0.4 * (1.0 - (-(linear - 0.6) / 0.4).exp()) } else { linear };
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

/// Sample points of the unit square for each use within a pixel: evenly spread (Roberts' R2 sequence),
/// shifted differently in each pixel.
struct Samples {
    shifts: [Vec2; 3],
}

impl Samples {
    const PLACE: usize = 0;
    const KEY: usize = 1;
    const SKY: usize = 2;

    fn of_pixel(x: usize, y: usize) -> Self {
        let mut state = (x as u32).wrapping_mul(0x9E37_79B9) ^ (y as u32).wrapping_mul(0x85EB_CA6B);
        let mut next = || {
            state = pcg(state);
            state as f32 / u32::MAX as f32
        };
        Self { shifts: [(); 3].map(|()| vec2(next(), next())) }
    }

    fn at(&self, usage: usize, sample: usize) -> Vec2 {
        (self.shifts[usage] + (sample as f32 + 0.5) * vec2(0.754_877_7, 0.569_840_3)).fract()
    }
}

/// One step of O'Neill's PCG generator, which also hashes well.
fn pcg(state: u32) -> u32 {
    let state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
