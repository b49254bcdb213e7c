/* temporal.c: steadies the disparities of a video from frame to frame. */
#include <refocus/temporal.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "depth/temporal.h"
#include "image/format.h"
#include "image/read.h"
#include "support/arena.h"
#include "support/compare.h"

enum {
    NEARLY = 3, /* codes of the guide that are not worth to look beside for less */
    MOST_COUNT = 255,
};

struct refocus_temporal {
    int width, height;
    uint32_t strength; /* Q8 */
    int noise;         /* disparities */
    bool guided;
    int frames;                        /* Known ones, up to RF_HISTORY. */
    struct rf_frame frame[RF_HISTORY]; /* as they came, the newest first */
    uint16_t *last, *filtered;         /* the filtered map of the last frame and of this one */
    uint8_t *count, *counted;          /* frames that each sample has been seen in */
    struct rf_motion *motion;          /* One vector a block. */
    void *block;
    struct rf_run run;
};

static bool good(const struct refocus_temporal_params *p)
{
    return p->width >= 1 && p->width <= REFOCUS_MAX_SIDE && p->height >= 1 &&
           p->height <= REFOCUS_MAX_SIDE && p->strength >= 0 && p->strength <= 0.95f &&
           p->noise >= 0 && p->noise <= 0.25f && !p->reserved;
}

static void lay_out(struct refocus_temporal *f, struct rf_arena *arena)
{
    const uint64_t samples = (uint64_t)f->width * (uint64_t)f->height;
    const uint64_t blocks = (uint64_t)((f->width + RF_BLOCK - 1) / RF_BLOCK) *
                            (uint64_t)((f->height + RF_BLOCK - 1) / RF_BLOCK);

    for (int k = 0; k < RF_HISTORY; k++) {
        f->frame[k].disparity = rf_arena_take(arena, samples, 2);
        f->frame[k].guide = rf_arena_take(arena, samples, 1);
        f->frame[k].from = rf_arena_take(arena, samples, sizeof *f->frame[k].from);
    }
    f->last = rf_arena_take(arena, samples, 2);
    f->filtered = rf_arena_take(arena, samples, 2);
    f->count = rf_arena_take(arena, samples, 1);
    f->counted = rf_arena_take(arena, samples, 1);
    f->motion = rf_arena_take(arena, blocks, sizeof *f->motion);
}

int refocus_temporal_create(struct refocus_temporal **filter,
                            const struct refocus_temporal_params *params)
{
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct refocus_temporal_params own;
    struct refocus_temporal *f;
    int status;

    if (!filter)
        return REFOCUS_ERR_ARGUMENT;
    *filter = NULL;
    status = refocus_struct_read(&own, sizeof own,
                                 REFOCUS_SIZE_TO(struct refocus_temporal_params, noise), params);
    if (status)
        return status;
    params = &own;
    if (!good(params))
        return REFOCUS_ERR_ARGUMENT;
    f = calloc(1, sizeof *f);
    if (!f)
        return REFOCUS_ERR_MEMORY;
    f->width = params->width;
    f->height = params->height;
    f->strength = (uint32_t)lrintf(params->strength * 256);
    f->noise = (int)lrintf(params->noise * 65535);
    lay_out(f, &arena);
    f->block = arena.used <= PTRDIFF_MAX ? malloc((size_t)arena.used) : NULL;
    if (!f->block) {
        free(f);
        return REFOCUS_ERR_MEMORY;
    }
    rf_arena_begin(&arena, f->block);
    lay_out(f, &arena);
    refocus_temporal_reset(f);
    *filter = f;
    return REFOCUS_OK;
}

void refocus_temporal_destroy(struct refocus_temporal **filter)
{
    if (!filter || !*filter)
        return;
    free((*filter)->block);
    free(*filter);
    *filter = NULL;
}

void refocus_temporal_reset(struct refocus_temporal *f)
{
    size_t blocks;

    if (!f)
        return;
    blocks = (size_t)((f->width + RF_BLOCK - 1) / RF_BLOCK) *
             (size_t)((f->height + RF_BLOCK - 1) / RF_BLOCK);
    f->frames = 0;
    memset(f->motion, 0, blocks * sizeof *f->motion);
}

void refocus_temporal_cancel(struct refocus_temporal *f)
{
    int running = RF_RUN_RUNNING;

    if (f)
        atomic_compare_exchange_strong(&f->run.state, &running, RF_RUN_CANCELLED);
}

struct rf_run *rf_run_of_temporal(struct refocus_temporal *f)
{
    return &f->run;
}

static uint16_t rescale(uint16_t d, double scale, double offset)
{
    const double value = scale * d + offset * 65535 + 0.5;

    return (uint16_t)(value > 0 ? value < 65535 ? value : 65535 : 0);
}

int refocus_temporal_rescale(struct refocus_temporal *f, double scale, double offset)
{
    size_t samples;

    if (!f || !(scale > 0) || !isfinite(scale) || !isfinite(offset))
        return REFOCUS_ERR_ARGUMENT;
    samples = (size_t)f->width * (size_t)f->height;
    for (size_t i = 0; i < samples && f->frames > 0; i++)
        f->last[i] = rescale(f->last[i], scale, offset);
    for (int k = 1; k < RF_HISTORY;
         k++) /* Frame 0 is the next; of the others as many are filled. */
        for (size_t i = 0; i < samples && k <= f->frames; i++) {
            f->frame[k].disparity[i] = rescale(f->frame[k].disparity[i], scale, offset);
            if (!f->guided) /* then depth is its own guide */
                f->frame[k].guide[i] = (uint8_t)(f->frame[k].disparity[i] >> 8);
        }
    return REFOCUS_OK;
}

/* Filters one sample as refocus_temporal_run() says. A block of which most
 * changes needs no majority of the history. */
static void filter(struct refocus_temporal *f, size_t i, bool changes)
{
    const struct rf_motion from = f->frame[0].from[i];
    const size_t q =
        from.x == RF_NOWHERE ? i : (size_t)((ptrdiff_t)i + from.y * (ptrdiff_t)f->width + from.x);
    const int d = f->frame[0].disparity[i], p = f->last[q], apart = abs(d - p);
    const int changed = abs(f->frame[0].guide[i] - f->frame[1].guide[q]);
    const int n = f->count[q];
    const int64_t square = (int64_t)f->noise * f->noise;
    uint32_t keep;

    f->filtered[i] = (uint16_t)d;
    f->counted[i] = 1;
    if (f->strength == 0 || from.x == RF_NOWHERE ||
        (f->guided ? changed >= RF_ALIKE : apart >= f->noise)) {
        f->frame[0].from[i].x = RF_NOWHERE;
        return;
    }
    /* The photo does not explain a jump: the history votes. */
    if (apart >= f->noise) {
        struct rf_history history;
        int of;

        rf_history_take(&history, f->frame, changes ? 2 : f->frames, f->width, i);
        of = rf_history_vote(&history, p, f->noise, &f->filtered[i]);
        if (!of)
            f->filtered[i] = (uint16_t)p;
        f->counted[i] = (uint8_t)(of ? of : n);
        return;
    }
    keep = (uint32_t)(256 * n / (n + 1));
    keep = keep < f->strength ? keep : f->strength;
    f->filtered[i] = (uint16_t)(d + (int64_t)keep * (square - (int64_t)apart * apart) * (p - d) /
                                        (256 * square));
    f->counted[i] = (uint8_t)(n < MOST_COUNT ? n + 1 : n);
}

/* Where a sample was: by the vector of its block, or beside that where the photo is more alike, as
 * blocks move by whole samples. */
static struct rf_motion find_origin(const struct refocus_temporal *f, int x, int y,
                                    struct rf_motion v)
{
    const uint8_t *const guide = f->frame[1].guide;
    const int here = f->frame[0].guide[(size_t)y * (size_t)f->width + (size_t)x];
    const int tx = x + v.x, ty = y + v.y;
    struct rf_motion best = v;
    int least;

    if (tx < 0 || ty < 0 || tx >= f->width || ty >= f->height)
        return (struct rf_motion){RF_NOWHERE, 0};
    least = abs(here - guide[(size_t)ty * (size_t)f->width + (size_t)tx]);
    if (!f->guided || least <= NEARLY)
        return best;
    for (int k = 0; k < 9; k++) {
        const int bx = rf_clamp(tx + k % 3 - 1, 0, f->width - 1),
                  by = rf_clamp(ty + k / 3 - 1, 0, f->height - 1);
        const int apart = abs(here - guide[(size_t)by * (size_t)f->width + (size_t)bx]);

        if (apart < least) {
            least = apart;
            best = (struct rf_motion){(int8_t)(bx - x), (int8_t)(by - y)};
        }
    }
    return best;
}

/* Fills in where the samples of a block were. Returns whether for most of them this frame and the
 * last agree on a place where they were not before. */
static bool find_origins(struct refocus_temporal *f, int x0, int y0, int columns, int rows,
                         struct rf_motion v)
{
    const uint16_t *const d = f->frame[0].disparity, *const before = f->frame[1].disparity;
    int jumps = 0;

    for (int y = y0; y < y0 + rows; y++)
        for (int x = x0; x < x0 + columns; x++) {
            const size_t i = (size_t)y * (size_t)f->width + (size_t)x;
            const struct rf_motion from = find_origin(f, x, y, v);
            const size_t q = (size_t)((ptrdiff_t)i + from.y * (ptrdiff_t)f->width + from.x);

            f->frame[0].from[i] = from;
            if (from.x != RF_NOWHERE)
                jumps += abs(d[i] - f->last[q]) >= f->noise && abs(d[i] - before[q]) < f->noise;
        }
    return 2 * jumps > columns * rows;
}

static void filter_all(struct refocus_temporal *f)
{
    const struct rf_frame last = {f->last, f->frame[1].guide, NULL};
    const struct rf_motion *motion = f->motion;

    rf_find_motion(f->motion, &f->frame[0], &last, f->width, f->height, &f->run);
    for (int y = 0; y < f->height && !rf_run_cancelled(&f->run); y += RF_BLOCK)
        for (int x = 0; x < f->width; x += RF_BLOCK) {
            const int columns = f->width - x < RF_BLOCK ? f->width - x : RF_BLOCK;
            const int rows = f->height - y < RF_BLOCK ? f->height - y : RF_BLOCK;
            const bool changes = find_origins(f, x, y, columns, rows, *motion++);

            for (int j = y; j < y + rows; j++)
                for (int i = x; i < x + columns; i++)
                    filter(f, (size_t)j * (size_t)f->width + (size_t)i, changes);
        }
}

static void swap16(uint16_t **a, uint16_t **b)
{
    uint16_t *const t = *a;

    *a = *b;
    *b = t;
}

static void swap8(uint8_t **a, uint8_t **b)
{
    uint8_t *const t = *a;

    *a = *b;
    *b = t;
}

int refocus_temporal_run(struct refocus_temporal *f, const struct refocus_image *photo,
                         const struct refocus_disparity *map, uint16_t *out, ptrdiff_t stride)
{
    struct refocus_image own_photo;
    struct refocus_disparity own_map;
    struct rf_frame oldest;
    size_t samples;
    int status;

    if (!f)
        return REFOCUS_ERR_ARGUMENT;
    if ((photo && (status = rf_read_any_image(NULL, "photo", &own_photo, photo))) ||
        (status = rf_read_map(NULL, "map", &own_map, map)))
        return status;
    if (photo && own_photo.format >= REFOCUS_FORMAT_RGB_HALF &&
        own_photo.format <= REFOCUS_FORMAT_RGBA_FLOAT)
        return REFOCUS_ERR_UNSUPPORTED;
    photo = photo ? &own_photo : NULL;
    map = &own_map;
    if (map->width != f->width || map->height != f->height || !out || ((uintptr_t)out & 1) ||
        (stride & 1) || !rf_good_stride(stride, 2 * (ptrdiff_t)f->width, f->height))
        return REFOCUS_ERR_ARGUMENT;
    samples = (size_t)f->width * (size_t)f->height;
    if (f->guided != (photo != NULL))
        f->frames = 0; /* another guide: nothing to compare with */
    f->guided = photo != NULL;
    atomic_store(&f->run.state, RF_RUN_RUNNING);
    rf_load_frame(&f->frame[0], f->width, f->height, photo, map, &f->run);
    if (f->frames > 0 && f->guided &&
        rf_is_cut(f->frame[0].guide, f->frame[1].guide, f->width, f->height))
        refocus_temporal_reset(f);
    if (f->frames++ > 0) {
        f->frames = f->frames < RF_HISTORY ? f->frames : RF_HISTORY;
        filter_all(f);
    } else {
        memcpy(f->filtered, f->frame[0].disparity, samples * sizeof *f->filtered);
        memset(f->counted, 1, samples);
    }
    if (atomic_exchange(&f->run.state, RF_RUN_IDLE) == RF_RUN_CANCELLED) {
        refocus_temporal_reset(f);
        return REFOCUS_ERR_CANCELLED;
    }
    for (int y = 0; y < f->height; y++)
        memcpy((char *)out + y * stride, f->filtered + (size_t)y * (size_t)f->width,
               (size_t)f->width * sizeof *out);
    oldest = f->frame[RF_HISTORY - 1];
    memmove(f->frame + 1, f->frame, (RF_HISTORY - 1) * sizeof *f->frame);
    f->frame[0] = oldest;
    swap16(&f->last, &f->filtered);
    swap8(&f->count, &f->counted);
    return REFOCUS_OK;
}
