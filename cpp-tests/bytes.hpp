/// What lies in memory, to compare bit by bit: equal numbers need not be equal bits, and equal bits need not be
/// equal numbers.

#ifndef DECIMESH_TESTS_BYTES_HPP
#define DECIMESH_TESTS_BYTES_HPP

#include <string>

#include <decimesh.hpp>

/// No `std::string`, so that a comparison that fails does not print them.
struct Bytes {
    std::string held;

    friend bool operator==(const Bytes &a, const Bytes &b) { return a.held == b.held; }
    friend bool operator!=(const Bytes &a, const Bytes &b) { return a.held != b.held; }
    friend Bytes operator+(const Bytes &a, const Bytes &b) { return {a.held + b.held}; }
};

template <class T>
Bytes bytes_of(decimesh::Span<T> span) {
    return {std::string(reinterpret_cast<const char *>(span.data()), span.size() * sizeof(T))};
}

/// All that a mesh holds.
inline Bytes bytes_of(decimesh::MeshView mesh) {
    return bytes_of(mesh.positions()) + bytes_of(mesh.indices()) + bytes_of(mesh.normals()) + bytes_of(mesh.uvs()) +
           bytes_of(mesh.colors());
}

#endif
