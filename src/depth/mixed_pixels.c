/* mixed_pixels.c: gives the mixed pixels along silhouettes of a soft photo to the nearer surface.
 *
 * Photos of many megapixels are soft: five pixels across a silhouette are mixtures of both
 * surfaces, and the map's edge runs through their middle. Those beyond it would be blurred with the
 * background, and leave a dim outline around a subject in focus; those of a blurred foreground
 * would stay as its outline on a background in focus. Either goes when the nearer surface has them
 * all.
 *
 * Across each step of the map, from F (far) to N (near), a pixel of colour p is a mixture of
 *
 *     share = (p - F) . (N - F) / |N - F|^2
 *
 * where F and N are colours well within the surfaces. The nearer surface takes those beyond its
 * edge of which it has more than LEAST, up to the first one of which it has not, and no more than
 * half of the mixtures, rounded up, as the edge is in their middle.
 *
 * Where the far surface has a pattern its pixels are like mixtures, too. So shares have to fall
 * from the edge on to those of F, and what is nearer has to look like N.
 *
 * A median of 3 x 3 then smooths the silhouettes.
 *
 * A small photo that is sharp to the pixel has at most two mixtures across most of its silhouettes.
 * There a whole pixel would be too much, and nothing is done: of 720 x 540 pixels path-traced
 * through a camera's lens 45 to 78 % are so sharp, of photos of 3 and 12 megapixels from phones 4
 * to 54 %. In photos of more than LARGE pixels one of them is too small to be seen.
 */
#include "depth/mixed_pixels.h"

#include <stdatomic.h>
#include <string.h>

#include "depth/median.h"
#include "image/format.h"
#include "support/compare.h"

enum {
    BAND = 16,       /* rows of a work item */
    BLOCK = 16,      /* pixels that are passed over together */
    STEP = 1966,     /* 0.03: a greater one is an edge */
    REACH = 5,       /* mixtures are looked for so far on either side of a step */
    MOST = 3,        /* pixels that are taken: two bits for each direction */
    MARGIN = 7,      /* pixels at the sides of a photo that are left alone: REACH + 2 */
    CONTRAST = 24,   /* codes: of surfaces that look more alike no share is certain */
    LEAST = 15,      /* percent of a mixture */
    RISE = 10,       /* percent: shares that rise by more away from the edge are a pattern */
    ALIKE = 50,      /* percent, of all pixels of the nearer surface */
    SHARP = 2,       /* mixtures across an edge that is sharp */
    FEW_SHARP = 30,  /* percent of the edges of a soft photo are sharp at most */
    FEWEST = 100,    /* edges that can tell */
    LARGE = 3 << 20, /* pixels: photos that have more are taken for soft */
    DIRECTIONS = 4,
};

/* From a far pixel to the near one beside it. */
static const struct {
    int x, y;
} towards[DIRECTIONS] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

struct work {
    struct rf_mixed_pixels mixed;
    int bytes; /* a pixel */
    atomic_int edges, sharp;
};

struct edge {
    int mixtures; /* -1: the photo does not tell */
    int run;      /* pixels for the nearer surface */
};

static bool continues(int disparity, int other, int contrast)
{
    const int off = disparity - other;

    return 2 * off < contrast && 2 * off > -contrast;
}

/* Whether shares of REACH + 1 pixels of the far surface, then of as many of the near one, are those
 * of a silhouette. */
static bool is_silhouette(const int *share, int square, int mixtures)
{
    const int far = REACH - 1 - (mixtures + 1) / 2; /* pixels that mixtures do not reach */

    for (int i = 0; i < far; i++)
        if (share[i] > LEAST * square || share[i] < -LEAST * square)
            return false;
    for (int i = 1; i <= REACH + 1; i++)
        if (share[i - 1] - share[i] > RISE * square)
            return false;
    for (int i = REACH + 1; i < 2 * REACH + 2; i++)
        if (share[i] < ALIKE * square)
            return false;
    return true;
}

/* The edge between the far pixel at (x, y) and the near one in a direction. */
static struct edge look_across(const struct work *work, int x, int y, int direction)
{
    const struct refocus_image *photo = work->mixed.photo;
    const int dx = towards[direction].x, dy = towards[direction].y;
    const ptrdiff_t along = dy * photo->stride[0] + dx * work->bytes;
    const ptrdiff_t on = dy * work->mixed.map.stride + dx;
    const uint16_t *map = work->mixed.map.at + y * work->mixed.map.stride + x;
    const uint8_t *pixel = photo->plane[0] + y * photo->stride[0] + (ptrdiff_t)x * work->bytes;
    const uint8_t *far = pixel - (REACH + 1) * along, *near = pixel + (REACH + 2) * along;
    const int contrast = map[on] - map[0];
    struct edge edge = {-1, 0};
    int square = 0, share[2 * REACH + 2];

    if (!continues(map[-(REACH + 1) * on], map[0], contrast) ||
        !continues(map[(REACH + 2) * on], map[on], contrast))
        return edge;
    for (int c = 0; c < 3; c++)
        square += (near[c] - far[c]) * (near[c] - far[c]);
    if (square <= CONTRAST * CONTRAST)
        return edge;
    edge.mixtures = 0;
    for (int i = 0; i < 2 * REACH + 2; i++) {
        const uint8_t *p = pixel + (i - REACH) * along;

        share[i] = 0;
        for (int c = 0; c < 3; c++)
            share[i] += 100 * (p[c] - far[c]) * (near[c] - far[c]);
        edge.mixtures += share[i] > LEAST * square && share[i] < (100 - LEAST) * square;
    }
    if (is_silhouette(share, square, edge.mixtures))
        while (edge.run < MOST && 2 * edge.run < edge.mixtures &&
               share[REACH - edge.run] > LEAST * square)
            edge.run++;
    return edge;
}

/* Whether one of BLOCK pixels lies beside a nearer surface. */
static bool has_step(const uint16_t *map, ptrdiff_t stride)
{
    int any = 0;

    for (int i = 0; i < BLOCK; i++) {
        const uint16_t left = map[i - 1], right = map[i + 1];
        const uint16_t above = map[i - stride], below = map[i + stride];
        const uint16_t beside = left > right ? left : right;
        const uint16_t over = above > below ? above : below;
        const uint16_t nearest = beside > over ? beside : over;

        any |= nearest - map[i] > STEP;
    }
    return any != 0;
}

/* Edges that were looked at, and how many of them are sharp. */
struct counts {
    int edges, sharp;
};

/* How many pixels the nearer surfaces around a far pixel take, two bits for each direction. */
static uint8_t runs_at(const struct work *work, int x, int y, struct counts *counts)
{
    const uint16_t *map = work->mixed.map.at + y * work->mixed.map.stride + x;
    unsigned runs = 0;

    for (int i = 0; i < DIRECTIONS; i++) {
        struct edge edge;

        if (map[towards[i].y * work->mixed.map.stride + towards[i].x] - map[0] <= STEP)
            continue;
        edge = look_across(work, x, y, i);
        counts->edges += edge.mixtures >= 0;
        counts->sharp += edge.mixtures >= 0 && edge.mixtures <= SHARP;
        runs |= (unsigned)edge.run << 2 * i;
    }
    return (uint8_t)runs;
}

static void find_runs(void *context, int band, int worker)
{
    struct work *work = context;
    const struct rf_mixed_pixels *mixed = &work->mixed;
    const int width = mixed->photo->width, height = mixed->photo->height;
    const int end = (band + 1) * BAND < height ? (band + 1) * BAND : height;
    struct counts counts = {0, 0};

    (void)worker;
    for (int y = band * BAND; y < end; y++) {
        const uint16_t *map = mixed->map.at + y * mixed->map.stride;
        uint8_t *run = mixed->run.at + y * mixed->run.stride;

        memset(run, 0, (size_t)width);
        if (y < MARGIN || y >= height - MARGIN)
            continue;
        for (int x0 = MARGIN; x0 < width - MARGIN; x0 += BLOCK) {
            const int left = width - MARGIN - x0;

            if (left >= BLOCK && !has_step(map + x0, mixed->map.stride))
                continue;
            for (int x = x0; x < x0 + (left < BLOCK ? left : BLOCK); x++)
                run[x] = runs_at(work, x, y, &counts);
        }
    }
    atomic_fetch_add(&work->edges, counts.edges);
    atomic_fetch_add(&work->sharp, counts.sharp);
}

/* Puts the disparities of nearer surfaces where they take pixels of rows y0 to y1 - 1. */
static void put_runs(const struct rf_mixed_pixels *mixed, int x, int y, int y0, int y1)
{
    const uint8_t runs = mixed->run.at[y * mixed->run.stride + x];

    for (int i = 0; i < DIRECTIONS; i++) {
        const int dx = towards[i].x, dy = towards[i].y, run = runs >> 2 * i & 3;
        const uint16_t near = mixed->map.at[(y + dy) * mixed->map.stride + x + dx];

        for (int k = 0; k < run; k++) {
            uint16_t *to = mixed->nearer.at + (y - k * dy) * mixed->nearer.stride + x - k * dx;

            if (y - k * dy >= y0 && y - k * dy < y1 && *to < near)
                *to = near;
        }
    }
}

static void put_band(void *context, int band, int worker)
{
    const struct work *work = context;
    const struct rf_mixed_pixels *mixed = &work->mixed;
    const int width = mixed->photo->width, height = mixed->photo->height, y0 = band * BAND;
    const int y1 = y0 + BAND < height ? y0 + BAND : height;
    const int last = y1 + MOST - 1 < height ? y1 + MOST - 1 : height;

    (void)worker;
    for (int y = y0; y < y1; y++)
        memset(mixed->nearer.at + y * mixed->nearer.stride, 0, (size_t)width * sizeof(uint16_t));
    for (int y = y0 < MOST - 1 ? 0 : y0 - (MOST - 1); y < last; y++) {
        const uint8_t *run = mixed->run.at + y * mixed->run.stride;

        for (int x = 0; x < width; x++) {
            uint64_t eight = 0;

            for (; x + 8 <= width && !eight; x += eight ? 0 : 8)
                memcpy(&eight, run + x, sizeof eight);
            if (x < width && run[x])
                put_runs(mixed, x, y, y0, y1);
        }
    }
}

/* Makes `nearer` the map with what nearer surfaces take, and `run` 1 where they take a pixel. */
static void take_nearer(void *context, int band, int worker)
{
    const struct work *work = context;
    const struct rf_mixed_pixels *mixed = &work->mixed;
    const int height = mixed->photo->height;
    const int end = (band + 1) * BAND < height ? (band + 1) * BAND : height;

    (void)worker;
    for (int y = band * BAND; y < end; y++) {
        const uint16_t *restrict map = mixed->map.at + y * mixed->map.stride;
        uint16_t *restrict nearer = mixed->nearer.at + y * mixed->nearer.stride;
        uint8_t *restrict taken = mixed->run.at + y * mixed->run.stride;

        for (int x = 0; x < mixed->photo->width; x++) {
            taken[x] = nearer[x] > map[x];
            nearer[x] = taken[x] ? nearer[x] : map[x];
        }
    }
}

/* Whether a pixel, or one of the eight around it, was taken by a nearer surface. */
static bool is_beside(const uint8_t *taken, ptrdiff_t stride)
{
    int any = 0;

    for (int i = -1; i <= 1; i++)
        any |= taken[i - stride] | taken[i] | taken[i + stride];
    return any != 0;
}

/* Whether any of n pixels is such a one. */
static bool has_any(const uint8_t *taken, ptrdiff_t stride, int n)
{
    int any = 0;

    for (int i = -1; i <= n; i++)
        any |= taken[i - stride] | taken[i] | taken[i + stride];
    return any != 0;
}

/* Each row or column is taken by itself, which leaves teeth of a pixel along silhouettes, and what
 * is sharp beside what is blurred shows. A median of 3 x 3 takes teeth and single pixels away. It
 * would take away surfaces that are as thin, too, so it is left out where nothing was taken. */
static void smooth_silhouettes(void *context, int band, int worker)
{
    const struct work *work = context;
    const struct rf_mixed_pixels *mixed = &work->mixed;
    const int width = mixed->photo->width, height = mixed->photo->height;
    const int end = (band + 1) * BAND < height ? (band + 1) * BAND : height;

    (void)worker;
    for (int y = band * BAND; y < end; y++) {
        uint16_t *map = mixed->map.at + y * mixed->map.stride;
        const uint16_t *nearer = mixed->nearer.at + y * mixed->nearer.stride;
        const uint8_t *taken = mixed->run.at + y * mixed->run.stride;

        memcpy(map, nearer, (size_t)width * sizeof *map);
        if (y < 1 || y >= height - 1)
            continue;
        for (int x = 1, n; x < width - 1; x += n) {
            n = rf_smaller(BLOCK, width - 1 - x);
            if (has_any(taken + x, mixed->run.stride, n))
                for (int i = x; i < x + n; i++)
                    if (is_beside(taken + i, mixed->run.stride))
                        map[i] = rf_median_of_nine(nearer + i, mixed->nearer.stride);
        }
    }
}

/* In a video the noise of each frame would move sharp edges by a pixel. */
static bool is_large(const struct rf_mixed_pixels *mixed)
{
    return mixed->still && (int64_t)mixed->photo->width * mixed->photo->height > LARGE;
}

static bool is_soft(struct work *work)
{
    const int edges = atomic_load(&work->edges), sharp = atomic_load(&work->sharp);

    return edges >= FEWEST && (int64_t)100 * sharp <= (int64_t)FEW_SHARP * edges;
}

void rf_claim_mixed_pixels(const struct rf_mixed_pixels *mixed, struct rf_pool *pool)
{
    struct work work = {.mixed = *mixed, .bytes = refocus_format_bytes(mixed->photo->format)};
    const int bands = (mixed->photo->height + BAND - 1) / BAND;

    atomic_init(&work.edges, 0);
    atomic_init(&work.sharp, 0);
    rf_pool_run(pool, find_runs, &work, bands);
    if ((!is_large(mixed) && !is_soft(&work)) || rf_run_cancelled(pool->run))
        return;
    rf_pool_run(pool, put_band, &work, bands);
    rf_pool_run(pool, take_nearer, &work, bands);
    rf_pool_run(pool, smooth_silhouettes, &work, bands);
}
