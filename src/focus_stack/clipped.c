/* clipped.c: where a photo is clipped, as taps see it that are several pixels apart.
 *
 * Light of blurred foreground is added up by taps of a lattice, so that a highlight of few pixels
 * lies on a tap for one pixel and between taps for the next one. Each tap therefore stands for all
 * pixels of its cell: with n x n of them, c of which are clipped, it is clipped by c / n^2. A pixel
 * and the next one then see shares of the same highlight, whatever the lattice is.
 */
#include "focus_stack/focus_stack.h"

struct search {
    const struct refocus_stack *stack;
    const struct rf_stack_photo *photo;
    uint16_t *own; /* shares of the samples alone */
    struct rf_stack_clipped *found;
    int cell; /* samples of a side */
};

static void count_row(void *context, int y, int worker)
{
    const struct search *search = context;
    const struct refocus_stack *s = search->stack;
    uint16_t *out = search->own + (ptrdiff_t)y * s->columns;

    (void)worker;
    for (int x = 0; x < s->columns; x++) {
        int64_t clipped = 0, all = 0;

        for (int v = y * s->reduced; v < (y + 1) * s->reduced && v < s->height; v++)
            for (int u = x * s->reduced; u < (x + 1) * s->reduced && u < s->width; u++, all++)
                clipped += rf_stack_is_clipped(search->photo->rgb + v * search->photo->stride +
                                               3 * (ptrdiff_t)u);
        out[x] = (uint16_t)(clipped * RF_STACK_CLIPPED / all);
    }
}

/* Samples outside of the picture are not clipped. */
static void spread_row(void *context, int y, int worker)
{
    const struct search *search = context;
    const struct refocus_stack *s = search->stack;
    const int n = search->cell, above = y - n / 2, left = -(n / 2);

    (void)worker;
    for (int x = 0; x < s->columns; x++) {
        const ptrdiff_t at = (ptrdiff_t)y * s->columns + x;
        uint16_t nearest = 0;
        uint64_t sum = 0;

        for (int v = above < 0 ? 0 : above; v < above + n && v < s->rows; v++)
            for (int u = x + left < 0 ? 0 : x + left; u < x + left + n && u < s->columns; u++) {
                const ptrdiff_t i = (ptrdiff_t)v * s->columns + u;

                sum += search->own[i];
                if (search->own[i] && s->moved[i] > nearest)
                    nearest = s->moved[i];
            }
        search->found->share[at] = (uint16_t)(sum / (uint64_t)(n * n));
        search->found->disparity[at] = nearest;
    }
}

struct rf_stack_clipped rf_stack_find_clipped(struct refocus_stack *s,
                                              const struct rf_stack_photo *photo, int apart)
{
    /* Costs of 8 bytes a sample are not needed any more. */
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    uint16_t *const own = (uint16_t *)(void *)s->cost;
    struct rf_stack_clipped found = {own + samples, own + 2 * samples};
    struct search search = {s, photo, own, &found, (apart + s->reduced - 1) / s->reduced};

    rf_pool_run(s->pool, count_row, &search, s->rows);
    rf_pool_run(s->pool, spread_row, &search, s->rows);
    return found;
}
