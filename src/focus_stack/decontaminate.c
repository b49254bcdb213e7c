/* decontaminate.c: the light of blurred foreground is taken out of the background beside it.
 *
 * Where background is in focus, what is nearer is not, and its blur lies over the background: a
 * pixel is
 *
 *     I = F + (1 - A) B
 *
 * in linear light, F and A the sums of the light and the coverage of the nearer pixels around it,
 * each spread over its circle of confusion. The photo in focus everywhere has their colours, so
 * B = (I - F) / (1 - A) is the background alone. Foreground that hides most of a pixel leaves too
 * little of it: there B is not taken. Clipped foreground has more light than the photo knows: such
 * a pixel is taken from the frame that is focused on the foreground, the less the less is clipped.
 *
 * The blur radius is not known. Away from depth edges a frame is the photo blurred by
 *
 *     r = K |d - df|
 *
 * with d and df of the whole range, 0 to 1; of some K, and those between, the one is taken by which
 * all frames are best predicted. If none explains them, nothing is changed.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <refocus/render.h>

#include "colour/transfer.h"

enum {
    PART = 40,            /* the largest K is this part of the longer side */
    RADII = 10,           /* the number of K that are tried, each the last by the root of 2 */
    ACROSS = 48,          /* places along the longer side where they are */
    TAPS = 10,            /* pixels of the aperture along a radius of K, at the most */
    LEAST = 2 << 8,       /* radii below this are no foreground's, Q8 pixels */
    ONE = 1 << 16,        /* all of a pixel */
    MOST = 3 << 14,       /* coverage beyond which too little of the background is left */
    FEW = 1 << 8,         /* coverage below which there is nothing to take out */
    HIGHLIGHT = ONE / 60, /* clipped coverage from which on none of it is taken out */
    KEPT = 4,             /* a channel keeps 1 / KEPT of its light */
    TILE = 8,             /* samples of a side */
    SIZE = 2 * TAPS + 1,
};

/* A disc of taps: `apart` pixels lie between neighbours, and `taps` on either side of the middle.
 */
struct disc {
    int apart, taps;
    uint8_t distance[SIZE][SIZE];         /* Q4 taps from the middle */
    uint32_t weight[16 * (TAPS + 1) + 1]; /* a tap's, by the radius in Q4 taps; all make ONE */
};

static void make_disc(struct disc *disc, double radius)
{
    const int whole = (int)ceil(radius);

    disc->apart = (whole + TAPS - 1) / TAPS;
    disc->apart = disc->apart > 1 ? disc->apart : 1;
    disc->taps = (whole + disc->apart - 1) / disc->apart;
    for (int j = 0; j < SIZE; j++)
        for (int i = 0; i < SIZE; i++) {
            const int x = i - TAPS, y = j - TAPS;

            disc->distance[j][i] = (uint8_t)(16 * sqrt((double)(x * x + y * y)) + 0.5);
        }
    for (int r = 0; r < 16 * (TAPS + 1) + 1; r++) {
        uint32_t sum = 0;

        for (int j = 0; j < SIZE; j++)
            for (int i = 0; i < SIZE; i++)
                sum += (uint32_t)rf_stack_clamp(r + 8 - disc->distance[j][i], 16);
        disc->weight[r] = ONE / (sum ? sum : 1);
    }
}

/* The share of a circle of confusion, radius in Q4 taps, that a tap takes. */
static uint32_t share_of(const struct disc *disc, int radius, int i, int j)
{
    const int distance = disc->distance[j + TAPS][i + TAPS];

    return (uint32_t)rf_stack_clamp(radius + 8 - distance, 16) * disc->weight[radius];
}

static const uint8_t *pixel(const struct rf_stack_photo *photo, const struct refocus_stack *s,
                            int x, int y)
{
    return photo->rgb + rf_stack_clamp(y, s->height - 1) * photo->stride +
           3 * (ptrdiff_t)rf_stack_clamp(x, s->width - 1);
}

static size_t sample_at(const struct refocus_stack *s, int x, int y)
{
    return (size_t)rf_stack_clamp(y / s->reduced, s->rows - 1) * (size_t)s->columns +
           (size_t)rf_stack_clamp(x / s->reduced, s->columns - 1);
}

/* ----- the blur radius ----- */

/* Whether the light of all pixels around a place is known. */
static bool is_known(const struct refocus_stack *s, const struct rf_stack_photo *photo, int x,
                     int y, int reach)
{
    for (int v = y - reach; v <= y + reach; v++)
        for (int u = x - reach; u <= x + reach; u++)
            if (pixel(photo, s, u, v)[1] >= RF_STACK_WHITE)
                return false;
    return true;
}

/* Whether a place is sure and on one surface as far as the largest blur reaches. */
static bool is_flat(const struct refocus_stack *s, int x, int y, int reach)
{
    const int here = s->moved[sample_at(s, x, y)];

    if (x < reach || y < reach || x + reach >= s->width || y + reach >= s->height ||
        s->sure[sample_at(s, x, y)] < RF_STACK_MEASURED)
        return false;
    for (int j = -4; j <= 4; j++)
        for (int i = -4; i <= 4; i++)
            if (abs(s->moved[sample_at(s, x + i * reach / 4, y + j * reach / 4)] - here) >
                65536 / 8)
                return false;
    return true;
}

/* Green light of the photo at a place, Q12, spread over a disc. */
static int blurred(const struct refocus_stack *s, const struct rf_stack_photo *photo,
                   const struct disc *disc, double radius, int x, int y)
{
    const int taps = (int)(radius * 16 / disc->apart + 0.5);
    const int reach = (taps + 8) / 16 < TAPS ? (taps + 8) / 16 : TAPS;
    uint64_t sum = 0;
    uint32_t all = 0;

    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++) {
            const uint32_t share = share_of(disc, taps, i, j);

            sum += share *
                   (uint64_t)s->transfer
                       ->to_light[pixel(photo, s, x + i * disc->apart, y + j * disc->apart)[1]];
            all += share;
        }
    return all ? (int)(sum / all) : s->transfer->to_light[pixel(photo, s, x, y)[1]];
}

/* The squared error by which frames are predicted at a place, with K in pixels. */
static uint64_t error_at(const struct refocus_stack *s, const struct rf_stack_photo *photo,
                         const struct disc *disc, double most, int x, int y)
{
    const int here = s->moved[sample_at(s, x, y)];
    uint64_t error = 0;

    for (int k = 0; k < s->count; k++) {
        const int away = abs(here - rf_stack_disparity(s, 256 * k));
        uint8_t seen[3];

        if (away >= 65536 / 8 && rf_stack_pixel(s, k, x, y, seen)) {
            const int64_t e =
                blurred(s, photo, disc, most * away / 65535, x, y) - s->transfer->to_light[seen[1]];

            error += (uint64_t)(e * e);
        }
    }
    return error;
}

static uint64_t error_of(const struct refocus_stack *s, const struct rf_stack_photo *photo,
                         const struct disc *disc, double most, int reach)
{
    const int longer = s->width > s->height ? s->width : s->height;
    const int step = (longer + ACROSS - 1) / ACROSS;
    uint64_t error = 0;

    for (int y = step / 2; y < s->height; y += step)
        for (int x = step / 2; x < s->width; x += step)
            if (is_flat(s, x, y, reach) && is_known(s, photo, x, y, reach))
                error += error_at(s, photo, disc, most, x, y);
    return error;
}

struct radii {
    const struct refocus_stack *stack;
    const struct rf_stack_photo *photo;
    int reach;
    uint64_t error[RADII + 1]; /* the last one without blur */
};

static double radius_of(const struct radii *radii, int i)
{
    return i < RADII ? ldexp(i & 1 ? sqrt(0.5) * radii->reach : radii->reach, -(i / 2)) : 0;
}

/* A radius between those that were tried: the least of the parabola through the errors of the best
 * one and its neighbours, over the logarithm of the radius. */
static double refined(const struct radii *radii, int best)
{
    const double radius = radius_of(radii, best);
    double before, after, bend, u;

    if (best == 0 || best + 1 >= RADII)
        return radius;
    before = (double)radii->error[best - 1];
    after = (double)radii->error[best + 1];
    bend = before - 2 * (double)radii->error[best] + after;
    u = bend > 0 ? (after - before) / (4 * bend) : 0;
    /* 2^u, u from -1/4 to 1/4, within 1/5000: that of libm is not the same everywhere. */
    return radius * (1 + u * (0.693147 + u * (0.240227 + u * 0.055504)));
}

static void try_radius(void *context, int i, int worker)
{
    struct radii *const radii = context;
    const double radius = radius_of(radii, i);
    struct disc disc;

    (void)worker;
    make_disc(&disc, radius > 0 ? radius : 1);
    radii->error[i] = error_of(radii->stack, radii->photo, &disc, radius, radii->reach);
}

/* K in pixels; 0 if no blur explains the frames. */
static double find_radius(const struct refocus_stack *s, const struct rf_stack_photo *photo)
{
    const int longer = s->width > s->height ? s->width : s->height;
    struct radii radii = {.stack = s, .photo = photo, .reach = longer / PART};
    int best = 0;

    rf_pool_run(s->pool, try_radius, &radii, RADII + 1);
    for (int i = 1; i < RADII; i++)
        best = radii.error[i] < radii.error[best] ? i : best;

    /* Three quarters of the error that no blur leaves, at the most. */
    return 4 * (radii.error[best] / 3) < radii.error[RADII] ? refined(&radii, best) : 0;
}

/* ----- the background ----- */

/* The largest disparity of each tile of samples and of those that blur reaches from. */
static uint16_t *nearest_of_tiles(const struct refocus_stack *s, int reach)
{
    const int across = (s->columns + TILE - 1) / TILE, down = (s->rows + TILE - 1) / TILE;
    const int beyond = reach / (s->reduced * TILE) + 1;
    uint16_t *tile = (uint16_t *)s->sum, *nearest = tile + (ptrdiff_t)across * down;

    memset(tile, 0, (size_t)across * (size_t)down * sizeof *tile);
    for (int y = 0; y < s->rows; y++)
        for (int x = 0; x < s->columns; x++) {
            uint16_t *most = tile + (ptrdiff_t)(y / TILE) * across + x / TILE;
            const uint16_t here = s->moved[(size_t)y * (size_t)s->columns + (size_t)x];

            *most = here > *most ? here : *most;
        }
    for (int y = 0; y < down; y++)
        for (int x = 0; x < across; x++) {
            uint16_t most = 0;

            for (int v = y - beyond; v <= y + beyond; v++)
                for (int u = x - beyond; u <= x + beyond; u++)
                    if (u >= 0 && v >= 0 && u < across && v < down &&
                        tile[(ptrdiff_t)v * across + u] > most)
                        most = tile[(ptrdiff_t)v * across + u];
            nearest[(ptrdiff_t)y * across + x] = most;
        }
    return nearest;
}

struct spill {         /* light of what is nearer, over a pixel */
    uint32_t coverage; /* parts of ONE */
    uint64_t light[3]; /* Q12 of ONE */
    int clipped;       /* the largest disparity of what is clipped; 0: nothing */
    uint32_t bright;   /* the coverage of that: single pixels of grain are no highlight */
};

struct lifting {
    const struct refocus_stack *stack;
    const struct rf_stack_photo *photo; /* written */
    struct rf_stack_photo before;       /* pixels as they were */
    const uint16_t *nearest;            /* disparity, of tiles */
    struct disc disc;
    struct rf_stack_clipped clipped;
    int most; /* K, Q8 pixels */
};

/* The radius, in Q4 taps, of what is nearer by so much. */
static int taps_of(const struct lifting *l, int nearer)
{
    return (int)((int64_t)l->most * nearer >> 20) / l->disc.apart;
}

/* The radius of what is clipped: K is known to a quarter, and no disc of that is to remain. */
static int clipped_taps_of(const struct lifting *l, int nearer)
{
    return taps_of(l, nearer) * 5 / 4;
}

static void add_clipped(const struct lifting *l, int disparity, uint32_t part, int focus, int i,
                        int j, struct spill *spill)
{
    const uint32_t wide = share_of(&l->disc, clipped_taps_of(l, disparity - focus), i, j);

    spill->bright += (uint32_t)((uint64_t)wide * part / RF_STACK_CLIPPED);
    if (wide && disparity > spill->clipped)
        spill->clipped = disparity;
}

/* Adds up what lies over a pixel that is seen at a focus, of surfaces that are nearer by so much at
 * the most: taps that the widest circle of confusion of these does not reach have no share. */
static void spill_of(const struct lifting *l, int focus, int nearer, int x, int y,
                     struct spill *spill)
{
    const struct refocus_stack *s = l->stack;
    const struct disc *disc = &l->disc;
    const struct rf_stack_photo *photo = &l->before;
    /* Exact for columns below 2^16, as no sample is as wide as 2^8 pixels. */
    const uint64_t by = (1 << 24) / (uint32_t)s->reduced + 1;
    const int least = focus + (int)(((int64_t)LEAST << 16) / l->most);
    /* A disc has a share half a tap beyond its radius, 8 in Q4. */
    const int widest = (clipped_taps_of(l, nearer) + 8 + 15) / 16;
    const int taps = widest < disc->taps ? widest : disc->taps;

    memset(spill, 0, sizeof *spill);
    for (int j = -taps; j <= taps; j++) {
        const int v = rf_stack_clamp(y + j * disc->apart, s->height - 1);
        const size_t row = sample_at(s, 0, v);
        const uint8_t *rgb = photo->rgb + v * photo->stride;

        for (int i = -taps; i <= taps; i++) {
            const int u = rf_stack_clamp(x + i * disc->apart, s->width - 1);
            const size_t at = row + ((uint64_t)u * by >> 24);
            const int here = s->moved[at];

            if (l->clipped.disparity[at] > least)
                add_clipped(l, l->clipped.disparity[at], l->clipped.share[at], focus, i, j, spill);
            if (here <= least)
                continue;

            const uint8_t *p = rgb + 3 * (ptrdiff_t)u;
            const uint32_t share = share_of(disc, taps_of(l, here - focus), i, j);

            spill->coverage += share;
            for (int c = 0; c < 3; c++)
                spill->light[c] += share * (uint64_t)s->transfer->to_light[p[c]];
        }
    }
}

/* Takes so much of a spill away, Q8, that each channel keeps at least 1 / KEPT of its light: more
 * would be more than there is, as far as depth and radius are known. With t of it taken away
 *
 *     (I - t F) / (1 - t A) >= I / KEPT
 */
static int share_to_take(const struct spill *spill, const int light[3])
{
    int64_t share = 256;

    for (int c = 0; c < 3; c++) {
        const int64_t here = (int64_t)light[c] * ONE;
        const int64_t over = KEPT * (int64_t)spill->light[c] - (int64_t)spill->coverage * light[c];

        if (over * share > here * (KEPT - 1) * 256)
            share = here * (KEPT - 1) * 256 / over;
    }
    return (int)share;
}

static void lift(const struct refocus_stack *s, const struct spill *spill, uint8_t *p)
{
    int light[3];
    int64_t share;

    if (spill->coverage < FEW || spill->coverage > MOST)
        return;
    for (int c = 0; c < 3; c++)
        light[c] = s->transfer->to_light[p[c]];
    share = share_to_take(spill, light);
    for (int c = 0; c < 3; c++) {
        const int64_t left = light[c] * (int64_t)ONE - (share * (int64_t)spill->light[c] >> 8);
        const int64_t out = left / (ONE - (share * (int64_t)spill->coverage >> 8));

        p[c] = s->transfer->to_code[4 * rf_stack_clamp((int)out, RF_LIGHT_MAX)];
    }
}

/* The pixel as the frame shows it that is focused nearest to a disparity. */
static void look_past(const struct refocus_stack *s, int disparity, int x, int y, uint8_t *p)
{
    int best = 0;

    for (int k = 1; k < s->count; k++)
        if (abs(rf_stack_disparity(s, 256 * k) - disparity) <
            abs(rf_stack_disparity(s, 256 * best) - disparity))
            best = k;
    rf_stack_pixel(s, best, x, y, p);
}

/* Takes out of a pixel what lies over it: the more of that is clipped, the more it becomes what the
 * other frame shows. */
static void clean(const struct lifting *l, int focus, int nearer, int x, int y, uint8_t *p)
{
    uint8_t past[3] = {p[0], p[1], p[2]};
    struct spill spill;
    int share;

    spill_of(l, focus, nearer, x, y, &spill);
    share = rf_stack_clamp(256 * (int)spill.bright / HIGHLIGHT, 256);
    if (share > 0)
        look_past(l->stack, spill.clipped, x, y, past);
    if (share < 256)
        lift(l->stack, &spill, p);
    for (int c = 0; c < 3; c++)
        p[c] = (uint8_t)((p[c] * (256 - share) + past[c] * share + 128) >> 8);
}

static void lift_row(void *context, int y, int worker)
{
    const struct lifting *l = context;
    const struct refocus_stack *s = l->stack;
    const int across = (s->columns + TILE - 1) / TILE;
    uint16_t *const depth = s->depth_row + (ptrdiff_t)worker * s->width;
    uint8_t *const sure = s->sure_row + (ptrdiff_t)worker * s->width;
    uint8_t *row = l->photo->rgb + y * l->photo->stride;

    rf_stack_depth_row(s, depth, sure, y);
    for (int x = 0; x < s->width; x++) {
        const int focus = rf_stack_disparity(s, rf_stack_focus(s, depth[x]));
        const size_t at = sample_at(s, x, y);
        const int tile =
            (int)(at / (size_t)s->columns) / TILE * across + (int)(at % (size_t)s->columns) / TILE;

        const int nearer = l->nearest[tile] - focus;

        if ((int64_t)l->most * nearer >> 16 >= LEAST)
            clean(l, focus, nearer, x, y, row + 3 * (ptrdiff_t)x);
    }
}

void rf_stack_decontaminate(struct refocus_stack *s, const struct rf_stack_photo *photo)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows, line = 3 * (size_t)s->width;
    struct lifting lifting = {.stack = s, .photo = photo, .before = {s->before, (ptrdiff_t)line}};

    for (size_t i = 0; i < samples; i++)
        s->moved[i] = rf_stack_disparity(s, s->depth[i] / s->sub);
    rf_transfer_init(s->transfer, REFOCUS_BLEND_LINEAR);
    s->radius = find_radius(s, photo);
    if (s->radius * 256 < LEAST) {
        s->radius = 0;
        return;
    }
    for (int y = 0; y < s->height; y++)
        memcpy(s->before + (size_t)y * line, photo->rgb + y * photo->stride, line);
    lifting.most = (int)(s->radius * 256);
    make_disc(&lifting.disc, s->radius * 5 / 4);
    lifting.clipped = rf_stack_find_clipped(s, &lifting.before, lifting.disc.apart);
    lifting.nearest = nearest_of_tiles(s, lifting.disc.taps * lifting.disc.apart);
    rf_pool_run(s->pool, lift_row, &lifting, s->height);
}
