/* The header by itself, first and twice, as C99, C11 and C++17; and a call, so that linking is seen too. */
#include "decimesh.h"
#include "decimesh.h"

#include <stdio.h>

int main(void) {
    static const float square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5F, 0.5F, 0};
    static const uint16_t fan[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    decimesh_buffers buffers;
    decimesh_simplify_options options;
    decimesh_simplify_report report;
    decimesh_mesh *mesh = NULL;
    decimesh_mesh *simplified = NULL;

    decimesh_buffers_init(&buffers, sizeof buffers);
    buffers.positions = square;
    buffers.vertex_count = 5;
    buffers.index_type = DECIMESH_INDEX_U16;
    buffers.indices = fan;
    buffers.index_count = 12;
    decimesh_simplify_options_init(&options, sizeof options);
    decimesh_simplify_report_init(&report, sizeof report);
    if (decimesh_mesh_from_buffers(&buffers, &mesh) != DECIMESH_OK ||
        decimesh_simplify(mesh, &options, &simplified, &report) != DECIMESH_OK) {
        fprintf(stderr, "%s\n", decimesh_last_error_message());
        return 1;
    }
    printf("decimesh %s: %u triangles of 4\n", decimesh_version_string(), (unsigned)report.triangles);
    decimesh_mesh_destroy(simplified);
    decimesh_mesh_destroy(mesh);
    return report.triangles == 2 && report.stopped_by == DECIMESH_STOPPED_BY_TARGET ? 0 : 1;
}
