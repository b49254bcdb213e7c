/* find.c: which pixels are mixtures, and of what. */
#include "thin/thin.h"

#include <stdlib.h>
#include <string.h>

#include "renderer/bands.h"
#include "renderer/renderer.h"

enum {
    JUMP = 65535 / 32,     /* disparities this far apart are two surfaces */
    AROUND = 3,            /* what is thin has something far within 7 x 7 pixels */
    THIN = 2 * AROUND + 1, /* pixels across */
    WIDE = 2 * THIN,       /* not thin */
    FAR = 10,              /* how far what is behind is looked for, */
    CLEAN = 4,       /* and how near it must be not to be taken from the edge itself */
    BEFORE = 2,      /* how far N is looked for */
    FAINT = 12 * 12, /* squared distance of light that is none */
    SHINES = 4000,   /* lamps, which highlights are for, and what is clipped */
    LEAST = 12,      /* alpha that a far pixel must have */
};

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* Planes that are free before the passes: the greatest disparity of 3 x 3 pixels, and
 * the greatest and the least of 7 x 7. */
struct extremes {
    uint16_t *near_most, *most, *least;
};

static struct extremes extremes_of(const struct refocus_renderer *r)
{
    return (struct extremes){(uint16_t *)r->front.blur, r->smooth[0], r->smooth[1]};
}

static const uint16_t *disparity_row(const struct refocus_renderer *r, int y)
{
    return r->disparity + clamp(y, r->height - 1) * r->stride;
}

/* Greatest and least of rows y - by to y + by. */
static void rows_extremes(const struct refocus_renderer *r, uint16_t *restrict most,
                          uint16_t *restrict least, int y, int by)
{
    const int w = r->width;

    memcpy(most, disparity_row(r, y), (size_t)w * 2);
    memcpy(least, most, (size_t)w * 2);
    for (int j = -by; j <= by; j++) {
        const uint16_t *restrict row = disparity_row(r, y + j);

        for (int x = 0; x < w; x++) {
            most[x] = row[x] > most[x] ? row[x] : most[x];
            least[x] = row[x] < least[x] ? row[x] : least[x];
        }
    }
    for (int i = 1; i <= by; i++) { /* the sides are repeated */
        most[-i] = most[0];
        least[-i] = least[0];
        most[w - 1 + i] = most[w - 1];
        least[w - 1 + i] = least[w - 1];
    }
}

static void most_across(uint16_t *restrict out, const uint16_t *restrict row, int by,
                        int n)
{
    memcpy(out, row, (size_t)n * 2);
    for (int i = -by; i <= by; i++)
        for (int x = 0; x < n; x++)
            out[x] = row[x + i] > out[x] ? row[x + i] : out[x];
}

static void least_across(uint16_t *restrict out, const uint16_t *restrict row, int by,
                         int n)
{
    memcpy(out, row, (size_t)n * 2);
    for (int i = -by; i <= by; i++)
        for (int x = 0; x < n; x++)
            out[x] = row[x + i] < out[x] ? row[x + i] : out[x];
}

static void extremes_band(void *context, int band, int worker)
{
    const struct refocus_renderer *r = context;
    const struct extremes e = extremes_of(r);
    uint16_t *const most = rf_scratch(r, worker) + RF_SPREAD_MARGIN;
    uint16_t *const least = most + r->width + 2 * RF_SPREAD_MARGIN;

    for (int y = rf_band_start(band); y < rf_band_end(r, band); y++) {
        const ptrdiff_t at = y * r->stride;

        rows_extremes(r, most, least, y, 1);
        most_across(e.near_most + at, most, 1, r->width);
        rows_extremes(r, most, least, y, AROUND);
        most_across(e.most + at, most, AROUND, r->width);
        least_across(e.least + at, least, AROUND, r->width);
    }
}

/* A pixel that is looked at. */
struct look {
    const struct refocus_renderer *r;
    struct extremes e;
    int x, y, own;                      /* own disparity */
    bool near;                          /* the map has it near */
    int above;                          /* what is above this disparity is near */
    int width;                          /* of what is near, where it is least */
    int far;                            /* disparity of F */
    int light[3], behind[3], before[3]; /* C, F, N */
    int spread; /* mean squared distance of what F is the mean of */
};

static ptrdiff_t place(const struct look *l, int x, int y)
{
    return y * l->r->stride + x;
}

static bool inside(const struct look *l, int x, int y)
{
    return x >= 0 && y >= 0 && x < l->r->width && y < l->r->height;
}

static const int8_t way[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                 {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};

/* The first far pixel in some direction. */
struct met {
    int steps; /* 0: there is none */
    ptrdiff_t at;
};

/* Steps in a direction before the picture ends, `most` at the most. */
static int steps_to_side(const struct look *l, int i, int most)
{
    const int x = way[i][0] > 0 ? l->r->width - 1 - l->x : way[i][0] < 0 ? l->x : most;
    const int y = way[i][1] > 0 ? l->r->height - 1 - l->y : way[i][1] < 0 ? l->y : most;
    const int least = x < y ? x : y;

    return least < most ? least : most;
}

/* `clean`: that has nothing near beside it, so that all of it is far. */
static struct met meet(const struct look *l, int i, bool clean, int most)
{
    const ptrdiff_t step = way[i][1] * l->r->stride + way[i][0];
    const uint16_t *const disparity = l->r->disparity, *const near_most =
                                                           l->e.near_most;
    const int above = l->above;
    ptrdiff_t at = place(l, l->x, l->y);

    most = steps_to_side(l, i, most);
    for (int n = 1; n <= most; n++) {
        at += step;
        if (disparity[at] <= above && (!clean || near_most[at] <= disparity[at] + JUMP))
            return (struct met){n, at};
    }
    return (struct met){0, 0};
}

/* How wide what is near, and begins at most two steps from a far pixel, is in the
 * direction where it is least. */
static int width_beside(const struct look *l)
{
    const uint16_t *const disparity = l->r->disparity;
    int width = WIDE;

    for (int i = 0; i < 8; i++) {
        const ptrdiff_t step = way[i][1] * l->r->stride + way[i][0];
        const int most = steps_to_side(l, i, 2 + THIN);
        ptrdiff_t at = place(l, l->x, l->y) + step;
        int n = 1, first;

        if (most > 0 && disparity[at] <= l->above) {
            n++;
            at += step;
        }
        for (first = n; n <= most && disparity[at] > l->above; n++)
            at += step;
        if (n > first && n <= most && n - first < width)
            width = n - first;
    }
    return width;
}

static int own_width(const struct look *l)
{
    int width = WIDE;

    for (int i = 0; i < 8; i += 2) {
        const int a = meet(l, i, false, THIN).steps,
                  b = meet(l, i + 1, false, THIN).steps;

        if (a && b && a + b - 1 < width)
            width = a + b - 1;
    }
    return width;
}

/* What is met in all directions, and how much each counts: by the inverse square of its
 * distance. */
struct ring {
    struct met met[8];
    int weight[8], disparity[8];
};

static bool same_surface(const struct ring *ring, int i, int disparity)
{
    return ring->weight[i] && abs(ring->disparity[i] - disparity) <= 2 * JUMP;
}

/* The disparity whose surface counts most, the farther of two equals. */
static int main_surface(const struct ring *ring)
{
    int most = 0, best = -1;

    for (int i = 0; i < 8; i++) {
        int sum = 0;

        for (int k = 0; ring->weight[i] && k < 8; k++)
            sum += same_surface(ring, k, ring->disparity[i]) ? ring->weight[k] : 0;
        if (sum > most || (sum && sum == most && ring->disparity[i] < best)) {
            most = sum;
            best = ring->disparity[i];
        }
    }
    return best;
}

/* False: there is nothing far, or it is not near enough. */
static bool look_around(const struct look *l, bool clean, struct ring *ring)
{
    int nearest = FAR + 1;

    for (int i = 0; i < 8; i++) {
        const struct met met = meet(l, i, clean, FAR);
        const int square = met.steps * met.steps * (i < 4 ? 1 : 2);

        ring->met[i] = met;
        ring->weight[i] = square ? 1440 / square : 0;
        ring->disparity[i] = square ? l->r->disparity[met.at] : 0;
        if (square && met.steps < nearest)
            nearest = met.steps;
    }
    return nearest <= (clean ? CLEAN : FAR);
}

/* F from what is met; false: there is none. */
static bool set_far(struct look *l, bool clean)
{
    struct ring ring;
    int64_t sum[3] = {0, 0, 0}, squares = 0, weights = 0;
    int count = 0;

    if (!look_around(l, clean, &ring))
        return false;
    l->far = main_surface(&ring);
    for (int i = 0; i < 8; i++) {
        if (!same_surface(&ring, i, l->far))
            continue;
        for (int c = 0; c < 3; c++)
            sum[c] += ring.weight[i] * l->r->front.light[c][ring.met[i].at];
        weights += ring.weight[i];
        count++;
    }
    for (int c = 0; c < 3; c++)
        l->behind[c] = (int)((sum[c] + weights / 2) / weights);
    for (int i = 0; i < 8; i++) {
        for (int c = 0; same_surface(&ring, i, l->far) && c < 3; c++) {
            const int off = l->r->front.light[c][ring.met[i].at] - l->behind[c];

            squares += off * off;
        }
    }
    l->spread = (int)(squares / count);
    return true;
}

/* N, and the nearest disparity of it; 0: there is none. */
static int set_near(struct look *l)
{
    int64_t sum[3] = {0, 0, 0}, weights = 0;
    int most = 0;

    for (int y = l->y - BEFORE; y <= l->y + BEFORE; y++) {
        for (int x = l->x - BEFORE; x <= l->x + BEFORE; x++) {
            ptrdiff_t at;
            int light[3], weight = 0;

            if (!inside(l, x, y))
                continue;
            at = place(l, x, y);
            if (l->r->disparity[at] <= l->above)
                continue;
            most = l->r->disparity[at] > most ? l->r->disparity[at] : most;
            for (int c = 0; c < 3; c++) {
                light[c] = l->r->front.light[c][at];
                weight += (light[c] - l->behind[c]) * (light[c] - l->behind[c]) >> 6;
            }
            for (int c = 0; c < 3; c++)
                sum[c] += (int64_t)(weight + 1) * light[c];
            weights += weight + 1;
        }
    }
    for (int c = 0; weights && c < 3; c++)
        l->before[c] = (int)((sum[c] + weights / 2) / weights);
    return most;
}

/* alpha, Q8: the share of N - F, and no less than makes N black or white. */
static int share(const struct look *l)
{
    int64_t along = 0, square = 0;
    int alpha;

    for (int c = 0; c < 3; c++) {
        const int64_t whole = l->before[c] - l->behind[c];

        along += whole * (l->light[c] - l->behind[c]);
        square += whole * whole;
    }
    if (along <= 0 || square < FAINT * 16)
        return 0;
    alpha = along >= square ? 255 : (int)(255 * along / square);
    for (int c = 0; c < 3; c++) {
        const int off = l->light[c] - l->behind[c];
        const int room = off < 0 ? l->behind[c] : RF_LIGHT_MAX - l->behind[c];
        const int least = off ? (255 * abs(off) + room - 1) / (room ? room : 1) : 0;

        alpha = least > alpha ? least : alpha;
    }
    return alpha < 255 ? alpha : 255;
}

/* How far C is from F, squared. */
static int64_t contrast(const struct look *l)
{
    int64_t sum = 0;

    for (int c = 0; c < 3; c++)
        sum += (int64_t)(l->light[c] - l->behind[c]) * (l->light[c] - l->behind[c]);
    return sum;
}

static bool shines(const struct look *l)
{
    for (int c = 0; c < 3; c++)
        if (l->before[c] > SHINES || l->light[c] > SHINES)
            return true;
    return false;
}

/* Whether a pixel is of something thin, or beside it and a mixture. A hair of one pixel
 * has nothing clean beside it that is as like what it hides. */
static bool take_apart(struct look *l, struct rf_thin *thin)
{
    int near, alpha;
    bool differs;

    l->width = l->near ? own_width(l) : width_beside(l);
    if (l->width > THIN || ((l->width == 1 || !set_far(l, true)) && !set_far(l, false)))
        return false;
    for (int c = 0; c < 3; c++)
        l->light[c] = l->r->front.light[c][place(l, l->x, l->y)];
    near = set_near(l);
    if (!near || shines(l))
        return false;
    alpha = share(l);
    differs = contrast(l) >= 2 * (int64_t)l->spread + FAINT;
    if (!l->near && (alpha < LEAST || !differs))
        return false;
    if (alpha == 0 || !differs)
        alpha = 255; /* it may be anything */
    *thin = (struct rf_thin){.alpha = (uint8_t)alpha,
                             .near_disparity = (uint16_t)(l->near ? l->own : near),
                             .far_disparity = (uint16_t)l->far};
    for (int c = 0; c < 3; c++)
        thin->light[c] = (uint16_t)l->behind[c];
    return true;
}

static bool look_at(const struct refocus_renderer *r, struct extremes e, int x, int y,
                    struct rf_thin *thin)
{
    const ptrdiff_t at = y * r->stride + x;
    const int own = r->disparity[at];
    struct look l = {.r = r, .e = e, .x = x, .y = y, .own = own};

    l.near = e.near_most[at] - own <= JUMP;
    l.above = l.near ? own - JUMP : own + JUMP;
    return (!l.near || own - e.least[at] > JUMP) && take_apart(&l, thin);
}

static void find_band(void *context, int band, int worker)
{
    struct refocus_renderer *r = context;
    struct rf_thin_list *list = &r->photo[r->used].thin;
    const struct extremes e = extremes_of(r);
    const uint64_t capacity = rf_thin_capacity(r->width);
    struct rf_thin *thin = list->pixel + (uint64_t)band * capacity;
    uint32_t count = 0;

    (void)worker;
    for (int tx = 0; tx < r->tiles_x; tx++) {
        struct rf_thin_run *run = &list->run[(size_t)band * r->tiles_x + tx];
        const int x0 = tx * RF_TILE, y0 = band * RF_TILE;

        run->first = count;
        for (int i = 0; i < RF_TILE * RF_TILE && count < capacity; i++) {
            const int x = x0 + i % RF_TILE, y = y0 + i / RF_TILE;
            const ptrdiff_t at = y * r->stride + x;

            if (x >= r->width || y >= r->height || e.most[at] - e.least[at] <= JUMP ||
                !look_at(r, e, x, y, &thin[count]))
                continue;
            thin[count++].at = (uint8_t)i;
        }
        run->count = count - run->first;
    }
}

void rf_find_thin(struct refocus_renderer *r)
{
    struct rf_thin_list *list = &r->photo[r->used].thin;

    list->blend = RF_NO_BLEND;
    rf_pool_run(&r->pool, extremes_band, r, rf_bands(r));
    rf_pool_run(&r->pool, find_band, r, rf_bands(r));
    if (!rf_cancelled(r))
        list->blend = r->blend;
}
