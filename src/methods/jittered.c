/* jittered.c: jittered sampling of the aperture, Yang et al. 2016, section "Randomized
 * Intersection Searching", first scheme.
 *
 * The pixels of the aperture mask are divided into cells of a x a. Each output pixel draws one
 * mask pixel of each cell at random and follows its ray exactly (trace.c): O(N M K / a^2).
 * Mask pixels whose middle the aperture closes send no light. Draws are hashes of seed, place
 * and cell, so that a picture can be made again.
 */
#include "methods/trace.h"
#include "renderer/bands.h"

#include <math.h>
#include <string.h>

/* 32 well-mixed bits of three numbers. */
static uint32_t draw(uint32_t seed, uint32_t place, uint32_t cell)
{
    uint64_t h = ((uint64_t)place << 32 | cell) + seed * UINT64_C(0x9e3779b97f4a7c15);

    h = (h ^ h >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ h >> 27) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)(h >> 32 ^ h);
}

/* A number for each pixel of the photo. */
static uint32_t place_of(const struct refocus_renderer *r, int x, int y)
{
    return (uint32_t)(y + r->origin_y) << 16 | (uint32_t)(x + r->origin_x);
}

/* Follow the ray through mask pixel (mx, my) for the pixels that drew it. */
static void follow(const struct rf_frame *f, struct rf_rect rect, int mx, int my, int member,
                   const uint8_t *drawn, struct rf_exact_sums *sums)
{
    const double K = f->params->max_blur_radius;
    const int open = rf_aperture_open(f->aperture, mx / K, my / K);
    struct rf_path path;

    if (!open)
        return;
    rf_path_of(f, -mx / K, -my / K, &path); /* seen from behind: aperture.h */
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++)
            if (drawn[y % RF_TILE * RF_TILE + x % RF_TILE] == member)
                rf_path_add(f, &path, x, y, open, sums);
}

void rf_jittered_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const int a = f->params->cell, reach = (int)floor(f->params->max_blur_radius);
    const int cells = (2 * reach + a) / a, first = -(cells * a / 2);
    uint8_t drawn[RF_TILE * RF_TILE];
    struct rf_exact_sums sums;
    struct rf_path centre;

    (void)tx;
    (void)ty;
    (void)worker;
    memset(&sums, 0, sizeof sums);
    for (int cell = 0; cell < cells * cells; cell++) {
        const int mx = first + cell % cells * a, my = first + cell / cells * a;

        for (int y = rect.y0; y < rect.y1; y++)
            for (int x = rect.x0; x < rect.x1; x++)
                drawn[y % RF_TILE * RF_TILE + x % RF_TILE] = (uint8_t)(
                    draw(f->params->seed, place_of(f->r, x, y), (uint32_t)cell) %
                    (uint32_t)(a * a));
        if (rf_cancelled(f->r))
            return;
        for (int member = 0; member < a * a; member++)
            follow(f, rect, mx + member % a, my + member / a, member, drawn, &sums);
    }
    rf_path_of(f, 0, 0, &centre);
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++)
            if (sums.weight[y % RF_TILE * RF_TILE + x % RF_TILE] <= 0)
                rf_path_add(f, &centre, x, y, 1, &sums); /* all draws were of closed ones */
    rf_exact_write(f, rect, &sums);
}
