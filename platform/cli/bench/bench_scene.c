/* bench_scene.c: a photo and disparities are made up to measure with. */
#include <stdlib.h>
#include "bench/bench_scene.h"
#include "line/report.h"

static uint32_t hash(uint32_t x, uint32_t y)
{
    uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u;

    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    return h ^ h >> 13;
}

/* A tilted floor before a wall, and upright discs in front of it that hide each other:
 * the same for every size but for its scale, with fine texture everywhere. */
static uint16_t surface_at(double x, double y, int *which)
{
    uint16_t nearest = y > 0.5 ? (uint16_t)(65535 * (0.05 + (y - 0.5) * 1.2)) : 3277;

    *which = y > 0.5;
    for (int i = 0; i < 12; i++) {
        const uint32_t h = hash((uint32_t)i + 1, 77);
        const double dx = x - (h & 255) / 255.0 * 1.33;
        const double dy = y - (0.2 + (h >> 8 & 255) / 425.0);
        const double radius = 0.05 + (h >> 16 & 63) / 420.0;
        const uint16_t d = (uint16_t)(6000 + (h >> 22) * 57);

        if (dx * dx + dy * dy < radius * radius && d > nearest) {
            nearest = d;
            *which = i + 2;
        }
    }
    return nearest;
}

int bench_scene_make(struct scene *scene, int width, int height)
{
    const uint64_t pixels = (uint64_t)width * (uint64_t)height;

    scene->photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, width, height, (ptrdiff_t)width * 3);
    scene->map_width = width;
    scene->map_height = height;
    if (pixels <= SIZE_MAX / 3) { /* on failure they stay NULL */
        scene->photo.plane[0] = malloc((size_t)pixels * 3);
        scene->disparity = malloc((size_t)pixels * 2);
    }
    if (!scene->photo.plane[0] || !scene->disparity)
        return report_failure(EXIT_FAILED, "--size", "not enough memory for %dx%d pixels", width,
                              height);
    for (int y = 0; y < height; y++) {
        uint8_t *row = scene->photo.plane[0] + y * scene->photo.stride[0];
        uint16_t *disparity = scene->disparity + (size_t)y * (size_t)width;

        for (int x = 0; x < width; x++) {
            int which;

            disparity[x] = surface_at((double)x / height, (double)y / height, &which);
            for (int c = 0; c < 3; c++)
                row[3 * x + c] =
                    (uint8_t)((hash((uint32_t)which, (uint32_t)c) & 127) +
                              (hash((uint32_t)x, (uint32_t)y) & 63) + ((x ^ y) & 8) * 4);
        }
    }
    return EXIT_DONE;
}

void bench_scene_free(struct scene *scene)
{
    free(scene->photo.plane[0]);
    free(scene->disparity);
}
