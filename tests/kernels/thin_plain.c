/* thin_plain.c: find_thin, pixel by pixel: the contract of kernels/thin.h in plain words. */
#include "thin_plain.h"

#include <stdlib.h>

enum {
    JUMP = 65535 / 32,     /* disparities this far apart are two surfaces */
    AROUND = 3,            /* a thin pixel has something far within 7 x 7 pixels */
    THIN = 2 * AROUND + 1, /* pixels across */
    WIDE = 2 * THIN,       /* not thin */
    FAR = 10,              /* how far the hidden background is looked for */
    CLEAN = 4,             /* how near it must be not to be taken from the edge itself */
    BEFORE = 2,            /* how far N is looked for */
    FAINT = 12 * 12,       /* squared distance of light that is none */
    SHINES = 4000,         /* lights, which highlights are for, and what is clipped */
    LEAST = 12,            /* alpha that a far pixel must have */
    WHITE = 4095,
};

/* A pixel that is looked at. */
struct look {
    const struct photo *p;
    int x, y, own;                             /* own disparity */
    bool near;                                 /* the map has it near */
    int above;                                 /* a disparity above this one is near */
    int width;                                 /* width of what is near, where it is least */
    int far;                                   /* disparity of F */
    int light[3], far_light[3], near_light[3]; /* C, F, N */
    int spread;                                /* mean squared distance of what F is the mean of */
};

static ptrdiff_t place(const struct look *l, int x, int y)
{
    return y * l->p->stride + x;
}

static bool inside(const struct look *l, int x, int y)
{
    return x >= 0 && y >= 0 && x < l->p->width && y < l->p->height;
}

static const int8_t way[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                 {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};

/* The first far pixel in some direction. */
struct hit {
    int steps; /* 0: there is none */
    ptrdiff_t at;
};

/* Steps in a direction before the picture ends, `most` at the most. */
static int steps_to_side(const struct look *l, int i, int most)
{
    const int x = way[i][0] > 0 ? l->p->width - 1 - l->x : way[i][0] < 0 ? l->x : most;
    const int y = way[i][1] > 0 ? l->p->height - 1 - l->y : way[i][1] < 0 ? l->y : most;
    const int least = x < y ? x : y;

    return least < most ? least : most;
}

/* `clean`: that has nothing near beside it, so that all of it is far. */
static struct hit hit_in(const struct look *l, int i, bool clean, int most)
{
    const ptrdiff_t step = way[i][1] * l->p->stride + way[i][0];
    const uint16_t *const disparity = l->p->disparity, *const near_most = l->p->most3;
    const int above = l->above;
    ptrdiff_t at = place(l, l->x, l->y);

    most = steps_to_side(l, i, most);
    for (int n = 1; n <= most; n++) {
        at += step;
        if (disparity[at] <= above && (!clean || near_most[at] <= disparity[at] + JUMP))
            return (struct hit){n, at};
    }
    return (struct hit){0, 0};
}

/* How wide what is near, and begins at most two steps from a far pixel, is in the
 * direction where it is least. */
static int width_beside(const struct look *l)
{
    const uint16_t *const disparity = l->p->disparity;
    int width = WIDE;

    for (int i = 0; i < 8; i++) {
        const ptrdiff_t step = way[i][1] * l->p->stride + way[i][0];
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
        const int a = hit_in(l, i, false, THIN).steps, b = hit_in(l, i + 1, false, THIN).steps;

        if (a && b && a + b - 1 < width)
            width = a + b - 1;
    }
    return width;
}

/* The pixels that are hit in all directions, and how much each counts: by the inverse square of
 * its distance. */
struct ring {
    struct hit hit[8];
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
        const struct hit hit = hit_in(l, i, clean, FAR);
        const int square = hit.steps * hit.steps * (i < 4 ? 1 : 2);

        ring->hit[i] = hit;
        ring->weight[i] = square ? 1440 / square : 0;
        ring->disparity[i] = square ? l->p->disparity[hit.at] : 0;
        if (square && hit.steps < nearest)
            nearest = hit.steps;
    }
    return nearest <= (clean ? CLEAN : FAR);
}

/* Finds F from what is hit; false: there is none. */
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
            sum[c] += ring.weight[i] * l->p->light[c][ring.hit[i].at];
        weights += ring.weight[i];
        count++;
    }
    for (int c = 0; c < 3; c++)
        l->far_light[c] = (int)((sum[c] + weights / 2) / weights);
    for (int i = 0; i < 8; i++) {
        for (int c = 0; same_surface(&ring, i, l->far) && c < 3; c++) {
            const int off = l->p->light[c][ring.hit[i].at] - l->far_light[c];

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
            if (l->p->disparity[at] <= l->above)
                continue;
            most = l->p->disparity[at] > most ? l->p->disparity[at] : most;
            for (int c = 0; c < 3; c++) {
                light[c] = l->p->light[c][at];
                weight += (light[c] - l->far_light[c]) * (light[c] - l->far_light[c]) >> 6;
            }
            for (int c = 0; c < 3; c++)
                sum[c] += (int64_t)(weight + 1) * light[c];
            weights += weight + 1;
        }
    }
    for (int c = 0; weights && c < 3; c++)
        l->near_light[c] = (int)((sum[c] + weights / 2) / weights);
    return most;
}

/* How far C is from F, squared. */
static int64_t contrast(const struct look *l)
{
    int64_t sum = 0;

    for (int c = 0; c < 3; c++)
        sum += (int64_t)(l->light[c] - l->far_light[c]) * (l->light[c] - l->far_light[c]);
    return sum;
}

/* Whether C is off the line from F to N by more than 30 degrees, cos^2 < 3/4. */
static bool is_stray(int64_t along, int64_t square, int64_t contrast)
{
    const int64_t all = square * contrast;

    return along * along < all - all / 4;
}

/* alpha, Q8: the share of N - F, and no less than makes N black or white. */
static int share(const struct look *l)
{
    int64_t along = 0, square = 0;
    int alpha;

    for (int c = 0; c < 3; c++) {
        const int64_t whole = l->near_light[c] - l->far_light[c];

        along += whole * (l->light[c] - l->far_light[c]);
        square += whole * whole;
    }
    if (along <= 0 || square < FAINT * 16 ||
        is_stray(along / 1024, square / 1024, contrast(l) / 1024))
        return 0;
    alpha = along >= square ? 255 : (int)(255 * along / square);
    for (int c = 0; c < 3; c++) {
        const int off = l->light[c] - l->far_light[c];
        const int room = off < 0 ? l->far_light[c] : WHITE - l->far_light[c];
        const int least = off ? (255 * abs(off) + room - 1) / (room ? room : 1) : 0;

        alpha = least > alpha ? least : alpha;
    }
    return alpha < 255 ? alpha : 255;
}

static bool shines(const struct look *l)
{
    for (int c = 0; c < 3; c++)
        if (l->near_light[c] > SHINES || l->light[c] > SHINES)
            return true;
    return false;
}

/* Whether a pixel is of something thin, or beside something near and a mixture. A hair of one pixel
 * has nothing clean beside it that is as like what it hides. */
static bool take_apart(struct look *l, struct rf_thin *thin)
{
    int near, alpha;
    bool differs;

    l->width = l->near ? own_width(l) : width_beside(l);
    if ((l->near && l->width > THIN) ||
        ((l->width == 1 || !set_far(l, true)) && !set_far(l, false)))
        return false;
    for (int c = 0; c < 3; c++)
        l->light[c] = l->p->light[c][place(l, l->x, l->y)];
    near = set_near(l);
    if (!near || shines(l))
        return false;
    alpha = share(l);
    differs = contrast(l) >= (l->width > THIN ? 8 : 2) * (int64_t)l->spread + FAINT;
    if (!l->near && (alpha < LEAST || !differs))
        return false;
    if (alpha == 0 || !differs)
        alpha = 255; /* it may be anything */
    *thin = (struct rf_thin){.alpha = (uint8_t)alpha,
                             .near_disparity = (uint16_t)(l->near ? l->own : near),
                             .far_disparity = (uint16_t)l->far,
                             .thick = l->width > THIN};
    for (int c = 0; c < 3; c++)
        thin->light[c] = (uint16_t)l->far_light[c];
    return true;
}

int find_thin_plain(struct rf_thin *out, const struct photo *p, int tx, int ty)
{
    int count = 0;

    for (int i = 0; i < RF_TILE * RF_TILE; i++) {
        const int x = tx * RF_TILE + i % RF_TILE, y = ty * RF_TILE + i / RF_TILE;
        struct look l = {.p = p, .x = x, .y = y};
        int least = 65535, most = 0;

        if (x >= p->width || y >= p->height)
            continue;
        l.own = p->disparity[place(&l, x, y)];
        for (int k = 0; k < THIN * THIN; k++) {
            const int u = x + k % THIN - AROUND, v = y + k / THIN - AROUND;
            const int d = inside(&l, u, v) ? p->disparity[place(&l, u, v)] : l.own;

            least = d < least ? d : least;
            most = d > most && abs(u - x) < 2 && abs(v - y) < 2 ? d : most;
        }
        l.near = most - l.own <= JUMP;
        l.above = l.near ? l.own - JUMP : l.own + JUMP;
        if ((l.near && l.own - least <= JUMP) || !take_apart(&l, &out[count]))
            continue;
        out[count++].at = (uint8_t)i;
    }
    return count;
}
