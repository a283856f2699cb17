/// The session's meshes on the graphics card.

#ifndef VIEWER_SCENE_HPP
#define VIEWER_SCENE_HPP

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "gpu_mesh.hpp"
#include "session.hpp"

namespace viewer {

/// What to draw; the pointers are the scene's, until its next update. Without vertices: nothing.
struct Drawable {
    const GpuVertices *vertices = nullptr;
    const GpuIndices *indices = nullptr;
    const GpuValues *values = nullptr;

    explicit operator bool() const noexcept { return vertices != nullptr && indices != nullptr; }
};

/// Uploads what is looked at, once: the vertices of nested levels serve them all, and each level's indices follow when
/// it is first seen.
class Scene {
public:
    /// How many buffers of each kind have been uploaded.
    struct Uploads {
        std::size_t vertices = 0;
        std::size_t indices = 0;
        std::size_t values = 0;
    };

    /// Forgets what the session no longer has. To be called before each frame.
    void update(const Session &session);

    /// The original.
    Drawable original(const Session &session);
    /// The result, or `level` of it.
    Drawable result(const Session &session, std::size_t level);
    /// The original's triangles with the distances of its vertices from the result, or from `level` of it.
    Drawable deviation(const Session &session, std::size_t level);

    const Uploads &uploads() const noexcept { return uploads_; }

private:
    /// Vertices with what refers to them, by level. Maps, because what is in them stays where it is when more comes.
    struct Shared {
        std::optional<GpuVertices> vertices;
        std::map<std::size_t, GpuIndices> indices;
    };

    Drawable show(Shared &shared, decimesh::MeshView mesh, const Frame &frame, std::size_t level,
                  decimesh::Span<const std::uint32_t> indices);

    std::uint64_t original_version_ = 0;
    std::uint64_t result_version_ = 0;
    Shared original_;
    Shared result_;
    std::map<std::size_t, GpuValues> distances_;
    Uploads uploads_;
};

}   // namespace viewer

#endif
