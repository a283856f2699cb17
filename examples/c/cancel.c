/* Simplifies in a thread of its own, while the thread of the user interface shows how far it has come and cancels. */

#include <decimesh.h>

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "hills.h"

enum { CELLS = 500 };

/* What the two threads share. */
typedef struct job {
    const decimesh_mesh *mesh;
    _Atomic float fraction;
    atomic_bool is_cancelled;
    atomic_bool is_done;
    decimesh_mesh *result;
    decimesh_status status;
    char message[256];
} job;

/* Called by decimesh, in the worker, now and then: any value but 0 ends the work. */
static int32_t on_progress(void *user, float fraction) {
    job *job = user;
    atomic_store(&job->fraction, fraction);
    return atomic_load(&job->is_cancelled);
}

static void *work(void *user) {
    job *job = user;
    decimesh_simplify_options options;
    decimesh_simplify_options_init(&options, sizeof options);
    options.target_value = 0.01;
    options.progress = on_progress;
    options.progress_user = job;
    job->status = decimesh_simplify(job->mesh, &options, &job->result, NULL);
    if (job->status != DECIMESH_OK) {
        /* The text belongs to this thread: it takes it along. */
        snprintf(job->message, sizeof job->message, "%s", decimesh_last_error_message());
    }
    atomic_store(&job->is_done, 1);
    return NULL;
}

static decimesh_mesh *hills(void) {
    const size_t vertex_count = hills_vertex_count(CELLS), index_count = hills_index_count(CELLS);
    hills_vertex *vertices = malloc(vertex_count * sizeof *vertices);
    uint32_t *indices = malloc(index_count * sizeof *indices);
    decimesh_mesh *mesh = NULL;
    if (vertices && indices) {
        hills_fill_vertices(CELLS, vertices);
        hills_fill_indices(CELLS, indices);
        decimesh_buffers buffers;
        decimesh_buffers_init(&buffers, sizeof buffers);
        buffers.positions = vertices[0].position;
        buffers.positions_stride = sizeof *vertices;
        buffers.vertex_count = vertex_count;
        buffers.indices = indices;
        buffers.index_count = index_count;
        if (decimesh_mesh_from_buffers(&buffers, &mesh) != DECIMESH_OK) {
            fprintf(stderr, "%s\n", decimesh_last_error_message());
        }
    }
    free(indices);
    free(vertices);
    return mesh;
}

int main(void) {
    decimesh_mesh *mesh = hills();
    job job = {.mesh = mesh};
    pthread_t worker;
    if (!mesh || pthread_create(&worker, NULL, work, &job) != 0) {
        fprintf(stderr, "no mesh or no thread\n");
        return EXIT_FAILURE;
    }

    /* The loop of the user interface. This user runs out of patience as soon as there is progress to see. */
    while (!atomic_load(&job.is_done)) {
        const struct timespec millisecond = {0, 1000000};
        nanosleep(&millisecond, NULL);
        const float fraction = atomic_load(&job.fraction);
        if (fraction > 0 && !atomic_load(&job.is_cancelled)) {
            printf("%.0f %% done; cancelling\n", 100.0 * (double)fraction);
            atomic_store(&job.is_cancelled, 1);
        }
    }
    pthread_join(worker, NULL);

    int is_right = 0;
    if (job.status == DECIMESH_ERROR_CANCELLED) {
        printf("ended: %s\n", job.message);
        is_right = job.result == NULL;
    } else if (job.status == DECIMESH_OK) {
        printf("it was faster: %zu triangles\n", decimesh_mesh_triangle_count(job.result));
        is_right = 1;
    } else {
        fprintf(stderr, "%s\n", job.message);
    }
    decimesh_mesh_destroy(job.result);
    decimesh_mesh_destroy(mesh);
    return is_right ? EXIT_SUCCESS : EXIT_FAILURE;
}
