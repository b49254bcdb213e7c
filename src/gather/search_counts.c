/* search_counts.c: the search of many rays and one test.
 *
 * A full mask has a ray for each pixel of the largest disc. Where a surface is blurred by less, its
 * rays hit the same pixels again and again, and light is weighted and added up over and over. So
 * hits are counted first, for each offset, and then each pixel that was hit is added up once, as
 * often as that. Sums are the same as those of ray after ray, as they are whole numbers.
 *
 * An example: K = 20, and a tile lies on a surface of blur 5. Of 1257 rays about 16 look at each of
 * the 79 pixels of its disc, so that 79 products are left of 1257.
 */
#include "gather/search_counts.h"

#include <assert.h>
#include <string.h>

enum {
    FEW_RAYS = 256, /* fewer lie too far apart to hit the same pixels */
    LOW_BITS = 13,  /* as the lower part of light times weight */
    MOST_TIMES = INT16_MAX,
    PITCH = RF_COUNTED_SIDE * RF_COUNT_ROW,
};
static_assert(((uint32_t)RF_CHROMA_MAX * RF_WEIGHT_MAX) >> LOW_BITS < 1 << 15, "the upper bits");
static_assert((uint64_t)MOST_TIMES * RF_WEIGHT_MAX <= UINT32_MAX, "sums of all rays");
static_assert(RF_RAY_CHUNK * 255 <= MOST_TIMES && (int)RF_RAY_CHUNK <= (int)RF_COUNTED_RAYS,
              "a chunk");

/* The greatest blur of those that first guesses of a tile find and of the nearest plane, in pixels.
 */
static int reach_of(const struct rf_frame *f, int tx, int ty)
{
    enum { CELLS = RF_TILE / RF_CELL, STRIP = RF_STRIP / RF_CELL };
    const int nearest = rf_nearest_blur(f) < 0 ? -rf_nearest_blur(f) : rf_nearest_blur(f);
    const int cells = ((nearest + 128) / 256 + RF_CELL - 1) / RF_CELL;
    int most = nearest;

    for (int y = ty * CELLS - cells; y <= ty * CELLS + STRIP + cells; y++) {
        const uint32_t *const range = f->range.at + y * f->range.stride + tx * CELLS;

        for (int x = -cells; x <= cells; x++) {
            const int low = -rf_range_least(range[x]), high = rf_range_most(range[x]);

            most = low > most ? low : most;
            most = high > most ? high : most;
        }
    }
    return (most + 128) / 256;
}

/* Light of a row of n pixels, or weights, and the lower and the upper bits of light times weight.
 */
static void fill_row(uint16_t *restrict out, const struct rf_frame *f, int x, int y, int n)
{
    const uint16_t *restrict weight = f->weighted ? f->weight.at + y * f->weight.stride + x : NULL;
    const struct rf_light_q12 searched = rf_searched_light(f);

    if (f->weighted)
        memcpy(out + 6 * PITCH, weight, (size_t)n * sizeof *out);
    for (int c = 0; c < 3; c++) {
        const uint16_t *restrict light = searched.channel[c] + y * f->view->stride + x;

        if (!f->weighted)
            memcpy(out + c * PITCH, light, (size_t)n * sizeof *out);
        for (int i = 0; f->weighted && i < n; i++) {
            const uint32_t product = (uint32_t)light[i] * weight[i];

            out[c * PITCH + i] = product & ((1 << LOW_BITS) - 1);
            out[(3 + c) * PITCH + i] = (uint16_t)(product >> LOW_BITS);
        }
    }
}

bool rf_count_begin(struct rf_counting *counting, const struct rf_frame *f, int tx, int ty,
                    const struct rf_ray_set *set)
{
    int reach;

    if (f->params->iterations > 1 || f->params->background || f->params->mirror ||
        set->count <= FEW_RAYS || (reach = reach_of(f, tx, ty)) > RF_COUNT_REACH)
        return false;
    counting->reach = reach;
    for (int y = -reach; y < RF_TILE + reach; y++) {
        const int first = rf_count_number(-reach, y), n = RF_TILE + 2 * reach;
        const int16_t *blur =
            f->blur.at + (ty * RF_TILE + y) * f->blur.stride + tx * RF_TILE - reach;

        memcpy(counting->blur + first, blur, (size_t)n * sizeof *blur);
        fill_row(counting->plane[0] + first, f, tx * RF_TILE - reach, ty * RF_TILE + y, n);
    }
    for (int y = -reach; y <= reach; y++)
        memset(counting->count[rf_count_number(-reach, y)], 0,
               (size_t)(2 * reach + 1) * sizeof counting->count[0]);
    memset(counting->settled, 0, sizeof counting->settled);
    memset(counting->touched, 0, sizeof counting->touched);
    memset(counting->settled_touched, 0, sizeof counting->settled_touched);
    counting->rays.rays = 0;
    return true;
}

/* Lists the numbers that are touched, and marks those of settled rays anew. Returns how many there
 * are. */
static int list_touched(struct rf_counting *c)
{
    int n = 0;

    for (int y = -c->reach; y <= c->reach; y++) {
        const int first = rf_count_number(-c->reach, y), end = first + 2 * c->reach + 1;

        for (int number = first; number < end; number += 8) {
            uint64_t marks;

            memcpy(&marks, c->touched + number, sizeof marks);
            for (int i = 0; marks && i < 8; i++) {
                c->number[n] = (uint16_t)(number + i);
                n += c->touched[number + i];
            }
        }
        memcpy(c->touched + first, c->settled_touched + first, (size_t)(end - first));
    }
    return n;
}

/* Sets the counts of n numbers to those of settled rays. */
static void set_counts(struct rf_counting *c, int n)
{
    for (int k = 0; k < n; k++) {
        const int number = c->number[k];
        const uint16_t times = c->settled[number];

        for (int i = 0; i < RF_TILE; i++)
            c->count[number][i] = times;
    }
}

/* Adds the sums of a row of a tile, whose rays weigh the same. */
static void add_row(struct rf_sums *sums, const struct rf_frame *f, uint32_t (*sum)[RF_TILE], int y,
                    uint32_t ray_weight)
{
    for (int i = 0; i < RF_TILE; i++) {
        const int at = y % RF_TILE * RF_TILE + i;

        for (int c = 0; c < 3; c++)
            sums->light[c][at] +=
                ray_weight *
                (f->weighted ? ((uint64_t)sum[3 + c][i] << LOW_BITS) + sum[c][i] : sum[c][i]);
        if (f->weighted)
            sums->weight[at] += (uint64_t)ray_weight * sum[6][i];
    }
}

/* Counts and adds up one row of a strip. */
static void count_row(struct rf_counting *c, const struct rf_frame *f, int y, uint32_t ray_weight,
                      struct rf_sums *sums)
{
    struct rf_counted_job job = {
        .count = (const uint16_t(*)[RF_TILE])c->count,
        .plane = c->plane[0] + y % RF_TILE * RF_COUNT_ROW,
        .pitch = PITCH,
        .planes = f->weighted ? RF_COUNTED_PLANES : 3,
        .number = c->number,
    };

    f->exec->kernels->count_hits(c->count, c->touched, c->blur + rf_count_number(0, y % RF_TILE),
                                 &c->rays);
    job.n = list_touched(c);
    memset(c->sum, 0, sizeof c->sum);
    f->exec->kernels->add_counted(c->sum, &job);
    set_counts(c, job.n);
    add_row(sums, f, c->sum, y, ray_weight);
}

/* Adds up a strip of all rays so far. */
static void count_strip(struct rf_counting *c, const struct rf_frame *f, int y, uint32_t ray_weight,
                        struct rf_sums *sums)
{
    int settled;

    memcpy(c->touched, c->settled_touched, sizeof c->touched);
    settled = list_touched(c);
    set_counts(c, settled);
    for (int i = 0; i < RF_STRIP && !rf_cancelled(f->exec); i++)
        count_row(c, f, y + i, ray_weight, sums);
    memset(c->settled_touched, 0, sizeof c->settled_touched);
    settled = list_touched(c);
    memset(c->settled, 0, sizeof c->settled);
    set_counts(c, settled);
    c->rays.rays = 0;
}

/* Sorts a chunk of rays into those that are settled for the strip, and those to be followed. */
static void sort_chunk(struct rf_counting *c, const struct rf_frame *f, int tx, int y,
                       uint16_t times)
{
    const struct rf_search_rays *const from = &c->chunk.rays;
    struct rf_counted_rays *const to = &c->rays;
    uint8_t is_settled[RF_RAY_CHUNK];
    int32_t place[RF_RAY_CHUNK];
    int left = to->rays;

    rf_settle_chunk(is_settled, place, f, &c->chunk, tx, y);
    for (int n = 0; n < from->rays; n++) {
        if (is_settled[n]) {
            const int number = rf_count_number(rf_settled_x(place[n]), rf_settled_y(place[n]));

            c->settled[number] = (uint16_t)(c->settled[number] + times);
            c->settled_touched[number] = 1;
            continue;
        }
        to->start[left] = (int16_t)from->start[n];
        to->u[left] = from->u[n];
        to->v[left] = from->v[n];
        to->within[left] = (uint16_t)from->within[n];
        to->times[left] = times;
        left++;
    }
    to->rays = left;
}

/* Rays count as often as they weigh; but those of whole chunks of equal weight count once each. */
static void count_rays_of_strip(struct rf_counting *c, const struct rf_frame *f, int tx, int y,
                                const struct rf_ray_set *set, struct rf_sums *sums)
{
    uint32_t ray_weight = 1, counted = 0; /* a pixel sees that many times so far */

    for (int n = 0, rays; n < set->count && !rf_cancelled(f->exec); n += rays) {
        const uint16_t weight = set->ray[n].weight;
        uint16_t times;

        rays = rf_rays_of_equal_weight(set, n);
        times = rays < RF_RAY_CHUNK && !(counted && ray_weight == weight) ? weight : 1;
        if (counted && (ray_weight != (uint32_t)(weight / times) ||
                        counted + (uint32_t)(rays * times) > MOST_TIMES ||
                        c->rays.rays + rays > RF_COUNTED_RAYS)) {
            count_strip(c, f, y, ray_weight, sums);
            counted = 0;
        }
        ray_weight = weight / times;
        counted += (uint32_t)(rays * times);
        rf_set_search_chunk(&c->chunk, f, &set->ray[n], rays, RF_COUNT_ROW);
        sort_chunk(c, f, tx, y, times);
    }
    count_strip(c, f, y, ray_weight, sums);
}

void rf_count_rays(struct rf_counting *counting, const struct rf_frame *f, int tx, int ty,
                   const struct rf_ray_set *set, struct rf_sums *sums)
{
    for (int y = ty * RF_TILE; y < (ty + 1) * RF_TILE; y += RF_STRIP)
        count_rays_of_strip(counting, f, tx, y, set, sums);
    for (int i = 0; !f->weighted && i < RF_TILE * RF_TILE; i++)
        sums->weight[i] = set->total_weight;
}
