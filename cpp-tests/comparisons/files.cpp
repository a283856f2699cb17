#include "files.hpp"

#include "decimesh_mesh.hpp"

namespace comparison {
namespace {

Handle open(const std::string &path) {
    decimesh_mesh *created = nullptr;
    check(decimesh_mesh_read(path.c_str(), &created));
    return Handle(created);
}

} // namespace

Mesh read(const std::string &path) { return from_decimesh(open(path).get()); }

Mesh read_welded(const std::string &path) {
    const Handle mesh = open(path);
    decimesh_mesh *created = nullptr;
    check(decimesh_mesh_weld(mesh.get(), 0.0F, &created));
    return from_decimesh(Handle(created).get());
}

void write(const Mesh &mesh, const std::string &path) {
    check(decimesh_mesh_write(to_decimesh(mesh).get(), path.c_str(), DECIMESH_ENCODING_BINARY));
}

} // namespace comparison
