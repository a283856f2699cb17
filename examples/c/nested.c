/* Builds levels of detail that share one vertex buffer, for an engine that keeps its vertices in a format of its own.
   The vertices are put in order once, each level needs the first of them, and 16 bits are enough for coarse ones. */

#include <decimesh.h>

#include <stdio.h>
#include <stdlib.h>

#include "hills.h"

enum { CELLS = 300, TARGETS = 4 };

static void require(decimesh_status status) {
    if (status != DECIMESH_OK) {
        fprintf(stderr, "%s: %s\n", decimesh_status_name(status), decimesh_last_error_message());
        exit(EXIT_FAILURE);
    }
}

static void *allocate(size_t count, size_t size) {
    void *memory = malloc(count * size);
    if (!memory) {
        fprintf(stderr, "no memory\n");
        exit(EXIT_FAILURE);
    }
    return memory;
}

int main(void) {
    const size_t vertex_count = hills_vertex_count(CELLS), index_count = hills_index_count(CELLS);
    hills_vertex *vertices = allocate(vertex_count, sizeof *vertices);
    uint32_t *indices = allocate(index_count, sizeof *indices);
    hills_fill_vertices(CELLS, vertices);
    hills_fill_indices(CELLS, indices);

    decimesh_buffers buffers;
    decimesh_buffers_init(&buffers, sizeof buffers);
    buffers.positions = vertices[0].position;
    buffers.positions_stride = sizeof *vertices;
    buffers.vertex_count = vertex_count;
    buffers.indices = indices;
    buffers.index_count = index_count;
    buffers.normals = vertices[0].normal; /* so that they can count */
    buffers.normals_stride = sizeof *vertices;
    decimesh_mesh *mesh = NULL;
    require(decimesh_mesh_from_buffers(&buffers, &mesh));
    free(indices);

    const double ratios[TARGETS] = {0.4, 0.16, 0.064, 0.0256};
    decimesh_simplify_options options;
    decimesh_simplify_options_init(&options, sizeof options);
    options.target = DECIMESH_TARGET_RATIO;
    options.normal_weight = 0.05F;
    decimesh_nested *nested = NULL;
    require(decimesh_nested_build(mesh, &options, ratios, TARGETS, &nested));
    decimesh_mesh_destroy(mesh); /* the levels have a copy */

    /* The engine's own vertices, with all that decimesh was not shown, in the order of the levels. */
    const uint32_t *order = decimesh_nested_order(nested);
    hills_vertex *ordered = allocate(vertex_count, sizeof *ordered);
    for (size_t vertex = 0; vertex < vertex_count; ++vertex) {
        ordered[vertex] = vertices[order[vertex]];
    }
    free(vertices);

    int is_right = 1;
    size_t last_count = SIZE_MAX;
    printf("level  triangles  vertices  bits  error\n");
    for (size_t number = 0; number < decimesh_nested_count(nested); ++number) {
        decimesh_nested_level level;
        decimesh_nested_level_init(&level, sizeof level);
        require(decimesh_nested_describe(nested, number, &level));
        const int is_narrow = level.vertices <= 65536;
        const size_t count = (size_t)level.indices;
        void *own = allocate(count, is_narrow ? sizeof(uint16_t) : sizeof(uint32_t));
        require(decimesh_nested_copy_indices(nested, number, is_narrow ? DECIMESH_INDEX_U16 : DECIMESH_INDEX_U32, own,
                                             count));
        /* Here they would go to the graphics card, as the first level.vertices of `ordered` have gone. */
        printf("%5zu  %9zu  %8llu  %4d  %.2f m\n", number, count / 3, (unsigned long long)level.vertices,
               is_narrow ? 16 : 32, (double)level.error);
        is_right &= count < last_count;
        last_count = count;
        free(own);
    }

    free(ordered);
    decimesh_nested_destroy(nested);
    return is_right ? EXIT_SUCCESS : EXIT_FAILURE;
}
