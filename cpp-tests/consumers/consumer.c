/* A plate of 8 x 8 squares becomes two triangles, in C. What scripts/consumers.sh builds in every way there is. */

#include <decimesh.h>

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { side = 8, row = side + 1 };

static void check(decimesh_status status) {
    if (status != DECIMESH_OK) {
        fprintf(stderr, "%s: %s\n", decimesh_status_name(status), decimesh_last_error_message());
        exit(EXIT_FAILURE);
    }
}

int main(void) {
    const uint32_t version =
        (uint32_t)DECIMESH_VERSION_MAJOR << 16 | DECIMESH_VERSION_MINOR << 8 | DECIMESH_VERSION_PATCH;
    float positions[row * row][3];
    uint32_t indices[side * side][6];
    decimesh_buffers buffers;
    decimesh_simplify_options options;
    decimesh_mesh *plate = NULL;
    decimesh_mesh *simplified = NULL;
    size_t triangles;

    for (uint32_t v = 0; v < row * row; ++v) {
        positions[v][0] = (float)(v % row);
        positions[v][1] = (float)(v / row);
        positions[v][2] = 0.0f;
    }
    for (uint32_t square = 0; square < side * side; ++square) {
        const uint32_t corner = square / side * row + square % side;
        const uint32_t corners[6] = {corner, corner + 1, corner + row, corner + 1, corner + row + 1, corner + row};
        for (int i = 0; i < 6; ++i) {
            indices[square][i] = corners[i];
        }
    }

    decimesh_buffers_init(&buffers, sizeof buffers);
    buffers.positions = &positions[0][0];
    buffers.vertex_count = row * row;
    buffers.indices = indices;
    buffers.index_count = side * side * 6;
    check(decimesh_mesh_from_buffers(&buffers, &plate));

    decimesh_simplify_options_init(&options, sizeof options);
    options.target = DECIMESH_TARGET_TRIANGLES;
    options.target_value = 2;
    check(decimesh_simplify(plate, &options, &simplified, NULL));

    triangles = decimesh_mesh_triangle_count(simplified);
    printf("C, decimesh %s: %zu triangles become %zu\n", decimesh_version_string(),
           decimesh_mesh_triangle_count(plate), triangles);
    decimesh_mesh_destroy(simplified);
    decimesh_mesh_destroy(plate);
    return triangles == 2 && decimesh_version() == version ? EXIT_SUCCESS : EXIT_FAILURE;
}
