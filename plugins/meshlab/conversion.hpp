// SPDX-License-Identifier: GPL-3.0-or-later
/// Between MeshLab's meshes and buffers as decimesh takes them: what is taken out of a layer to be simplified (`Part`),
/// and what comes into its place (`Replacement`). Nothing here knows of filters, parameters or windows.
///
/// A layer is never left half changed: everything that can fail is in `take` and in the simplification between; `put`
/// writes what they have made.

#ifndef DECIMESH_MESHLAB_CONVERSION_HPP
#define DECIMESH_MESHLAB_CONVERSION_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include <common/ml_mesh_type.h>
#include <decimesh.hpp>

namespace meshlab_plugin {

/// Which faces of a layer are to be simplified.
enum class Extent { all_faces, selected_faces };

/// Which attributes of a layer mean something, and are to be carried over. Of texture coordinates decimesh has one set:
/// where there are those of wedges, they are taken.
struct Attributes {
    bool normals = false;       ///< of vertices
    bool colors = false;        ///< of vertices
    bool vertex_uvs = false;    ///< ignored where there are `wedge_uvs`
    bool wedge_uvs = false;
};

/// Faces of a layer, and their vertices, as decimesh takes them. A vertex whose wedges have different texture
/// coordinates is here several times, once for each: a seam, as decimesh knows it.
struct Part {
    std::size_t layer_vertices = 0;         ///< how many the layer has room for, deleted ones counted
    bool has_wedge_uvs = false;             ///< whether `uvs` are those of wedges
    bool has_several_textures = false;      ///< whether `textures` differ: then those of faces must not mix
    std::vector<std::uint32_t> faces;       ///< by index in the layer, ascending; `indices` are theirs
    std::vector<std::uint32_t> vertices;    ///< for each vertex here the one of the layer that it is
    std::vector<float> positions;           ///< x y z
    std::vector<float> normals;             ///< x y z; empty where they are not carried
    std::vector<float> uvs;                 ///< u v; empty where they are not carried
    std::vector<std::uint8_t> colors;       ///< red, green, blue, alpha; empty where they are not carried
    std::vector<std::uint32_t> indices;     ///< three a face
    std::vector<std::uint32_t> textures;    ///< for each face which texture it has; empty unless `has_wedge_uvs`
    /// Vertices here that must stay: faces outside or edges use them, or they alone are between two such and the border
    /// of the surface.
    std::vector<std::uint32_t> kept;
    std::vector<bool> is_selected;          ///< for each vertex here whether it is selected in the layer
};

/// Takes `extent` of `mesh`. Of all faces, it takes all vertices, used or not; of selected ones, those that they use.
///
/// Throws `std::invalid_argument`, with MeshLab's indices, where there is no face to take, and where a position, or a
/// texture coordinate that is carried, is infinite or none. Normals that are none are taken as (0, 0, 0): MeshLab makes
/// such of faces without area. n log n time; about 100 bytes a vertex.
Part take(const CMeshO &mesh, Extent extent, const Attributes &attributes);

/// `part` in its own memory, for decimesh to read.
decimesh::Buffers<> buffers_of(const Part &part);

/// What comes into the place of a `Part`.
struct Replacement {
    /// For each vertex the one of the layer that becomes it. Two become one where they are at one place and differ by
    /// their wedges alone. What is `layer_vertices` or more is of `added`.
    std::vector<std::uint32_t> carriers;
    /// For each vertex that the layer needs more than it has, one that it begins as a copy of. Only where seams were
    /// allowed to open.
    std::vector<std::uint32_t> added;
    std::vector<float> positions;           ///< x y z; empty where no vertex has moved
    std::vector<float> normals;             ///< as `Part` has them; empty where no vertex has moved
    std::vector<float> uvs;                 ///< as `Part` has them; those of vertices are empty where none has moved
    std::vector<std::uint8_t> colors;       ///< as `Part` has them; empty where no vertex has moved
    std::vector<std::uint32_t> indices;     ///< three a face
    std::vector<std::uint32_t> textures;    ///< for each face; empty unless `uvs` are those of wedges
};

/// The replacement that `result` is, made of `part`: `origins` say where each vertex of the part went, and `groups` are
/// those of the result. Where no vertex moved and there are several textures, `part.textures` must have been
/// `Options::triangle_groups`; otherwise there are no groups. A vertex becomes one of those that went into it, itself
/// where it has stayed. Linear time.
Replacement moved(const Part &part, decimesh::MeshView result, decimesh::Span<const std::uint32_t> origins,
                  decimesh::Span<const std::uint32_t> groups);

/// The replacement with vertices of `part` as they are: vertex `i` of `indices` is `sources[i]` of `part`. `textures`
/// are those of the faces; where they are empty, vertices must not have gone from one texture to another. Linear time.
Replacement unmoved(const Part &part, decimesh::Span<const std::uint32_t> sources,
                    decimesh::Span<const std::uint32_t> indices, decimesh::Span<const std::uint32_t> textures);

/// Puts `replacement` into the place of `part`, which was taken from `mesh`, or from a mesh with the same numbers of
/// vertices and faces that `mesh` is a copy of. Adjacencies must have been disabled. What is not `part` stays as it is,
/// bit for bit, but for the numbers of vertices and faces, which are made compact.
///
/// New faces have the flags, colour and quality of a new face, and are selected if `selected`. Other attributes of
/// vertices (quality, radius, curvature, flags) are those of the vertex that carries them on. Normals of faces and the
/// bounding box are made anew; those of vertices are as they were carried.
void put(CMeshO &mesh, const Part &part, const Replacement &replacement, bool selected);

/// All of a mesh, where it stands in the document: for measuring.
struct Placed {
    std::vector<std::uint32_t> vertices;    ///< for each vertex here the one of the layer that it is
    std::vector<float> positions;           ///< x y z, by the layer's matrix
    std::vector<std::uint32_t> indices;     ///< three a face; none of a cloud of points
};

/// Throws `std::invalid_argument`, with MeshLab's indices, where there is no vertex or a position is infinite or none.
Placed place(const CMeshO &mesh);

}   // namespace meshlab_plugin

#endif
