/* Simplifies the buffers of an engine where they lie: fewer indices over the same vertices. All levels of detail
   then share one vertex buffer, and nothing but an index buffer is uploaded for each. */

#include <decimesh.h>

#include <stdio.h>
#include <stdlib.h>

#include "hills.h"

enum { CELLS = 200 };

int main(void) {
    const size_t vertex_count = hills_vertex_count(CELLS), index_count = hills_index_count(CELLS);
    hills_vertex *vertices = malloc(vertex_count * sizeof *vertices);
    uint32_t *indices = malloc(index_count * sizeof *indices);
    uint32_t *fewer = malloc(index_count * sizeof *fewer); /* never more than there were */
    if (!vertices || !indices || !fewer) {
        fprintf(stderr, "no memory\n");
        return EXIT_FAILURE;
    }
    hills_fill_vertices(CELLS, vertices);
    hills_fill_indices(CELLS, indices);

    /* decimesh reads interleaved vertices as they are. Indices of 16 bits would do as well. */
    decimesh_buffers buffers;
    decimesh_buffers_init(&buffers, sizeof buffers);
    buffers.positions = vertices[0].position;
    buffers.positions_stride = sizeof *vertices;
    buffers.vertex_count = vertex_count;
    buffers.indices = indices;
    buffers.index_count = index_count;
    buffers.index_type = DECIMESH_INDEX_U32;

    decimesh_simplify_options options;
    decimesh_simplify_options_init(&options, sizeof options);
    options.target = DECIMESH_TARGET_RATIO;
    options.target_value = 0.1;
    options.lock_boundary = 1; /* the next tile of the landscape still fits */

    decimesh_simplify_report report;
    decimesh_simplify_report_init(&report, sizeof report);
    size_t fewer_count = 0;
    const decimesh_status status = decimesh_simplify_indices(fewer, &buffers, &options, &fewer_count, &report);
    if (status != DECIMESH_OK) {
        fprintf(stderr, "%s: %s\n", decimesh_status_name(status), decimesh_last_error_message());
        return EXIT_FAILURE;
    }
    printf("%zu triangles became %zu, within about %.2f m; %llu vertices of the border stayed\n", index_count / 3,
           fewer_count / 3, (double)report.error, (unsigned long long)report.locked_vertices);

    free(fewer);
    free(indices);
    free(vertices);
    /* A target that cannot be met is no failure; the report says so. */
    return report.stopped_by == DECIMESH_STOPPED_BY_TARGET ? EXIT_SUCCESS : EXIT_FAILURE;
}
