/* grid.c: one level of a selection is cut, refined and cleaned. */
#include <string.h>
#include "grid.h"

static const int dx[RF_CUT_NEIGHBOURS] = {-1, 0, 1, -1, 1, -1, 0, 1};
static const int dy[RF_CUT_NEIGHBOURS] = {-1, -1, -1, 0, 0, 1, 1, 1};

/* Slots of neighbours whose label is given, until their weight is known. */
enum { NO_NEIGHBOUR = -1, FIXED_OUTSIDE = -2, FIXED_INSIDE = -3 };

static struct rf_colour colour_at(const struct rf_grid *grid, const struct rf_pyramid *pyramid,
                                  int32_t x, int32_t y)
{
    struct rf_colour colour;

    x += grid->area.x;
    y += grid->area.y;
    if (grid->level > 0)
        return pyramid
            ->level[grid->level][(size_t)y * (size_t)pyramid->width[grid->level] + (size_t)x];
    rf_pyramid_row(pyramid, 0, x, y, 1, &colour);
    return colour;
}

/* u and v are halves. */
static int32_t contrast(struct rf_colour a, struct rf_colour b)
{
    const int32_t y = a.y - b.y, u = a.u - b.u, v = a.v - b.v;

    return y * y + 4 * (u * u + v * v);
}

static int32_t place_score(const struct rf_grid *grid, int32_t x, int32_t y)
{
    const struct rf_area area = grid->place_area;
    int32_t column = ((grid->area.x + x) >> grid->place_shift) - area.x;
    int32_t row = ((grid->area.y + y) >> grid->place_shift) - area.y;

    column = column < 0 ? 0 : column >= area.width ? area.width - 1 : column;
    row = row < 0 ? 0 : row >= area.height ? area.height - 1 : row;
    return grid->place[(size_t)row * (size_t)area.width + (size_t)column];
}

static int64_t count_open(const struct rf_grid *grid)
{
    const int64_t pixels = rf_area_pixels(grid->area);
    int64_t open = 0;

    for (int64_t i = 0; i < pixels; i++)
        open += grid->state[i] >> 2 & 1;
    return open;
}

/* Tie a node to what is there already: the nodes before it, and pixels whose label is
 * given. Capacities are contrasts as yet. */
static void tie(struct rf_cut *cut, int32_t index, const struct rf_grid *grid,
                const struct rf_pyramid *pyramid, struct rf_colour colour, int32_t x, int32_t y,
                const int32_t *index_of)
{
    struct rf_cut_node *const node = &cut->nodes[index];
    const int32_t w = grid->area.width, h = grid->area.height;

    for (int d = 0; d < RF_CUT_NEIGHBOURS; d++) {
        const int32_t nx = x + dx[d], ny = y + dy[d];
        uint8_t state;
        int32_t other;

        if (nx < 0 || nx >= w || ny < 0 || ny >= h)
            continue;
        state = grid->state[(size_t)ny * (size_t)w + (size_t)nx];
        if (state & RF_OPEN && d >= 4)
            continue;
        node->capacity[d] = contrast(colour, colour_at(grid, pyramid, nx, ny));
        if (!(state & RF_OPEN)) {
            node->neighbour[d] = state & RF_INSIDE ? FIXED_INSIDE : FIXED_OUTSIDE;
            continue;
        }
        other = index_of[(size_t)(ny & 1) * (size_t)w + (size_t)nx];
        node->neighbour[d] = other;
        cut->nodes[other].neighbour[7 - d] = index;
        cut->nodes[other].capacity[7 - d] = node->capacity[d];
    }
}

static void build(struct rf_grid *grid, struct rf_selector *selector,
                  const struct rf_pyramid *pyramid, int32_t *index_of)
{
    struct rf_cut *const cut = &selector->cut;
    const int32_t w = grid->area.width;

    cut->count = 0;
    for (int32_t y = 0; y < grid->area.height; y++) {
        const uint8_t *const row = grid->state + (size_t)y * (size_t)w;
        const uint8_t *at = row;

        for (int32_t x = 0; x < w; x++, at++) {
            struct rf_cut_node *node;
            struct rf_colour colour;

            if (!(*at & RF_OPEN))
                continue;
            node = &cut->nodes[cut->count];
            colour = colour_at(grid, pyramid, x, y);
            for (int d = 0; d < RF_CUT_NEIGHBOURS; d++) {
                node->neighbour[d] = NO_NEIGHBOUR;
                node->capacity[d] = 0;
            }
            node->terminal = selector->likeness.score[rf_bin(colour)] + place_score(grid, x, y);
            node->place = (uint32_t)y << 16 | (uint32_t)x;
            index_of[(size_t)(y & 1) * (size_t)w + (size_t)x] = cut->count;
            rf_cut_guess(cut, cut->count, *at & RF_INSIDE);
            tie(cut, cut->count, grid, pyramid, colour, x, y, index_of);
            cut->count++;
        }
    }
}

/* exp(-x) for x in sixteenths up to 8, 8 bits after the point: (1 - x / 16)^16. */
static int32_t falloff(int64_t x_q4)
{
    int64_t value = 65536 - (x_q4 << 8);

    if (x_q4 >= 128)
        return 0;
    for (int i = 0; i < 4; i++)
        value = value * value >> 16;
    return (int32_t)(value >> 8);
}

/* Contrasts become what it costs to part two pixels, as in GrabCut (Rother et al.
 * 2004): most where they are alike, measured by the mean contrast. */
static void weigh(struct rf_cut *cut)
{
    enum { MOST = 20 * RF_BIT, LEAST = RF_BIT / 4, DIAGONAL_Q8 = 181 };
    int64_t sum = 0, edges = 0;
    int64_t mean;

    for (int32_t i = 0; i < cut->count; i++) {
        for (int d = 0; d < RF_CUT_NEIGHBOURS; d++) {
            if (cut->nodes[i].neighbour[d] != NO_NEIGHBOUR) {
                sum += cut->nodes[i].capacity[d];
                edges++;
            }
        }
    }
    mean = edges > 0 ? sum / edges + 1 : 1;
    for (int32_t i = 0; i < cut->count; i++) {
        struct rf_cut_node *const node = &cut->nodes[i];

        for (int d = 0; d < RF_CUT_NEIGHBOURS; d++) {
            int32_t weight;

            if (node->neighbour[d] == NO_NEIGHBOUR)
                continue;
            weight = LEAST + (MOST * falloff(node->capacity[d] * 8 / mean) >> 8);
            if (dx[d] && dy[d])
                weight = weight * DIAGONAL_Q8 >> 8;
            node->capacity[d] = weight;
            if (node->neighbour[d] <= FIXED_OUTSIDE) {
                node->terminal += node->neighbour[d] == FIXED_INSIDE ? weight : -weight;
                node->neighbour[d] = NO_NEIGHBOUR;
                node->capacity[d] = 0;
            }
        }
    }
}

int rf_grid_cut(struct rf_grid *grid, struct rf_selector *selector,
                const struct rf_pyramid *pyramid, bool settle)
{
    struct rf_cut *const cut = &selector->cut;
    int32_t *const index_of =
        rf_selector_scratch(selector, 7, 2 * (int64_t)grid->area.width, sizeof *index_of);
    const int status = rf_cut_reserve(cut, count_open(grid));

    if (status != REFOCUS_OK || !index_of)
        return REFOCUS_ERR_MEMORY;
    build(grid, selector, pyramid, index_of);
    weigh(cut);
    if (settle)
        rf_cut_settle(cut);
    else
        rf_cut_solve(cut);
    for (int32_t i = 0; i < cut->count; i++) {
        const uint32_t place = cut->nodes[i].place;

        grid->state[(size_t)(place >> 16) * (size_t)grid->area.width + (place & 0xffff)] =
            rf_cut_inside(cut, i) ? RF_INSIDE : 0;
    }
    return REFOCUS_OK;
}

struct rf_area rf_grid_finer_area(const struct rf_grid *coarse, const struct rf_pyramid *pyramid)
{
    const int level = coarse->level - 1;
    struct rf_area area = {2 * coarse->area.x, 2 * coarse->area.y, 2 * coarse->area.width,
                           2 * coarse->area.height};

    if (area.x + area.width > pyramid->width[level])
        area.width = pyramid->width[level] - area.x;
    if (area.y + area.height > pyramid->height[level])
        area.height = pyramid->height[level] - area.y;
    return area;
}

/* Open the pixels of a row that touch one of the other label, if nothing is certain of
 * them. */
static void open_row(struct rf_grid *grid, int32_t y)
{
    const int32_t w = grid->area.width, h = grid->area.height;
    uint8_t *const row = grid->state + (size_t)y * (size_t)w;
    const uint8_t *const above = y > 0 ? row - w : row;
    const uint8_t *const below = y + 1 < h ? row + w : row;

    for (int32_t x = 0; x < w; x++) {
        const int32_t l = x > 0 ? x - 1 : x, r = x + 1 < w ? x + 1 : x;
        const int differs = (above[l] ^ row[x]) | (above[x] ^ row[x]) | (above[r] ^ row[x]) |
                            (row[l] ^ row[x]) | (row[r] ^ row[x]) | (below[l] ^ row[x]) |
                            (below[x] ^ row[x]) | (below[r] ^ row[x]);

        row[x] |= (uint8_t)((differs & RF_INSIDE & ~(row[x] >> 1)) << 2);
    }
}

void rf_grid_refine(struct rf_grid *fine, struct rf_grid *coarse, const struct rf_pyramid *pyramid)
{
    const int32_t cw = coarse->area.width;

    fine->level = coarse->level - 1;
    fine->area = rf_grid_finer_area(coarse, pyramid);
    fine->place = coarse->place;
    fine->place_area = coarse->place_area;
    fine->place_shift = coarse->place_shift + 1;
    for (int32_t y = 0; y < coarse->area.height; y++)
        open_row(coarse, y);
    for (int32_t y = 0; y < fine->area.height; y++) {
        const uint8_t *const from = coarse->state + (size_t)(y / 2) * (size_t)cw;
        uint8_t *const to = fine->state + (size_t)y * (size_t)fine->area.width;

        if (y & 1) {
            memcpy(to, to - fine->area.width, (size_t)fine->area.width);
            continue;
        }
        for (int32_t x = 0; x < fine->area.width / 2; x++)
            to[2 * x] = to[2 * x + 1] = from[x];
        if (fine->area.width & 1)
            to[fine->area.width - 1] = from[fine->area.width / 2];
    }
}

void rf_grid_connect(struct rf_grid *grid, int32_t *stack)
{
    enum { REACHED = 128 };
    const int32_t w = grid->area.width, h = grid->area.height;
    const int32_t pixels = w * h;
    int32_t depth = 0;

    for (int32_t i = 0; i < pixels; i++) {
        if ((grid->state[i] & (RF_INSIDE | RF_SEED)) == (RF_INSIDE | RF_SEED)) {
            grid->state[i] |= REACHED;
            stack[depth++] = i;
        }
    }
    while (depth > 0) {
        const int32_t at = stack[--depth], x = at % w, y = at / w;
        const int32_t next[4] = {x > 0 ? at - 1 : at, x + 1 < w ? at + 1 : at, y > 0 ? at - w : at,
                                 y + 1 < h ? at + w : at};

        for (int i = 0; i < 4; i++) {
            if ((grid->state[next[i]] & (RF_INSIDE | REACHED)) == RF_INSIDE) {
                grid->state[next[i]] |= REACHED;
                stack[depth++] = next[i];
            }
        }
    }
    for (int32_t i = 0; i < pixels; i++) {
        if (!(grid->state[i] & REACHED))
            grid->state[i] &= (uint8_t)~RF_INSIDE;
        grid->state[i] &= (uint8_t)~REACHED;
    }
}

void rf_grid_shrink(struct rf_grid *grid, int32_t margin)
{
    const struct rf_area old = grid->area;
    int32_t x0 = old.width, y0 = old.height, x1 = 0, y1 = 0;

    for (int32_t y = 0; y < old.height; y++) {
        for (int32_t x = 0; x < old.width; x++) {
            if (grid->state[(size_t)y * (size_t)old.width + (size_t)x] & RF_INSIDE) {
                x0 = x < x0 ? x : x0;
                x1 = x + 1 > x1 ? x + 1 : x1;
                y0 = y < y0 ? y : y0;
                y1 = y + 1;
            }
        }
    }
    if (x0 >= x1) {
        grid->area.width = grid->area.height = 0;
        return;
    }
    x0 = x0 > margin ? x0 - margin : 0;
    y0 = y0 > margin ? y0 - margin : 0;
    x1 = x1 + margin < old.width ? x1 + margin : old.width;
    y1 = y1 + margin < old.height ? y1 + margin : old.height;
    grid->area.x += x0;
    grid->area.y += y0;
    grid->area.width = x1 - x0;
    grid->area.height = y1 - y0;
    for (int32_t y = 0; y < y1 - y0; y++)
        memmove(grid->state + (size_t)y * (size_t)(x1 - x0),
                grid->state + (size_t)(y + y0) * (size_t)old.width + (size_t)x0, (size_t)(x1 - x0));
}
