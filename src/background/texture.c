/* texture.c: predicts the light of hidden pixels from the texture around them. */
#include "background/texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "background/inpaint.h"
#include "image/border.h"
#include "kernels/kernels.h"
#include "kernels/pull_mix.h"
#include "support/compare.h"

enum {
    BLOCK = 32,                  /* pixels of a block that shares an autocovariance */
    MARGIN = 16,                 /* pixels around it that this is of, too */
    WINDOW = BLOCK + 2 * MARGIN, /* pixels of both */
    REACH = 5,                   /* pixels that a prediction looks away */
    AROUND = 80,                 /* pixels no farther than that */
    MOST = 36,                   /* known pixels that a prediction is from */
    LAG = 2 * REACH,             /* the farthest that two of them are apart */
    LAGS = 2 * LAG + 1,
    LANES = RF_SOLVE_LANES,
    LEAST_KNOWN = 100,  /* known pixels that tell a texture */
    LEAST_PAIRS = 40,   /* covariances of fewer pairs count less */
    LEAST_VARIANCE = 1, /* codes squared: less cannot be seen */
    BAND = 16,
};
static_assert(REACH <= MARGIN, "a prediction stays in the window");
static_assert(WINDOW * 255 * 255 <= INT32_MAX, "a row of products");

/* Noise, in parts of the variance: of any pixel, and of one beside unknown pixels. Chosen on two
 * scenes; twice or half of either changes 0.02 dB. */
static const float noise = 0.1f, edge_noise = 0.5f;

struct rf_texture_scratch {
    int16_t residual[3][WINDOW * WINDOW], luma[WINDOW * WINDOW]; /* codes; 0 where unknown */
    int16_t known[WINDOW * WINDOW];                              /* 1, or 0 */
    int16_t blur[WINDOW * WINDOW];                               /* RF_NO_BLUR where unknown */
    float covariance[LAGS][LAGS];                                /* in parts of the variance */
    float matrix[MOST * (MOST + 1) / 2][LANES], weight[MOST][LANES];
};

uint64_t rf_texture_scratch_bytes(void)
{
    return sizeof(struct rf_texture_scratch);
}

/* A level that is being pulled. */
struct step {
    const struct rf_executor *exec;
    const struct rf_viewport *view;
    const struct rf_texture *texture;
    const struct rf_level *fine, *coarse;
    int level, blocks_x;
    int16_t apart;            /* as of the pyramid */
    int8_t around[AROUND][2]; /* x and y, the nearest first */
};

/* The part of a level that a block looks at. */
struct window {
    struct rf_texture_scratch *scratch;
    int x0, y0, width, height;
};

/* An unknown pixel whose residual is predicted. */
struct site {
    int x, y, blur, fade; /* fade: 256 = all of the residual */
    int count;
    int at[MOST]; /* known pixels, in the window */
};

/* The light of a pixel by the next level, as the kernel pull computes it. */
static int pulled(const struct step *step, int c, int x, int y)
{
    const struct rf_level *coarse = step->coarse;
    const uint16_t *light = coarse->light.channel[c];
    const int near_x = x / 2, near_y = y / 2;
    const int far_x = rf_within(x % 2 ? near_x + 1 : near_x - 1, coarse->width - 1);
    const int far_y = rf_within(y % 2 ? near_y + 1 : near_y - 1, coarse->height - 1);
    const ptrdiff_t near = near_y * coarse->light.stride, far = far_y * coarse->light.stride;
    const int16_t *near_blur = coarse->blur.at + near_y * coarse->blur.stride;
    const int16_t *far_blur = coarse->blur.at + far_y * coarse->blur.stride;
    const struct rf_two_blurs beside = {near_blur[near_x], far_blur[near_x]};
    const struct rf_two_blurs beyond = {near_blur[far_x], far_blur[far_x]};
    const int16_t apart = step->apart;

    return rf_mix_light(
        rf_mix_light(light[near + near_x], light[far + near_x], beside, apart),
        rf_mix_light(light[near + far_x], light[far + far_x], beyond, apart),
        (struct rf_two_blurs){rf_mix_blur(beside, apart), rf_mix_blur(beyond, apart)}, apart);
}

static int code_of(const struct step *step, int light)
{
    return step->texture->transfer->to_code[4 * rf_within(light, RF_LIGHT_MAX)];
}

/* Light by a residual in codes. Of light above white (highlights/known.h), whose code is that of
 * white, it takes as much away as of white, and adds nothing. */
static int changed(const struct step *step, int light, int residual)
{
    const uint16_t *to_light = step->texture->transfer->to_light;
    const int code = code_of(step, light), other = rf_within(code + residual, 255);

    return rf_within(light + to_light[other] - to_light[code], rf_larger(light, RF_LIGHT_MAX));
}

/* Takes the residuals of the window in; returns how many pixels are known. */
static int take_residuals(const struct step *step, const struct window *w)
{
    const struct rf_level *fine = step->fine;
    struct rf_texture_scratch *s = w->scratch;
    int known = 0;

    memset(s->luma, 0, sizeof s->luma);
    memset(s->known, 0, sizeof s->known);
    for (int y = 0; y < w->height; y++) {
        const ptrdiff_t row = (w->y0 + y) * fine->light.stride + w->x0;
        const int16_t *blur = fine->blur.at + (w->y0 + y) * fine->blur.stride + w->x0;

        for (int x = 0; x < w->width; x++) {
            const int at = y * WINDOW + x;

            s->blur[at] = blur[x];
            if (blur[x] == RF_NO_BLUR)
                continue;
            for (int c = 0; c < 3; c++)
                s->residual[c][at] =
                    (int16_t)(code_of(step, fine->light.channel[c][row + x]) -
                              code_of(step, pulled(step, c, w->x0 + x, w->y0 + y)));
            s->luma[at] =
                (int16_t)((s->residual[0][at] + 2 * s->residual[1][at] + s->residual[2][at]) / 4);
            s->known[at] = 1;
            known++;
        }
    }
    return known;
}

/* The sum of products of pixels (across, down) apart, down >= 0. */
static int64_t products(const struct step *step, const int16_t *plane, int across, int down)
{
    const int16_t *first = plane + (across < 0 ? -across : 0);

    return step->exec->kernels->products(first, first + down * WINDOW + across, WINDOW,
                                         WINDOW - abs(across), WINDOW - down);
}

/* Sets the autocovariance of the window; false: there is no texture. */
static bool find_covariance(const struct step *step, struct rf_texture_scratch *s)
{
    double variance = 0;

    for (int down = 0; down <= LAG; down++) {
        for (int across = down ? -LAG : 0; across <= LAG; across++) {
            const int64_t pairs = products(step, s->known, across, down);
            const double mean = (double)products(step, s->luma, across, down) /
                                (double)(pairs > LEAST_PAIRS ? pairs : LEAST_PAIRS);

            if (across == 0 && down == 0)
                variance = mean;
            if (variance < LEAST_VARIANCE)
                return false;
            s->covariance[LAG + down][LAG + across] = s->covariance[LAG - down][LAG - across] =
                (float)(mean / variance);
        }
    }
    return true;
}

static float covariance_of(const struct rf_texture_scratch *s, int from, int to)
{
    const int across = to % WINDOW - from % WINDOW, down = to / WINDOW - from / WINDOW;

    return s->covariance[LAG + down][LAG + across];
}

/* Whether a pixel of the window lies beside an unknown one. */
static bool is_beside_unknown(const struct window *w, int at)
{
    const int x = at % WINDOW, y = at / WINDOW;

    for (int j = y > 0 ? y - 1 : y; j <= y + 1 && j < w->height; j++)
        for (int i = x > 0 ? x - 1 : x; i <= x + 1 && i < w->width; i++)
            if (!w->scratch->known[j * WINDOW + i])
                return true;
    return false;
}

/* The nearest known pixels of the same surface. */
static void find_known(const struct step *step, const struct window *w, struct site *site)
{
    const int x = site->x - w->x0, y = site->y - w->y0;

    site->count = 0;
    for (int k = 0; k < AROUND && site->count < MOST; k++) {
        const int i = x + step->around[k][0], j = y + step->around[k][1];
        const int at = j * WINDOW + i;

        if (i < 0 || j < 0 || i >= w->width || j >= w->height || !w->scratch->known[at] ||
            abs(w->scratch->blur[at] - site->blur) > step->texture->same)
            continue;
        site->at[site->count++] = at;
    }
}

/* Writes the equations of a site to a lane, n of them: those beyond its pixels have no effect. */
static void set_equations(const struct step *step, const struct window *w, const struct site *site,
                          int lane, int n)
{
    struct rf_texture_scratch *s = w->scratch;
    const int own = (site->y - w->y0) * WINDOW + site->x - w->x0;
    int k = 0;

    for (int i = 0; i < n; i++) {
        const bool there = i < site->count;

        for (int j = 0; j < i; j++, k++)
            s->matrix[k][lane] = there ? covariance_of(s, site->at[j], site->at[i]) : 0;
        s->matrix[k++][lane] =
            1 + noise +
            (there && step->level == 0 && is_beside_unknown(w, site->at[i]) ? edge_noise : 0);
        s->weight[i][lane] = there ? covariance_of(s, own, site->at[i]) : 0;
    }
}

/* The residual of a channel in whole codes, by the weights of a lane: no more than the known ones
 * that it is predicted from have. Covariances of few pairs need not be those of any texture: what
 * the equations then make of them may be anything, or not finite, where nothing is predicted. */
static int predicted(const struct rf_texture_scratch *s, const struct site *site, int c, int lane)
{
    int least = 0, most = 0;
    float sum = 0, whole;

    for (int k = 0; k < site->count; k++) {
        const int known = s->residual[c][site->at[k]];

        least = rf_smaller(least, known);
        most = rf_larger(most, known);
        sum += s->weight[k][lane] * (float)known;
    }
    whole = floorf(sum * (float)site->fade * (1.0f / 256) + 0.5f);
    return isnan(whole)           ? 0
           : whole < (float)least ? least
           : whole > (float)most  ? most
                                  : (int)whole;
}

/* Predicts the residuals of up to LANES sites and adds them to the light. */
static void predict(const struct step *step, const struct window *w, const struct site *site,
                    int sites)
{
    const struct rf_level *fine = step->fine;
    struct rf_texture_scratch *s = w->scratch;
    int n = 0;

    for (int i = 0; i < sites; i++)
        n = rf_larger(n, site[i].count);
    for (int lane = 0; lane < LANES; lane++)
        set_equations(step, w, &site[lane < sites ? lane : 0], lane, n);
    step->exec->kernels->solve_lanes(s->matrix, s->weight, n);
    for (int i = 0; i < sites; i++) {
        for (int c = 0; c < 3; c++) {
            uint16_t *light = fine->light.channel[c] + site[i].y * fine->light.stride + site[i].x;
            *light = (uint16_t)changed(step, *light, predicted(s, &site[i], c, i));
        }
    }
}

/* How much of its residual a pixel of that blur gets. */
static int fade_of(const struct step *step, int blur)
{
    const int64_t limit = ((int64_t)RF_TEXTURE_BLUR << step->level) >> step->texture->unit;

    return (int)(abs(blur) >= limit ? 0
                                    : rf_smaller((int)((limit - abs(blur)) * 1024 / limit), 256));
}

/* Gives an unknown pixel the light of the next level; returns whether more is to be predicted. */
static bool pull_pixel(const struct step *step, int x, int y, struct site *site)
{
    const struct rf_level *fine = step->fine, *coarse = step->coarse;
    const int blur = coarse->blur.at[y / 2 * coarse->blur.stride + x / 2];

    for (int c = 0; c < 3; c++)
        fine->light.channel[c][y * fine->light.stride + x] = (uint16_t)pulled(step, c, x, y);
    *site = (struct site){.x = x, .y = y, .blur = blur, .fade = fade_of(step, blur)};
    return site->fade > 0;
}

static void pull_block(void *context, int item, int worker)
{
    const struct step *step = context;
    const struct rf_level *fine = step->fine;
    const int x0 = item % step->blocks_x * BLOCK, y0 = item / step->blocks_x * BLOCK;
    const int x1 = rf_smaller(x0 + BLOCK, fine->width), y1 = rf_smaller(y0 + BLOCK, fine->height);
    struct window w = {.scratch = step->texture->scratch + worker,
                       .x0 = rf_larger(x0 - MARGIN, 0),
                       .y0 = rf_larger(y0 - MARGIN, 0)};
    struct site site[LANES];
    bool looked = false, textured = true;
    int sites = 0;

    w.width = rf_smaller(x1 + MARGIN, fine->width) - w.x0;
    w.height = rf_smaller(y1 + MARGIN, fine->height) - w.y0;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            if (fine->blur.at[y * fine->blur.stride + x] != RF_NO_BLUR ||
                !pull_pixel(step, x, y, &site[sites]) || !textured)
                continue;
            if (!looked)
                textured =
                    take_residuals(step, &w) >= LEAST_KNOWN && find_covariance(step, w.scratch);
            looked = true;
            if (!textured)
                continue;
            find_known(step, &w, &site[sites]);
            sites += site[sites].count > 0;
            if (sites == LANES) {
                predict(step, &w, site, sites);
                sites = 0;
            }
        }
    }
    if (sites > 0)
        predict(step, &w, site, sites);
}

/* Unknown pixels become known once all blocks have looked at them. */
static void pull_blur_band(void *context, int band, int worker)
{
    const struct step *step = context;
    const struct rf_level *fine = step->fine, *coarse = step->coarse;
    const int y0 = band * BAND, y1 = rf_smaller(y0 + BAND, fine->height);

    for (int y = y0; y < y1; y++) {
        const int far_y = rf_within(y % 2 ? y / 2 + 1 : y / 2 - 1, coarse->height - 1);
        int16_t *const blur = fine->blur.at + y * fine->blur.stride;
        struct rf_unknown run = {0};

        while (rf_next_unknown(blur, fine->width, &run)) {
            const int16_t *parent = coarse->blur.at + run.x0 / 2;
            const struct rf_parents parents = {
                .near_blur = parent + y / 2 * coarse->blur.stride,
                .far_blur = parent + far_y * coarse->blur.stride,
                .apart = step->apart,
            };

            step->exec->kernels->pull_blur(blur + run.x0, &parents,
                                           (int16_t *)rf_scratch(step->exec, worker),
                                           (run.x1 - run.x0 + 1) / 2);
        }
    }
    if (step->level > 0)
        return;
    for (int c = 0; c < 3; c++)
        rf_extend_rows(step->view, fine->light.channel[c], fine->light.stride, y0, y1);
    rf_extend_rows(step->view, fine->blur.at, fine->blur.stride, y0, y1);
}

static void list_around(struct step *step)
{
    int k = 0;

    for (int far = 1; far <= REACH * REACH; far++)
        for (int y = -REACH; y <= REACH; y++)
            for (int x = -REACH; x <= REACH; x++)
                if (x * x + y * y == far) {
                    step->around[k][0] = (int8_t)x;
                    step->around[k++][1] = (int8_t)y;
                }
}

void rf_background_pull_textured(const struct rf_executor *exec, const struct rf_viewport *view,
                                 const struct rf_pyramid *pyramid, const struct rf_texture *texture)
{
    struct step step = {.exec = exec, .view = view, .texture = texture, .apart = pyramid->apart};

    list_around(&step);
    for (step.level = pyramid->levels - 1; step.level >= 0; step.level--) {
        step.fine = &pyramid->level[step.level];
        step.coarse = step.fine + 1;
        step.blocks_x = (step.fine->width + BLOCK - 1) / BLOCK;
        rf_pool_run(exec->pool, pull_block, &step,
                    step.blocks_x * ((step.fine->height + BLOCK - 1) / BLOCK));
        rf_pool_run(exec->pool, pull_blur_band, &step, (step.fine->height + BAND - 1) / BAND);
    }
    if (pyramid->levels == 0) /* a picture of one pixel: nothing is unknown */
        rf_background_pull(exec, view, pyramid, 0, 0);
}
