// SPDX-License-Identifier: GPL-3.0-or-later
#include "conversion.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace meshlab_plugin {

namespace {

static_assert(std::is_same<Scalarm, float>::value, "decimesh has positions of 32 bits, as Debian's MeshLab has");

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

std::uint32_t index_of(std::size_t index) {
    return static_cast<std::uint32_t>(index);
}

std::uint32_t vertex_of(const CMeshO &mesh, const CFaceO &face, int corner) {
    return index_of(vcg::tri::Index(mesh, face.cV(corner)));
}

bool is_finite(const Point3m &point) {
    return std::isfinite(point.X()) && std::isfinite(point.Y()) && std::isfinite(point.Z());
}

void require_finite(const Point3m &position, std::size_t vertex) {
    if (!is_finite(position)) {
        throw std::invalid_argument("vertex " + std::to_string(vertex) +
                                    " has a coordinate that is infinite or not a number");
    }
}

void require_finite(float u, float v, const char *owner, std::size_t index) {
    if (!std::isfinite(u) || !std::isfinite(v)) {
        throw std::invalid_argument(std::string(owner) + " " + std::to_string(index) +
                                    " has a texture coordinate that is infinite or not a number");
    }
}

void append(std::vector<float> &numbers, const Point3m &point) {
    numbers.insert(numbers.end(), {point.X(), point.Y(), point.Z()});
}

Point3m point_at(const std::vector<float> &numbers, std::size_t place) {
    return {numbers[3 * place], numbers[3 * place + 1], numbers[3 * place + 2]};
}

/// Makes a `Part`: each vertex once, then once more for each further texture coordinate of its wedges.
class Taker {
public:
    Taker(const CMeshO &mesh, const Attributes &attributes) : mesh_(mesh), attributes_(attributes) {
        part_.layer_vertices = mesh.vert.size();
        part_.has_wedge_uvs = attributes.wedge_uvs;
    }

    Part take(Extent extent) {
        take_faces(extent);
        take_vertices(extent);
        if (attributes_.wedge_uvs) {
            take_wedges();
        } else {
            take_corners();
        }
        take_attributes();
        find_kept();
        return std::move(part_);
    }

private:
    void take_faces(Extent extent) {
        for (std::size_t face = 0; face < mesh_.face.size(); ++face) {
            const CFaceO &candidate = mesh_.face[face];
            if (!candidate.IsD() && (extent == Extent::all_faces || candidate.IsS())) {
                part_.faces.push_back(index_of(face));
            }
        }
        if (part_.faces.empty()) {
            throw std::invalid_argument(extent == Extent::all_faces ? "the layer has no faces" : "no face is selected");
        }
    }

    void take_vertices(Extent extent) {
        std::vector<bool> is_wanted(mesh_.vert.size(), extent == Extent::all_faces);
        if (extent == Extent::selected_faces) {
            for (const std::uint32_t face : part_.faces) {
                for (int corner = 0; corner < 3; ++corner) {
                    is_wanted[vertex_of(mesh_, mesh_.face[face], corner)] = true;
                }
            }
        }
        first_of_.assign(mesh_.vert.size(), none);
        for (std::size_t vertex = 0; vertex < mesh_.vert.size(); ++vertex) {
            if (is_wanted[vertex] && !mesh_.vert[vertex].IsD()) {
                require_finite(mesh_.vert[vertex].cP(), vertex);
                first_of_[vertex] = index_of(part_.vertices.size());
                part_.vertices.push_back(index_of(vertex));
            }
        }
    }

    void take_corners() {
        part_.indices.reserve(3 * part_.faces.size());
        for (const std::uint32_t face : part_.faces) {
            for (int corner = 0; corner < 3; ++corner) {
                part_.indices.push_back(first_of_[vertex_of(mesh_, mesh_.face[face], corner)]);
            }
        }
    }

    void take_wedges() {
        part_.indices.reserve(3 * part_.faces.size());
        part_.uvs.assign(2 * part_.vertices.size(), 0);
        texture_of_.assign(part_.vertices.size(), none);
        next_.assign(part_.vertices.size(), none);
        for (const std::uint32_t face : part_.faces) {
            const CFaceO &taken = mesh_.face[face];
            // The texture is the face's, though each wedge says it: MeshLab draws by the first.
            const std::uint32_t texture = static_cast<std::uint16_t>(taken.cWT(0).n());
            for (int corner = 0; corner < 3; ++corner) {
                const float u = taken.cWT(corner).u();
                const float v = taken.cWT(corner).v();
                require_finite(u, v, "face", face);
                part_.indices.push_back(copy_with(first_of_[vertex_of(mesh_, taken, corner)], u, v, texture));
            }
            part_.textures.push_back(texture);
        }
        part_.has_several_textures =
            std::any_of(part_.textures.begin(), part_.textures.end(),
                        [this](std::uint32_t texture) { return texture != part_.textures.front(); });
    }

    /// The copy of a vertex, whose first one is given, with such a wedge; made if there is none yet.
    std::uint32_t copy_with(std::uint32_t first, float u, float v, std::uint32_t texture) {
        std::uint32_t last = first;
        for (std::uint32_t copy = first; copy != none; copy = next_[copy]) {
            if (texture_of_[copy] == none) {
                set_wedge(copy, u, v, texture);
                return copy;
            }
            if (texture_of_[copy] == texture && part_.uvs[2 * copy] == u && part_.uvs[2 * copy + 1] == v) {
                return copy;
            }
            last = copy;
        }
        const std::uint32_t added = index_of(part_.vertices.size());
        part_.vertices.push_back(part_.vertices[first]);
        part_.uvs.resize(part_.uvs.size() + 2);
        texture_of_.push_back(none);
        next_.push_back(none);
        next_[last] = added;
        set_wedge(added, u, v, texture);
        return added;
    }

    void set_wedge(std::uint32_t copy, float u, float v, std::uint32_t texture) {
        part_.uvs[2 * copy] = u;
        part_.uvs[2 * copy + 1] = v;
        texture_of_[copy] = texture;
    }

    void take_attributes() {
        const bool takes_uvs = attributes_.vertex_uvs && !attributes_.wedge_uvs;
        for (const std::uint32_t index : part_.vertices) {
            const CVertexO &vertex = mesh_.vert[index];
            append(part_.positions, vertex.cP());
            if (attributes_.normals) {
                append(part_.normals, is_finite(vertex.cN()) ? vertex.cN() : Point3m(0, 0, 0));
            }
            if (attributes_.colors) {
                const vcg::Color4b color = vertex.cC();
                part_.colors.insert(part_.colors.end(), {color[0], color[1], color[2], color[3]});
            }
            if (takes_uvs) {
                const float u = vertex.cT().u();
                const float v = vertex.cT().v();
                require_finite(u, v, "vertex", index);
                part_.uvs.insert(part_.uvs.end(), {u, v});
            }
            part_.is_selected.push_back(vertex.IsS());
        }
    }

    void find_kept() {
        std::vector<bool> is_kept(mesh_.vert.size(), false);
        auto next_taken = part_.faces.begin();
        for (std::size_t face = 0; face < mesh_.face.size(); ++face) {
            if (next_taken != part_.faces.end() && *next_taken == face) {
                ++next_taken;
            } else if (!mesh_.face[face].IsD()) {
                for (int corner = 0; corner < 3; ++corner) {
                    is_kept[vertex_of(mesh_, mesh_.face[face], corner)] = true;
                }
            }
        }
        for (const CEdgeO &edge : mesh_.edge) {
            if (!edge.IsD()) {
                is_kept[vcg::tri::Index(mesh_, edge.cV(0))] = true;
                is_kept[vcg::tri::Index(mesh_, edge.cV(1))] = true;
            }
        }
        keep_ears(is_kept);
        for (std::size_t copy = 0; copy < part_.vertices.size(); ++copy) {
            if (is_kept[part_.vertices[copy]]) {
                part_.kept.push_back(index_of(copy));
            }
        }
    }

    /// A face at the border to the rest whose third vertex is at the border of the surface could go with that vertex,
    /// and the face beyond would be at the border then: so that one is kept, too.
    void keep_ears(std::vector<bool> &is_kept) const {
        if (std::find(is_kept.begin(), is_kept.end(), true) == is_kept.end()) {
            return;
        }
        const std::vector<bool> is_at_border = border_vertices();
        const std::vector<bool> is_shared = is_kept;
        for (const std::uint32_t face : part_.faces) {
            std::uint32_t third = none;
            int shared = 0;
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = vertex_of(mesh_, mesh_.face[face], corner);
                if (is_shared[vertex]) {
                    ++shared;
                } else {
                    third = vertex;
                }
            }
            if (shared == 2 && is_at_border[third]) {
                is_kept[third] = true;
            }
        }
    }

    /// Whether each vertex of the layer is at an edge of one face of the part alone.
    std::vector<bool> border_vertices() const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        edges.reserve(3 * part_.faces.size());
        for (const std::uint32_t face : part_.faces) {
            for (int corner = 0; corner < 3; ++corner) {
                edges.push_back(std::minmax({vertex_of(mesh_, mesh_.face[face], corner),
                                             vertex_of(mesh_, mesh_.face[face], (corner + 1) % 3)}));
            }
        }
        std::sort(edges.begin(), edges.end());
        std::vector<bool> is_at_border(mesh_.vert.size(), false);
        for (auto edge = edges.begin(); edge != edges.end();) {
            const auto next = std::find_if(edge, edges.end(), [&](const auto &other) { return other != *edge; });
            if (next - edge == 1) {
                is_at_border[edge->first] = true;
                is_at_border[edge->second] = true;
            }
            edge = next;
        }
        return is_at_border;
    }

    const CMeshO &mesh_;
    const Attributes attributes_;
    Part part_;
    std::vector<std::uint32_t> first_of_;      ///< for each vertex of the layer its first copy
    std::vector<std::uint32_t> next_;          ///< for each copy the next one of the same vertex
    std::vector<std::uint32_t> texture_of_;    ///< for each copy its texture; none as long as no face has shown it
};

/// The textures of triangles over vertices that each are of one.
std::vector<std::uint32_t> textures_by(const std::vector<std::uint32_t> &texture_of,
                                       decimesh::Span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> textures(indices.size() / 3);
    for (std::size_t face = 0; face < textures.size(); ++face) {
        textures[face] = texture_of[indices[3 * face]];
    }
    return textures;
}

std::vector<std::uint32_t> textures_of_vertices(const Part &part) {
    std::vector<std::uint32_t> textures(part.vertices.size(), 0);
    for (std::size_t corner = 0; corner < part.indices.size(); ++corner) {
        textures[part.indices[corner]] = part.textures[corner / 3];
    }
    return textures;
}

/// Finds which vertices of the layer carry those of a result on.
class Carriers {
public:
    Carriers(const Part &part, decimesh::MeshView result, decimesh::Span<const std::uint32_t> origins)
        : part_(part), result_(result), origins_(origins), carriers_(result.vertex_count(), none),
          is_taken_(part.layer_vertices, false) {}

    void find(Replacement &replacement) {
        take_those_that_stayed();
        take_kept();
        take_others(replacement.added);
        replacement.carriers = std::move(carriers_);
    }

private:
    /// Copies of one vertex that have stayed become that vertex again.
    void take_those_that_stayed() {
        const decimesh::Span<const float> positions = result_.positions();
        for_each_origin([&](std::uint32_t copy, std::uint32_t vertex) {
            const float *before = part_.positions.data() + 3 * std::size_t{copy};
            const float *after = positions.data() + 3 * std::size_t{vertex};
            if (std::memcmp(before, after, 3 * sizeof(float)) == 0) {
                carriers_[vertex] = std::min(carriers_[vertex], part_.vertices[copy]);
            }
        });
    }

    /// Where another vertex lay on one that faces outside use, it is that one which has to go on.
    void take_kept() {
        for (const std::uint32_t copy : part_.kept) {
            is_taken_[part_.vertices[copy]] = true;
            if (origins_[copy] != decimesh::vanished) {
                carriers_[origins_[copy]] = part_.vertices[copy];
            }
        }
    }

    void take_others(std::vector<std::uint32_t> &added) {
        for (const std::uint32_t carrier : carriers_) {
            if (carrier != none) {
                is_taken_[carrier] = true;
            }
        }
        for_each_origin([&](std::uint32_t copy, std::uint32_t vertex) {
            const std::uint32_t candidate = part_.vertices[copy];
            if (carriers_[vertex] == none && !is_taken_[candidate]) {
                carriers_[vertex] = candidate;
                is_taken_[candidate] = true;
            }
        });
        for_each_origin([&](std::uint32_t copy, std::uint32_t vertex) {
            if (carriers_[vertex] == none) {
                carriers_[vertex] = index_of(part_.layer_vertices + added.size());
                added.push_back(part_.vertices[copy]);
            }
        });
        if (std::find(carriers_.begin(), carriers_.end(), none) != carriers_.end()) {
            throw std::logic_error("decimesh made a vertex of nothing");
        }
    }

    template <class Call>
    void for_each_origin(Call call) const {
        for (std::size_t copy = 0; copy < origins_.size(); ++copy) {
            if (origins_[copy] != decimesh::vanished) {
                call(index_of(copy), origins_[copy]);
            }
        }
    }

    const Part &part_;
    const decimesh::MeshView result_;
    const decimesh::Span<const std::uint32_t> origins_;
    std::vector<std::uint32_t> carriers_;
    std::vector<bool> is_taken_;
};

template <class T>
std::vector<T> copy_of(decimesh::Span<const T> span) {
    return {span.begin(), span.end()};
}

/// Writes what vertices carry; those that faces outside use are not to be written to.
void write_vertices(CMeshO &mesh, const Part &part, const Replacement &replacement) {
    std::vector<bool> is_kept(mesh.vert.size(), false);
    for (const std::uint32_t copy : part.kept) {
        is_kept[part.vertices[copy]] = true;
    }
    for (std::size_t place = 0; place < replacement.carriers.size(); ++place) {
        if (is_kept[replacement.carriers[place]]) {
            continue;
        }
        CVertexO &vertex = mesh.vert[replacement.carriers[place]];
        if (!replacement.positions.empty()) {
            vertex.P() = point_at(replacement.positions, place);
        }
        if (!replacement.normals.empty()) {
            vertex.N() = point_at(replacement.normals, place);
        }
        if (!replacement.colors.empty()) {
            const std::uint8_t *color = &replacement.colors[4 * place];
            vertex.C() = vcg::Color4b(color[0], color[1], color[2], color[3]);
        }
        if (!replacement.uvs.empty() && !part.has_wedge_uvs) {
            vertex.T().u() = replacement.uvs[2 * place];
            vertex.T().v() = replacement.uvs[2 * place + 1];
        }
    }
}

void write_face(CMeshO &mesh, const Part &part, const Replacement &replacement, std::size_t place, bool selected) {
    CFaceO &face = mesh.face[part.faces[place]];
    face.Flags() = 0;
    if (selected) {
        face.SetS();
    }
    for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t index = replacement.indices[3 * place + static_cast<std::size_t>(corner)];
        face.V(corner) = &mesh.vert[replacement.carriers[index]];
        if (part.has_wedge_uvs) {
            face.WT(corner).u() = replacement.uvs[2 * std::size_t{index}];
            face.WT(corner).v() = replacement.uvs[2 * std::size_t{index} + 1];
            face.WT(corner).n() = static_cast<short>(static_cast<std::uint16_t>(replacement.textures[place]));
        }
    }
    if (mesh.face.IsColorEnabled()) {
        face.C() = vcg::Color4b(vcg::Color4b::White);
    }
    if (mesh.face.IsQualityEnabled()) {
        face.Q() = 0;
    }
}

/// Vertices of `part` that neither its new faces nor others use.
void delete_unused(CMeshO &mesh, const Part &part, const Replacement &replacement) {
    std::vector<bool> is_used(mesh.vert.size(), false);
    for (const std::uint32_t copy : part.kept) {
        is_used[part.vertices[copy]] = true;
    }
    for (const std::uint32_t index : replacement.indices) {
        is_used[replacement.carriers[index]] = true;
    }
    for (const std::uint32_t vertex : part.vertices) {
        if (!is_used[vertex] && !mesh.vert[vertex].IsD()) {
            vcg::tri::Allocator<CMeshO>::DeleteVertex(mesh, mesh.vert[vertex]);
        }
    }
}

}   // namespace

Part take(const CMeshO &mesh, Extent extent, const Attributes &attributes) {
    return Taker(mesh, attributes).take(extent);
}

decimesh::Buffers<> buffers_of(const Part &part) {
    decimesh::Buffers<> buffers;
    buffers.positions = part.positions;
    buffers.indices = part.indices;
    buffers.normals = part.normals;
    buffers.uvs = part.uvs;
    buffers.colors = part.colors;
    return buffers;
}

Replacement moved(const Part &part, decimesh::MeshView result, decimesh::Span<const std::uint32_t> origins,
                  decimesh::Span<const std::uint32_t> groups) {
    Replacement replacement;
    Carriers(part, result, origins).find(replacement);
    replacement.positions = copy_of(result.positions());
    replacement.normals = copy_of(result.normals());
    replacement.uvs = copy_of(result.uvs());
    replacement.colors = copy_of(result.colors());
    replacement.indices = copy_of(result.indices());
    if (!groups.empty()) {
        replacement.textures = copy_of(groups);
    } else if (part.has_wedge_uvs) {
        const std::vector<std::uint32_t> before = textures_of_vertices(part);
        std::vector<std::uint32_t> after(result.vertex_count(), 0);
        for (std::size_t copy = 0; copy < origins.size(); ++copy) {
            if (origins[copy] != decimesh::vanished) {
                after[origins[copy]] = before[copy];
            }
        }
        replacement.textures = textures_by(after, replacement.indices);
    }
    return replacement;
}

Replacement unmoved(const Part &part, decimesh::Span<const std::uint32_t> sources,
                    decimesh::Span<const std::uint32_t> indices, decimesh::Span<const std::uint32_t> textures) {
    Replacement replacement;
    replacement.indices = copy_of(indices);
    for (const std::uint32_t source : sources) {
        replacement.carriers.push_back(part.vertices[source]);
    }
    if (part.has_wedge_uvs) {
        const std::vector<std::uint32_t> before = textures_of_vertices(part);
        std::vector<std::uint32_t> after;
        for (const std::size_t source : sources) {
            replacement.uvs.insert(replacement.uvs.end(), {part.uvs[2 * source], part.uvs[2 * source + 1]});
            after.push_back(before[source]);
        }
        replacement.textures = textures.empty() ? textures_by(after, indices) : copy_of(textures);
    }
    return replacement;
}

void put(CMeshO &mesh, const Part &part, const Replacement &replacement, bool selected) {
    using Allocator = vcg::tri::Allocator<CMeshO>;
    if (!replacement.added.empty()) {
        Allocator::AddVertices(mesh, replacement.added.size());
        for (std::size_t place = 0; place < replacement.added.size(); ++place) {
            mesh.vert[part.layer_vertices + place].ImportData(mesh.vert[replacement.added[place]]);
        }
    }
    write_vertices(mesh, part, replacement);
    const std::size_t faces = replacement.indices.size() / 3;
    for (std::size_t place = 0; place < part.faces.size(); ++place) {
        if (place < faces) {
            write_face(mesh, part, replacement, place, selected);
        } else {
            Allocator::DeleteFace(mesh, mesh.face[part.faces[place]]);
        }
    }
    delete_unused(mesh, part, replacement);
    Allocator::CompactEveryVector(mesh);
    vcg::tri::UpdateNormal<CMeshO>::PerFaceNormalized(mesh);
    vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
}

Placed place(const CMeshO &mesh) {
    Placed placed;
    std::vector<std::uint32_t> place_of(mesh.vert.size(), none);
    for (std::size_t vertex = 0; vertex < mesh.vert.size(); ++vertex) {
        if (!mesh.vert[vertex].IsD()) {
            const Point3m position = mesh.Tr * mesh.vert[vertex].cP();
            require_finite(position, vertex);
            place_of[vertex] = index_of(placed.vertices.size());
            placed.vertices.push_back(index_of(vertex));
            append(placed.positions, position);
        }
    }
    if (placed.vertices.empty()) {
        throw std::invalid_argument("the layer has no vertices");
    }
    for (const CFaceO &face : mesh.face) {
        if (!face.IsD()) {
            for (int corner = 0; corner < 3; ++corner) {
                placed.indices.push_back(place_of[vertex_of(mesh, face, corner)]);
            }
        }
    }
    return placed;
}

}   // namespace meshlab_plugin
