/* linearise_deep.c: turns a deep photo into light up to white, which is all that the planes hold;
 * what is above white stays with the photo (highlights/known.c). */
#include "passes/linearise.h"

#include "image/border.h"

struct job {
    const struct rf_viewport *view;
    const struct rf_linearise_deep *pass;
};

/* A value of 0 to 1, or beyond, in steps of which 1 has `most`: half up. */
static int steps_of(float value, int most)
{
    const float steps = value * (float)most;

    return !(value > 0) ? 0 : value >= 1 ? most : (int)(steps + 0.5f);
}

static uint8_t code_of_alpha(const struct rf_deep *deep, const uint8_t *at)
{
    return (uint8_t)steps_of(rf_deep_value(deep, at), 255);
}

static void convert_row(const struct rf_linearise_deep *pass, int y, int n)
{
    const struct rf_deep *deep = pass->photo;
    uint8_t *alpha = pass->alpha.at + y * pass->alpha.stride;
    uint8_t *guide = pass->guide ? pass->guide->plane[0] + y * pass->guide->stride[0] : NULL;

    for (int x = 0; x < n; x++) {
        float exact[3];

        rf_deep_light(deep, x, y, exact);
        for (int c = 0; c < 3; c++) {
            const uint16_t light = (uint16_t)steps_of(exact[c], RF_LIGHT_MAX);

            pass->light.channel[c][y * pass->light.stride + x] = light;
            if (guide)
                guide[3 * x + c] = pass->transfer->to_code[4 * light];
        }
        alpha[x] = deep->channels == 4
                       ? code_of_alpha(deep, rf_deep_pixel(deep, x, y) + 3 * deep->bytes)
                       : 255;
    }
}

static void convert_band(void *context, int band, int worker)
{
    const struct job *job = context;
    const struct rf_light_q12 light = job->pass->light;
    const int y0 = rf_band_start(band), y1 = rf_band_end(job->view, band);

    (void)worker;
    for (int y = y0; y < y1; y++)
        convert_row(job->pass, y, job->view->width);
    for (int c = 0; c < 3; c++)
        rf_extend_rows(job->view, light.channel[c], light.stride, y0, y1);
}

void rf_linearise_deep(const struct rf_executor *exec, const struct rf_viewport *view,
                       const struct rf_linearise_deep *pass)
{
    struct job job = {view, pass};

    rf_pool_run(exec->pool, convert_band, &job, rf_bands(view));
}
