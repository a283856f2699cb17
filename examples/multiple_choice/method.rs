//! What is compared.

use std::error::Error;

use decimesh::multiple_choice::{Cost, Decimation, Selection};
use decimesh::{Mesh, Monitor, Options, Placement, Target, simplify};

use crate::measure::{Time, processor_time};

/// A way to simplify that moves no vertex.
pub(crate) struct Method {
    pub(crate) name: &'static str,
    engine: Engine,
}

enum Engine {
    HalfEdges(Cost, Selection),
    /// The library's default engine, with [`Placement::Existing`], on one thread.
    Passes,
}

impl Method {
    /// Where the paper's own stands among [`all`](Self::all), and those that it compares with.
    pub(crate) const JIA: usize = 0;
    pub(crate) const QEM: usize = 1;
    pub(crate) const MELAX: usize = 2;

    pub(crate) fn all() -> [Self; 7] {
        let half_edges = |name, cost, selection| Self { name, engine: Engine::HalfEdges(cost, selection) };
        [
            half_edges("Jia", Cost::Visual, Selection::default()),
            half_edges("QEM", Cost::Quadric, Selection::EagerHeap),
            half_edges("Melax", Cost::Melax, Selection::EagerHeap),
            half_edges("Jia's cost, lazy heap", Cost::Visual, Selection::LazyHeap),
            half_edges("QEM, lazy heap", Cost::Quadric, Selection::LazyHeap),
            half_edges("Melax, lazy heap", Cost::Melax, Selection::LazyHeap),
            Self { name: "default engine", engine: Engine::Passes },
        ]
    }

    /// Simplifies until nothing is left that may go, as the paper's Table 2 does.
    pub(crate) fn time(&self, mesh: &Mesh) -> Result<Time, Box<dyn Error>> {
        let quiet = &mut Monitor::silent();
        let start = processor_time();
        match self.engine {
            Engine::HalfEdges(cost, selection) => {
                let mut decimation = Decimation::new(mesh, cost, selection);
                let begun = processor_time();
                decimation.reduce_to(0, quiet)?;
                Ok(Time {
                    begin: (begun - start).as_secs_f64() * 1e3,
                    simplify: (processor_time() - begun).as_secs_f64() * 1e3,
                    evaluations: Some(decimation.evaluations()),
                    left: decimation.triangles().len(),
                })
            }
            Engine::Passes => {
                let result = simplify(mesh, &passes(Target::Triangles(0)), quiet)?;
                Ok(Time {
                    begin: 0.0,
                    simplify: (processor_time() - start).as_secs_f64() * 1e3,
                    evaluations: None,
                    left: result.mesh.triangles().len(),
                })
            }
        }
    }

    /// What is left at each share of the triangles, from the largest to the smallest.
    pub(crate) fn levels(&self, mesh: &Mesh, shares: &[f64]) -> Result<Vec<Mesh>, Box<dyn Error>> {
        let quiet = &mut Monitor::silent();
        match self.engine {
            Engine::HalfEdges(cost, selection) => {
                let mut decimation = Decimation::new(mesh, cost, selection);
                let level = |share: &f64| {
                    decimation.reduce_to((mesh.triangles().len() as f64 * share) as usize, quiet)?;
                    Ok(Mesh::new(mesh.positions().to_vec(), decimation.triangles())?)
                };
                shares.iter().map(level).collect()
            }
            Engine::Passes => {
                let level = |&share: &f64| {
                    let options = Options { track_sources: true, ..passes(Target::Ratio(share)) };
                    let result = simplify(mesh, &options, quiet)?;
                    let sources = result.sources.ok_or("the sources were asked for")?;
                    let named = |triangle: &[u32; 3]| triangle.map(|vertex| sources[vertex as usize]);
                    let triangles = result.mesh.triangles().iter().map(named).collect();
                    Ok(Mesh::new(mesh.positions().to_vec(), triangles)?)
                };
                shares.iter().map(level).collect()
            }
        }
    }
}

fn passes(target: Target) -> Options {
    Options { placement: Placement::Existing, threads: 1, ..Options::new(target) }
}
