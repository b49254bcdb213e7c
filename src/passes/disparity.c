/* disparity.c: copies a disparity map as large as the photo to its plane, and smooths its steps. */
#include "passes/disparity.h"

#include <string.h>

#include "depth/dequantise.h"
#include "support/compare.h"

enum { ROWS = 16 }; /* rows of a work item */

static void take_band(void *context, int band, int worker)
{
    const struct rf_copy_disparity *pass = context;
    const struct refocus_disparity *map = pass->map;
    const int end = rf_smaller((band + 1) * ROWS, map->height);

    (void)worker;
    for (int y = band * ROWS; y < end; y++) {
        const uint8_t *in = (const uint8_t *)map->samples + y * map->stride;
        uint16_t *out = pass->disparity.at + y * pass->disparity.stride;

        if (map->bits == 16)
            memcpy(out, in, (size_t)map->width * 2);
        else
            for (int x = 0; x < map->width; x++)
                out[x] = (uint16_t)(in[x] * 257);
    }
}

void rf_copy_disparity(const struct rf_executor *exec, const struct rf_copy_disparity *pass)
{
    const struct rf_dequantiser d = {
        .kernels = exec->kernels,
        .code = pass->disparity,
        .spare = {pass->spare[0], pass->spare[1]},
        .width = pass->map->width,
        .height = pass->map->height,
        .step = pass->step,
    };

    rf_pool_run(exec->pool, take_band, (void *)pass, (pass->map->height + ROWS - 1) / ROWS);
    if (pass->step)
        rf_dequantise(&d, exec->pool);
}
