/* things.c: draws bright things of known light, each pixel by the share that they cover, into test
 * pictures. */
#include "things.h"

bool is_in_thing(const struct thing *t, double x, double y)
{
    x = fabs(x) / (t->wide / 2);
    y = fabs(y) / (t->high / 2);
    return t->kind == ELLIPSE ? x * x + y * y < 1 : t->kind == BOX ? x < 1 && y < 1 : x + y < 1;
}

double share_of_thing(const struct thing *t, double x, double y)
{
    enum { FINE = 16 };
    int count = 0;

    for (int i = 0; i < FINE * FINE; i++)
        count += is_in_thing(t, x + (i % FINE + 0.5) / FINE, y + (double)(i / FINE + 0.5) / FINE);
    return count / (double)(FINE * FINE);
}

void draw_thing(struct picture *p, const struct thing *t, double cx, double cy)
{
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const double share = fabs(x - cx) > t->wide / 2 + 1 || fabs(y - cy) > t->high / 2 + 1
                                     ? 0
                                     : share_of_thing(t, x - cx, y - cy);

            for (int c = 0; c < 3 && share > 0; c++) {
                uint8_t *code = &p->rgb[3 * (y * p->width + x) + c];

                *code = picture_code(share * t->light[c] + (1 - share) * picture_light(*code));
            }
        }
}
