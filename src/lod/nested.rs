//! A few levels of detail, each an index buffer into a prefix of one vertex buffer.

#[cfg(feature = "deviation")]
use crate::deviation::{Bound, BoundOptions, DeviationError, bound};
use crate::hqms::{Options, Placement, Simplified, SimplifyError, StoppedBy, Target, build_levels};
use crate::mesh::topology::is_face;
use crate::mesh::{Mesh, select};
use crate::monitor::Monitor;

/// A chain of levels from fine to coarse. Level 0 is the input itself; each level names vertices of one
/// buffer, and none beyond a number that falls from level to level.
///
/// ```
/// use decimesh::lod::NestedLevels;
/// use decimesh::mesh::shapes;
/// use decimesh::{Monitor, Options, Target};
///
/// let stone = shapes::bumpy_sphere(32, 1);
/// let targets = [0.5, 0.25, 0.125].map(Target::Ratio);
/// let levels = NestedLevels::build(&stone, &targets, &Options::new(targets[0]), &mut Monitor::silent())?;
/// for (number, level) in levels.levels().iter().enumerate() {
///     let within = |&vertex: &u32| (vertex as usize) < level.vertices;
///     assert!(levels.triangles(number).as_flattened().iter().all(within));
/// }
/// # Ok::<(), decimesh::SimplifyError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct NestedLevels {
    mesh: Mesh,
    order: Vec<u32>,
    levels: Vec<Level>,
    /// Of the levels after the first, whose triangles are those of `mesh`.
    coarser: Vec<Coarser>,
}

/// The triangles of a level.
#[derive(Debug, Clone, PartialEq)]
struct Coarser {
    triangles: Vec<[u32; 3]>,
    groups: Option<Vec<u32>>,
}

/// What is known of a level, but for its triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Its vertices are those before this one in the buffer.
    pub vertices: usize,
    /// Largest distance from the input, in units of the positions: estimated, or a bound once the levels
    /// are [certified](NestedLevels::certify). Never less than that of the level before; 0 for the first.
    pub error: f32,
    /// Why it is as large as it is.
    pub stopped_by: StoppedBy,
    /// Whether holes, handles or components had to be given up, here or on a finer level.
    pub topology_changed: bool,
    /// For each of its vertices the one that it goes into on the next coarser level: itself where it stays,
    /// and where what surrounds it vanishes. A vertex drawn on the way from its own place to that one's
    /// hides the change of levels. Empty on the coarsest level.
    pub morphs: Vec<u32>,
}

impl NestedLevels {
    /// Simplifies `mesh` to each of `targets` in turn, from fine to coarse, as [`build_levels`] does with
    /// [`Placement::Existing`], and puts its vertices in order: those of the coarsest level first, in the
    /// order they had, then what each finer level adds, then those that no triangle uses.
    ///
    /// [`Options::target`] and [`Options::placement`] are not looked at. Where the surface had to be parted
    /// at a vertex (see [`Topology::RelaxIfStuck`](crate::Topology::RelaxIfStuck)), its parts are one vertex
    /// again; a triangle that this leaves with two corners on one vertex is dropped.
    ///
    /// Linear time; besides what [`build_levels`] takes, 4 bytes for each vertex of the input and each level.
    pub fn build(
        mesh: &Mesh,
        targets: &[Target],
        options: &Options,
        monitor: &mut Monitor,
    ) -> Result<Self, SimplifyError> {
        let options = Options {
            placement: Placement::Existing,
            track_origins: true,
            track_sources: true,
            ..options.clone()
        };
        Self::from_levels(mesh, &build_levels(mesh, targets, &options, monitor)?)
    }

    /// The same of levels that [`build_levels`] has made of `mesh`, from fine to coarse. It must have been
    /// asked for [`Placement::Existing`], origins and sources; [`SimplifyError::InvalidOption`] if not.
    pub fn from_levels(mesh: &Mesh, chain: &[Simplified]) -> Result<Self, SimplifyError> {
        let chain = chain.iter().map(|level| Tracked::new(mesh, level)).collect::<Result<Vec<_>, _>>()?;
        let ranks = ranks(mesh, &chain);
        let (order, names, vertices) = sorted(&ranks, chain.len() + 1);

        let renamed = |triangles: &[[u32; 3]], names: &[u32]| -> Vec<[u32; 3]> {
            triangles.iter().map(|triangle| triangle.map(|vertex| names[vertex as usize])).collect()
        };
        let positions = select(mesh.positions(), &order);
        let attributes = mesh.attributes().select(&order);
        let mesh = Mesh::with_attributes(positions, renamed(mesh.triangles(), &names), attributes)?;

        let mut levels = vec![Level {
            vertices: vertices[0],
            error: 0.0,
            stopped_by: StoppedBy::Target,
            topology_changed: false,
            morphs: Vec::new(),
        }];
        let mut coarser = Vec::with_capacity(chain.len());
        for (level, tracked) in (1..).zip(&chain) {
            let Tracked { result, origins, sources } = tracked;
            let finer = &mut levels[level - 1];
            let morph = |name: usize| {
                let kept = name < vertices[level];
                let into = sources.get(origins[order[name] as usize] as usize).filter(|_| !kept);
                into.map_or(name as u32, |&vertex| names[vertex as usize])
            };
            finer.morphs = (0..finer.vertices).map(morph).collect();
            let error = result.error.max(finer.error);
            let names: Vec<u32> = sources.iter().map(|&vertex| names[vertex as usize]).collect();
            let mut triangles = renamed(result.mesh.triangles(), &names);
            let groups = result.groups.as_ref().map(|groups| {
                let kept = groups.iter().zip(&triangles).filter(|(_, triangle)| is_face(triangle));
                kept.map(|(&group, _)| group).collect()
            });
            triangles.retain(is_face);
            let vertices = vertices[level];
            let Simplified { stopped_by, topology_changed, .. } = **result;
            levels.push(Level { vertices, error, stopped_by, topology_changed, morphs: Vec::new() });
            coarser.push(Coarser { triangles, groups });
        }
        Ok(Self { mesh, order, levels, coarser })
    }

    /// The vertex buffer of all levels, and the triangles of level 0.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// For each vertex of the buffer the vertex of the input that it is: every one, once.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The levels from fine to coarse; the first is the input.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The triangles of `level`; corners are vertices of the buffer, below [`Level::vertices`].
    ///
    /// # Panics
    ///
    /// If there is no such level.
    pub fn triangles(&self, level: usize) -> &[[u32; 3]] {
        match level.checked_sub(1) {
            None => self.mesh.triangles(),
            Some(coarser) => &self.coarser[coarser].triangles,
        }
    }

    /// The group of each triangle of `level`, if the levels were made with [`Options::groups`]. `None` for
    /// level 0, whose triangles are those of the input, in their order: its groups are those given.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    pub fn groups(&self, level: usize) -> Option<&[u32]> {
        self.coarser[level.checked_sub(1)?].groups.as_deref()
    }

    /// `level` as a mesh of its own, with the vertices of its prefix.
    ///
    /// # Panics
    ///
    /// If there is no such level.
    pub fn level_mesh(&self, level: usize) -> Mesh {
        self.mesh.prefix(self.levels[level].vertices, self.triangles(level).to_vec())
    }

    /// Puts a guaranteed bound in the place of each level's estimated error: no point of the level is farther
    /// from the input than that, and none of the input from the level. Answers what was found for each level
    /// after the first.
    ///
    /// One call of [`bound`] a level, which takes far longer than [`build`](Self::build). Fails as that does,
    /// also for a level without triangles; then nothing has changed.
    #[cfg(feature = "deviation")]
    pub fn certify(
        &mut self,
        options: &BoundOptions,
        monitor: &mut Monitor,
    ) -> Result<Vec<Bound>, DeviationError> {
        let coarser = self.levels.len() - 1;
        let share = |level: usize| level as f32 / coarser as f32;
        let mut bounds = Vec::with_capacity(coarser);
        for level in 1..=coarser {
            let part = &mut monitor.part(share(level - 1)..share(level));
            bounds.push(bound(&self.mesh, &self.level_mesh(level), options, part)?);
        }
        let mut largest = 0.0f32;
        for (level, found) in self.levels[1..].iter_mut().zip(&bounds) {
            largest = largest.max(found.not_above());
            level.error = largest;
        }
        Ok(bounds)
    }

    /// Writes all levels to the file at `path` as GLB, whole or not at all, as
    /// [`io::write`](crate::io::write) does.
    ///
    /// The vertex buffer is there once. Each level is a node and a mesh, whose accessors end where the level's
    /// vertices do; the node's `extras` hold its `error`. The scene shows the first, which names the others by
    /// the extension `MSFT_lod`. Levels without triangles and vertices that no triangle uses are left out.
    #[cfg(feature = "io")]
    pub fn write_glb(&self, path: &std::path::Path) -> Result<(), crate::io::FileError> {
        let views: Vec<_> = (0..)
            .zip(&self.levels)
            .map(|(number, level)| crate::io::LevelOfDetail {
                vertices: level.vertices,
                triangles: self.triangles(number),
                error: level.error,
            })
            .collect();
        crate::io::write_levels(&self.mesh, &views, path)
    }

    /// The coarsest level whose error is at most `max_error`, in units of the positions: 0 if none but the
    /// input is so good. [`View::error_at`](super::View::error_at) says which error can be seen.
    pub fn coarsest_within(&self, max_error: f32) -> usize {
        super::coarsest_within(self.levels.iter().map(|level| level.error), max_error).unwrap_or(0)
    }
}

/// A level that says where its vertices come from and where those of the input went.
struct Tracked<'a> {
    result: &'a Simplified,
    origins: &'a [u32],
    sources: &'a [u32],
}

impl<'a> Tracked<'a> {
    fn new(mesh: &Mesh, result: &'a Simplified) -> Result<Self, SimplifyError> {
        let invalid = |problem: &str| SimplifyError::InvalidOption(problem.to_owned());
        let (Some(origins), Some(sources)) = (&result.origins, &result.sources) else {
            return Err(invalid("nested levels need origins and sources, which were not asked for"));
        };
        let (input, output) = (mesh.positions(), result.mesh.positions());
        let is_of_mesh = origins.len() == input.len()
            && sources.len() == output.len()
            && sources.iter().zip(output).all(|(&source, place)| input.get(source as usize) == Some(place));
        if !is_of_mesh {
            return Err(invalid("nested levels need levels of the same mesh whose vertices have not moved"));
        }
        Ok(Self { result, origins, sources })
    }
}

/// For each vertex of the input how many levels, from the finest on, it is needed for: up to the last one
/// that names it.
fn ranks(mesh: &Mesh, chain: &[Tracked]) -> Vec<u32> {
    let mut ranks = vec![0; mesh.positions().len()];
    for &vertex in mesh.triangles().as_flattened() {
        ranks[vertex as usize] = 1;
    }
    for (rank, level) in (2..).zip(chain) {
        for &vertex in level.sources {
            ranks[vertex as usize] = rank;
        }
    }
    ranks
}

/// The vertices by falling rank, otherwise in their order; where each went; and for each level how many
/// vertices have the rank that it asks for.
fn sorted(ranks: &[u32], levels: usize) -> (Vec<u32>, Vec<u32>, Vec<usize>) {
    let mut vertices = vec![0; levels + 1];
    for &rank in ranks {
        vertices[rank as usize] += 1;
    }
    // A rank is needed by all levels below it.
    for rank in (0..levels).rev() {
        vertices[rank] += vertices[rank + 1];
    }
    let mut next: Vec<usize> = vertices[1..].iter().copied().chain([0]).collect();
    let mut order = vec![0; ranks.len()];
    let names = (0..)
        .zip(ranks)
        .map(|(vertex, &rank)| {
            let name = &mut next[rank as usize];
            order[*name] = vertex;
            *name += 1;
            *name as u32 - 1
        })
        .collect();
    vertices.remove(0);
    (order, names, vertices)
}
