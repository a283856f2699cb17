//! `decimesh_simplify`, and the options and the report that all simplifications share.

use super::buffers::{gather, write_elements};
use super::entry::{entry, null};
use super::mesh::decimesh_mesh;
use super::progress::{decimesh_progress, monitor};
use super::status::{
    DECIMESH_ERROR_ENUM, DECIMESH_ERROR_OPTION, DECIMESH_ERROR_UNKNOWN_OPTION, Failure, decimesh_status,
};
use super::structs::{self, Versioned};
use crate::hqms::{
    AttributeWeights, Options, Placement, Selection, Simplified, StoppedBy, Target, Topology, simplify,
};
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use std::ffi::c_void;
use std::ptr;

/// What a simplification shall arrive at.
pub type decimesh_target = i32;
/// At most target_value triangles: that many, or one fewer.
pub const DECIMESH_TARGET_TRIANGLES: decimesh_target = 0;
/// At most target_value vertices that a triangle uses.
pub const DECIMESH_TARGET_VERTICES: decimesh_target = 1;
/// The fraction target_value, 0 to 1, of the input's triangles, rounded down.
pub const DECIMESH_TARGET_RATIO: decimesh_target = 2;
/// As few triangles as an estimated distance of target_value, in units of the positions, allows.
pub const DECIMESH_TARGET_MAX_ERROR: decimesh_target = 3;

/// Which collapses a pass takes.
pub type decimesh_selection = i32;
/// All that cost less than a sampled quantile: the best and fastest.
pub const DECIMESH_SELECTION_SAMPLED_THRESHOLD: decimesh_selection = 0;
/// The paper's: a replacement-selection heap of heap_records records.
pub const DECIMESH_SELECTION_REPLACEMENT: decimesh_selection = 1;

/// What may happen to holes, handles and components.
pub type decimesh_topology = i32;
/// They are kept as long as the target can be reached so, and given up where it cannot.
pub const DECIMESH_TOPOLOGY_RELAX_IF_STUCK: decimesh_topology = 0;
/// They are kept, even if the target is missed.
pub const DECIMESH_TOPOLOGY_KEEP: decimesh_topology = 1;

/// Where the vertex of a collapsed edge goes.
pub type decimesh_placement = i32;
/// Where the error is least: a new vertex.
pub const DECIMESH_PLACEMENT_OPTIMAL: decimesh_placement = 0;
/// To one of the edge's ends: every vertex of the result is a vertex of the input, bit for bit.
pub const DECIMESH_PLACEMENT_EXISTING: decimesh_placement = 1;

/// Why a simplification ended.
pub type decimesh_stopped_by = i32;
/// The target is met.
pub const DECIMESH_STOPPED_BY_TARGET: decimesh_stopped_by = 0;
/// Every further collapse would exceed the error asked for.
pub const DECIMESH_STOPPED_BY_ERROR: decimesh_stopped_by = 1;
/// Every further collapse would change the topology, fold a face over, or move a locked vertex.
pub const DECIMESH_STOPPED_BY_STUCK: decimesh_stopped_by = 2;

/// A vertex that stays, bit for bit: a bit of decimesh_simplify_options.vertex_flags, as the next two are.
pub const DECIMESH_VERTEX_LOCK: u8 = 1;
/// A vertex that goes along seams only, whatever cross_seams says.
pub const DECIMESH_VERTEX_PROTECT: u8 = 2;
/// A vertex that is kept as long as others can go: it costs a hundred times as much.
pub const DECIMESH_VERTEX_PRIORITIZE: u8 = 4;

/// How to simplify. decimesh_simplify_options_init() sets the defaults.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct decimesh_simplify_options {
    /// sizeof(decimesh_simplify_options), as decimesh_simplify_options_init sets it.
    pub struct_size: u32,
    /// What to arrive at: a DECIMESH_TARGET_ value; by default _RATIO.
    pub target: decimesh_target,
    /// How many or how much of it, as target says: a whole number, a fraction or a distance; by default 0.5.
    pub target_value: f64,
    /// Which collapses a pass takes: a DECIMESH_SELECTION_ value; by default _SAMPLED_THRESHOLD.
    pub selection: decimesh_selection,
    /// Records of the heap of DECIMESH_SELECTION_REPLACEMENT, at least 1; by default 15, as in the paper.
    pub heap_records: u32,
    /// What may happen to the topology: a DECIMESH_TOPOLOGY_ value; by default _RELAX_IF_STUCK.
    pub topology: decimesh_topology,
    /// Where vertices go: a DECIMESH_PLACEMENT_ value; by default _OPTIMAL.
    pub placement: decimesh_placement,
    /// 1: vertices of the border stay, bit for bit; by default 0.
    pub lock_boundary: i32,
    /// 1: where several vertices are at one place, as along the seams of textures and the creases of normals,
    /// no crack opens; 0: the sides of a seam are borders, and part. By default 1.
    ///
    /// With DECIMESH_PLACEMENT_EXISTING such vertices go along their seam together, and are known by their
    /// places, with attributes or without. With DECIMESH_PLACEMENT_OPTIMAL they stay, bit for bit, where the
    /// mesh has attributes and in decimesh_simplify_in_place(); what is all seams, such as a faceted mesh,
    /// then gets stuck.
    pub keep_seams: i32,
    /// Threads to use, 0: all that the machine has. The result is the same, byte for byte; by default 0.
    pub threads: u32,
    /// Must be 0.
    pub reserved: u32,
    /// Indices of vertices that stay, bit for bit; NULL where there are none.
    pub locked_vertices: *const u32,
    /// How many locked_vertices there are.
    pub locked_count: usize,
    /// NULL, or room for one index a vertex of the input. It receives the vertex of the result that each
    /// went into, UINT32_MAX where it vanished. Levels have a call of their own for theirs.
    pub origins: *mut u32,
    /// Is told of progress, and can cancel; NULL for none.
    pub progress: decimesh_progress,
    /// Handed to progress as it is.
    pub progress_user: *mut c_void,
    /// What a difference of 1 in a coordinate of a normal weighs, beside a distance as long as the longest
    /// side of the bounding box: finite, not negative; by default 0, no say. The three weights are for
    /// DECIMESH_PLACEMENT_EXISTING; otherwise they change nothing.
    pub normal_weight: f32,
    /// The same for a texture coordinate.
    pub uv_weight: f32,
    /// The same for a channel of a colour, from none (0) to full (255).
    pub color_weight: f32,
    /// 1: with DECIMESH_PLACEMENT_EXISTING vertices may go across seams too, at the cost of the attributes by
    /// their weights: what was on one side then takes the nearest attributes of the other. The surface stays
    /// closed. It is for meshes of many small charts, and for faceted ones, which otherwise get stuck.
    /// By default 0.
    pub cross_seams: i32,
    /// The group of each triangle of the input, such as its material, or NULL: where groups meet, their
    /// border stays a border. For DECIMESH_PLACEMENT_EXISTING only.
    pub triangle_groups: *const u32,
    /// NULL, or room for one group a triangle of the input, where triangle_groups is not NULL. It receives
    /// the group of each triangle of the result. Levels have calls of their own for theirs.
    pub result_groups: *mut u32,
    /// For each vertex of the input what it may do, DECIMESH_VERTEX_ bits or 0; or NULL.
    /// locked_vertices count as well. The last two bits are for DECIMESH_PLACEMENT_EXISTING; otherwise they
    /// change nothing.
    pub vertex_flags: *const u8,
    /// 1: vertices are moved and edges turned in the end, so that the surface is nearer to the input's: its RMS
    /// distance falls by 6 to 10 %; the largest one may rise. All takes 1.2 times as long at a hundredth of the
    /// triangles, 1.6 at a tenth, and up to 4 at a half. Vertices that are locked or on a border stay. For
    /// DECIMESH_PLACEMENT_OPTIMAL only; otherwise 1 is DECIMESH_ERROR_OPTION. By default 0.
    pub refine: i32,
    /// 1: levels remember what became of each vertex of the input, for decimesh_levels_origins(). For
    /// decimesh_levels_build(); elsewhere it changes nothing. By default 0.
    pub level_origins: i32,
}

// SAFETY: repr(C); integers, a double, pointers and sizes that leave no gap between them; a function
// pointer may have any bits but those of no function, which the caller vouches for.
unsafe impl Versioned for decimesh_simplify_options {
    const NAME: &'static str = "decimesh_simplify_options";

    fn initial() -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            target: DECIMESH_TARGET_RATIO,
            target_value: 0.5,
            selection: DECIMESH_SELECTION_SAMPLED_THRESHOLD,
            heap_records: 15,
            topology: DECIMESH_TOPOLOGY_RELAX_IF_STUCK,
            placement: DECIMESH_PLACEMENT_OPTIMAL,
            lock_boundary: 0,
            keep_seams: 1,
            threads: 0,
            reserved: 0,
            locked_vertices: ptr::null(),
            locked_count: 0,
            origins: ptr::null_mut(),
            progress: None,
            progress_user: ptr::null_mut(),
            normal_weight: 0.0,
            uv_weight: 0.0,
            color_weight: 0.0,
            cross_seams: 0,
            triangle_groups: ptr::null(),
            result_groups: ptr::null_mut(),
            vertex_flags: ptr::null(),
            refine: 0,
            level_origins: 0,
        }
    }
}

/// How a simplification came about. decimesh_simplify_report_init() sets it up.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct decimesh_simplify_report {
    /// sizeof(decimesh_simplify_report), as decimesh_simplify_report_init sets it.
    pub struct_size: u32,
    /// Why it ended: a DECIMESH_STOPPED_BY_ value.
    pub stopped_by: decimesh_stopped_by,
    /// Triangles of the result.
    pub triangles: u64,
    /// Vertices of the result.
    pub vertices: u64,
    /// Vertices of the input that were locked: by index, as borders, or as seams.
    pub locked_vertices: u64,
    /// Estimated largest distance from the input, in units of the positions.
    pub error: f32,
    /// 1 if holes, handles or components had to be given up to meet the target.
    pub topology_changed: i32,
    /// Passes over the mesh: the levels of approximation of the paper.
    pub passes: u32,
    /// Always 0.
    pub reserved: u32,
    /// Estimated largest difference of the attributes from the input's, by their weights: in units of the
    /// positions, a difference of 1 being the weight times the longest side of the bounding box. 0 where no
    /// attribute has a weight.
    pub attribute_error: f32,
    /// Always 0.
    pub reserved_padding: u32,
}

// SAFETY: repr(C); integers and floats that leave no gap between them.
unsafe impl Versioned for decimesh_simplify_report {
    const NAME: &'static str = "decimesh_simplify_report";

    fn initial() -> Self {
        Self { struct_size: size_of::<Self>() as u32, ..Self::default() }
    }
}

pub(super) fn stopped_by(reason: StoppedBy) -> decimesh_stopped_by {
    match reason {
        StoppedBy::Target => DECIMESH_STOPPED_BY_TARGET,
        StoppedBy::Error => DECIMESH_STOPPED_BY_ERROR,
        StoppedBy::Stuck => DECIMESH_STOPPED_BY_STUCK,
    }
}

impl From<&Simplified> for decimesh_simplify_report {
    fn from(simplified: &Simplified) -> Self {
        Self {
            stopped_by: stopped_by(simplified.stopped_by),
            triangles: simplified.mesh.triangles().len() as u64,
            vertices: simplified.mesh.positions().len() as u64,
            locked_vertices: simplified.locked as u64,
            error: simplified.error,
            topology_changed: simplified.topology_changed.into(),
            passes: u32::try_from(simplified.passes).unwrap_or(u32::MAX),
            attribute_error: simplified.attribute_error,
            ..Self::initial()
        }
    }
}

/// Where a report goes, if anywhere.
pub(super) struct ReportPlace {
    pointer: *mut decimesh_simplify_report,
    size: usize,
}

impl ReportPlace {
    /// # Safety
    /// `pointer` is NULL or points to a struct as long as its first field says.
    pub(super) unsafe fn new(pointer: *mut decimesh_simplify_report) -> Result<Self, Failure> {
        // SAFETY: as the caller of this function promises.
        let size = if pointer.is_null() { 0 } else { unsafe { structs::size(pointer)? } };
        Ok(Self { pointer, size })
    }

    /// # Safety
    /// The struct still is there.
    pub(super) unsafe fn write(&self, report: &decimesh_simplify_report) {
        if !self.pointer.is_null() {
            // SAFETY: as the caller of this function promises, and the size is the struct's own.
            unsafe { structs::write(self.pointer, self.size, report) };
        }
    }
}

impl decimesh_simplify_options {
    /// The options of `pointer`, all checked but those that depend on the mesh or the target.
    ///
    /// # Safety
    /// `pointer` is not NULL and points to a struct as long as its first field says, whose pointers are
    /// good.
    pub(super) unsafe fn read(pointer: *const Self) -> Result<(Self, Options), Failure> {
        // SAFETY: as the caller of this function promises.
        unsafe {
            let own = structs::read(pointer)?;
            let options = own.with_target(own.target(own.target_value)?)?;
            Ok((own, options))
        }
    }

    /// The options with this target in place of their own, but for what [`complete`](Self::complete) adds.
    ///
    /// # Safety
    /// The pointers are good.
    pub(super) unsafe fn with_target(&self, target: Target) -> Result<Options, Failure> {
        if self.reserved != 0 {
            let message =
                format!("reserved is {}, not 0: it is an option of a newer decimesh", self.reserved);
            return Err(Failure::new(DECIMESH_ERROR_UNKNOWN_OPTION, message));
        }
        self.keeps_level_origins()?;
        let selection = match self.selection {
            DECIMESH_SELECTION_SAMPLED_THRESHOLD => Selection::SampledThreshold,
            DECIMESH_SELECTION_REPLACEMENT => {
                Selection::ReplacementSelection { records: self.heap_records as usize }
            }
            other => return Err(foreign("selection", other)),
        };
        let topology = match self.topology {
            DECIMESH_TOPOLOGY_RELAX_IF_STUCK => Topology::RelaxIfStuck,
            DECIMESH_TOPOLOGY_KEEP => Topology::Keep,
            other => return Err(foreign("topology", other)),
        };
        let placement = match self.placement {
            DECIMESH_PLACEMENT_OPTIMAL => Placement::Optimal,
            DECIMESH_PLACEMENT_EXISTING => Placement::Existing,
            other => return Err(foreign("placement", other)),
        };
        let locked = match (self.locked_vertices.is_null(), self.locked_count) {
            (_, 0) => Vec::new(),
            (true, _) => return Err(null("locked_vertices")),
            // SAFETY: as the caller of this function promises.
            (false, count) => unsafe { read_locked(self.locked_vertices, count)? },
        };
        if self.triangle_groups.is_null() && !self.result_groups.is_null() {
            let message = "result_groups must be NULL where triangle_groups is: there are no groups";
            return Err(Failure::new(DECIMESH_ERROR_OPTION, message));
        }
        Ok(Options {
            selection,
            topology,
            placement,
            lock_boundary: switch("lock_boundary", self.lock_boundary)?,
            keep_seams: switch("keep_seams", self.keep_seams)?,
            cross_seams: switch("cross_seams", self.cross_seams)?,
            refine: switch("refine", self.refine)?,
            attribute_weights: AttributeWeights {
                normals: self.normal_weight,
                uvs: self.uv_weight,
                colors: self.color_weight,
            },
            locked,
            threads: self.threads as usize,
            track_origins: !self.origins.is_null(),
            ..Options::new(target)
        })
    }

    /// Whether levels are to remember what became of each vertex.
    pub(super) fn keeps_level_origins(&self) -> Result<bool, Failure> {
        switch("level_origins", self.level_origins)
    }

    /// `options` with what there is one of for each vertex or triangle of `mesh`.
    ///
    /// # Safety
    /// The pointers are good.
    pub(super) unsafe fn complete(&self, mut options: Options, mesh: &Mesh) -> Result<Options, Failure> {
        if !self.triangle_groups.is_null() {
            // SAFETY: as the caller of this function promises.
            let groups =
                unsafe { gather("triangle_groups", self.triangle_groups, 0, mesh.triangles().len())? };
            options.groups = Some(groups.iter().map(|&[group]| group).collect());
        }
        if !self.vertex_flags.is_null() {
            for vertex in 0..mesh.positions().len() {
                // SAFETY: as the caller of this function promises.
                let flags = unsafe { self.vertex_flags.add(vertex).read() };
                if flags & !VERTEX_FLAGS != 0 {
                    let message = format!(
                        "vertex_flags of vertex {vertex} are {flags}, of which {} is no DECIMESH_VERTEX_ bit",
                        flags & !VERTEX_FLAGS
                    );
                    return Err(Failure::new(DECIMESH_ERROR_OPTION, message));
                }
                for (flag, list) in [
                    (DECIMESH_VERTEX_LOCK, &mut options.locked),
                    (DECIMESH_VERTEX_PROTECT, &mut options.protected),
                    (DECIMESH_VERTEX_PRIORITIZE, &mut options.prioritized),
                ] {
                    if flags & flag != 0 {
                        list.push(vertex as u32);
                    }
                }
            }
        }
        Ok(options)
    }

    /// The target of this kind with another value.
    pub(super) fn target(&self, value: f64) -> Result<Target, Failure> {
        let count = || {
            // Above this, doubles are not exact; no mesh is so large.
            if value >= 0.0 && value <= 2f64.powi(53) && value.fract() == 0.0 {
                Ok(value as usize)
            } else {
                Err(Failure::new(
                    DECIMESH_ERROR_OPTION,
                    format!("target_value {value} is not a whole number"),
                ))
            }
        };
        match self.target {
            DECIMESH_TARGET_TRIANGLES => count().map(Target::Triangles),
            DECIMESH_TARGET_VERTICES => count().map(Target::Vertices),
            DECIMESH_TARGET_RATIO => Ok(Target::Ratio(value)),
            DECIMESH_TARGET_MAX_ERROR => Ok(Target::MaxError(value as f32)),
            other => Err(foreign("target", other)),
        }
    }

    /// # Safety
    /// [`progress`](Self::progress) may be called on this thread with its user's pointer.
    pub(super) unsafe fn monitor(&self) -> Monitor<'static> {
        // SAFETY: as the caller of this function promises.
        unsafe { monitor(self.progress, self.progress_user) }
    }

    /// Hands origins and groups to the caller, if these were asked for.
    ///
    /// # Safety
    /// What was asked for has room for them.
    pub(super) unsafe fn write_elements(&self, origins: Option<&[u32]>, groups: Option<&[u32]>) {
        for (destination, elements) in [(self.origins, origins), (self.result_groups, groups)] {
            // SAFETY: as the caller of this function promises.
            unsafe { write_elements(destination, elements.unwrap_or_default()) };
        }
    }

    /// Refuses room for what levels do not have.
    pub(super) fn refuse_elements(&self) -> Result<(), Failure> {
        for (name, pointer) in [("origins", self.origins), ("result_groups", self.result_groups)] {
            if !pointer.is_null() {
                let message = format!("{name} must be NULL: levels do not fill it");
                return Err(Failure::new(DECIMESH_ERROR_OPTION, message));
            }
        }
        Ok(())
    }
}

/// All bits of `vertex_flags` that mean something.
const VERTEX_FLAGS: u8 = DECIMESH_VERTEX_LOCK | DECIMESH_VERTEX_PROTECT | DECIMESH_VERTEX_PRIORITIZE;

pub(super) fn foreign(option: &str, value: i32) -> Failure {
    Failure::new(DECIMESH_ERROR_ENUM, format!("{option} is {value}, which is none of its values"))
}

pub(super) fn switch(option: &str, value: i32) -> Result<bool, Failure> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Failure::new(DECIMESH_ERROR_OPTION, format!("{option} is {value}, neither 0 nor 1"))),
    }
}

/// # Safety
/// `first` points to `count` indices.
pub(super) unsafe fn read_locked(first: *const u32, count: usize) -> Result<Vec<u32>, Failure> {
    if count > u32::MAX as usize {
        let message = format!("locked_count is {count}, more than a mesh can have vertices");
        return Err(Failure::new(DECIMESH_ERROR_OPTION, message));
    }
    // SAFETY: as the caller of this function promises.
    let locked = unsafe { gather("locked_vertices", first, 0, count)? };
    Ok(locked.iter().map(|&[vertex]| vertex).collect())
}

/// Sets the defaults: half of the triangles, new vertices, all threads. NULL is left alone.
///
/// struct_size is sizeof(decimesh_simplify_options), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_simplify_options_init(
    options: *mut decimesh_simplify_options,
    struct_size: usize,
) {
    // SAFETY: the caller\'s pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(options, struct_size) }
}

/// Sets struct_size and makes all else 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_simplify_report), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_simplify_report_init(
    report: *mut decimesh_simplify_report,
    struct_size: usize,
) {
    // SAFETY: the caller\'s pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(report, struct_size) }
}

/// Simplifies a mesh by quadric edge collapses, in linear time (HQMS: Chen, Fahn, Tsai, Chen and Lin, "A
/// Linear Time Algorithm for High Quality Mesh Simplification").
///
/// A target that cannot be met is no failure: the result is then as small as the options allow, and the
/// report says why it stopped. With DECIMESH_PLACEMENT_OPTIMAL attributes are interpolated, and do not count
/// as error; with _EXISTING they count by their weights. The input is not changed. The result depends on the
/// mesh and the options alone: not on the threads, nor on the language of the caller.
///
/// *simplified receives a new mesh, which the caller ends with decimesh_mesh_destroy(). *report, if it is
/// not NULL, has been set up by decimesh_simplify_report_init. Fails with _NULL, _STRUCT_SIZE,
/// _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
///
/// Linear time; about 24 bytes of memory a triangle, and the result. Any thread; progress is told on the
/// calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_simplify(
    mesh: *const decimesh_mesh,
    options: *const decimesh_simplify_options,
    simplified: *mut *mut decimesh_mesh,
    report: *mut decimesh_simplify_report,
) -> decimesh_status {
    entry!([mesh, options, simplified] {
        // SAFETY: none is NULL but perhaps the report, and the caller vouches for what they point to.
        unsafe {
            let mesh = (*mesh).mesh();
            let (own, options) = decimesh_simplify_options::read(options)?;
            let options = own.complete(options, mesh)?;
            let report = ReportPlace::new(report)?;
            let result = simplify(mesh, &options, &mut own.monitor())?;
            report.write(&(&result).into());
            own.write_elements(result.origins.as_deref(), result.groups.as_deref());
            decimesh_mesh::give(result.mesh, simplified);
        }
        Ok(())
    })
}
