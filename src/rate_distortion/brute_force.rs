//! Oracles for small hierarchies: surfaces and their errors triangle by triangle, and the best sets of vertices
//! to remove, by trying all of them and by minimum cuts.

use super::graph::Graph;
use super::layout::{Layout, Site};
use crate::random::SplitMix64;
use std::collections::{BTreeMap, VecDeque};

type Triangle = [(usize, usize); 3];

/// Heights on all samples of a layout.
pub(super) struct Terrain {
    pub(super) layout: Layout,
    heights: BTreeMap<(usize, usize), f64>,
}

impl Terrain {
    /// Midpoints displaced by whole numbers that halve from level to level, about.
    pub(super) fn fractal(layout: Layout, seed: u64) -> Self {
        let mut random = SplitMix64::at(seed, 0);
        let mut displaced = |amplitude: usize| random.below(2 * amplitude + 1) as f64 - amplitude as f64;
        let ([columns, rows], side) = (layout.base(), layout.side());
        let mut heights = BTreeMap::new();
        for (column, row) in (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row))) {
            heights.insert((column * side, row * side), displaced(256));
        }
        for vertex in 0..layout.vertices() {
            let site = layout.site(vertex);
            let [from, to] = layout.edge(site).map(|end| heights[&end]);
            let height = (from + to) / 2.0 + displaced(256 >> (site.level / 2));
            heights.insert((site.x, site.y), height);
        }
        Self { layout, heights }
    }

    /// One height for each sample.
    pub(super) fn of(layout: Layout, mut height: impl FnMut(usize, usize) -> f64) -> Self {
        let [right, bottom] = layout.extent();
        let places = (0..=bottom).flat_map(|y| (0..=right).map(move |x| (x, y)));
        Self { layout, heights: places.map(|(x, y)| ((x, y), height(x, y))).collect() }
    }

    pub(super) fn height(&self, x: usize, y: usize) -> f32 {
        self.heights[&(x, y)] as f32
    }

    /// The change of distortion that each vertex makes: the error of the triangles that it splits, less that of
    /// their halves.
    pub(super) fn deltas(&self) -> Vec<f64> {
        (0..self.layout.vertices())
            .map(|vertex| {
                let site = self.layout.site(vertex);
                let whole: Vec<_> = self.layout.split(site).collect();
                let middle = (site.x, site.y);
                let halves: Vec<_> = whole
                    .iter()
                    .flat_map(|&[apex, from, to]| [[middle, apex, from], [middle, to, apex]])
                    .collect();
                self.squared_error(&whole) - self.squared_error(&halves)
            })
            .collect()
    }

    /// The triangles that are left if the vertices that are `gone` are.
    pub(super) fn surface(&self, gone: &[bool]) -> Vec<Triangle> {
        let layout = &self.layout;
        let mut pending: Vec<(Triangle, u32)> = match layout.levels() {
            0 => Vec::new(),
            _ => layout
                .level(1)
                .flat_map(|vertex| layout.split(layout.site(vertex)))
                .map(|triangle| (triangle, 1))
                .collect(),
        };
        let mut surface = Vec::new();
        while let Some((triangle, level)) = pending.pop() {
            let [apex, from, to] = triangle;
            let middle = ((from.0 + to.0) / 2, (from.1 + to.1) / 2);
            let site = Site { x: middle.0, y: middle.1, level };
            if level > layout.levels() || gone[layout.index(site)] {
                surface.push(triangle);
            } else {
                pending.extend([([middle, apex, from], level + 1), ([middle, to, apex], level + 1)]);
            }
        }
        surface
    }

    /// The sum of the squared errors of the samples that triangles cover, those on shared edges once. Triangles
    /// that share a sample must agree on its height.
    pub(super) fn squared_error(&self, triangles: &[Triangle]) -> f64 {
        let mut covered: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for triangle in triangles {
            let cross = |a: (usize, usize), b: (usize, usize), c: (usize, usize)| {
                let [ax, ay, bx, by, cx, cy] = [a.0, a.1, b.0, b.1, c.0, c.1].map(|value| value as i64);
                (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            };
            let [a, b, c] = *triangle;
            let area = cross(a, b, c);
            assert!(area > 0, "{triangle:?} is turned");
            let range = |axis: [usize; 3]| axis.into_iter().min().unwrap()..=axis.into_iter().max().unwrap();
            for y in range([a.1, b.1, c.1]) {
                for x in range([a.0, b.0, c.0]) {
                    let parts = [cross((x, y), b, c), cross(a, (x, y), c), cross(a, b, (x, y))];
                    if parts.iter().all(|&part| part >= 0) {
                        let corners = parts.iter().zip(triangle);
                        let height: f64 =
                            corners.map(|(&part, corner)| part as f64 * self.heights[corner]).sum();
                        let error = height / area as f64 - self.heights[&(x, y)];
                        let other = *covered.entry((x, y)).or_insert(error);
                        assert!((other - error).abs() <= 1e-9, "a crack at {x}, {y}");
                    }
                }
            }
        }
        covered.values().map(|error| error * error).sum()
    }

    /// Fails unless triangles cover the layout once, edge to edge.
    pub(super) fn assert_conforming(&self, triangles: &[Triangle]) {
        let [right, bottom] = self.layout.extent();
        let edges = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let mut sides = std::collections::BTreeSet::new();
        for edge in edges {
            assert!(sides.insert(edge), "{edge:?} has two triangles on one side");
        }
        for &(from, to) in &sides {
            let on_rim = (from.0 == to.0 && (from.0 == 0 || from.0 == right))
                || (from.1 == to.1 && (from.1 == 0 || from.1 == bottom));
            assert_eq!(sides.contains(&(to, from)), !on_rim, "{from:?} {to:?}");
        }
        let twice = |&[a, b, c]: &Triangle| {
            let [ax, ay, bx, by, cx, cy] = [a.0, a.1, b.0, b.1, c.0, c.1].map(|value| value as i64);
            (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        };
        assert_eq!(triangles.iter().map(twice).sum::<i64>(), 2 * (right * bottom) as i64);
    }
}

/// A graph as lists of children.
fn children(graph: &impl Graph) -> Vec<Vec<usize>> {
    (0..graph.vertices()).map(|vertex| graph.children(vertex).collect()).collect()
}

/// The least distortion for each number of vertices removed, by trying all sets that hold with each vertex its
/// children; and how many such sets there are.
pub(super) fn exhaustive(graph: &impl Graph, deltas: &[f64]) -> (Vec<f64>, usize) {
    let children = children(graph);
    let mut fine_first: Vec<_> = (0..graph.vertices()).collect();
    fine_first.sort_by_key(|&vertex| std::cmp::Reverse(graph.level(vertex)));
    let mut least = vec![f64::INFINITY; deltas.len() + 1];
    let mut sets = 0;
    // Each set with how many of the vertices have been decided on, its size and its distortion.
    let mut pending = vec![(vec![false; deltas.len()], 0, 0, 0.0)];
    while let Some((gone, decided, size, distortion)) = pending.pop() {
        let Some(&vertex) = fine_first.get(decided) else {
            sets += 1;
            least[size] = f64::min(least[size], distortion);
            continue;
        };
        if children[vertex].iter().all(|&child| gone[child]) {
            let mut more = gone.clone();
            more[vertex] = true;
            pending.push((more, decided + 1, size + 1, distortion + deltas[vertex]));
        }
        pending.push((gone, decided + 1, size, distortion));
    }
    (least, sets)
}

/// The corners of the lower convex hull of all pairs of vertices removed and distortion, exactly.
pub(super) fn lower_hull(graph: &impl Graph, deltas: &[i64]) -> Vec<(usize, i64)> {
    let children = children(graph);
    let mut hull = vec![(0, 0), (deltas.len(), deltas.iter().sum())];
    let mut at = 0;
    // Between two corners there is another as long as some set lies below the line that joins them.
    while at + 1 < hull.len() {
        let [from, to] = [hull[at], hull[at + 1]];
        let (run, rise) = ((to.0 - from.0) as i64, to.1 - from.1);
        let above = |(removed, distortion): (usize, i64)| {
            i128::from(distortion) * i128::from(run) - removed as i128 * i128::from(rise)
        };
        let profits: Vec<_> =
            deltas.iter().map(|&delta| i128::from(rise) - i128::from(delta) * i128::from(run)).collect();
        let set = closure(&children, &profits);
        let corner = (set.len(), set.iter().map(|&vertex| deltas[vertex]).sum());
        if above(corner) < above(from) {
            hull.insert(at + 1, corner);
        } else {
            at += 1;
        }
    }
    hull
}

/// How far a distortion lies above the hull with so many vertices removed.
pub(super) fn above_hull(hull: &[(usize, i64)], removed: usize, distortion: f64) -> f64 {
    let pair = hull.windows(2).find(|pair| removed <= pair[1].0).unwrap();
    let [from, to] = [pair[0], pair[1]];
    let part = (removed - from.0) as f64 / (to.0 - from.0) as f64;
    distortion - (from.1 as f64 + (to.1 - from.1) as f64 * part)
}

/// The vertices of greatest profit that hold all of their children: a maximum closure, by a minimum cut (Picard
/// 1976; flow along shortest paths).
fn closure(children: &[Vec<usize>], profits: &[i128]) -> Vec<usize> {
    let (source, sink) = (profits.len(), profits.len() + 1);
    let mut capacities: BTreeMap<(usize, usize), i128> = BTreeMap::new();
    let mut neighbours = vec![Vec::new(); profits.len() + 2];
    let mut join = |from: usize, to: usize, capacity: i128| {
        capacities.insert((from, to), capacity);
        capacities.entry((to, from)).or_insert(0);
        neighbours[from].push(to);
        neighbours[to].push(from);
    };
    for (vertex, &profit) in profits.iter().enumerate() {
        match profit > 0 {
            true => join(source, vertex, profit),
            false => join(vertex, sink, -profit),
        }
        children[vertex].iter().for_each(|&child| join(vertex, child, i128::MAX / 4));
    }
    loop {
        let mut came_from = vec![None; profits.len() + 2];
        came_from[source] = Some(source);
        let mut pending = VecDeque::from([source]);
        while let Some(node) = pending.pop_front() {
            for &next in &neighbours[node] {
                if came_from[next].is_none() && capacities[&(node, next)] > 0 {
                    came_from[next] = Some(node);
                    pending.push_back(next);
                }
            }
        }
        if came_from[sink].is_none() {
            return (0..profits.len()).filter(|&vertex| came_from[vertex].is_some()).collect();
        }
        let back = |node: &usize| came_from[*node].filter(|before| before != node);
        let path: Vec<_> = std::iter::successors(Some(sink), back).collect();
        let along = || path.windows(2).map(|pair| (pair[1], pair[0]));
        let flow = along().map(|edge| capacities[&edge]).min().unwrap();
        for (from, to) in along() {
            *capacities.get_mut(&(from, to)).unwrap() -= flow;
            *capacities.get_mut(&(to, from)).unwrap() += flow;
        }
    }
}
