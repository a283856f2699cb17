//! Assets whose best simplification is known.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use decimesh::hqms::{AttributeWeights, SimplifyError};
use decimesh::mesh::shapes;
use decimesh::{
    Attributes, HalfEdge, Mesh, Monitor, Options, Simplified, StoppedBy, Target, Topology, simplify,
};

use super::{WEIGHTS, cell, cut, existing, named, run};
use crate::meshes::{attributed, joined, moved, shuffled, tetrahedron};
use crate::places::{Places, replay};

fn with(mesh: &Mesh, attributes: Attributes) -> Mesh {
    Mesh::with_attributes(mesh.positions().to_vec(), mesh.triangles().to_vec(), attributes).unwrap()
}

fn with_uvs(mesh: &Mesh, uv: impl Fn([f32; 3]) -> [f32; 2]) -> Mesh {
    let uvs = mesh.positions().iter().map(|&position| uv(position)).collect();
    with(mesh, Attributes { uvs: Some(uvs), ..Attributes::default() })
}

fn with_colors(mesh: &Mesh, color: impl Fn([f32; 3]) -> [u8; 4]) -> Mesh {
    let colors = mesh.positions().iter().map(|&position| color(position)).collect();
    with(mesh, Attributes { colors: Some(colors), ..Attributes::default() })
}

/// A cube of `n` by `n` cells a side, whose sides have vertices and normals of their own.
fn faceted_cube(n: usize) -> Mesh {
    let cube = shapes::cube(n);
    let side = |triangle: usize| {
        let [a, b, c] = cube.triangles()[triangle].map(|v| glam::Vec3::from(cube.positions()[v as usize]));
        (b - a).cross(c - a).normalize().round()
    };
    let number =
        |normal: glam::Vec3| (9.0 * (normal.x + 1.0) + 3.0 * (normal.y + 1.0) + normal.z + 1.0) as u64;
    let parted = cut(&cube, |triangle| number(side(triangle)));
    let mut normals = vec![[0.0; 3]; parted.positions().len()];
    for (triangle, corners) in parted.triangles().iter().enumerate() {
        corners.iter().for_each(|&vertex| normals[vertex as usize] = side(triangle).to_array());
    }
    with(&parted, Attributes { normals: Some(normals), ..Attributes::default() })
}

#[test]
fn a_faceted_cube_becomes_twelve_triangles() {
    for weights in [AttributeWeights::default(), WEIGHTS] {
        for target in [Target::Triangles(12), Target::MaxError(1e-5), Target::Vertices(24)] {
            let mesh = faceted_cube(10);
            let options =
                Options { attribute_weights: weights, topology: Topology::Keep, ..existing(target) };
            let result = run(&mesh, &options);
            assert_eq!(
                (result.mesh.triangles().len(), result.mesh.positions().len()),
                (12, 24),
                "{target:?}"
            );
            assert_eq!((result.error, result.attribute_error), (0.0, 0.0));
            let normals = result.mesh.attributes().normals.as_ref().unwrap();
            for triangle in result.mesh.triangles() {
                let [a, b, c] = triangle.map(|v| glam::Vec3::from(result.mesh.positions()[v as usize]));
                let normal = (b - a).cross(c - a).normalize();
                assert!(triangle.iter().all(|&v| glam::Vec3::from(normals[v as usize]).dot(normal) > 0.999));
            }
        }
    }
}

/// A tube around the z axis, of `around` by `along` cells, cut open along one line for its texture.
fn tube(around: usize, along: usize) -> Mesh {
    let columns = around + 1;
    let vertices = || (0..=along).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let position = |(column, row): (usize, usize)| {
        let angle = std::f64::consts::TAU * (column % around) as f64 / around as f64;
        [angle.cos() as f32, angle.sin() as f32, row as f32 / along as f32]
    };
    let uv = |(column, row): (usize, usize)| [column as f32 / around as f32, row as f32 / along as f32];
    let name = |column: usize, row: usize| (row * columns + column) as u32;
    let triangles = (0..along).flat_map(|row| {
        (0..around).flat_map(move |column| {
            let [a, b] = [name(column, row), name(column + 1, row)];
            let [c, d] = [name(column, row + 1), name(column + 1, row + 1)];
            [[a, b, d], [a, d, c]]
        })
    });
    let uvs = vertices().map(uv).collect();
    let attributes = Attributes { uvs: Some(uvs), ..Attributes::default() };
    Mesh::with_attributes(vertices().map(position).collect(), triangles.collect(), attributes).unwrap()
}

/// Along the axis nothing is lost: neither shape nor texture, whose seam runs there.
#[test]
fn a_tube_keeps_its_sides_alone() {
    let mesh = tube(8, 24);
    let target = Target::MaxError(1e-4);
    let options = Options { attribute_weights: WEIGHTS, ..existing(target) };
    let result = run(&mesh, &options);
    assert_eq!((result.mesh.triangles().len(), result.mesh.positions().len()), (16, 18));
    // The square root of what single precision makes of a difference of squares.
    assert!(result.attribute_error < 1e-3, "{}", result.attribute_error);
}

#[test]
fn a_linear_texture_costs_nothing() {
    let plane = with_uvs(&shapes::plane(24), |[x, y, _]| [0.3 + 2.0 * x - y, 0.5 * x + 3.0 * y]);
    for mesh in [&plane, &shuffled_with_uvs(&plane)] {
        for ratio in [0.7, 0.3, 0.05, 0.002] {
            let options = Options { attribute_weights: WEIGHTS, ..existing(Target::Ratio(ratio)) };
            let result = run(mesh, &options);
            assert!(result.attribute_error < 1e-3, "{} at {ratio}", result.attribute_error);
        }
    }
}

/// The positions alone say what the texture is.
fn shuffled_with_uvs(plane: &Mesh) -> Mesh {
    with_uvs(&shuffled(plane, 3), |[x, y, _]| [0.3 + 2.0 * x - y, 0.5 * x + 3.0 * y])
}

/// The mean difference of a colour from what is painted, at the middles of many triangles' parts.
fn paint_error(result: &Simplified, paint: impl Fn([f32; 3]) -> [u8; 4]) -> f64 {
    let mesh = &result.mesh;
    let colors = mesh.attributes().colors.as_ref().unwrap();
    let (mut sum, mut area) = (0.0, 0.0);
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|v| glam::Vec3::from(mesh.positions()[v as usize]));
        let size = f64::from((b - a).cross(c - a).length());
        const PARTS: usize = 20;
        for i in 0..PARTS {
            for j in 0..PARTS - i {
                let (u, v) = ((i as f32 + 0.3) / PARTS as f32, (j as f32 + 0.3) / PARTS as f32);
                let at = (a + u * (b - a) + v * (c - a)).to_array();
                let shares = [1.0 - u - v, u, v];
                let red: f32 = (0..3)
                    .map(|corner| shares[corner] * f32::from(colors[triangle[corner] as usize][0]))
                    .sum();
                sum += size * f64::from((red - f32::from(paint(at)[0])).abs());
                area += size;
            }
        }
    }
    sum / area
}

#[test]
fn a_painted_line_is_kept_by_its_weight() {
    let paint = |[x, y, _]: [f32; 3]| if (x - 0.5).hypot(y - 0.4) < 0.3 { [255; 4] } else { [0, 0, 0, 255] };
    let hills = shapes::height_field(40, |x, y| 0.02 * (7.0 * x).sin() * (9.0 * y).cos()).unwrap();
    let mesh = with_colors(&hills, paint);
    let error = |colors: f32| {
        let attribute_weights = AttributeWeights { colors, ..AttributeWeights::default() };
        let result = run(&mesh, &Options { attribute_weights, ..existing(Target::Ratio(0.1)) });
        assert_eq!(result.attribute_error > 0.0, colors > 0.0);
        paint_error(&result, paint)
    };
    let errors = [0.0, 0.01, 1.0].map(error);
    assert!(errors[1] < 0.8 * errors[0] && errors[2] < 0.8 * errors[0], "{errors:?}");
}

/// A stone in small charts, with attributes that jump between them.
fn charted_stone() -> Mesh {
    let stone = shapes::bumpy_sphere(14, 2);
    attributed(cut(&stone, |triangle| cell(&stone, triangle, 80, 9)), 4)
}

/// Seams are given up before holes, handles and components, and these only where they must be; a target that
/// can be met along seams is.
#[test]
fn seams_are_crossed_where_they_must_be() {
    let large = shapes::bumpy_sphere(40, 2);
    let large = attributed(cut(&large, |triangle| cell(&large, triangle, 300, 9)), 4);
    for mesh in [charted_stone(), large] {
        let stuck = run(&mesh, &Options { topology: Topology::Keep, ..existing(Target::Triangles(40)) });
        assert_eq!(stuck.stopped_by, StoppedBy::Stuck);
        let within_reach = existing(Target::Triangles(2 * stuck.mesh.triangles().len()));
        let along = run(&mesh, &Options { topology: Topology::Keep, ..within_reach.clone() });
        let result = run(&mesh, &within_reach);
        assert_eq!((along.stopped_by, result.mesh), (StoppedBy::Target, along.mesh));

        let result = run(&mesh, &existing(Target::Triangles(60)));
        assert_eq!(result.stopped_by, StoppedBy::Target);
        assert!(!result.topology_changed && result.collapses.is_some());

        // All protected, nothing can be crossed: what cannot be reached along seams is reached otherwise.
        let protected = (0..mesh.positions().len() as u32).collect();
        let result = run(&mesh, &Options { protected, ..existing(Target::Triangles(60)) });
        assert!(result.topology_changed || result.stopped_by == StoppedBy::Stuck);
    }
}

#[test]
fn across_seams_one_gets_further() {
    let mesh = charted_stone();
    let keep = Options { topology: Topology::Keep, ..existing(Target::Triangles(60)) };
    let along = run(&mesh, &keep);
    let across = run(&mesh, &Options { cross_seams: true, ..keep.clone() });
    assert_eq!(along.stopped_by, StoppedBy::Stuck);
    assert_eq!(across.stopped_by, StoppedBy::Target);

    // All protected is the same as not to cross.
    let protected: Vec<u32> = (0..mesh.positions().len() as u32).collect();
    let all = run(&mesh, &Options { cross_seams: true, protected, ..keep.clone() });
    assert_eq!(all.mesh, along.mesh);

    // Some of them protected: these go along an edge of their own, the others go further.
    let protected: Vec<u32> = (0..mesh.positions().len() as u32).filter(|vertex| vertex % 5 == 0).collect();
    let some = run(&mesh, &Options { cross_seams: true, protected: protected.clone(), ..keep });
    assert!(some.mesh.triangles().len() < along.mesh.triangles().len());
    let places = Places::new(&mesh);
    let at = |vertex: u32| places.of[vertex as usize];
    let protected: BTreeSet<u32> = protected.into_iter().map(at).collect();
    let collapses = some.collapses.unwrap();
    let mut triangles = mesh.triangles().to_vec();
    let mut leaps = 0;
    for collapse in &collapses {
        let HalfEdge { source, target } = *collapse;
        let along = triangles.iter().any(|triangle| triangle.contains(&source) && triangle.contains(&target));
        assert!(along || !protected.contains(&at(source)), "{collapse:?} leaps over a seam");
        leaps += usize::from(!along);
        replay(&mut triangles, &places, *collapse);
    }
    assert!(leaps > 0);
}

#[test]
fn what_is_prioritized_goes_last() {
    let mesh = shapes::bumpy_sphere(20, 3);
    let prioritized: Vec<u32> = (0..mesh.positions().len() as u32).filter(|vertex| vertex % 7 == 0).collect();
    let left = |prioritized: Vec<u32>| {
        let result = run(&mesh, &Options { prioritized, ..existing(Target::Ratio(0.2)) });
        result.sources.unwrap().iter().filter(|&vertex| vertex % 7 == 0).count()
    };
    let (with, without) = (left(prioritized.clone()), left(Vec::new()));
    assert!(
        with > 2 * without && with > prioritized.len() / 2,
        "{with} and {without} of {}",
        prioritized.len()
    );
    // Not for ever: they go where nothing else is left.
    let result = run(&mesh, &Options { prioritized, ..existing(Target::Triangles(12)) });
    assert_eq!(result.stopped_by, StoppedBy::Target);
}

/// On a flat sheet of three materials, what each covers stays.
#[test]
fn groups_keep_their_area() {
    let mesh = shapes::plane(20);
    let group = |triangle: &[u32; 3]| {
        let middle: f32 = triangle.iter().map(|&v| mesh.positions()[v as usize][0]).sum::<f32>() / 3.0;
        if middle < 0.3 {
            7
        } else if middle < 0.65 {
            u32::MAX
        } else {
            0
        }
    };
    let groups: Vec<u32> = mesh.triangles().iter().map(group).collect();
    let areas = |mesh: &Mesh, groups: &[u32]| {
        [7, u32::MAX, 0].map(|wanted| {
            let triangles = mesh.triangles().iter().zip(groups).filter(|(_, group)| **group == wanted);
            let area = |triangle: &[u32; 3]| {
                let [a, b, c] = triangle.map(|v| glam::Vec3::from(mesh.positions()[v as usize]).as_dvec3());
                (b - a).cross(c - a).length() / 2.0
            };
            triangles.map(|(triangle, _)| area(triangle)).sum::<f64>()
        })
    };
    let before = areas(&mesh, &groups);
    // An inner collapse takes two triangles where there may be one too many.
    for (target, counts) in [(Target::Ratio(0.2), 159..=160), (Target::MaxError(1e-5), 6..=6)] {
        for cross_seams in [false, true] {
            let options = Options { groups: Some(groups.clone()), cross_seams, ..existing(target) };
            let result = run(&mesh, &options);
            let count = result.mesh.triangles().len();
            assert!(counts.contains(&count), "{count} triangles");
            let after = areas(&result.mesh, result.groups.as_ref().unwrap());
            for (before, after) in before.iter().zip(after) {
                assert!((before - after).abs() < 1e-5, "{before} became {after}");
            }
        }
    }
}

#[test]
fn threads_change_nothing_on_many_tiles() {
    let stone = shapes::bumpy_sphere(70, 5);
    let mesh = attributed(cut(&stone, |triangle| cell(&stone, triangle, 200, 3)), 2);
    let groups = (0..stone.triangles().len()).map(|triangle| cell(&stone, triangle, 4, 8) as u32).collect();
    let options = Options {
        attribute_weights: WEIGHTS,
        groups: Some(groups),
        cross_seams: true,
        locked: (0..400).map(|index| 61 * index).collect(),
        protected: (0..400).map(|index| 53 * index).collect(),
        prioritized: (0..400).map(|index| 47 * index).collect(),
        track_origins: true,
        ..existing(Target::Ratio(0.1))
    };
    let of = |threads| {
        let options = Options { threads, ..options.clone() };
        let result = simplify(&mesh, &options, &mut Monitor::silent()).unwrap();
        let errors = [result.error, result.attribute_error].map(f32::to_bits);
        (result.mesh, result.sources, result.origins, result.collapses, result.groups, errors)
    };
    let expected = of(1);
    assert!(of(2) == expected && of(3) == expected);
}

#[test]
fn a_run_with_seams_ends_at_any_report() {
    let mesh = charted_stone();
    let options = Options { attribute_weights: WEIGHTS, cross_seams: true, ..existing(Target::Ratio(0.1)) };
    let mut reports = 0;
    let mut count = Monitor::new(|_| {
        reports += 1;
        ControlFlow::Continue(())
    });
    simplify(&mesh, &options, &mut count).unwrap();
    drop(count);
    for allowed in 0..reports {
        let mut heard = 0;
        let mut monitor = Monitor::new(|_| {
            heard += 1;
            if heard > allowed { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let outcome = simplify(&mesh, &options, &mut monitor);
        assert!(matches!(outcome, Err(SimplifyError::Cancelled(_))), "report {allowed} of {reports}");
    }
}

#[test]
fn what_cannot_be_is_said() {
    let mesh = shapes::plane(3);
    let base = existing(Target::Ratio(0.5));
    let message = |options: Options| match simplify(&mesh, &options, &mut Monitor::silent()) {
        Err(SimplifyError::InvalidOption(message)) => message,
        other => panic!("{other:?}"),
    };
    let groups = |count| Options { groups: Some(vec![0; count]), ..base.clone() };
    assert_eq!(message(groups(17)), "there are 17 groups for 18 triangles");
    assert_eq!(message(groups(0)), "there are 0 groups for 18 triangles");
    let optimal = Options { placement: decimesh::Placement::Optimal, track_collapses: false, ..groups(18) };
    assert_eq!(message(optimal), "groups are kept where vertices stay (Placement::Existing) only");
    for weight in [f32::NAN, f32::INFINITY, -1.0] {
        let weights = [
            AttributeWeights { normals: weight, ..WEIGHTS },
            AttributeWeights { uvs: weight, ..WEIGHTS },
            AttributeWeights { colors: weight, ..WEIGHTS },
        ];
        for attribute_weights in weights {
            let said = message(Options { attribute_weights, ..base.clone() });
            assert!(said.ends_with("neither 0 nor a positive number"), "{said}");
        }
    }
    let named = |vertex| vec![3, vertex];
    assert_eq!(
        message(Options { protected: named(16), ..base.clone() }),
        "protected vertex 16 does not exist: there are 16 vertices"
    );
    assert_eq!(
        message(Options { prioritized: named(u32::MAX), ..base.clone() }),
        "prioritized vertex 4294967295 does not exist: there are 16 vertices"
    );
}

#[test]
fn nothing_and_next_to_nothing() {
    let one_place = Mesh::new(vec![[1.0, 2.0, 3.0]; 6], vec![[0, 1, 2], [3, 4, 5], [0, 0, 1]]).unwrap();
    let two_places = Mesh::new(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [-0.0, 0.0, -0.0], [2.0, 1.0, 0.0]],
        vec![[0, 1, 2], [2, 0, 1], [0, 1, 3]],
    );
    for (mesh, left) in [(Mesh::default(), 0), (one_place, 0), (two_places.unwrap(), 1)] {
        for target in [Target::Triangles(1), Target::MaxError(0.0), Target::Ratio(1.0), Target::Vertices(3)] {
            let groups = Some(vec![5; mesh.triangles().len()]);
            let options = Options {
                attribute_weights: WEIGHTS,
                groups,
                cross_seams: true,
                track_origins: true,
                ..existing(target)
            };
            let result = run(&mesh, &options);
            assert_eq!(result.mesh.triangles().len(), left, "{target:?}");
            assert_eq!(result.groups, Some(vec![5; left]));
            assert_eq!(result.attribute_error, 0.0);
        }
    }
}

/// Attributes at the end of their range, on meshes at the end of theirs, make no number that is none.
#[test]
fn large_and_small_numbers() {
    for exponent in [-60, 0, 60] {
        let scale = f32::exp2(exponent as f32);
        let stone = shapes::bumpy_sphere(6, 2);
        let parted = moved(&cut(&stone, |triangle| triangle as u64 % 5), |x| x.map(|x| x * scale));
        for size in [1e-30, 1.0, 1e30] {
            let mesh = with_uvs(&parted, |[x, y, _]| [x / scale * size, y / scale * size]);
            for uvs in [1e-20, 1.0, 1e20] {
                let attribute_weights = AttributeWeights { uvs, ..WEIGHTS };
                let options =
                    Options { attribute_weights, cross_seams: true, ..existing(Target::Triangles(40)) };
                let result = run(&mesh, &options);
                assert!(result.attribute_error.is_finite(), "{}", result.attribute_error);
                assert!(!named(&result).is_empty());
            }
        }
    }
}

/// A sheet whose border lies on an edge of a small solid: this would be the first to vanish, and leave a gap.
#[test]
fn what_lies_on_an_edge_keeps_it_when_the_topology_is_given_up() {
    let sheet = moved(&shapes::plane(6), |x| x.map(|x| 6.0 * x));
    let mesh = joined(&[sheet, tetrahedron([0.0, 0.0, 0.0], 1.0)]);
    let result = run(&mesh, &existing(Target::Triangles(3)));
    let at = |vertex: u32| mesh.positions()[vertex as usize];
    let on_edge = |triangle: &&[u32; 3]| {
        let corners = triangle.map(at);
        corners.contains(&[0.0; 3]) && corners.contains(&[1.0, 0.0, 0.0])
    };
    assert!(named(&result).iter().filter(on_edge).count() > 1);
}
