/* upsample_surfaces.c: decides at depth edges which surface a pixel of the photo belongs to. */
#include <string.h>

#include "depth/upsample.h"
#include "image/format.h"
#include "support/compare.h"

enum {
    PAD = RF_UPSAMPLE_PAD,
    BLOCK = RF_UPSAMPLE_BLOCK,
    STEP = 65535 / 24, /* largest one within a surface */
    RUN = 8,           /* most columns and rows of pixels that are looked at together */
    SLICE = 128,       /* pixels whose colours are copied at once */
    KINDS = 8,         /* spans that are remembered */
};

/* Where pixels of spans lie among the samples, for the last few kinds of spans. */
struct placements {
    struct rf_placement placement[KINDS];
    int alike[KINDS], x[KINDS];
};

/* The samples around cells side by side, column by column. */
struct around {
    uint16_t disparity[RF_AROUND * RF_TURNED];
    uint8_t colour[3][RF_AROUND * RF_TURNED], trust[RF_AROUND * RF_TURNED];
};

/* All that a worker needs for rows of pixels between the same samples. */
struct patch {
    const struct rf_upsampler *up;
    int row;    /* the first of the taps */
    int y0, y1; /* rows of pixels, at most RUN */
    int bytes;  /* a pixel */
    int ready;  /* colours of the columns before are in `colour` */
    int from;   /* the first of them */
    uint8_t colour[3][RUN][SLICE + RUN];
    struct rf_parts parts;
    struct rf_cell cell;
    struct placements placements;
    struct around around;
};

/* The colours of n pixels from column x on, a row after the other. */
static void collect(uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], struct patch *patch, int x, int n)
{
    const struct refocus_image *photo = patch->up->photo;
    const int rows = patch->y1 - patch->y0;

    if (x < patch->from || x + n > patch->ready) {
        const int left = photo->width - x;

        patch->from = x;
        patch->ready = x + (left < SLICE ? left : SLICE);
        for (int y = patch->y0; y < patch->y1; y++) {
            const uint8_t *row =
                photo->plane[0] + y * photo->stride[0] + (ptrdiff_t)x * patch->bytes;
            uint8_t *const out[3] = {patch->colour[0][y - patch->y0],
                                     patch->colour[1][y - patch->y0],
                                     patch->colour[2][y - patch->y0]};

            patch->up->kernels->quarter(out, row, patch->bytes, patch->ready - x);
            for (int i = SLICE; i < 2 * SLICE && x + i < photo->width; i += 16)
                __builtin_prefetch(row + i * patch->bytes);
        }
    }
    const size_t left = (size_t)(x - patch->from), step = (size_t)n;
    size_t at = 0;

    /* Copies of 8 cost less than copies of n. */
    for (int j = 0; j < rows; j++, at += step) {
        memcpy(&colour[0][at], &patch->colour[0][j][left], RUN);
        memcpy(&colour[1][at], &patch->colour[1][j][left], RUN);
        memcpy(&colour[2][at], &patch->colour[2][j][left], RUN);
    }
    for (int c = 0; c < 3; c++)
        memset(&colour[c][at], colour[c][0], RF_BATCH_SPARE);
}

static const struct rf_placement *placement_of(struct patch *patch, int cell, int x, int n)
{
    const struct rf_upsampler *up = patch->up;
    const struct rf_span *span = &up->span[cell];
    /* Runs of one span have places of their own: 3 apart, those of up to three kinds of spans. */
    const int off = x - span->begin, kind = (span->alike + off / RUN * 3) % KINDS;
    struct rf_placement *placement = &patch->placements.placement[kind];

    if (patch->placements.alike[kind] == span->alike && patch->placements.x[kind] == off)
        return placement;
    patch->placements.alike[kind] = span->alike;
    patch->placements.x[kind] = off;
    for (int y = patch->y0, at = 0; y < patch->y1; y++)
        for (int i = 0; i < n; i++, at++) {
            placement->all[at] = 0;
            for (int t = 0; t < RF_TAP_COUNT; t++) {
                const uint32_t near_by = (uint32_t)up->across[x + i].near_by[t / RF_TAPS] *
                                             up->down[y].near_by[t % RF_TAPS] >>
                                         16;

                placement->near_by[t][at] = (uint16_t)near_by;
                placement->all[at] = (uint16_t)(placement->all[at] + near_by);
            }
            placement->x[at] = up->across[x + i].middle;
            placement->y[at] = up->down[y].middle;
        }
    return placement;
}

/* n elements of one or two bytes, at most 8 and often 4 or more: then four and four. */
static inline void put(void *to, const void *from, size_t n, size_t size)
{
    if (n >= 4) {
        memcpy(to, from, 4 * size);
        memcpy((char *)to + (n - 4) * size, (const char *)from + (n - 4) * size, 4 * size);
    } else {
        memcpy(to, from, n * size);
    }
}

/* Writes the disparities that were found for columns x to x + n - 1. */
static inline void put_rows(const struct patch *patch, const uint16_t *result,
                            const uint8_t *is_sure, int x, size_t n)
{
    const struct rf_upsampler *up = patch->up;
    const ptrdiff_t out_stride = up->out.stride, sure_stride = up->sure.stride;
    uint16_t *out = up->out.at + patch->y0 * out_stride + x;
    uint8_t *sure = up->sure.at + (patch->y0 - up->first_row) * sure_stride + x;

    for (int y = patch->y0; y < patch->y1; y++) {
        put(out, result, n, sizeof *out);
        put(sure, is_sure, n, sizeof *sure);
        out += out_stride;
        sure += sure_stride;
        result += n;
        is_sure += n;
    }
}

/* Elements of a row from x on; beyond the border those at the border. */
static const uint8_t *take8(uint8_t spare[RF_TURNED], const uint8_t *row, int x, int columns)
{
    const int from = x < 0 ? -x : 0;
    const int to = columns - x < RF_TURNED ? columns - x : RF_TURNED;

    if (from < to)
        memcpy(spare + from, row + x + from, (size_t)(to - from));
    for (int i = 0; i < from; i++)
        spare[i] = row[0];
    for (int i = to < from ? from : to; i < RF_TURNED; i++)
        spare[i] = row[columns - 1];
    return spare;
}

static const uint16_t *take16(uint16_t spare[RF_TURNED], const uint16_t *row, int x, int columns)
{
    const int from = x < 0 ? -x : 0;
    const int to = columns - x < RF_TURNED ? columns - x : RF_TURNED;

    if (from < to)
        memcpy(spare + from, row + x + from, (size_t)(to - from) * sizeof *row);
    for (int i = 0; i < from; i++)
        spare[i] = row[0];
    for (int i = to < from ? from : to; i < RF_TURNED; i++)
        spare[i] = row[columns - 1];
    return spare;
}

/* Rows of bytes from column x on; `inside`: all of them are there. */
static void turn(const struct patch *patch, uint8_t *out, const uint8_t *samples,
                 const ptrdiff_t off[RF_AROUND], int x, bool inside)
{
    const struct rf_upsampler *up = patch->up;
    uint8_t spare[RF_AROUND][RF_TURNED];
    const uint8_t *row[RF_AROUND];

    for (int j = 0; j < RF_AROUND; j++)
        row[j] = inside ? samples + off[j] + x : take8(spare[j], samples + off[j], x, up->columns);
    up->kernels->transpose8(out, row);
}

/* The samples around RF_CELLS cells from the first-th on. */
static void look_around(struct patch *patch, int first)
{
    const struct rf_upsampler *up = patch->up;
    const int x = first - PAD - 2;
    const bool inside = x >= -PAD && x + RF_TURNED <= up->columns + PAD;
    uint16_t spare[RF_AROUND][RF_TURNED];
    const uint16_t *row[RF_AROUND];
    ptrdiff_t of_colour[RF_AROUND], of_trust[RF_AROUND];

    for (int j = 0; j < RF_AROUND; j++) {
        const int y = rf_clamp(patch->row - 2 + j, 0, up->rows - 1);
        const uint16_t *samples = up->coarse.at + y * up->coarse.stride;

        row[j] = inside ? samples + x : take16(spare[j], samples, x, up->columns);
        of_colour[j] = y * up->colour.stride;
        of_trust[j] = y * up->trust.stride;
    }
    up->kernels->transpose16(patch->around.disparity, row);
    for (int c = 0; c < 3; c++)
        turn(patch, patch->around.colour[c], up->colour.channel[c], of_colour, x, inside);
    if (up->confidence)
        turn(patch, patch->around.trust, up->trust.at, of_trust, x, inside);
}

/* Finds the surface of each pixel of the i-th cell of those that have been looked around. */
static void fill_cell(struct patch *patch, int cell, int i)
{
    const struct rf_upsampler *up = patch->up;
    const struct around *around = &patch->around;
    const int x1 = up->span[cell + 1].begin, rows = patch->y1 - patch->y0;
    const int at = RF_AROUND * i;
    const struct rf_window window = {
        .disparity = around->disparity + at,
        .colour = {around->colour[0] + at, around->colour[1] + at, around->colour[2] + at},
        .trust = up->confidence ? around->trust + at : NULL};
    bool found = false;

    for (int x = up->span[cell].begin; x < x1; x += RUN) {
        const int n = x1 - x < RUN ? x1 - x : RUN;
        uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], sure[RF_BATCH];
        uint16_t result[RF_BATCH];

        /* Collect long before this is read as vectors: that would stall. */
        collect(colour, patch, x, n);
        if (!found)
            up->kernels->find_surfaces(&patch->cell, &window, &patch->parts, i);
        found = true;
        up->kernels->choose_surface(result, sure, &patch->cell, &window,
                                    placement_of(patch, cell, x, n), colour, rows * n);
        put_rows(patch, result, sure, x, (size_t)n);
    }
}

/* Clamps RUN pixels, of which n are in the cell. */
static inline void clamp_run(uint16_t *out, int n, uint16_t low, uint16_t high)
{
    uint16_t v[RUN];

    memcpy(v, out, sizeof v);
    for (int i = 0; i < RUN; i++) {
        v[i] = v[i] < low ? low : v[i];
        v[i] = v[i] > high ? high : v[i];
    }
    put(out, v, (size_t)n, sizeof *v);
}

/* Taps in the corners are in the means, but nothing beyond the others is to come of
 * that. */
static void clamp_cell(const struct patch *patch, int cell, const uint16_t *const row[RF_TAPS],
                       int at)
{
    const struct rf_upsampler *up = patch->up;
    const int x1 = up->span[cell + 1].begin;
    uint16_t low = row[1][at], high = low;

    for (int j = 0; j < RF_TAPS; j++) {
        const bool outer = j == 0 || j == RF_TAPS - 1;

        for (int i = outer; i < RF_TAPS - outer; i++) {
            const uint16_t d = row[j][at + i];

            low = d < low ? d : low;
            high = d > high ? d : high;
        }
    }
    for (int y = patch->y0; y < patch->y1; y++) {
        uint16_t *out = up->out.at + y * up->out.stride;
        int x = up->span[cell].begin;

        for (; x < x1 && x + RUN <= up->photo->width; x += RUN)
            clamp_run(out + x, x1 - x < RUN ? x1 - x : RUN, low, high);
        for (; x < x1; x++)
            out[x] = out[x] < low ? low : out[x] > high ? high : out[x];
    }
}

/* Classifies the pixels of the rough cells among the n from the first-th on. */
static void fill_cells(struct patch *patch, int first, int n)
{
    const struct rf_upsampler *up = patch->up;
    const uint16_t *row[RF_TAPS];
    const uint8_t *trust[RF_TAPS] = {NULL};
    uint8_t rough[RF_CELLS];

    for (int j = 0; j < RF_TAPS; j++) {
        row[j] = up->coarse.at + (patch->row + j) * up->coarse.stride + first - PAD;
        if (up->confidence)
            trust[j] = up->trust.at + (patch->row + j) * up->trust.stride + first - PAD;
    }
    const unsigned any = up->kernels->rough_cells(rough, row, trust, STEP, n);

    if (any & RF_ROUGH_CORNER)
        for (int i = 0; i < n; i++)
            if (rough[i] == RF_ROUGH_CORNER)
                clamp_cell(patch, first + i, row, i);
    if (!(any & RF_ROUGH))
        return;
    up->kernels->part_taps(&patch->parts, row, n);
    look_around(patch, first);
    for (int i = 0; i < n; i++)
        if (rough[i] == RF_ROUGH && up->span[first + i].begin < up->span[first + i + 1].begin)
            fill_cell(patch, first + i, i);
}

/* Lists the blocks of a row that have pixels that are not sure. */
static void list_unsure(const struct rf_upsampler *up, int y)
{
    const int width = up->photo->width, blocks = rf_upsample_blocks(width);
    const uint8_t *sure = up->sure.at + (y - up->first_row) * up->sure.stride;
    uint16_t *unsure = up->unsure.at + (y - up->first_row) * up->unsure.stride;
    int n = 0;

    for (int i = 0; i < blocks; i++, sure += BLOCK) {
        uint64_t half[2];

        if (i == blocks - 1 && width % BLOCK) {
            memset(half, 255, sizeof half);
            memcpy(half, sure, (size_t)(width % BLOCK));
        } else {
            memcpy(half, sure, sizeof half);
        }
        unsure[n + 1] = (uint16_t)i; /* overwritten by the next one if it is not counted */
        n += (half[0] & half[1]) != UINT64_MAX;
    }
    unsure[0] = (uint16_t)n;
}

uint64_t rf_upsample_share(void)
{
    return sizeof(struct patch);
}

void rf_upsample_rows(const struct rf_upsampler *up, int first, int y0, int y1, int worker)
{
    const int width = up->photo->width, cells = up->columns + 1;
    const uint16_t *wide[RF_TAPS];
    struct patch *const patch = rf_share(&up->shares, worker);

    patch->up = up;
    patch->row = first;
    patch->bytes = refocus_format_bytes(up->photo->format);
    for (int i = 0; i < RF_TAPS; i++)
        wide[i] =
            up->wide.at + (rf_clamp(first + i, 0, up->rows - 1) - up->first_wide) * up->wide.stride;
    for (int y = y0; y < y1 && !rf_run_cancelled(up->run); y++) {
        up->kernels->blend4(up->out.at + y * up->out.stride, wide, up->down[y].share, width);
        memset(up->sure.at + (y - up->first_row) * up->sure.stride, 255, (size_t)width);
    }
    for (patch->y0 = y0; patch->y0 < y1; patch->y0 = patch->y1) {
        patch->y1 = patch->y0 + RUN < y1 ? patch->y0 + RUN : y1;
        patch->from = patch->ready = 0;
        for (int i = 0; i < KINDS; i++)
            patch->placements.alike[i] = -1;
        for (int i = 0; i < cells && !rf_run_cancelled(up->run); i += RF_CELLS)
            fill_cells(patch, i, cells - i < RF_CELLS ? cells - i : RF_CELLS);
    }
    for (int y = y0; y < y1; y++)
        list_unsure(up, y);
}

static bool lie_alike(const struct rf_upsampler *up, int a, int b)
{
    const int from = up->span[a].begin, n = up->span[a + 1].begin - from;

    if (up->span[b + 1].begin - up->span[b].begin != n)
        return false;
    for (int i = 0; i < n; i++)
        if (up->across[from + i].middle != up->across[up->span[b].begin + i].middle)
            return false;
    return true;
}

void rf_find_spans(struct rf_upsampler *up)
{
    int x = 0;

    for (int i = 0; i < up->columns + 2; i++) {
        while (x < up->photo->width && up->across[x].first < i - PAD)
            x++;
        up->span[i].begin = x;
    }
    for (int i = 0; i <= up->columns; i++) {
        up->span[i].alike = i;
        for (int k = i - 1; k >= 0 && k >= i - KINDS; k--) {
            if (lie_alike(up, k, i)) {
                up->span[i].alike = up->span[k].alike;
                break;
            }
        }
    }
}
