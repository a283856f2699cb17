/* A landscape to try things on, 1000 m wide: `cells` by `cells` squares of two triangles each. */

#ifndef HILLS_H
#define HILLS_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* A vertex as a renderer might have it. */
typedef struct hills_vertex {
    float position[3];
    float normal[3];
    float uv[2];
} hills_vertex;

static size_t hills_vertex_count(size_t cells) {
    return (cells + 1) * (cells + 1);
}

static size_t hills_index_count(size_t cells) {
    return 6 * cells * cells;
}

static void hills_fill_vertices(size_t cells, hills_vertex *vertices) {
    for (size_t j = 0; j <= cells; ++j) {
        for (size_t i = 0; i <= cells; ++i) {
            const float u = (float)i / (float)cells, v = (float)j / (float)cells;
            const float slope_x = 1.5F * cosf(25 * u) + 0.405F * cosf(90 * u + 30 * v);
            const float slope_y = -0.8F * sinf(20 * v) + 0.135F * cosf(90 * u + 30 * v);
            const float length = sqrtf(slope_x * slope_x + slope_y * slope_y + 1);
            const float height = 60 * sinf(25 * u) + 40 * cosf(20 * v) + 4.5F * sinf(90 * u + 30 * v);
            const hills_vertex vertex = {
                {1000 * u, 1000 * v, height}, {-slope_x / length, -slope_y / length, 1 / length}, {u, v}};
            *vertices++ = vertex;
        }
    }
}

/* The corners of the triangles, counter-clockwise from above. */
static void hills_fill_indices(size_t cells, uint32_t *indices) {
    for (size_t j = 0; j < cells; ++j) {
        for (size_t i = 0; i < cells; ++i) {
            const size_t row = cells + 1;
            const uint32_t a = (uint32_t)(j * row + i), b = a + 1;
            const uint32_t c = (uint32_t)(a + row + 1), d = (uint32_t)(a + row);
            const uint32_t corners[6] = {a, b, c, a, c, d};
            for (size_t corner = 0; corner < 6; ++corner) {
                *indices++ = corners[corner];
            }
        }
    }
}

#endif
