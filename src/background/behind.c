/* behind.c: puts what the caller knows of the hidden background in its place. */
#include "background/behind.h"

#include <stdlib.h>
#include <string.h>

#include "image/format.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum { ROWS = 16 }; /* rows of a work item */

void rf_lay_out_behind(struct rf_behind *behind, struct rf_arena *arena, int max_width,
                       int max_height)
{
    const uint64_t pixels = (uint64_t)max_width * (uint64_t)max_height;

    behind->code = rf_arena_take(arena, pixels, 4);
    behind->disparity = rf_arena_take(arena, pixels, sizeof *behind->disparity);
}

struct load {
    const struct refocus_image *image;
    const struct refocus_disparity *map;
    struct rf_behind *behind;
};

static void load_band(void *context, int band, int worker)
{
    const struct load *load = context;
    const struct rf_behind *behind = load->behind;
    const struct rf_order o = rf_order_of(load->image->format);
    const int end = (band + 1) * ROWS < behind->height ? (band + 1) * ROWS : behind->height;

    (void)worker;
    for (int y = band * ROWS; y < end; y++) {
        const size_t at = (size_t)y * (size_t)behind->width;
        const uint8_t *in = load->image->plane[0] + y * load->image->stride[0];
        const uint8_t *samples = (const uint8_t *)load->map->samples + y * load->map->stride;
        uint8_t *code = behind->code + 4 * at;
        uint16_t *disparity = behind->disparity + at;

        for (int x = 0; x < behind->width; x++, in += o.bytes, code += 4) {
            code[0] = in[o.r];
            code[1] = in[o.g];
            code[2] = in[o.b];
            code[3] = o.a < 0 ? 255 : in[o.a];
        }
        if (load->map->bits == 16)
            memcpy(disparity, samples, (size_t)behind->width * 2);
        else
            for (int x = 0; x < behind->width; x++)
                disparity[x] = (uint16_t)(samples[x] * 257);
    }
}

void rf_behind_load(const struct rf_executor *exec, const struct refocus_image *image,
                    const struct refocus_disparity *map, struct rf_behind *behind)
{
    struct load load = {image, map, behind};

    behind->width = image->width;
    behind->height = image->height;
    rf_pool_run(exec->pool, load_band, &load, (image->height + ROWS - 1) / ROWS);
}

/* The steps of the pre-filter that the light of a blur takes. */
static int steps_of(const struct rf_behind_pass *pass, int blur)
{
    int steps = 0;

    while (steps < pass->steps && abs(blur) > pass->above[steps])
        steps++;
    return steps;
}

/* The first place from v - reach on that is in the picture and a multiple of `apart` away from v.
 */
static int first_of(int v, int reach, int apart)
{
    return v < reach ? v % apart : v - reach;
}

/* The mean light, half up, of the layer's pixels around pixel (x, y) of the photo whose disparity
 * is within 1/32 of that one's; of more than 15 x 15, every so many across and down. */
static void mean_around(const struct rf_behind_pass *pass, int x, int y, int steps,
                        uint16_t light[3])
{
    enum { MOST = 3 };
    const struct rf_behind *behind = pass->behind;
    const int apart = steps > MOST ? 1 << (steps - MOST) : 1;
    const int reach = apart * ((1 << (steps > MOST ? MOST : steps)) - 1);
    const int x0 = first_of(x, reach, apart), y0 = first_of(y, reach, apart);
    const int x1 = rf_within(x + reach, behind->width - 1),
              y1 = rf_within(y + reach, behind->height - 1);
    const int own = behind->disparity[(size_t)y * (size_t)behind->width + (size_t)x];
    uint32_t sum[3] = {0}, count = 0; /* 225 at the most */

    for (int j = y0; j <= y1; j += apart) {
        for (int i = x0; i <= x1; i += apart) {
            const size_t at = (size_t)j * (size_t)behind->width + (size_t)i;
            const uint8_t *code = behind->code + 4 * at;

            if (!code[3] || abs(behind->disparity[at] - own) > 65535 / 32)
                continue;
            for (int c = 0; c < 3; c++)
                sum[c] += pass->transfer->to_light[code[c]];
            count++;
        }
    }
    for (int c = 0; c < 3; c++)
        light[c] = (uint16_t)((sum[c] + count / 2) / count);
}

/* Whether rays that would meet the layer, of this blur, at a pixel of the window look past it:
 * those to two or more of eight places around see what is deeper, and less out of focus. */
static bool is_passed(const struct rf_viewport *view, const struct rf_behind_pass *pass, int blur,
                      int x, int y)
{
    static const int8_t way[8][2] = {{4, 0},  {3, 3},   {0, 4},  {-3, 3},
                                     {-4, 0}, {-3, -3}, {0, -4}, {3, -3}};
    const int step = rf_in_pixels(abs(blur), pass->blur.unit) * 3 / 16; /* three quarters in all */
    int deeper = 0;

    for (int i = 0; i < 8; i++) {
        const int u = rf_clamp(x + way[i][0] * step / 256, 0, view->width - 1);
        const int v = rf_clamp(y + way[i][1] * step / 256, 0, view->height - 1);
        const int seen = pass->blur.at[v * pass->blur.stride + u];

        deeper += seen - blur > pass->apart && seen + blur < 0;
    }
    return deeper > 1;
}

/* A row of the window. */
static void put_row(const struct rf_viewport *view, const struct rf_behind_pass *pass,
                    const int16_t *own_blur, int y)
{
    const uint16_t *disparity = pass->disparity.at + y * pass->disparity.stride;
    const int16_t *seen = pass->blur.at + y * pass->blur.stride;
    const ptrdiff_t at = y * pass->background.light.stride;
    int16_t *blur = pass->background.blur.at + y * pass->background.blur.stride;

    for (int x = 0; x < view->width; x++) {
        const int photo_x = view->x0 + x, photo_y = view->y0 + y;
        uint16_t light[3];

        if (blur[x] != RF_NO_BLUR || own_blur[x] <= seen[x] ||
            !rf_is_behind(pass->behind, photo_x, photo_y, disparity[x]) ||
            is_passed(view, pass, own_blur[x], x, y))
            continue;
        mean_around(pass, photo_x, photo_y, steps_of(pass, own_blur[x]), light);
        for (int c = 0; c < 3; c++)
            pass->background.light.channel[c][at + x] = light[c];
        blur[x] = own_blur[x];
    }
}

void rf_behind_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                    const struct rf_behind_pass *pass, int y0, int y1, int worker)
{
    int16_t *own_blur = (int16_t *)rf_scratch(exec, worker);

    for (int y = y0; y < y1 && !rf_cancelled(exec); y++) {
        const uint16_t *disparity = pass->behind->disparity +
                                    (size_t)(view->y0 + y) * (size_t)pass->behind->width + view->x0;

        if (pass->plan->plain)
            exec->kernels->signed_blur(own_blur, disparity, pass->plan->focus, view->width);
        else
            rf_focus_row(pass->plan, own_blur, disparity, view->x0, view->y0 + y, view->width);
        put_row(view, pass, own_blur, y);
    }
}
