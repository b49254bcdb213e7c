/* stack.c: a focus stack: its memory, and the frames that it takes in. */
#include <refocus/stack.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/transfer.h"
#include "focus_stack/focus_stack.h"
#include "image/format.h"
#include "image/read.h"
#include "support/arena.h"

enum {
    LEAST_SIDE = 16,
    SMALL_PIXELS = 1 << 18, /* at the most, in the finest picture of the alignment */
    PATHS = 8,
};

static void lay_out(struct refocus_stack *s, struct rf_arena *arena)
{
    const uint64_t pixels = (uint64_t)s->width * (uint64_t)s->height;
    const uint64_t samples = (uint64_t)s->columns * (uint64_t)s->rows;
    const uint64_t labels = (uint64_t)s->labels;
    const uint64_t longer = (uint64_t)(s->columns > s->rows ? s->columns : s->rows);

    for (int k = 0; k < s->most; k++) {
        struct rf_stack_frame *frame = &s->frame[k];
        uint64_t w = (uint64_t)(s->width / s->small_by), h = (uint64_t)(s->height / s->small_by);

        frame->rgb = rf_arena_take(arena, pixels, 3);
        frame->sharpness = rf_arena_take(arena, samples, 2);
        for (int i = 0; i < RF_STACK_LEVELS; i++, w /= 2, h /= 2)
            frame->small[i] = rf_arena_take(arena, w * h, 2);
        for (int c = 0; c < 2; c++)
            frame->colour[c] = rf_arena_take(arena, SMALL_PIXELS / 4, 2);
    }
    s->before = rf_arena_take(arena, pixels, 3);
    s->smooth = (uint16_t *)(void *)s->before;
    s->luma = s->before ? s->before + 2 * pixels : NULL;
    s->moved = rf_arena_take(arena, samples > SMALL_PIXELS ? samples : SMALL_PIXELS, 2);
    s->guide = rf_arena_take(arena, samples, 3);
    s->cost = rf_arena_take(arena, samples * labels, 1);
    s->sum = rf_arena_take(arena, samples * labels, 2);
    s->path_size = (size_t)(longer * PATHS * (labels + 2 * RF_STACK_PATHS_APART));
    s->path = rf_arena_take(arena, longer * PATHS * (labels + 2 * RF_STACK_PATHS_APART), 2 * 2);
    s->column = rf_arena_take(arena, (uint64_t)s->columns * RF_STACK_SQUARES * (uint64_t)s->planes,
                              4 * (uint64_t)s->threads);
    s->depth = rf_arena_take(arena, samples, 2);
    s->sure = rf_arena_take(arena, samples, 1);
    s->depth_row = rf_arena_take(arena, (uint64_t)s->width, 2 * (uint64_t)s->threads);
    s->sure_row = rf_arena_take(arena, (uint64_t)s->width, (uint64_t)s->threads);
    s->transfer = rf_arena_take(arena, 1, sizeof *s->transfer);
    if (s->kind != REFOCUS_STACK_FOCUS) {
        const uint64_t more = 2 * RF_STACK_MARGIN + 1;

        s->table =
            rf_arena_take(arena, (uint64_t)s->columns + more, 4 * ((uint64_t)s->rows + more));
        s->code = rf_arena_take(arena, RF_LIGHT_MAX + 1, 2);
    }
}

static bool good(const struct refocus_stack_params *p)
{
    return p->width >= LEAST_SIDE && p->width <= REFOCUS_MAX_SIDE && p->height >= LEAST_SIDE &&
           p->height <= REFOCUS_MAX_SIDE && p->frames >= REFOCUS_STACK_LEAST_FRAMES &&
           p->frames <= REFOCUS_STACK_MOST_FRAMES && p->reference >= 0 &&
           p->reference <= p->frames && p->threads >= 0 && p->threads <= RF_MAX_THREADS &&
           p->align < REFOCUS_STACK_ALIGN_COUNT && p->order < REFOCUS_STACK_ORDER_COUNT &&
           p->kind < REFOCUS_STACK_KIND_COUNT && (p->kind == REFOCUS_STACK_FOCUS || !p->reference);
}

/* The least whole number by which both sides are divided to leave at most so many samples. */
static int reduction(int width, int height, int64_t most)
{
    int k = 1;

    while ((int64_t)((width + k - 1) / k) * ((height + k - 1) / k) > most)
        k++;
    return k;
}

static void size(struct refocus_stack *s, const struct refocus_stack_params *p)
{
    s->width = p->width;
    s->height = p->height;
    s->most = p->frames;
    s->reference = p->reference;
    s->align = p->align;
    s->order = p->order;
    s->kind = p->kind;
    s->threads = rf_thread_count(p->threads);
    s->sub = rf_stack_sub(p->frames);
    s->planes = s->kind == REFOCUS_STACK_FOCUS ? p->frames : RF_STACK_RADII;
    const int depths =
        s->kind == REFOCUS_STACK_FOCUS ? (p->frames - 1) * s->sub + 1 : RF_STACK_RADII;
    s->labels = depths <= 24 ? (depths + 7) / 8 * 8 : REFOCUS_STACK_MOST_FRAMES;
    const int longer = p->width > p->height ? p->width : p->height;
    s->reduced = s->kind == REFOCUS_STACK_FOCUS
                     ? reduction(p->width, p->height, RF_STACK_MOST_SAMPLES)
                     : (longer + RF_STACK_LONGER - 1) / RF_STACK_LONGER;
    s->columns = (p->width + s->reduced - 1) / s->reduced;
    s->rows = (p->height + s->reduced - 1) / s->reduced;
    s->small_by = reduction(p->width, p->height, SMALL_PIXELS);
}

int refocus_stack_create(struct refocus_stack **stack, const struct refocus_stack_params *params)
{
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct refocus_stack_params own;
    struct refocus_stack *s;
    int status;

    if (!stack)
        return REFOCUS_ERR_ARGUMENT;
    *stack = NULL;
    status = refocus_struct_read(&own, sizeof own,
                                 REFOCUS_SIZE_TO(struct refocus_stack_params, align), params);
    if (status)
        return status;
    if (!good(&own))
        return REFOCUS_ERR_ARGUMENT;
    s = calloc(1, sizeof *s);
    if (!s)
        return REFOCUS_ERR_MEMORY;
    size(s, &own);
    lay_out(s, &arena);
    if (arena.used > PTRDIFF_MAX) {
        free(s);
        return REFOCUS_ERR_SIZE;
    }
    s->block = malloc((size_t)arena.used);
    if (!s->block) {
        free(s);
        return REFOCUS_ERR_MEMORY;
    }
    rf_arena_begin(&arena, s->block);
    lay_out(s, &arena);
    *stack = s;
    return REFOCUS_OK;
}

void refocus_stack_destroy(struct refocus_stack **stack)
{
    if (!stack || !*stack)
        return;
    free((*stack)->block);
    free(*stack);
    *stack = NULL;
}

static bool position_fits(const struct refocus_stack *s, double position)
{
    if (isinf(position) || (s->count && isnan(position) != s->without_positions))
        return false;
    if (s->kind != REFOCUS_STACK_FOCUS && (isnan(position) ? s->most > 2 : position <= 0))
        return false;
    for (int k = 0; k < s->count && !isnan(position); k++)
        if (s->frame[k].position == position)
            return false;
    return true;
}

struct copy {
    uint8_t *out;
    const struct refocus_image *frame;
};

static void copy_row(void *context, int y, int worker)
{
    const struct copy *copy = context;
    const struct refocus_image *frame = copy->frame;
    const struct rf_order order = rf_order_of(frame->format);
    const uint8_t *in = frame->plane[0] + y * frame->stride[0];
    uint8_t *out = copy->out + (ptrdiff_t)y * 3 * frame->width;

    (void)worker;
    for (int x = 0; x < frame->width; x++, in += order.bytes, out += 3) {
        out[0] = in[order.r];
        out[1] = in[order.g];
        out[2] = in[order.b];
    }
}

int refocus_stack_add(struct refocus_stack *s, const struct refocus_image *given, double position)
{
    struct refocus_image image;
    struct rf_stack_frame frame;
    struct rf_pool pool;
    int status, place;

    if (!s)
        return REFOCUS_ERR_ARGUMENT;
    status = rf_read_image(NULL, "frame", &image, given);
    if (status)
        return status;
    if (image.width != s->width || image.height != s->height || image.white > 0 ||
        (image.transfer != REFOCUS_TRANSFER_DEFAULT && image.transfer != REFOCUS_TRANSFER_LINEAR) ||
        refocus_format_is_yuv(image.format) || !position_fits(s, position))
        return REFOCUS_ERR_ARGUMENT;
    if (s->count == s->most || s->finished)
        return REFOCUS_ERR_STATE;
    status = rf_pool_start(&pool, s->threads, NULL, NULL);
    if (status)
        return status;
    s->pool = &pool;
    s->without_positions = isnan(position);
    frame = s->frame[s->count];
    frame.position = s->without_positions ? s->count : position;
    rf_pool_run(&pool, copy_row, &(struct copy){frame.rgb, &image}, s->height);
    rf_stack_measure(s, &frame);
    rf_pool_end(&pool);
    for (place = s->count; place > 0 && s->frame[place - 1].position > frame.position; place--)
        s->frame[place] = s->frame[place - 1];
    frame.added = s->count + 1;
    s->frame[place] = frame;
    s->count++;
    return REFOCUS_OK;
}
