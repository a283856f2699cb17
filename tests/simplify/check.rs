//! What must be true of every result, whatever the input and the options.

use std::collections::{BTreeMap, BTreeSet};

use decimesh::mesh::verify;
use decimesh::{Attributes, Mesh, Options, Placement, Simplified, StoppedBy, Target, Topology};

use crate::places::{self, Places};

/// How far a vertex may lie outside the bounds of the input, as a share of their diagonal.
const OVERSHOOT: f64 = 0.251;

/// Whether a triangle names three vertices.
pub(crate) fn is_face(&[a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// The triangles that name three vertices, and the vertices they name.
pub(crate) fn clean_counts(mesh: &Mesh) -> (usize, usize) {
    let faces = || mesh.triangles().iter().filter(|triangle| is_face(triangle));
    (faces().count(), faces().flatten().collect::<BTreeSet<_>>().len())
}

/// The vertices of edges that have not as many faces in one direction as in the other.
pub(crate) fn boundary(mesh: &Mesh) -> BTreeSet<u32> {
    let mut edges: BTreeMap<[u32; 2], [usize; 2]> = BTreeMap::new();
    for triangle in mesh.triangles().iter().filter(|triangle| is_face(triangle)) {
        for corner in 0..3 {
            let (from, to) = (triangle[corner], triangle[(corner + 1) % 3]);
            edges.entry([from.min(to), from.max(to)]).or_default()[usize::from(from < to)] += 1;
        }
    }
    edges.into_iter().filter(|(_, sides)| sides[0] != sides[1]).flat_map(|(edge, _)| edge).collect()
}

/// The vertices that share their place with another.
fn seams(mesh: &Mesh) -> BTreeSet<u32> {
    let mut at: BTreeMap<[u32; 3], Vec<u32>> = BTreeMap::new();
    for (vertex, position) in (0..).zip(mesh.positions()) {
        // Both zeros are one place.
        at.entry(position.map(|x| (x + 0.0).to_bits())).or_default().push(vertex);
    }
    at.into_values().filter(|vertices| vertices.len() > 1).flatten().collect()
}

fn bits(position: [f32; 3]) -> [u32; 3] {
    position.map(f32::to_bits)
}

/// Panics, and says what is wrong, unless `result` keeps what the options promise.
pub(crate) fn check(input: &Mesh, options: &Options, result: &Simplified) {
    let places = Places::for_options(input, options);
    check_surface(input, options, &places, result);
    assert!(options.topology != Topology::Keep || !result.topology_changed, "the topology was to be kept");
    assert!(result.error >= 0.0 && result.error.is_finite(), "error {}", result.error);
    check_target(input, options, result);
    check_origins(input, options, &places, result);
    check_sources(input, options, result);
    check_locks(input, options, &places, result);
    check_attributes(input, &result.mesh);
    check_extent(input, &result.mesh);
}

/// The surface is as sound as that of the input. Where vertices at one place are one, it is that of the places.
fn check_surface(input: &Mesh, options: &Options, places: &Places, result: &Simplified) {
    let topology_kept = !result.topology_changed;
    let violation = if !places::are_known(options) {
        verify(input, &result.mesh, topology_kept)
    } else if topology_kept {
        let Some(sources) = &result.sources else { panic!("no sources") };
        let place = |vertex: u32| places.of[sources[vertex as usize] as usize];
        verify(&places.surface(input), &places::merged(&result.mesh, place), true)
    } else if let Some(vertices) = &result.surface_vertices {
        let vertex = |vertex: u32| vertices[vertex as usize];
        verify(&places.surface(input), &places::merged(&result.mesh, vertex), false)
    } else {
        verify(&places.surface(input), &result.mesh, false)
    };
    if let (Some(vertices), Some(sources), true) = (&result.surface_vertices, &result.sources, topology_kept)
    {
        let place = |vertex: u32| places.of[sources[vertex as usize] as usize];
        let mut first = BTreeMap::new();
        for (&vertex, name) in vertices.iter().zip(0..) {
            assert_eq!(vertex, *first.entry(place(name)).or_insert(name), "not the first at its place");
        }
    }
    if let Err(violation) = violation {
        panic!("{violation}");
    }
    let named: BTreeSet<u32> = result.mesh.triangles().as_flattened().iter().copied().collect();
    assert_eq!(named.len(), result.mesh.positions().len(), "vertices that no triangle names");
}

/// The count is met exactly, or the result says why not. Along a seam several vertices go at once.
pub(crate) fn check_target(input: &Mesh, options: &Options, result: &Simplified) {
    let target = options.target;
    let places = Places::for_options(input, options);
    let whole: Vec<&[u32; 3]> =
        input.triangles().iter().filter(|triangle| places.is_whole(triangle)).collect();
    let (faces, vertices) = (whole.len(), whole.iter().copied().flatten().collect::<BTreeSet<_>>().len());
    let (faces_left, vertices_left) = (result.mesh.triangles().len(), result.mesh.positions().len());
    let faces_wanted = match target {
        Target::Triangles(wanted) => wanted,
        Target::Ratio(ratio) => (input.triangles().len() as f64 * ratio).floor() as usize,
        Target::Vertices(wanted) => {
            match result.stopped_by {
                StoppedBy::Target if vertices <= wanted => {
                    assert_eq!((faces_left, vertices_left), (faces, vertices), "nothing was to be done");
                }
                StoppedBy::Target if !result.topology_changed => assert!(
                    vertices_left <= wanted && vertices_left + places.most_removed() > wanted,
                    "{vertices_left} of {wanted} vertices"
                ),
                StoppedBy::Target => assert!(vertices_left <= wanted, "{vertices_left} of {wanted} vertices"),
                _ => assert!(
                    vertices_left > wanted,
                    "{vertices_left} of {wanted} vertices, but not the target"
                ),
            }
            return;
        }
        Target::MaxError(limit) => {
            assert_eq!(result.stopped_by, StoppedBy::Error);
            assert!(result.error <= limit, "error {} of {limit}", result.error);
            return;
        }
    };
    match result.stopped_by {
        StoppedBy::Target if faces <= faces_wanted => {
            assert_eq!((faces_left, vertices_left), (faces, vertices), "nothing was to be done");
        }
        StoppedBy::Target => assert!(
            faces_left == faces_wanted || faces_left + 1 == faces_wanted,
            "{faces_left} triangles, {faces_wanted} were asked for"
        ),
        _ => {
            assert!(faces_left > faces_wanted, "{faces_left} of {faces_wanted} triangles, but not the target")
        }
    }
}

fn check_origins(input: &Mesh, options: &Options, places: &Places, result: &Simplified) {
    assert_eq!(result.origins.is_some(), options.track_origins);
    let Some(origins) = &result.origins else { return };
    assert_eq!(origins.len(), input.positions().len());
    let mut reached = vec![false; result.mesh.positions().len()];
    for &origin in origins.iter().filter(|&&origin| origin != u32::MAX) {
        reached[origin as usize] = true;
    }
    // Where the topology was given up, a vertex may have been split into several.
    let reached_all = reached.iter().all(|&reached| reached);
    assert!(reached_all || result.topology_changed, "an output vertex that nothing went into");
    let used = used(input, places);
    // A chart of a texture may vanish whole, its surface into the charts around it.
    let may_vanish = |vertex: u32| result.topology_changed || has_seam(input, places, vertex);
    for (vertex, &origin) in origins.iter().enumerate() {
        let vanished = origin == u32::MAX;
        assert!(
            !vanished || !used.contains(&(vertex as u32)) || may_vanish(vertex as u32),
            "{vertex} vanished"
        );
        assert!(vanished || used.contains(&(vertex as u32)), "{vertex} was not used, but went somewhere");
    }
}

/// The vertices of triangles that have three corners.
fn used(input: &Mesh, places: &Places) -> BTreeSet<u32> {
    input.triangles().iter().filter(|triangle| places.is_whole(triangle)).flatten().copied().collect()
}

/// Whether the chart that a vertex is on, which is what hangs together by vertices, ends at a seam.
fn has_seam(input: &Mesh, places: &Places, vertex: u32) -> bool {
    let mut sizes = vec![0; places.of.len()];
    places.of.iter().for_each(|&place| sizes[place as usize] += 1);
    let mut chart = BTreeSet::from([vertex]);
    loop {
        let before = chart.len();
        for triangle in input.triangles().iter().filter(|triangle| places.is_whole(triangle)) {
            if triangle.iter().any(|corner| chart.contains(corner)) {
                chart.extend(triangle);
            }
        }
        if chart.len() == before {
            break;
        }
    }
    chart.iter().any(|&vertex| sizes[places.of[vertex as usize] as usize] > 1)
}

/// Each vertex was one of the input's that went into it, and where none moves still is that one, bit for bit.
fn check_sources(input: &Mesh, options: &Options, result: &Simplified) {
    let unmoved = options.placement == Placement::Existing;
    assert_eq!(result.sources.is_some(), options.track_sources || unmoved);
    let Some(sources) = &result.sources else { return };
    assert_eq!(sources.len(), result.mesh.positions().len());
    let distinct = sources.iter().collect::<BTreeSet<_>>().len() == sources.len();
    assert!(distinct || result.topology_changed, "two output vertices were one of the input");
    for (vertex, &source) in sources.iter().enumerate() {
        let source = source as usize;
        if let Some(origins) = &result.origins
            && !result.topology_changed
        {
            assert_eq!(origins[source] as usize, vertex, "the source of {vertex} went elsewhere");
        }
        if unmoved {
            let (before, after) = (input.positions()[source], result.mesh.positions()[vertex]);
            assert_eq!(bits(before), bits(after), "{vertex} is not what {source} was");
            let (before, after) = (input.attributes(), result.mesh.attributes());
            let same_normal = before.normals.as_ref().map(|normals| normals[source])
                == after.normals.as_ref().map(|normals| normals[vertex]);
            let same_color = before.colors.as_ref().map(|colors| colors[source])
                == after.colors.as_ref().map(|colors| colors[vertex]);
            let same_uv =
                before.uvs.as_ref().map(|uvs| uvs[source]) == after.uvs.as_ref().map(|uvs| uvs[vertex]);
            assert!(same_normal && same_color && same_uv, "{vertex} has not the attributes of {source}");
        }
    }
}

/// Locked vertices are where they were, each as a vertex of its own.
fn check_locks(input: &Mesh, options: &Options, places: &Places, result: &Simplified) {
    let mut locked: BTreeSet<u32> = options.locked.iter().copied().collect();
    if places::are_known(options) {
        return check_locked_places(input, options, places, result);
    }
    if options.lock_boundary {
        locked.extend(boundary(input));
    }
    if options.keep_seams && *input.attributes() != Attributes::default() {
        locked.extend(seams(input));
    }
    let used: BTreeSet<u32> =
        input.triangles().iter().filter(|triangle| is_face(triangle)).flatten().copied().collect();
    locked.retain(|vertex| used.contains(vertex));
    if let Some(origins) = &result.origins {
        let mut taken = BTreeSet::new();
        for &vertex in &locked {
            let origin = origins[vertex as usize];
            if origin == u32::MAX {
                assert!(result.topology_changed, "the locked vertex {vertex} vanished");
            } else {
                let (before, after) =
                    (input.positions()[vertex as usize], result.mesh.positions()[origin as usize]);
                assert_eq!(
                    bits(before),
                    bits(after),
                    "the locked vertex {vertex} moved from {before:?} to {after:?}"
                );
                assert!(taken.insert(origin), "the locked vertex {vertex} went into another");
            }
        }
    } else if !result.topology_changed {
        let mut left: BTreeMap<[u32; 3], usize> = BTreeMap::new();
        for &position in result.mesh.positions() {
            *left.entry(bits(position)).or_default() += 1;
        }
        for &vertex in &locked {
            let position = input.positions()[vertex as usize];
            let count = left.entry(bits(position)).or_default();
            assert!(*count > 0, "the locked vertex {vertex} at {position:?} is gone");
            *count -= 1;
        }
    }
}

/// [`check_locks`] where vertices at one place are one: that stays, and those of its vertices that are named
/// still are themselves.
fn check_locked_places(input: &Mesh, options: &Options, places: &Places, result: &Simplified) {
    let Some(sources) = &result.sources else { panic!("no sources") };
    let place = |vertex: u32| places.of[vertex as usize];
    let mut locked: BTreeSet<u32> = options.locked.iter().copied().map(place).collect();
    locked.extend(places.tangled.iter().copied().map(place));
    if options.lock_boundary {
        locked.extend(boundary(&places.surface(input)));
    }
    let used = used(input, places);
    let there: BTreeSet<u32> = used.iter().copied().map(place).collect();
    let left: BTreeSet<u32> = sources.iter().copied().map(place).collect();
    for &vertex in locked.intersection(&there) {
        assert!(left.contains(&vertex) || result.topology_changed, "the locked vertex {vertex} is gone");
    }
    let Some(origins) = &result.origins else { return };
    for vertex in used.into_iter().filter(|&vertex| locked.contains(&place(vertex))) {
        let origin = origins[vertex as usize];
        assert!(
            origin == u32::MAX || sources[origin as usize] == vertex,
            "the locked vertex {vertex} went into another"
        );
    }
}

fn check_attributes(input: &Mesh, output: &Mesh) {
    let (before, after) = (input.attributes(), output.attributes());
    assert_eq!(before.normals.is_some(), after.normals.is_some());
    assert_eq!(before.colors.is_some(), after.colors.is_some());
    assert_eq!(before.uvs.is_some(), after.uvs.is_some());
    for normal in after.normals.iter().flatten() {
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        assert!((length - 1.0).abs() < 1e-4, "a normal of length {length}");
    }
    if let (Some(before), Some(after)) = (&before.colors, &after.colors) {
        for channel in 0..4 {
            let all = || before.iter().map(|color| color[channel]);
            let range = all().min().unwrap_or(0)..=all().max().unwrap_or(0);
            assert!(after.iter().all(|color| range.contains(&color[channel])), "a colour out of range");
        }
    }
    if let (Some(before), Some(after)) = (&before.uvs, &after.uvs) {
        for axis in 0..2 {
            let all = || before.iter().map(|uv| uv[axis]);
            let (low, high) = (all().fold(f32::INFINITY, f32::min), all().fold(f32::NEG_INFINITY, f32::max));
            let slack = 1e-5 * (high - low);
            let range = low - slack..=high + slack;
            assert!(after.iter().all(|uv| range.contains(&uv[axis])), "a texture coordinate out of range");
        }
    }
}

/// Optimal placements may leave the bounds, but not by much.
fn check_extent(input: &Mesh, output: &Mesh) {
    let (Some((low, high)), Some((low_after, high_after))) = (input.bounds(), output.bounds()) else {
        return;
    };
    let slack = OVERSHOOT * input.diagonal();
    for axis in 0..3 {
        let outside = f64::max(
            f64::from(low[axis]) - f64::from(low_after[axis]),
            f64::from(high_after[axis]) - f64::from(high[axis]),
        );
        assert!(outside <= slack, "a vertex lies {outside} outside, on a diagonal of {}", input.diagonal());
    }
}
