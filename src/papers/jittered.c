/* jittered.c: jittered sampling of the aperture, Yang et al. 2016, section "Randomized
 * Intersection Searching", first scheme.
 *
 * The pixels of the aperture mask are divided into cells of a x a. Each output pixel draws one
 * mask pixel of each cell at random and follows its ray exactly (trace.c): O(N M K / a^2).
 * Mask pixels whose middle the aperture closes send no light. Draws are hashes of seed, place
 * and cell, so that a picture can be made again.
 */
#include "papers/papers.h"
#include "papers/trace.h"
#include "image/viewport.h"

#include <math.h>
#include <string.h>

/* Hashes three numbers to 32 well-mixed bits. */
static uint32_t draw_number(uint32_t seed, uint32_t place, uint32_t cell)
{
    uint64_t h = ((uint64_t)place << 32 | cell) + seed * UINT64_C(0x9e3779b97f4a7c15);

    h = (h ^ h >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ h >> 27) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)(h >> 32 ^ h);
}

/* A number for each pixel of the photo. */
static uint32_t place_of(const struct rf_frame *f, int x, int y)
{
    return (uint32_t)(y + f->view->y0) << 16 | (uint32_t)(x + f->view->x0);
}

/* The draws of the pixels of a tile from one cell: for each member of the cell the pixels that drew
 * it. */
struct draws {
    int first[16 * 16 + 1]; /* each member begins there in pixel[] */
    uint8_t pixel[RF_TILE * RF_TILE];
};

static void draw_all(const struct rf_frame *f, struct rf_rect rect, int cell, struct draws *draws)
{
    const uint32_t members = (uint32_t)(f->params->cell * f->params->cell);
    uint8_t drawn[RF_TILE * RF_TILE];
    int count[16 * 16 + 1] = {0};

    for (int y = rect.y0; y < rect.y1; y++) {
        for (int x = rect.x0; x < rect.x1; x++) {
            const uint32_t member =
                draw_number(f->params->seed, place_of(f, x, y), (uint32_t)cell) % members;

            drawn[y % RF_TILE * RF_TILE + x % RF_TILE] = (uint8_t)member;
            count[member]++;
        }
    }
    draws->first[0] = 0;
    for (uint32_t i = 0; i < members; i++) {
        draws->first[i + 1] = draws->first[i] + count[i];
        count[i] = draws->first[i];
    }
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++) {
            const int pixel = y % RF_TILE * RF_TILE + x % RF_TILE;

            draws->pixel[count[drawn[pixel]]++] = (uint8_t)pixel;
        }
}

/* Follows the ray through mask pixel (mx, my) for the pixels that drew it. */
static void follow(const struct rf_frame *f, struct rf_rect rect, struct rf_blur_range reach,
                   int mx, int my, const struct draws *draws, int member,
                   struct rf_exact_sums *sums)
{
    const double K = f->params->max_blur_radius;
    const int open = rf_aperture_open(f->aperture, mx / K, my / K);
    const int x0 = rect.x0 - rect.x0 % RF_TILE, y0 = rect.y0 - rect.y0 % RF_TILE;
    struct rf_path path;

    if (!open || draws->first[member] == draws->first[member + 1])
        return;
    rf_path_of(f, reach, -mx / K, -my / K, &path); /* seen from behind: aperture.h */
    for (int i = draws->first[member]; i < draws->first[member + 1]; i++)
        rf_path_add(f, &path, x0 + draws->pixel[i] % RF_TILE, y0 + draws->pixel[i] / RF_TILE, open,
                    sums);
}

static void jittered_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const struct rf_blur_range reach = rf_blur_range_of(f, tx, ty);
    const int a = f->params->cell, side = (int)floor(f->params->max_blur_radius);
    const int cells = (2 * side + a) / a, first = -(cells * a / 2);
    struct rf_exact_sums sums;
    struct rf_path centre;
    struct draws draws;

    (void)worker;
    memset(&sums, 0, sizeof sums);
    for (int cell = 0; cell < cells * cells; cell++) {
        const int mx = first + cell % cells * a, my = first + cell / cells * a;

        if (rf_cancelled(f->exec))
            return;
        draw_all(f, rect, cell, &draws);
        for (int member = 0; member < a * a; member++)
            follow(f, rect, reach, mx + member % a, my + member / a, &draws, member, &sums);
    }
    rf_path_of(f, reach, 0, 0, &centre);
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++)
            if (sums.weight[y % RF_TILE * RF_TILE + x % RF_TILE] <= 0)
                rf_path_add(f, &centre, x, y, 1, &sums); /* all draws hit closed mask pixels */
    rf_exact_write(f, rect, &sums);
}

const struct rf_method rf_jittered_method = {.tile = jittered_tile, .exact = rf_exact_init};
