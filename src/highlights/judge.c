/* judge.c: whether what is clipped is a lamp, and what it lost (highlights.h). */
#include "highlights/lamps.h"

#include <stdlib.h>
#include <string.h>

enum {
    AROUND = 12, /* surroundings: so many cells on each side, */
    GRID = 3,    /* every third of them */
    NEAR = 3,    /* the same of the rim of something large */
    OUTER = 3,   /* cells that a shape is grown by at most, */
    BESIDE = 2,  /* and its limbs */
    HALF_LIT = RF_LIGHT_MAX * 40 / 100,
    GAIN = 3, /* full gain of 4 adds three times white */
    SMALL = 5,
    LARGE = 6,  /* halves of its surroundings that a lamp has to exceed: small or of cells */
    ALIKE = 16, /* colours of a run differ by at most that part of the light, in each channel */
};

/* What the lamp may be, and what is around it. */
struct lit {
    int64_t own[3], around[3]; /* mean colours, */
    int64_t beyond[3];         /* that 2 or 3 cells away, which the light falls to, */
    int64_t base;              /* and the brightest channel there */
    int64_t rim[3];            /* what its rim has more than that, or its surroundings, added up */
    int pixels;
    int edge, half_lit; /* those of its edge, and half lit ones beside it */
    int fade[2]; /* pixels in its cells and beside them, on the way to its surroundings: the upper
                    part of it, from 0.4 on, and the lower one, from 0.1 */
};

/* Rec. 709, of light of 12 bits. */
static int luminance_of(int r, int g, int b)
{
    return (218 * r + 732 * g + 74 * b) / 1024;
}

static int luminance(const int64_t colour[3])
{
    return luminance_of((int)colour[0], (int)colour[1], (int)colour[2]);
}

/* The pixel in the middle of a cell, in one direction. */
static int middle_of(const struct rf_lamp_photo *p, int cell, int pixels)
{
    return rf_within(cell * p->cell + p->cell / 2, pixels - 1);
}

/* The colour in the middle of a cell of the photo. */
static void sample(const struct rf_lamp_photo *p, int x, int y, int colour[3])
{
    rf_colour_at(p, middle_of(p, x, p->width), middle_of(p, y, p->height), colour);
}

/* Add the clipped pixels of a cell up; returns how many. */
static int add_own(const struct rf_lamp_photo *p, int x, int y, int64_t own[3])
{
    const struct rf_rect in = rf_pixels_of(p, x, y);
    int count = 0;

    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++) {
            int colour[3];

            rf_colour_at(p, px, py, colour);
            if (rf_level_of(p, colour) <= RF_CLIPPED)
                continue;
            for (int c = 0; c < 3; c++)
                own[c] += colour[c];
            count++;
        }
    return count;
}

static bool has_cell(const struct rf_lamp_photo *p, int x, int y)
{
    return x >= 0 && y >= 0 && x < p->across && y < p->down;
}

static bool is_in(const struct rf_lamp_shape *shape, int x, int y)
{
    const int i = x - shape->x, j = y - shape->y;

    return i >= 0 && i < 64 && j >= 0 && j < shape->rows && (shape->row[j] >> i & 1);
}

/* Mean colours of a lamp's body, and of a sparse grid around the shape that it is of. False: there
 * is nothing around. */
static bool look_around(const struct rf_lamp_photo *p, const struct rf_lamp_shape *body,
                        const struct rf_lamp_shape *shape, struct lit *lit)
{
    uint64_t all = 0;
    int count = 0, x0, x1;

    for (int j = 0; j < shape->rows; j++) {
        all |= shape->row[j];
        for (uint64_t row = body->row[j]; row; row &= row - 1)
            lit->pixels += add_own(p, shape->x + __builtin_ctzll(row), shape->y + j, lit->own);
    }
    x0 = shape->x + __builtin_ctzll(all) - AROUND;
    x1 = shape->x + 63 - __builtin_clzll(all) + AROUND;
    for (int y = shape->y - AROUND; y < shape->y + shape->rows + AROUND; y += GRID)
        for (int x = x0; x <= x1; x += GRID) {
            int colour[3];

            if (!has_cell(p, x, y) || is_in(shape, x, y))
                continue;
            sample(p, x, y, colour);
            for (int c = 0; c < 3; c++)
                lit->around[c] += colour[c];
            count++;
        }
    for (int c = 0; c < 3 && count; c++) {
        lit->own[c] /= lit->pixels;
        lit->around[c] /= count;
    }
    return count > 0;
}

static bool is_edge(const struct rf_lamp_photo *p, int x, int y)
{
    return !(rf_is_clipped(p, x - 1, y) && rf_is_clipped(p, x + 1, y) &&
             rf_is_clipped(p, x, y - 1) && rf_is_clipped(p, x, y + 1));
}

static bool is_beside(const struct rf_lamp_photo *p, int x, int y)
{
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (rf_is_clipped(p, x + i, y + j))
                return true;
    return false;
}

/* What is not clipped, between that and white. */
static void add_fade(struct lit *lit, int most)
{
    const int64_t above = 10 * (most - lit->base) / (RF_LIGHT_MAX - lit->base + 1);

    lit->fade[0] += above >= 4;
    lit->fade[1] += above >= 1 && above < 4;
}

/* Its edge, and the pixels beside it, none of which is clipped: of those that have little of its
 * light, the colour is mostly not its own. */
static void look_at_pixel(const struct rf_lamp_photo *p, int x, int y, struct lit *lit)
{
    int colour[3], most;

    rf_colour_at(p, x, y, colour);
    most = rf_level_of(p, colour);
    if (most > RF_CLIPPED) {
        lit->edge += is_edge(p, x, y);
        return;
    }
    add_fade(lit, most);
    if (is_beside(p, x, y)) {
        lit->half_lit += most - lit->base >= 2 * (RF_LIGHT_MAX - lit->base) / 5;
        for (int c = 0; c < 3 && most > lit->base; c++)
            lit->rim[c] += (colour[c] - lit->beyond[c]) * (most - lit->base) / RF_LIGHT_MAX;
    }
}

/* The cells of a shape and so many around it, from OUTER rows before it on. */
struct grown {
    uint64_t row[RF_LAMP_SIDE + 2 * OUTER];
};

static struct grown grown_by(const struct rf_lamp_shape *shape, int by)
{
    struct grown grown = {{0}};

    for (int j = 0; j < shape->rows; j++) {
        uint64_t row = shape->row[j];

        for (int i = 0; i < by; i++)
            row |= row << 1 | row >> 1;
        for (int i = -by; i <= by; i++)
            grown.row[OUTER + j + i] |= row;
    }
    return grown;
}

/* Where a body meets a limb there is nothing to be told. */
static struct grown near_limbs(const struct rf_lamp_shape *body, const struct rf_lamp_shape *shape)
{
    struct rf_lamp_shape limbs = *shape;

    for (int j = 0; j < limbs.rows; j++)
        limbs.row[j] &= ~body->row[j];
    return grown_by(&limbs, BESIDE);
}

/* A lamp may light what is beside it: that is not its rim. */
static void look_beyond(const struct rf_lamp_photo *p, const struct rf_lamp_shape *body,
                        const struct grown *limbs, struct lit *lit)
{
    const struct grown rim = grown_by(body, 1), beyond = grown_by(body, OUTER);
    int count = 0;

    for (int j = 0; j < body->rows + 2 * OUTER; j++)
        for (uint64_t row = beyond.row[j] & ~rim.row[j] & ~limbs->row[j]; row; row &= row - 1) {
            const int x = body->x + __builtin_ctzll(row), y = body->y + j - OUTER;
            int colour[3];

            if (!has_cell(p, x, y))
                continue;
            sample(p, x, y, colour);
            if (rf_level_of(p, colour) > RF_CLIPPED) /* another lamp */
                continue;
            lit->base += rf_level_of(p, colour);
            for (int c = 0; c < 3; c++)
                lit->beyond[c] += colour[c];
            count++;
        }
    lit->base /= count ? count : 1;
    for (int c = 0; c < 3; c++)
        lit->beyond[c] /= count ? count : 1;
}

/* Clipped pixels that are near each other are of one shape: no other is in the cells around it. */
static void look_at_rim(const struct rf_lamp_photo *p, const struct rf_lamp_shape *body,
                        const struct grown *limbs, struct lit *lit)
{
    const struct grown rim = grown_by(body, 1);

    for (int j = 0; j < body->rows + 2 * OUTER; j++)
        for (uint64_t row = rim.row[j] & ~limbs->row[j]; row; row &= row - 1) {
            const int x = body->x + __builtin_ctzll(row), y = body->y + j - OUTER;
            struct rf_rect in;

            if (!has_cell(p, x, y))
                continue;
            in = rf_pixels_of(p, x, y);
            for (int py = in.y0; py < in.y1; py++)
                for (int px = in.x0; px < in.x1; px++)
                    look_at_pixel(p, px, py, lit);
        }
}

/* Of a core in its own glow the rim tells little, as the lamp's channel is clipped there too: if
 * that is so two cells away, mostly, it has the colour of what is there. */
static void look_at_glow(const struct rf_lamp_photo *p, const struct rf_lamp_shape *core,
                         struct lit *lit)
{
    const struct grown rim = grown_by(core, 1), glow = grown_by(core, 2);
    int64_t sum[3] = {0, 0, 0};
    int count = 0, clipped = 0;

    for (int j = 0; j < core->rows + 2 * OUTER; j++)
        for (uint64_t row = glow.row[j] & ~rim.row[j]; row; row &= row - 1) {
            int colour[3];

            sample(p, core->x + __builtin_ctzll(row), core->y + j - OUTER, colour);
            for (int c = 0; c < 3; c++)
                sum[c] += colour[c];
            clipped += colour[0] > RF_CLIPPED || colour[1] > RF_CLIPPED || colour[2] > RF_CLIPPED;
            count++;
        }
    if (4 * clipped >= 3 * count)
        memcpy(lit->rim, sum, sizeof lit->rim);
}

static int64_t most_of(const int64_t colour[3])
{
    const int64_t most = colour[0] > colour[1] ? colour[0] : colour[1];

    return colour[2] > most ? colour[2] : most;
}

/* Q12 light of full strength: the colour of the rim, white if it has none. */
static void added_of(const int64_t rim[3], int added[3])
{
    const int64_t most = most_of(rim);

    for (int c = 0; c < 3; c++)
        added[c] = GAIN * (int)(most < RF_LIGHT_MAX / 4 ? RF_LIGHT_MAX
                                : rim[c] < 0            ? 0
                                                        : rim[c] * RF_LIGHT_MAX / most);
}

/*
 * A pixel that is lit in part by a lamp of L times white still clips down to a share of 0.94 / L,
 * and is half lit only from there to 0.4 / L: the brighter, the fewer of the pixels beside the edge
 * are half lit. At L = 1 it is 0.54 of those that are lit in part, of which there are somewhat more
 * than the edge has: never less than 0.6 of the edge. White paint and the shine of rounded things
 * fade out over many.
 *
 * Large photos are softer, pixel by pixel. An edge blurred by a Gaussian of s pixels goes from 0.94
 * to 0.4 over 1.8 s at L = 1, over 0.77 s at 2 and over 0.56 s at 4, and from 0.4 to 0.1 over
 * 1.0 s, 0.8 s and 0.7 s: however soft, the upper part is the longer one only of what is white.
 * What fades out over a cell and more is not soft, but shining; and between the strokes of a sign
 * there is no telling.
 */
static int steepness(const struct rf_lamp_photo *p, const struct lit *lit)
{
    const int64_t edge = 100 * lit->edge, upper = lit->fade[0], lower = lit->fade[1];
    const int64_t square = (int64_t)lit->edge * lit->edge; /* 10 times the pixels of a disc */
    const int sharp = rf_ramp(edge, 167 * lit->half_lit, 225 * lit->half_lit);
    int soft;

    if (4 * square < 10 * lit->pixels) /* limbs on most sides */
        return 0;
    if (p->cell == 1)
        return sharp;
    soft = rf_ramp(edge * p->cell, 100 * upper, 160 * upper) *
           rf_ramp(100 * lower, 71 * upper, 91 * upper) / 256 *
           rf_ramp(40 * lit->pixels - square, 0, 15 * lit->pixels) / 256;
    return sharp > soft ? sharp : soft;
}

void rf_end_list(struct rf_lamp_search *s)
{
    struct rf_highlight *run = &s->run;

    if (!run->count)
        return;
    for (int c = 0; c < 3; c++)
        run->added[c] = (uint16_t)((s->lost[c] + run->count / 2) / run->count);
    rf_list_highlight(&s->lists[run->y / RF_LAMP_ROWS], *run);
    run->count = 0;
}

/* What all pixels of a lamp have in common. */
struct lamp {
    int added[3]; /* light at full strength */
    int strength, size, pixels;
};

/* Whether two lights are of about one colour. */
static bool are_alike(const int a[3], const int b[3])
{
    const int of_a = a[0] + a[1] + a[2], of_b = b[0] + b[1] + b[2];

    for (int c = 0; c < 3; c++)
        if (ALIKE * llabs((long long)a[c] * of_b - (long long)b[c] * of_a) > (long long)of_a * of_b)
            return false;
    return true;
}

/* The next one of the run, of a lamp of the same colour. */
static bool goes_on(const struct rf_lamp_search *s, int x, int y, const int full[3])
{
    const struct rf_highlight *run = &s->run;

    return run->count && run->count < RF_LAMP_RUN && run->y == y && run->x + run->count == x &&
           are_alike(full, s->full);
}

static int second_of(const int colour[3])
{
    const struct rf_lamp_photo core = {.core = true};

    return rf_level_of(&core, colour);
}

/* A channel that is not clipped has lost nothing; and where one channel alone is clipped there is a
 * colour, red hair or a petal, and no light. */
static void list(struct rf_lamp_search *s, int x, int y, const struct lamp *lamp)
{
    int colour[3], full[3], lost[3];

    rf_colour_at(&s->photo, x, y, colour);
    if (second_of(colour) <= RF_CLIPPED)
        return;
    for (int c = 0; c < 3; c++) {
        full[c] = lamp->added[c] * lamp->strength / 256;
        lost[c] = full[c] * rf_ramp(colour[c], RF_CLIPPED, RF_LIGHT_MAX) / 256;
    }
    if (!(lost[0] | lost[1] | lost[2]))
        return;
    if (!goes_on(s, x, y, full)) {
        rf_end_list(s);
        s->run = (struct rf_highlight){
            .x = (uint16_t)x,
            .y = (uint16_t)y,
            .size = (uint8_t)(lamp->size < UINT8_MAX ? lamp->size : UINT8_MAX)};
        memset(s->lost, 0, sizeof s->lost);
        memcpy(s->full, full, sizeof s->full);
    }
    s->run.count++;
    for (int c = 0; c < 3; c++)
        s->lost[c] += lost[c];
}

/* What of a shape shines; clipped as in `photo`. */
struct shining {
    const struct rf_lamp_photo *photo;
    struct rf_lamp_shape shape;
    struct lamp lamp;
};

/* Its pixels in row y of the photo. */
static void list_row(struct rf_lamp_search *s, const struct shining *shining, int y)
{
    const struct rf_lamp_shape *shape = &shining->shape;
    const int cell = s->photo.cell;

    for (uint64_t row = shape->row[y / cell - shape->y]; row; row &= row - 1) {
        const int x = (shape->x + __builtin_ctzll(row)) * cell;

        for (int i = 0; i < cell; i++)
            if (rf_is_clipped(shining->photo, x + i, y))
                list(s, x + i, y, &shining->lamp);
    }
}

/* From `halves` / 2 times the surroundings on, all of it at 3/2 of that. */
static int ramp_above(int64_t own, int64_t around, int halves)
{
    return rf_ramp(4 * own, 2 * halves * around, 3 * halves * around);
}

/* By luminance, and by the channel that stands out most of its bright ones: what is blue among
 * blue is a petal. */
static int isolation(const struct lit *lit, int halves)
{
    const int all = ramp_above(luminance(lit->own), luminance(lit->around), halves);
    const int64_t bright = 7 * most_of(lit->own) / 8;
    int most = 0;

    for (int c = 0; c < 3; c++)
        if (lit->own[c] >= bright) {
            const int own = ramp_above(lit->own[c], lit->around[c], halves);

            most = own > most ? own : most;
        }
    return all < most ? all : most;
}

/* Of the body of a shape; strength 0: it is none. */
static struct lamp lamp_of(const struct rf_lamp_photo *p, const struct rf_lamp_shape *body,
                           const struct rf_lamp_shape *shape)
{
    const struct grown limbs = near_limbs(body, p->core ? body : shape); /* a glow is none */
    struct lit lit = {0};
    struct lamp lamp = {0};

    if (!look_around(p, body, shape, &lit))
        return lamp;
    lamp.strength = isolation(&lit, SMALL);
    if (!lamp.strength)
        return lamp;
    look_beyond(p, body, &limbs, &lit);
    look_at_rim(p, body, &limbs, &lit);
    lamp.strength = lamp.strength * steepness(p, &lit) / 256;
    if (!lamp.strength)
        return lamp;
    if (p->core)
        look_at_glow(p, body, &lit);
    added_of(lit.rim, lamp.added);
    lamp.pixels = lit.pixels;
    lamp.size = 3 * lit.pixels / lit.edge; /* 5/6 of a disc, 3/2 of a stroke */
    return lamp;
}

/* The one that makes more light. */
static void prefer(struct shining *best, const struct rf_lamp_photo *p,
                   const struct rf_lamp_shape *part, const struct rf_lamp_shape *shape)
{
    const struct lamp lamp = lamp_of(p, part, shape);

    if (lamp.strength * lamp.pixels > best->lamp.strength * best->lamp.pixels)
        *best = (struct shining){p, *part, lamp};
}

/* With its limbs and its glow it may be one lamp, or some together. */
void rf_list_shape(struct rf_lamp_search *s, const struct rf_lamp_shape *shape)
{
    const struct rf_lamp_photo *p = &s->photo;
    const int first = shape->y * p->cell, end = (shape->y + shape->rows) * p->cell;
    struct rf_lamp_photo cores = *p;
    struct rf_lamp_shape part;
    struct shining best = {.lamp = {.strength = 0}};

    cores.core = true;
    prefer(&best, p, shape, shape);
    if (best.lamp.strength < 256 && rf_lamp_body(&part, shape))
        prefer(&best, p, &part, shape);
    if (best.lamp.strength < 256 && rf_lamp_core(&part, &cores, shape))
        prefer(&best, &cores, &part, shape);
    for (int y = first > s->y0 ? first : s->y0; best.lamp.strength && y < end && y < s->y1; y++)
        list_row(s, &best, y);
}

/* Of the square around a cell, whether each is clipped, with a border of none. */
struct square {
    bool clipped[2 * NEAR + 3][2 * NEAR + 3];
    int colour[2 * NEAR + 1][2 * NEAR + 1][3];
};

static void take_square(const struct rf_lamp_photo *p, int x, int y, struct square *square)
{
    memset(square->clipped, 0, sizeof square->clipped);
    for (int j = 0; j <= 2 * NEAR; j++)
        for (int i = 0; i <= 2 * NEAR; i++) {
            int *colour = square->colour[j][i];

            sample(p, rf_within(x + i - NEAR, p->across - 1), rf_within(y + j - NEAR, p->down - 1),
                   colour);
            square->clipped[j + 1][i + 1] = rf_level_of(p, colour) > RF_CLIPPED;
        }
}

/* Whether one beside it is clipped, and it is not. */
static bool is_rim(const struct square *square, int i, int j)
{
    int count = 0;

    for (int k = 0; k < 9; k++)
        count += square->clipped[j + k / 3][i + k % 3];
    return count > 0 && !square->clipped[j + 1][i + 1];
}

/* The squares around a cell: how many of the near one's are clipped. */
static int look_near(const struct rf_lamp_photo *p, int x, int y, struct lit *lit)
{
    struct square square;
    int clipped = 0, beyond = 0;

    take_square(p, x, y, &square);
    for (int j = 0; j <= 2 * NEAR; j++)
        for (int i = 0; i <= 2 * NEAR; i++) {
            const int *colour = square.colour[j][i], most = rf_level_of(p, colour);

            clipped += most > RF_CLIPPED;
            lit->half_lit += most <= RF_CLIPPED && most >= HALF_LIT;
            if (most > RF_CLIPPED || is_rim(&square, i, j))
                continue;
            for (int c = 0; c < 3; c++)
                lit->beyond[c] += colour[c];
            beyond++;
        }
    for (int c = 0; c < 3; c++)
        lit->beyond[c] = beyond ? lit->beyond[c] / beyond : lit->around[c];
    for (int j = 0; j <= 2 * NEAR; j++)
        for (int i = 0; i <= 2 * NEAR; i++) {
            const int *colour = square.colour[j][i], most = rf_level_of(p, colour);

            for (int c = 0; c < 3 && is_rim(&square, i, j); c++)
                lit->rim[c] += (colour[c] - lit->beyond[c]) * most / RF_LIGHT_MAX;
        }
    return clipped;
}

static void list_pixels(struct rf_lamp_search *s, struct rf_rect in, const struct lamp *lamp)
{
    for (int y = in.y0 > s->y0 ? in.y0 : s->y0; y < in.y1 && y < s->y1; y++)
        for (int x = in.x0; x < in.x1; x++)
            if (rf_is_clipped(&s->photo, x, y))
                list(s, x, y, lamp);
}

/* Mean colour of a sparse grid around a cell, and in it. False: `own` does not stand out; where
 * much is white the rows beside it tell. */
static bool look_at_square(const struct rf_lamp_photo *p, int x, int y, struct lit *lit)
{
    enum { ACROSS = 2 * AROUND / GRID + 1, ALL = ACROSS * ACROSS };
    const int own = luminance(lit->own);
    int sum[3] = {0, 0, 0}, column[ACROSS];

    for (int i = 0; i < ACROSS; i++)
        column[i] = middle_of(p, rf_within(x + i * GRID - AROUND, p->across - 1), p->width);
    for (int k = 0; k < ACROSS; k++) {
        const int j = GRID * (k % 2 ? -(k + 1) / 2 : k / 2); /* from the middle on */
        const int row = middle_of(p, rf_within(y + j, p->down - 1), p->height);

        for (int i = 0; i < ACROSS; i++) {
            int colour[3];

            rf_colour_at(p, column[i], row, colour);
            for (int c = 0; c < 3; c++)
                sum[c] += colour[c];
        }
        /* as isolation() will find, so far; cells are many, and 32 bits enough */
        if (2 * own <= LARGE * luminance_of(sum[0] / ALL, sum[1] / ALL, sum[2] / ALL))
            return false;
    }
    for (int c = 0; c < 3; c++)
        lit->around[c] = sum[c] / ALL;
    return true;
}

void rf_list_cell(struct rf_lamp_search *s, int x, int y)
{
    const struct rf_lamp_photo *p = &s->photo;
    struct lit lit = {0};
    struct lamp lamp = {.size = 1};
    const int own = add_own(p, x, y, lit.own);
    int clipped;

    for (int c = 0; c < 3; c++)
        lit.own[c] /= own;
    if (!look_at_square(p, x, y, &lit))
        return;
    lamp.strength = isolation(&lit, LARGE);
    if (!lamp.strength)
        return;
    clipped = look_near(p, x, y, &lit);
    lamp.strength = lamp.strength * rf_ramp(clipped, 2 * lit.half_lit, 4 * lit.half_lit) / 256;
    if (!lamp.strength)
        return;
    added_of(lit.rim, lamp.added);
    list_pixels(s, rf_pixels_of(p, x, y), &lamp);
}
