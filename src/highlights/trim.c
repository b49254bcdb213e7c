/* trim.c: trims a clipped component to the highlight in it, without what that merely lights.
 *
 * A candle's flame is connected with the wax that it lights, a street light with its post, where
 * these are so bright that they are clipped. They are limbs, thinner than the light. A coloured
 * light, a tail light, has a glow around it in which its own channel is clipped, and the others are
 * not.
 */
#include "highlights/detect.h"

#include <string.h>

enum { ROWS = RF_COMPONENT_SIDE };

/* Keeps the cells all of whose neighbours are there. False: none is left. */
static bool erode(uint64_t row[ROWS])
{
    uint64_t across[ROWS + 2] = {0}, all = 0;

    for (int j = 0; j < ROWS; j++)
        across[j + 1] = row[j] & row[j] << 1 & row[j] >> 1;
    for (int j = 0; j < ROWS; j++) {
        row[j] = across[j] & across[j + 1] & across[j + 2];
        all |= row[j];
    }
    return all;
}

/* Adds the neighbours of cells that are in the component. */
static void dilate(uint64_t row[ROWS], const struct rf_component *component)
{
    uint64_t across[ROWS + 2] = {0};

    for (int j = 0; j < ROWS; j++)
        across[j + 1] = row[j] | row[j] << 1 | row[j] >> 1;
    for (int j = 0; j < ROWS; j++)
        row[j] = (across[j] | across[j + 1] | across[j + 2]) & component->row[j];
}

static int cells_of(const uint64_t row[ROWS])
{
    int count = 0;

    for (int j = 0; j < ROWS; j++)
        count += __builtin_popcountll(row[j]);
    return count;
}

bool rf_trim_limbs(struct rf_component *body, const struct rf_component *component)
{
    uint64_t row[ROWS];
    int layers = 0, half, left, all;

    memcpy(row, component->row, sizeof row);
    while (erode(row))
        layers++;
    half = (layers + 1) / 2;
    memcpy(row, component->row, sizeof row);
    for (int i = 0; i < half; i++)
        erode(row);
    for (int i = 0; i < half + 1; i++) /* once more, as it may be round */
        dilate(row, component);
    left = cells_of(row);
    all = cells_of(component->row);
    *body = *component;
    memcpy(body->row, row, sizeof row);
    return 2 * left >= all && left < all;
}

static bool has_clipped(const struct rf_cell_photo *p, int x, int y)
{
    const struct rf_rect in = rf_pixels_of(p, x, y);

    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++)
            if (rf_is_clipped(p, px, py))
                return true;
    return false;
}

bool rf_trim_glow(struct rf_component *core, const struct rf_cell_photo *p,
                  const struct rf_component *component)
{
    uint64_t any = 0, missing = 0;

    *core = *component;
    for (int j = 0; j < component->rows; j++) {
        for (uint64_t row = component->row[j]; row; row &= row - 1)
            if (!has_clipped(p, component->x + __builtin_ctzll(row), component->y + j))
                core->row[j] &= ~(row & -row);
        any |= core->row[j];
        missing |= component->row[j] & ~core->row[j];
    }
    return any && missing;
}
