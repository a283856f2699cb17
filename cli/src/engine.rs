//! The engines that the command can simplify with.

use decimesh::deviation::{Sampling, deviation};
use decimesh::mesh::verify;
use decimesh::multiple_choice::{Cost, Decimation, Selection};
use decimesh::{Certified, Mesh, Monitor, Options, Simplified, StoppedBy, Target, Topology};

use crate::arguments::{EngineArguments, EngineName};
use crate::failure::Failure;

/// `original`, simplified as the arguments say.
pub(crate) fn simplify(
    original: &Mesh,
    target: Target,
    arguments: &EngineArguments,
    monitor: &mut Monitor,
) -> Result<Simplified, Failure> {
    match arguments.engine {
        EngineName::Hqms | EngineName::Indices => {
            Ok(decimesh::simplify(original, &arguments.options(target), monitor)?)
        }
        EngineName::MultipleChoice => multiple_choice(original, target, arguments, monitor),
    }
}

/// `original`, simplified to triangles that are proven to be within `max_error`.
pub(crate) fn simplify_within(
    original: &Mesh,
    max_error: f64,
    arguments: &EngineArguments,
    monitor: &mut Monitor,
) -> Result<Certified, Failure> {
    if arguments.engine == EngineName::MultipleChoice {
        let message = "--certify is for the engines hqms and indices";
        return Err(Failure::Options(message.into()));
    }
    let options = arguments.options(Target::MaxError(0.0));
    Ok(decimesh::simplify_within(original, max_error, &options, monitor)?)
}

/// The paper's engine. It does not estimate the error it makes, so that is measured.
fn multiple_choice(
    original: &Mesh,
    target: Target,
    arguments: &EngineArguments,
    monitor: &mut Monitor,
) -> Result<Simplified, Failure> {
    let count = original.triangles().len();
    let triangles = match target {
        Target::Triangles(triangles) => triangles,
        Target::Ratio(ratio) if (0.0..=1.0).contains(&ratio) => (count as f64 * ratio) as usize,
        Target::Ratio(ratio) => {
            return Err(Failure::Options(format!("ratio {ratio} is not between 0 and 1")));
        }
        Target::Vertices(_) | Target::MaxError(_) => {
            let message = "the engine multiple-choice goes by --triangles or --ratio";
            return Err(Failure::Options(message.into()));
        }
    };
    let selection = Selection::MultipleChoice { candidates: arguments.candidates, seed: arguments.seed };
    let mut decimation = Decimation::new(original, Cost::Visual, selection);
    let stopped_by = match decimation.reduce_to(triangles, monitor).map_err(unexpected)? {
        true => StoppedBy::Target,
        false => StoppedBy::Stuck,
    };
    let (mesh, sources) = original.of_triangles(&decimation.triangles()).map_err(unexpected)?;
    let error = if original.triangles().is_empty() || mesh.triangles().is_empty() {
        0.0
    } else {
        let sampling = Sampling { threads: arguments.threads, ..Sampling::default() };
        deviation(original, &mesh, &sampling, monitor)?.max as f32
    };
    Ok(Simplified {
        mesh,
        stopped_by,
        error,
        attribute_error: 0.0,
        locked: 0,
        topology_changed: false,
        origins: None,
        sources: Some(sources),
        groups: None,
        surface_vertices: None,
        collapses: None,
        passes: 0,
    })
}

/// Fails if an invariant is broken. A change of the topology is none only where it was allowed and is
/// admitted. Where vertices stay, it is the surface that keeps it, on which the vertices of a seam are one.
pub(crate) fn check(original: &Mesh, result: &Simplified, options: &Options) -> Result<(), Failure> {
    let topology_kept = options.topology == Topology::Keep || !result.topology_changed;
    let verified = match &result.surface_vertices {
        Some(vertices) => {
            let before = on_surface(original, &original.surface_vertices())?;
            verify(&before, &on_surface(&result.mesh, vertices)?, topology_kept)
        }
        None => verify(original, &result.mesh, topology_kept),
    };
    verified.map_err(Failure::Verification)
}

/// The mesh with `vertices` in place of its own. Triangles with two corners at one position are left out, as
/// the engine does.
fn on_surface(mesh: &Mesh, vertices: &[u32]) -> Result<Mesh, Failure> {
    let is_face = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| mesh.positions()[vertex as usize]);
        a != b && b != c && c != a
    };
    let named = |triangle: [u32; 3]| triangle.map(|vertex| vertices[vertex as usize]);
    let triangles: Vec<_> = mesh.triangles().iter().copied().filter(is_face).map(named).collect();
    Ok(mesh.of_triangles(&triangles).map_err(unexpected)?.0)
}

fn unexpected(error: impl std::fmt::Display) -> Failure {
    Failure::Unexpected(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simplified(mesh: Mesh, topology_changed: bool) -> Simplified {
        let (stopped_by, error, attribute_error, locked, passes) = (StoppedBy::Target, 0.0, 0.0, 0, 1);
        let (origins, sources, groups, surface_vertices, collapses) = (None, None, None, None, None);
        Simplified {
            mesh,
            stopped_by,
            error,
            attribute_error,
            locked,
            topology_changed,
            origins,
            sources,
            groups,
            surface_vertices,
            collapses,
            passes,
        }
    }

    fn mesh(triangles: &[[u32; 3]]) -> Mesh {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Mesh::new(positions, triangles.to_vec()).unwrap()
    }

    #[test]
    fn topology_may_change_where_that_is_allowed_and_admitted() {
        let closed = mesh(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        let opened = mesh(&[[0, 2, 1], [0, 1, 3], [1, 2, 3]]);
        let check = |result: Simplified, topology| {
            let options = Options { topology, ..Options::new(Target::Triangles(4)) };
            check(&closed, &result, &options)
        };
        assert!(check(simplified(closed.clone(), false), Topology::Keep).is_ok());
        assert!(check(simplified(opened.clone(), true), Topology::RelaxIfStuck).is_ok());
        for (admitted, topology) in
            [(false, Topology::RelaxIfStuck), (false, Topology::Keep), (true, Topology::Keep)]
        {
            let failure = check(simplified(opened.clone(), admitted), topology).unwrap_err();
            assert!(matches!(failure, Failure::Verification(_)), "{failure}");
        }
    }
}
