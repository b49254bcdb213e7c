/* body.c: a lamp without what it lights (highlights.h).
 *
 * A candle's flame hangs together with its rim, a street lamp with its post, where these are so
 * bright that they are clipped. They are thinner than the lamp. A coloured lamp, a tail light, has
 * a glow around it in which its own channel is clipped, and the others are not.
 */
#include "highlights/lamps.h"

#include <string.h>

enum { ROWS = RF_LAMP_SIDE };

/* Cells all of whose neighbours are there. False: none. */
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

/* And their neighbours in the shape. */
static void dilate(uint64_t row[ROWS], const struct rf_lamp_shape *shape)
{
    uint64_t across[ROWS + 2] = {0};

    for (int j = 0; j < ROWS; j++)
        across[j + 1] = row[j] | row[j] << 1 | row[j] >> 1;
    for (int j = 0; j < ROWS; j++)
        row[j] = (across[j] | across[j + 1] | across[j + 2]) & shape->row[j];
}

static int cells_of(const uint64_t row[ROWS])
{
    int count = 0;

    for (int j = 0; j < ROWS; j++)
        count += __builtin_popcountll(row[j]);
    return count;
}

bool rf_lamp_body(struct rf_lamp_shape *body, const struct rf_lamp_shape *shape)
{
    uint64_t row[ROWS];
    int layers = 0, half, left, all;

    memcpy(row, shape->row, sizeof row);
    while (erode(row))
        layers++;
    half = (layers + 1) / 2;
    memcpy(row, shape->row, sizeof row);
    for (int i = 0; i < half; i++)
        erode(row);
    for (int i = 0; i < half + 1; i++) /* once more, as it may be round */
        dilate(row, shape);
    left = cells_of(row);
    all = cells_of(shape->row);
    *body = *shape;
    memcpy(body->row, row, sizeof row);
    return 2 * left >= all && left < all;
}

static bool has_clipped(const struct rf_lamp_photo *p, int x, int y)
{
    const struct rf_rect in = rf_pixels_of(p, x, y);

    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++)
            if (rf_is_clipped(p, px, py))
                return true;
    return false;
}

bool rf_lamp_core(struct rf_lamp_shape *core, const struct rf_lamp_photo *p,
                  const struct rf_lamp_shape *shape)
{
    uint64_t any = 0, missing = 0;

    *core = *shape;
    for (int j = 0; j < shape->rows; j++) {
        for (uint64_t row = shape->row[j]; row; row &= row - 1)
            if (!has_clipped(p, shape->x + __builtin_ctzll(row), shape->y + j))
                core->row[j] &= ~(row & -row);
        any |= core->row[j];
        missing |= shape->row[j] & ~core->row[j];
    }
    return any && missing;
}
