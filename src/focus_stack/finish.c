/* finish.c: depth, and a photo that is in focus everywhere, of a focus stack whose frames are all
 * there: the order of the steps. */
#include <refocus/stack.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "focus_stack/focus_stack.h"
#include "image/deep.h"
#include "image/format.h"
#include "image/read.h"

enum { TELLING = 25 /* the direction tells which end is far from 1 / TELLING on */ };

static int reference_of(const struct refocus_stack *s)
{
    for (int k = 0; k < s->count && s->reference; k++)
        if (s->frame[k].added == s->reference)
            return k;
    return s->reference ? -1 : s->count / 2;
}

/* Labels of apertures are distances from the end that is in focus. */
static uint16_t disparity_of_blur(const struct refocus_stack *s, int depth)
{
    const int away = 65535 * rf_stack_clamp(depth, s->farthest) / s->farthest;

    return (uint16_t)(s->kind == REFOCUS_STACK_APERTURE_NEAREST ? 65535 - away : away);
}

uint16_t rf_stack_disparity(const struct refocus_stack *s, int depth)
{
    if (s->kind != REFOCUS_STACK_FOCUS)
        return disparity_of_blur(s, depth);

    const int k = rf_stack_clamp(depth >> 8, s->count - 2);
    const double first = s->frame[0].position, range = s->frame[s->count - 1].position - first;
    const double below = s->frame[k].position, above = s->frame[k + 1].position;
    const double at = below + (above - below) * (depth - 256 * k) / 256;
    const double d = (at - first) / range * 65535 + 0.5;

    return (uint16_t)(d > 0 ? d < 65535 ? d : 65535 : 0);
}

struct rows {
    struct refocus_stack *stack;
    const struct refocus_stack_result *result;
    atomic_llong measured; /* pixels */
};

static void write_row(void *context, int y, int worker)
{
    struct rows *const rows = context;
    const struct refocus_stack *s = rows->stack;
    const struct refocus_stack_result *r = rows->result;
    uint16_t *const depth = s->depth_row + (ptrdiff_t)worker * s->width;
    uint8_t *const sure = s->sure_row + (ptrdiff_t)worker * s->width;
    int measured = 0;

    rf_stack_depth_row(s, depth, sure, y);
    if (r->photo && s->kind == REFOCUS_STACK_FOCUS)
        rf_stack_compose_row(s, r->photo + y * r->photo_stride, depth, y);
    else if (r->photo)
        memcpy(r->photo + y * r->photo_stride, s->frame[0].rgb + 3 * (ptrdiff_t)y * s->width,
               3 * (size_t)s->width);
    if (r->confidence)
        memcpy(r->confidence + y * r->confidence_stride, sure, (size_t)s->width);
    for (int x = 0; x < s->width; x++)
        measured += sure[x] >= RF_STACK_MEASURED;
    atomic_fetch_add_explicit(&rows->measured, measured, memory_order_relaxed);
    if (r->disparity) {
        uint16_t *out = (uint16_t *)(void *)((char *)r->disparity + y * r->disparity_stride);

        for (int x = 0; x < s->width; x++)
            out[x] = rf_stack_disparity(s, depth[x]);
    }
}

static void write_rows(struct refocus_stack *s, struct refocus_stack_result *r,
                       struct rf_deep *light, void *work)
{
    const struct rf_stack_photo photo = {r->photo, r->photo_stride};
    struct rows rows = {.stack = s, .result = r};

    rf_pool_run(s->pool, write_row, &rows, s->height);
    if (r->photo && s->kind == REFOCUS_STACK_FOCUS) {
        rf_stack_decontaminate(s, &photo);
        rf_stack_whiten(s, &photo);
    }
    if (work)
        rf_stack_find_light(s, &photo, light, work);
    r->measured = (float)((double)rows.measured / ((double)s->width * s->height));
}

static bool good_result(const struct refocus_stack *s, const struct refocus_stack_result *r)
{
    const ptrdiff_t w = s->width;

    return (!r->photo || rf_good_stride(r->photo_stride, 3 * w, s->height)) &&
           (!r->confidence || rf_good_stride(r->confidence_stride, w, s->height)) &&
           (!r->disparity || (!((uintptr_t)r->disparity & 1) && !(r->disparity_stride & 1) &&
                              rf_good_stride(r->disparity_stride, 2 * w, s->height))) &&
           !r->reserved;
}

/* Puts the far end first, where the order is to be told and the picture tells it. */
static void direct(struct refocus_stack *s, struct refocus_stack_result *own)
{
    own->direction = 0;
    own->by_rows = 0;
    if (s->order != REFOCUS_STACK_ORDER_ADDED && s->without_positions) {
        own->direction = rf_stack_direction(s, &own->by_rows);
        if (TELLING * own->direction <= -1)
            rf_stack_reverse(s);
    }
}

static void find_depth(struct refocus_stack *s, struct refocus_stack_result *own)
{
    own->order_margin = 1;
    if (s->order == REFOCUS_STACK_ORDER_FOUND && s->without_positions)
        own->order_margin = rf_stack_find_order(s);
    s->still = reference_of(s);
    rf_stack_align(s, s->still);
    rf_stack_match_exposure(s);
    rf_stack_find_moving(s);
    s->sub = rf_stack_sub(s->count);
    if ((s->count - 1) * s->sub >= s->labels) /* more frames were announced than came */
        s->sub = 1;
    s->depths = (s->count - 1) * s->sub + 1;
    rf_stack_sharpness(s);
    rf_stack_find_noise(s);
    if (s->sub > 1)
        rf_stack_model(s);
    rf_stack_costs(s);
    own->disorder = rf_stack_disorder(s);
    rf_stack_aggregate(s);
    rf_stack_choose(s);
    rf_stack_fill(s, false);
    direct(s, own);
    if (s->count > 2)
        rf_stack_silhouettes(s);
    if (s->count > 3)
        rf_stack_median(s);
    rf_stack_smooth(s);
    own->blur = 0;
}

static void finish(struct refocus_stack *s, struct refocus_stack_result *own, struct rf_deep *light,
                   void *work)
{
    s->finished = true;
    if (s->kind == REFOCUS_STACK_FOCUS)
        find_depth(s, own);
    else
        rf_stack_apertures(s, own);
    own->reference = s->frame[s->still].added;
    own->alike = (float)s->alike;
    memset(own->order, 0, sizeof own->order);
    for (int k = 0; k < s->count; k++)
        own->order[k] = (uint8_t)s->frame[k].added;
    write_rows(s, own, light, work);
    own->moving = (float)((double)s->moving / ((double)s->columns * s->rows));
    own->matched = (uint32_t)s->matched;
    own->exposure = (float)s->exposure;
    own->moved = 0;
    for (int k = 0; k < s->count; k++)
        own->moved = fmaxf(own->moved, (float)rf_similarity_reach(&s->frame[k].from_reference,
                                                                  s->width, s->height));
}

/* Light is of its own memory: floats of R, G and B, or halves, linear. */
static int begin_light(struct refocus_stack *s, const struct refocus_stack_result *r,
                       struct rf_deep *light, void **work)
{
    struct refocus_image image;
    uint64_t bytes;
    int status;

    if (!r->light)
        return REFOCUS_OK;
    status = rf_read_any_image(NULL, "light", &image, r->light);
    if (status)
        return status;
    if (!r->photo || s->kind != REFOCUS_STACK_FOCUS || image.width != s->width ||
        image.height != s->height || image.white > 0 ||
        (image.transfer != REFOCUS_TRANSFER_DEFAULT && image.transfer != REFOCUS_TRANSFER_LINEAR) ||
        (image.format != REFOCUS_FORMAT_RGB_HALF && image.format != REFOCUS_FORMAT_RGB_FLOAT))
        return REFOCUS_ERR_ARGUMENT;
    rf_deep_begin(light, &image, false);
    bytes = rf_stack_light_bytes(s);
    *work = bytes <= PTRDIFF_MAX ? malloc((size_t)bytes) : NULL;
    return *work ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
}

int refocus_stack_finish(struct refocus_stack *s, struct refocus_stack_result *result)
{
    const size_t first = REFOCUS_SIZE_TO(struct refocus_stack_result, moved);
    struct refocus_stack_result own;
    struct rf_deep light = {.on = false};
    void *work = NULL;
    struct rf_pool pool;
    int status;

    if (!s)
        return REFOCUS_ERR_ARGUMENT;
    status = refocus_struct_read(&own, sizeof own, first, result);
    if (status)
        return status;
    if (!good_result(s, &own))
        return REFOCUS_ERR_ARGUMENT;
    if (s->count < REFOCUS_STACK_LEAST_FRAMES || s->finished || reference_of(s) < 0)
        return REFOCUS_ERR_STATE;
    status = begin_light(s, &own, &light, &work);
    if (status)
        return status;
    status = rf_pool_start(&pool, s->threads, NULL, NULL);
    if (status) {
        free(work);
        return status;
    }
    s->pool = &pool;
    finish(s, &own, &light, work);
    rf_pool_end(&pool);
    free(work);
    return refocus_struct_write(result, first, &own, sizeof own);
}
