/* linearise.c: turns the codes of a photo of R, G and B into light that can be averaged. */
#include "passes/linearise.h"

#include <string.h>

#include "image/border.h"
#include "image/format.h"

/* A row of n pixels, read once; `bytes` is a constant. */
static inline void convert_row(uint16_t *restrict red, uint16_t *restrict green,
                               uint16_t *restrict blue, uint8_t *restrict alpha,
                               const uint8_t *restrict in, struct rf_order o, const int bytes,
                               const uint16_t *restrict to_light, int n)
{
    if (o.a < 0)
        memset(alpha, 255, (size_t)n);
    for (int x = 0; x < n; x++) {
        red[x] = to_light[in[x * bytes + o.r]];
        green[x] = to_light[in[x * bytes + o.g]];
        blue[x] = to_light[in[x * bytes + o.b]];
        if (o.a >= 0)
            alpha[x] = in[x * bytes + o.a];
    }
}

struct job {
    const struct rf_viewport *view;
    const struct rf_linearise *pass;
};

static void convert_band(void *context, int band, int worker)
{
    const struct job *job = context;
    const struct rf_linearise *pass = job->pass;
    const struct rf_order o = rf_order_of(pass->photo->format);
    const struct rf_light_q12 light = pass->light;
    const uint16_t *to_light = pass->transfer->to_light;
    const int y0 = rf_band_start(band), y1 = rf_band_end(job->view, band), n = job->view->width;

    (void)worker;
    for (int y = y0; y < y1; y++) {
        const uint8_t *in = pass->photo->plane[0] + y * pass->photo->stride[0];
        uint16_t *red = light.channel[0] + y * light.stride;
        uint16_t *green = light.channel[1] + y * light.stride;
        uint16_t *blue = light.channel[2] + y * light.stride;
        uint8_t *alpha = pass->alpha.at + y * pass->alpha.stride;

        if (o.bytes == 3)
            convert_row(red, green, blue, alpha, in, o, 3, to_light, n);
        else
            convert_row(red, green, blue, alpha, in, o, 4, to_light, n);
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(job->view, light.channel[c], light.stride, y0, y1);
}

void rf_linearise(const struct rf_executor *exec, const struct rf_viewport *view,
                  const struct rf_linearise *pass)
{
    struct job job = {view, pass};

    rf_pool_run(exec->pool, convert_band, &job, rf_bands(view));
}

void rf_reblend_rows(const struct rf_viewport *view, const struct rf_transfer *from,
                     const struct rf_transfer *to, struct rf_light_q12 light, int y0, int y1)
{
    const uint8_t *to_code = from->to_code;
    const uint16_t *to_light = to->to_light;

    for (int c = 0; c < 3; c++) {
        for (int y = y0; y < y1; y++) {
            uint16_t *row = light.channel[c] + y * light.stride;

            for (int x = 0; x < view->width; x++)
                row[x] = to_light[to_code[4 * row[x]]];
        }
        rf_extend_rows(view, light.channel[c], light.stride, y0, y1);
    }
}
