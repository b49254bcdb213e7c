/* faint.c: depth of faint texture counts as measured where no edge is near.
 *
 * Depth is sure where texture is much sharper in one frame than in another. Beside an edge a plain
 * surface has nothing but the skirt of the blurred edge, and is the sharpest where that is widest,
 * in a frame that is focused elsewhere: so texture has to stand out against a floor (costs.c). Far
 * from edges that floor would call walls, skin and sand unknown, whose texture is fainter than it
 * and well above noise. There depth is sure without it, where it is so in all samples of a block:
 * noise alone makes a sample here and there sharp in one frame.
 *
 * An edge is near if a block within REACH of a sample's own has a mean square of sharpness of more
 * than STRONGER times its own.
 */
#include "focus_stack/focus_stack.h"

enum {
    BLOCKS = 64, /* along the shorter side, at the most */
    LEAST = 8,   /* samples of one, each way */
    REACH = 2,   /* blocks either way */
    STRONGER = 4,
};

struct grid {
    const struct refocus_stack *stack;
    struct rf_stack_faint faint;
    int side; /* samples of a block, each way */
    int columns, rows;
};

static int begin_of(const struct grid *g, int block)
{
    return block * g->side;
}

static int end_of(const struct grid *g, int block, int samples)
{
    return rf_stack_clamp((block + 1) * g->side, samples);
}

static void measure_blocks(void *context, int row, int worker)
{
    const struct grid *const g = context;
    const struct refocus_stack *const s = g->stack;

    (void)worker;
    for (int column = 0; column < g->columns; column++) {
        uint32_t strongest = 0;

        for (int y = begin_of(g, row); y < end_of(g, row, s->rows); y++)
            for (int x = begin_of(g, column); x < end_of(g, column, s->columns); x++) {
                const uint32_t here =
                    g->faint.strongest[(size_t)y * (size_t)s->columns + (size_t)x];

                strongest = here > strongest ? here : strongest;
            }
        g->faint.block[(size_t)row * (size_t)g->columns + (size_t)column] = strongest;
    }
}

/* The strongest texture in a block and in those around it. */
static uint32_t strongest_near(const struct grid *g, int row, int column)
{
    uint32_t strongest = 0;

    for (int v = row - REACH; v <= row + REACH; v++)
        for (int u = column - REACH; u <= column + REACH; u++)
            if (v >= 0 && v < g->rows && u >= 0 && u < g->columns) {
                const uint32_t here = g->faint.block[(size_t)v * (size_t)g->columns + (size_t)u];

                strongest = here > strongest ? here : strongest;
            }
    return strongest;
}

static void take_blocks(void *context, int row, int worker)
{
    const struct grid *const g = context;
    const struct refocus_stack *const s = g->stack;

    (void)worker;
    for (int column = 0; column < g->columns; column++) {
        const uint32_t least = strongest_near(g, row, column) / STRONGER;
        const int x0 = begin_of(g, column), x1 = end_of(g, column, s->columns);
        uint8_t sure = UINT8_MAX;

        for (int y = begin_of(g, row); y < end_of(g, row, s->rows); y++)
            for (int x = x0; x < x1; x++) {
                const size_t i = (size_t)y * (size_t)s->columns + (size_t)x;

                sure = g->faint.sure[i] < sure ? g->faint.sure[i] : sure;
            }
        for (int y = begin_of(g, row); y < end_of(g, row, s->rows); y++)
            for (int x = x0; x < x1; x++) {
                const size_t i = (size_t)y * (size_t)s->columns + (size_t)x;

                if (g->faint.strongest[i] >= least && sure > s->sure[i])
                    s->sure[i] = sure;
            }
    }
}

void rf_stack_take_faint(struct refocus_stack *s)
{
    const int shorter = s->columns < s->rows ? s->columns : s->rows;
    const int side = shorter > BLOCKS * LEAST ? shorter / BLOCKS : LEAST;
    struct grid grid = {s, rf_stack_faint(s), side, (s->columns + side - 1) / side,
                        (s->rows + side - 1) / side};

    rf_pool_run(s->pool, measure_blocks, &grid, grid.rows);
    rf_pool_run(s->pool, take_blocks, &grid, grid.rows);
}
