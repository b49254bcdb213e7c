/* white.c: what is clipped in the photo of a focus stack is white again.
 *
 * Noise and JPEG leave few clipped pixels at 255, and how flat white is tells renderers how much
 * light was lost. The mean m of the codes above 242 around a pixel, within two pixels and of one
 * channel, tells what is clipped from paper and snow; one of them, w, becomes
 *
 *     w + (255 - w) t u,    t = (m - 250) / 3 and u = (w - 242) / 8, both from 0 to 1
 *
 * so that the 251 of a highlight whose codes are 253 on the average becomes 255, the 246 at its
 * edge 250 or 251, and the 251 of paper of 249 stays.
 */
#include <string.h>

#include "focus_stack/focus_stack.h"

enum {
    AROUND = 2,
    SURE = RF_STACK_WHITE - RF_STACK_NEAR,
    ALL = 3, /* by so much the mean is above RF_STACK_WHITE where all is clipped */
};

struct whites {
    const struct refocus_stack *stack;
    const struct rf_stack_photo *photo; /* written, of `before` */
};

static uint8_t whiten(const struct refocus_stack *s, int x, int y, int c)
{
    const uint8_t own = s->before[3 * ((size_t)y * (size_t)s->width + (size_t)x) + (size_t)c];
    int sum = 0, count = 0, part, all;

    for (int v = y - AROUND; v <= y + AROUND; v++)
        for (int u = x - AROUND; u <= x + AROUND; u++) {
            const size_t row = (size_t)rf_stack_clamp(v, s->height - 1) * (size_t)s->width;
            const size_t at = row + (size_t)rf_stack_clamp(u, s->width - 1);
            const int code = s->before[3 * at + (size_t)c];

            if (code > RF_STACK_NEAR) {
                sum += code - RF_STACK_WHITE;
                count++;
            }
        }
    part = rf_stack_clamp(sum, ALL * count) * rf_stack_clamp(own - RF_STACK_NEAR, SURE);
    all = ALL * count * SURE;
    return (uint8_t)(own + ((255 - own) * part + all / 2) / all);
}

static void whiten_row(void *context, int y, int worker)
{
    const struct whites *whites = context;
    const struct refocus_stack *s = whites->stack;
    uint8_t *row = whites->photo->rgb + y * whites->photo->stride;

    (void)worker;
    for (int x = 0; x < s->width; x++)
        for (int c = 0; c < 3; c++)
            if (row[3 * x + c] > RF_STACK_NEAR)
                row[3 * x + c] = whiten(s, x, y, c);
}

void rf_stack_whiten(struct refocus_stack *s, const struct rf_stack_photo *photo)
{
    const size_t line = 3 * (size_t)s->width;

    for (int y = 0; y < s->height; y++)
        memcpy(s->before + (size_t)y * line, photo->rgb + y * photo->stride, line);
    rf_pool_run(s->pool, whiten_row, &(struct whites){s, photo}, s->height);
}
