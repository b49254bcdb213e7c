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
 */
#include "focus_stack/defocus.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "colour/transfer.h"

enum {
    LEAST = 2 << 8, /* radii below this are no foreground's, Q8 pixels */
    MOST = 3 << 14, /* coverage beyond which too little of the background is left */
    FEW = 1 << 8,   /* coverage below which there is nothing to take out */
    HIGHLIGHT = RF_DEFOCUS_ONE / 60, /* clipped coverage from which on none of it is taken out */
    KEPT = 4,                        /* a channel keeps 1 / KEPT of its light */
    TILE = 8,                        /* samples of a side */
};

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
    uint32_t coverage; /* parts of RF_DEFOCUS_ONE */
    uint64_t light[3]; /* Q12 of RF_DEFOCUS_ONE */
    int clipped;       /* the largest disparity of what is clipped; 0: nothing */
    uint32_t bright;   /* the coverage of that: single pixels of grain are no highlight */
};

struct lifting {
    const struct refocus_stack *stack;
    const struct rf_stack_photo *photo; /* written */
    struct rf_stack_photo before;       /* pixels as they were */
    const uint16_t *nearest;            /* disparity, of tiles */
    struct rf_defocus disc;
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
    const uint32_t wide = rf_defocus_share(&l->disc, clipped_taps_of(l, disparity - focus), i, j);

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
    const struct rf_defocus *disc = &l->disc;
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
        const size_t row = rf_defocus_sample(s, 0, v);
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
            const uint32_t share = rf_defocus_share(disc, taps_of(l, here - focus), i, j);

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
        const int64_t here = (int64_t)light[c] * RF_DEFOCUS_ONE;
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
        const int64_t left =
            light[c] * (int64_t)RF_DEFOCUS_ONE - (share * (int64_t)spill->light[c] >> 8);
        const int64_t out = left / (RF_DEFOCUS_ONE - (share * (int64_t)spill->coverage >> 8));

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
        const size_t at = rf_defocus_sample(s, x, y);
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
    s->radius = rf_defocus_find_radius(s, photo);
    if (s->radius * 256 < LEAST) {
        s->radius = 0;
        return;
    }
    for (int y = 0; y < s->height; y++)
        memcpy(s->before + (size_t)y * line, photo->rgb + y * photo->stride, line);
    lifting.most = (int)(s->radius * 256);
    rf_defocus_make(&lifting.disc, s->radius * 5 / 4);
    lifting.clipped = rf_stack_find_clipped(s, &lifting.before, lifting.disc.apart);
    lifting.nearest = nearest_of_tiles(s, lifting.disc.taps * lifting.disc.apart);
    rf_pool_run(s->pool, lift_row, &lifting, s->height);
}
