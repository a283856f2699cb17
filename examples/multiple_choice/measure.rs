//! How long it takes, and how much it errs.

use std::error::Error;
use std::time::Duration;

use decimesh::deviation::{Sampling, deviation};
use decimesh::{Mesh, Monitor};
use glam::{DVec3, Vec3};

use crate::method::Method;

/// What it took to simplify as far as it goes.
#[derive(Clone, Copy)]
pub(crate) struct Time {
    /// Milliseconds until the first vertex can go.
    pub(crate) begin: f64,
    /// Milliseconds after that.
    pub(crate) simplify: f64,
    /// How many times a vertex has weighed its neighbours, where that is counted.
    pub(crate) evaluations: Option<usize>,
    /// The triangles that are left.
    pub(crate) left: usize,
}

impl Time {
    pub(crate) fn total(&self) -> f64 {
        self.begin + self.simplify
    }
}

/// A simplified mesh beside the original.
pub(crate) struct Level {
    pub(crate) triangles: usize,
    /// The larger of both directions, as a share of the diagonal; and so is the next.
    pub(crate) rms: f64,
    pub(crate) hausdorff: f64,
    /// Triangles that show their back: the normal is against the mean of the original's normals at the
    /// three corners. A large triangle may do so without having been turned over.
    pub(crate) flipped: usize,
}

/// The medians of what each method takes. The methods take turns, so that a slow minute of the machine is
/// one for all of them.
pub(crate) fn times(methods: &[Method], mesh: &Mesh, rounds: usize) -> Result<Vec<Time>, Box<dyn Error>> {
    let mut all = vec![Vec::with_capacity(rounds); methods.len()];
    for _ in 0..rounds {
        for (times, method) in all.iter_mut().zip(methods) {
            times.push(method.time(mesh)?);
        }
    }
    Ok(all.into_iter().map(median).collect())
}

/// Of the runs the one whose total is in the middle.
fn median(mut times: Vec<Time>) -> Time {
    times.sort_by(|a, b| a.total().total_cmp(&b.total()));
    times[times.len() / 2]
}

/// The time that this process has computed: it does not count what others do on the machine meanwhile.
#[cfg(unix)]
pub(crate) fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// The time that has passed: what the process has computed is not known here.
#[cfg(not(unix))]
pub(crate) fn processor_time() -> Duration {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed()
}

/// What a method makes of the mesh at each share of its triangles.
pub(crate) fn levels(method: &Method, mesh: &Mesh, shares: &[f64]) -> Result<Vec<Level>, Box<dyn Error>> {
    let normals = vertex_normals(mesh);
    let sampling = Sampling { samples: 100_000, ..Sampling::default() };
    let measure = |level: Mesh| {
        let measured = deviation(mesh, &level, &sampling, &mut Monitor::silent())?;
        Ok(Level {
            triangles: level.triangles().len(),
            rms: measured.rms_rel(),
            hausdorff: measured.max_rel(),
            flipped: flipped(&level, &normals),
        })
    };
    method.levels(mesh, shares)?.into_iter().map(measure).collect()
}

fn normal(mesh: &Mesh, triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|vertex| Vec3::from(mesh.positions()[vertex as usize]).as_dvec3());
    (b - a).cross(c - a)
}

/// Of unit length, from all faces of the vertex, by their areas.
fn vertex_normals(mesh: &Mesh) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; mesh.positions().len()];
    for triangle in mesh.triangles() {
        triangle.iter().for_each(|&vertex| normals[vertex as usize] += normal(mesh, triangle));
    }
    normals.into_iter().map(DVec3::normalize_or_zero).collect()
}

fn flipped(level: &Mesh, normals: &[DVec3]) -> usize {
    let is_flipped = |triangle: &&[u32; 3]| {
        let facing: DVec3 = triangle.iter().map(|&vertex| normals[vertex as usize]).sum();
        normal(level, triangle).dot(facing) < 0.0
    };
    level.triangles().iter().filter(is_flipped).count()
}
