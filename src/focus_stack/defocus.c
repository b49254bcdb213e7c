/* defocus.c: the blur radius of a focus stack, which nobody says.
 *
 * Away from depth edges a frame is the photo blurred by
 *
 *     r = K |d - df|
 *
 * with d and df of the whole range, 0 to 1; of some K, and those between, the one is taken by which
 * all frames are best predicted.
 */
#include "focus_stack/defocus.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "colour/transfer.h"

enum {
    PART = 40,   /* the largest K is this part of the longer side */
    RADII = 10,  /* the number of K that are tried, each the last by the root of 2 */
    ACROSS = 48, /* places along the longer side where they are */
};

void rf_defocus_make(struct rf_defocus *disc, double radius)
{
    const int whole = (int)ceil(radius);

    disc->apart = (whole + RF_DEFOCUS_TAPS - 1) / RF_DEFOCUS_TAPS;
    disc->apart = disc->apart > 1 ? disc->apart : 1;
    disc->taps = (whole + disc->apart - 1) / disc->apart;
    for (int j = 0; j < RF_DEFOCUS_SIZE; j++)
        for (int i = 0; i < RF_DEFOCUS_SIZE; i++) {
            const int x = i - RF_DEFOCUS_TAPS, y = j - RF_DEFOCUS_TAPS;

            disc->distance[j][i] = (uint8_t)(16 * sqrt((double)(x * x + y * y)) + 0.5);
        }
    for (int r = 0; r < 16 * (RF_DEFOCUS_TAPS + 1) + 1; r++) {
        uint32_t sum = 0;

        for (int j = 0; j < RF_DEFOCUS_SIZE; j++)
            for (int i = 0; i < RF_DEFOCUS_SIZE; i++)
                sum += (uint32_t)rf_stack_clamp(r + 8 - disc->distance[j][i], 16);
        disc->weight[r] = RF_DEFOCUS_ONE / (sum ? sum : 1);
    }
}

static const uint8_t *pixel(const struct rf_stack_photo *photo, const struct refocus_stack *s,
                            int x, int y)
{
    return photo->rgb + rf_stack_clamp(y, s->height - 1) * photo->stride +
           3 * (ptrdiff_t)rf_stack_clamp(x, s->width - 1);
}

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
    const int here = s->moved[rf_defocus_sample(s, x, y)];

    if (x < reach || y < reach || x + reach >= s->width || y + reach >= s->height ||
        s->sure[rf_defocus_sample(s, x, y)] < RF_STACK_MEASURED)
        return false;
    for (int j = -4; j <= 4; j++)
        for (int i = -4; i <= 4; i++)
            if (abs(s->moved[rf_defocus_sample(s, x + i * reach / 4, y + j * reach / 4)] - here) >
                65536 / 8)
                return false;
    return true;
}

/* Green light of the photo at a place, Q12, spread over a disc. */
static int blurred(const struct refocus_stack *s, const struct rf_stack_photo *photo,
                   const struct rf_defocus *disc, double radius, int x, int y)
{
    const int taps = (int)(radius * 16 / disc->apart + 0.5);
    const int reach = (taps + 8) / 16 < RF_DEFOCUS_TAPS ? (taps + 8) / 16 : RF_DEFOCUS_TAPS;
    uint64_t sum = 0;
    uint32_t all = 0;

    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++) {
            const uint32_t share = rf_defocus_share(disc, taps, i, j);

            sum += share *
                   (uint64_t)s->transfer
                       ->to_light[pixel(photo, s, x + i * disc->apart, y + j * disc->apart)[1]];
            all += share;
        }
    return all ? (int)(sum / all) : s->transfer->to_light[pixel(photo, s, x, y)[1]];
}

/* The squared error by which frames are predicted at a place, with K in pixels. */
static uint64_t error_at(const struct refocus_stack *s, const struct rf_stack_photo *photo,
                         const struct rf_defocus *disc, double most, int x, int y)
{
    const int here = s->moved[rf_defocus_sample(s, x, y)];
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
                         const struct rf_defocus *disc, double most, int reach)
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
    struct rf_defocus disc;

    (void)worker;
    rf_defocus_make(&disc, radius > 0 ? radius : 1);
    radii->error[i] = error_of(radii->stack, radii->photo, &disc, radius, radii->reach);
}

double rf_defocus_find_radius(const struct refocus_stack *s, const struct rf_stack_photo *photo)
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
