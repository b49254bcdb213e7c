/* measure.c: measures a clipped component: its colour, its surroundings, and how its edge fades. */
#include "highlights/classify.h"

#include <string.h>

enum {
    AROUND = 12, /* cells on each side that are the surroundings */
    GRID = 3,    /* every third cell of them is measured */
    OUTER = 3,   /* cells that a component is out by at most */
    BESIDE = 2,  /* cells that the limbs of a component are out by */
};

int rf_add_clipped(const struct rf_cell_photo *p, int x, int y, int64_t own[3])
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

static bool has_cell(const struct rf_cell_photo *p, int x, int y)
{
    return x >= 0 && y >= 0 && x < p->across && y < p->down;
}

static bool is_in(const struct rf_component *component, int x, int y)
{
    const int i = x - component->x, j = y - component->y;

    return i >= 0 && i < 64 && j >= 0 && j < component->rows && (component->row[j] >> i & 1);
}

bool rf_measure_colours(const struct rf_cell_photo *p, const struct rf_component *body,
                        const struct rf_component *component, struct rf_measured *m)
{
    uint64_t all = 0;
    int count = 0, x0, x1;

    for (int j = 0; j < component->rows; j++) {
        all |= component->row[j];
        for (uint64_t row = body->row[j]; row; row &= row - 1)
            m->pixels +=
                rf_add_clipped(p, component->x + __builtin_ctzll(row), component->y + j, m->own);
    }
    x0 = component->x + __builtin_ctzll(all) - AROUND;
    x1 = component->x + 63 - __builtin_clzll(all) + AROUND;
    for (int y = component->y - AROUND; y < component->y + component->rows + AROUND; y += GRID)
        for (int x = x0; x <= x1; x += GRID) {
            int colour[3];

            if (!has_cell(p, x, y) || is_in(component, x, y))
                continue;
            rf_sample_cell(p, x, y, colour);
            for (int c = 0; c < 3; c++)
                m->around[c] += colour[c];
            count++;
        }
    for (int c = 0; c < 3 && count; c++) {
        m->own[c] /= m->pixels;
        m->around[c] /= count;
    }
    return count > 0;
}

static bool is_edge(const struct rf_cell_photo *p, int x, int y)
{
    return !(rf_is_clipped(p, x - 1, y) && rf_is_clipped(p, x + 1, y) &&
             rf_is_clipped(p, x, y - 1) && rf_is_clipped(p, x, y + 1));
}

static bool is_beside(const struct rf_cell_photo *p, int x, int y)
{
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (rf_is_clipped(p, x + i, y + j))
                return true;
    return false;
}

/* Counts a pixel that is not clipped, by how far it is from the surroundings to white. */
static void add_fade(struct rf_measured *m, int most)
{
    const int64_t above = 10 * (most - m->base) / (RF_LIGHT_MAX - m->base + 1);

    m->fade[0] += above >= 4;
    m->fade[1] += above >= 1 && above < 4;
}

/* Measures a pixel of the body or beside it. The colour of pixels beside it that have little of its
 * light is mostly not its own, so they count for less. */
static void measure_pixel(const struct rf_cell_photo *p, int x, int y, struct rf_measured *m)
{
    int colour[3], most;

    rf_colour_at(p, x, y, colour);
    most = rf_level_of(p, colour);
    if (most > RF_CLIPPED) {
        m->edge += is_edge(p, x, y);
        return;
    }
    add_fade(m, most);
    if (is_beside(p, x, y)) {
        m->half_lit += most - m->base >= 2 * (RF_LIGHT_MAX - m->base) / 5;
        for (int c = 0; c < 3 && most > m->base; c++)
            m->edge_light[c] += (colour[c] - m->beyond[c]) * (most - m->base) / RF_LIGHT_MAX;
    }
}

/* The cells of a component and so many around it, from OUTER rows before it on. */
struct dilated {
    uint64_t row[RF_COMPONENT_SIDE + 2 * OUTER];
};

static struct dilated dilated_by(const struct rf_component *component, int by)
{
    struct dilated out = {{0}};

    for (int j = 0; j < component->rows; j++) {
        uint64_t row = component->row[j];

        for (int i = 0; i < by; i++)
            row |= row << 1 | row >> 1;
        for (int i = -by; i <= by; i++)
            out.row[OUTER + j + i] |= row;
    }
    return out;
}

/* Cells near what was trimmed from a body. */
static struct dilated near_limbs(const struct rf_component *body,
                                 const struct rf_component *component)
{
    struct rf_component limbs = *component;

    for (int j = 0; j < limbs.rows; j++)
        limbs.row[j] &= ~body->row[j];
    return dilated_by(&limbs, BESIDE);
}

/* Measures what is 2 or 3 cells away. A highlight may light what is beside it: that is not its
 * edge. */
static void measure_beyond(const struct rf_cell_photo *p, const struct rf_component *body,
                           const struct dilated *limbs, struct rf_measured *m)
{
    const struct dilated beside = dilated_by(body, 1), beyond = dilated_by(body, OUTER);
    int count = 0;

    for (int j = 0; j < body->rows + 2 * OUTER; j++)
        for (uint64_t row = beyond.row[j] & ~beside.row[j] & ~limbs->row[j]; row; row &= row - 1) {
            const int x = body->x + __builtin_ctzll(row), y = body->y + j - OUTER;
            int colour[3];

            if (!has_cell(p, x, y))
                continue;
            rf_sample_cell(p, x, y, colour);
            if (rf_level_of(p, colour) > RF_CLIPPED) /* another highlight */
                continue;
            m->base += rf_level_of(p, colour);
            for (int c = 0; c < 3; c++)
                m->beyond[c] += colour[c];
            count++;
        }
    m->base /= count ? count : 1;
    for (int c = 0; c < 3; c++)
        m->beyond[c] /= count ? count : 1;
}

/* Measures the body's cells and those beside it. Clipped pixels that are near each other are of one
 * component: no other is in the cells around it. */
static void count_edge(const struct rf_cell_photo *p, const struct rf_component *body,
                       const struct dilated *limbs, struct rf_measured *m)
{
    const struct dilated beside = dilated_by(body, 1);

    for (int j = 0; j < body->rows + 2 * OUTER; j++)
        for (uint64_t row = beside.row[j] & ~limbs->row[j]; row; row &= row - 1) {
            const int x = body->x + __builtin_ctzll(row), y = body->y + j - OUTER;
            struct rf_rect in;

            if (!has_cell(p, x, y))
                continue;
            in = rf_pixels_of(p, x, y);
            for (int py = in.y0; py < in.y1; py++)
                for (int px = in.x0; px < in.x1; px++)
                    measure_pixel(p, px, py, m);
        }
}

void rf_measure_edge(const struct rf_cell_photo *p, const struct rf_component *body,
                     const struct rf_component *component, struct rf_measured *m)
{
    const struct dilated limbs = near_limbs(body, p->core ? body : component);

    measure_beyond(p, body, &limbs, m);
    count_edge(p, body, &limbs, m);
}

/* The edge of a core in its own glow tells little, as the highlight's channel is clipped
 * there too: if it mostly is two cells away, the core has the colour of what is there. */
void rf_measure_glow(const struct rf_cell_photo *p, const struct rf_component *core,
                     struct rf_measured *m)
{
    const struct dilated beside = dilated_by(core, 1), glow = dilated_by(core, 2);
    int64_t sum[3] = {0, 0, 0};
    int count = 0, clipped = 0;

    for (int j = 0; j < core->rows + 2 * OUTER; j++)
        for (uint64_t row = glow.row[j] & ~beside.row[j]; row; row &= row - 1) {
            int colour[3];

            rf_sample_cell(p, core->x + __builtin_ctzll(row), core->y + j - OUTER, colour);
            for (int c = 0; c < 3; c++)
                sum[c] += colour[c];
            clipped += colour[0] > RF_CLIPPED || colour[1] > RF_CLIPPED || colour[2] > RF_CLIPPED;
            count++;
        }
    if (4 * clipped >= 3 * count)
        memcpy(m->edge_light, sum, sizeof m->edge_light);
}
