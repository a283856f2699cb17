// Simplifies the buffers of an engine where they lie, in both ways there are:
// - fewer indices over the same vertices, so that all levels of detail share one vertex buffer;
// - vertices moved to where the error is least, for an object that is simplified once.

#include <decimesh.hpp>

#include <cstdio>
#include <cstdlib>

#include "hills.hpp"

namespace {

void tell(const char *what, std::size_t before, const decimesh::SimplifiedIndices &result) {
    std::printf("%s: %zu triangles became %zu, within about %.2f m\n", what, before / 3, result.index_count / 3,
                static_cast<double>(result.report.error));
}

}   // namespace

int main() {
    Hills hills(200);
    const std::size_t before = hills.indices.size();

    decimesh::Options options;
    options.target = decimesh::Target::ratio(0.1);
    options.lock_boundary = true;   // the next tile of the landscape still fits

    try {
        // decimesh reads interleaved vertices as they are. Indices of 16 bits would do as well.
        decimesh::Buffers<> source;
        source.positions = decimesh::interleaved(hills.vertices, &Vertex::position);
        source.indices = hills.indices;
        std::vector<std::uint32_t> fewer(before);   // never more than there were
        const decimesh::SimplifiedIndices shared = decimesh::simplify_indices(fewer, source, options);
        fewer.resize(shared.index_count);
        tell("same vertices", before, shared);

        decimesh::MutableBuffers<> own;
        own.positions = decimesh::interleaved(hills.vertices, &Vertex::position);
        own.normals = decimesh::interleaved(hills.vertices, &Vertex::normal);
        own.uvs = decimesh::interleaved(hills.vertices, &Vertex::uv);
        own.indices = hills.indices;
        const decimesh::SimplifiedIndices moved = decimesh::simplify_in_place(own, options);
        hills.indices.resize(moved.index_count);
        tell("moved vertices", before, moved);

        // A target that cannot be met throws nothing; the report says so.
        const bool is_right = shared.report.stopped_by == decimesh::StoppedBy::target &&
                              moved.report.stopped_by == decimesh::StoppedBy::target &&
                              moved.report.error <= shared.report.error;
        return is_right ? EXIT_SUCCESS : EXIT_FAILURE;
    } catch (const decimesh::Error &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
