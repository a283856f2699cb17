/* Builds levels of detail, and picks one for each distance by the error that it makes on the screen. */

#include <decimesh.h>

#include <stdio.h>
#include <stdlib.h>

#include "hills.h"

enum { CELLS = 200, LEVELS = 5 };

static void require(decimesh_status status) {
    if (status != DECIMESH_OK) {
        fprintf(stderr, "%s: %s\n", decimesh_status_name(status), decimesh_last_error_message());
        exit(EXIT_FAILURE);
    }
}

/* The error, in units of the mesh, that covers so many pixels.

   A camera with a vertical field of view of `fov` sees, at a distance d, a slice of the world that is
   2 * d * tan(fov / 2) high, on a screen of `height` pixels. So one pixel is 2 * d * tan(fov / 2) / height.

   d is the distance to the nearest point of the object, such as that to the middle of its bounding sphere less
   the radius: there the error looks largest. */
static float error_of_pixels(float pixels, float distance, float fov, float height) {
    return pixels * 2 * distance * tanf(fov / 2) / height;
}

static decimesh_mesh *hills(void) {
    const size_t vertex_count = hills_vertex_count(CELLS), index_count = hills_index_count(CELLS);
    hills_vertex *vertices = malloc(vertex_count * sizeof *vertices);
    uint32_t *indices = malloc(index_count * sizeof *indices);
    if (!vertices || !indices) {
        fprintf(stderr, "no memory\n");
        exit(EXIT_FAILURE);
    }
    hills_fill_vertices(CELLS, vertices);
    hills_fill_indices(CELLS, indices);

    decimesh_buffers buffers;
    decimesh_buffers_init(&buffers, sizeof buffers);
    buffers.positions = vertices[0].position;
    buffers.positions_stride = sizeof *vertices;
    buffers.vertex_count = vertex_count;
    buffers.indices = indices;
    buffers.index_count = index_count;
    buffers.normals = vertices[0].normal; /* carried along to every level */
    buffers.normals_stride = sizeof *vertices;
    buffers.uvs = vertices[0].uv;
    buffers.uvs_stride = sizeof *vertices;

    decimesh_mesh *mesh = NULL;
    require(decimesh_mesh_from_buffers(&buffers, &mesh));
    free(indices); /* the mesh is a copy */
    free(vertices);
    return mesh;
}

int main(void) {
    decimesh_mesh *mesh = hills();

    /* Each level has about 40 % of the triangles of the one before. */
    const double ratios[LEVELS] = {0.4, 0.16, 0.064, 0.0256, 0.01};
    decimesh_simplify_options options;
    decimesh_simplify_options_init(&options, sizeof options);
    options.target = DECIMESH_TARGET_RATIO;
    decimesh_levels *levels = NULL;
    require(decimesh_levels_build(mesh, &options, ratios, LEVELS, &levels));

    printf("level  triangles  error\n    -  %9zu  0 m\n", decimesh_mesh_triangle_count(mesh));
    for (size_t level = 0; level < decimesh_levels_count(levels); ++level) {
        const decimesh_mesh *coarse = NULL; /* belongs to the levels */
        decimesh_simplify_report report;
        decimesh_simplify_report_init(&report, sizeof report);
        require(decimesh_levels_mesh(levels, level, &coarse));
        require(decimesh_levels_report(levels, level, &report));
        printf("%5zu  %9zu  %.2f m\n", level, decimesh_mesh_triangle_count(coarse), (double)report.error);
    }

    /* What a renderer does each frame, for each object. */
    const float fov = 1.0F, height = 1080, pixels = 1;
    size_t last_triangles = decimesh_mesh_triangle_count(mesh);
    int is_right = 1;
    for (float distance = 50; distance < 1e5F; distance *= 3) {
        size_t level = 0;
        require(decimesh_levels_select(levels, error_of_pixels(pixels, distance, fov, height), &level));
        const decimesh_mesh *drawn = mesh; /* no level is good enough: the original */
        if (level < decimesh_levels_count(levels)) {
            require(decimesh_levels_mesh(levels, level, &drawn));
        }
        const size_t triangles = decimesh_mesh_triangle_count(drawn);
        printf("from %.0f m away, draw %zu triangles\n", (double)distance, triangles);
        is_right &= triangles <= last_triangles;
        last_triangles = triangles;
    }
    is_right &= last_triangles < decimesh_mesh_triangle_count(mesh) / 50;

    decimesh_levels_destroy(levels);
    decimesh_mesh_destroy(mesh);
    return is_right ? EXIT_SUCCESS : EXIT_FAILURE;
}
