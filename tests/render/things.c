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

void draw_skirt(struct picture *p, double cx, double cy, double area, const double light[3],
                double share)
{
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const double away = hypot(x - cx, y - cy) / 2;
            const double skirt = share * area / (12 * pow(1 + away * away, 1.5));

            for (int c = 0; c < 3; c++) {
                uint8_t *code = &p->rgb[3 * (y * p->width + x) + c];

                *code = picture_code(picture_light(*code) + skirt * light[c]);
            }
        }
}

struct picture night(uint32_t seed, int w, int h)
{
    struct picture p = picture_make(w, h, seed);

    for (int i = 0; i < 3 * w * h; i++)
        p.rgb[i] /= 5;
    for (int i = 0; i < 150; i++) {
        struct thing t = {.light = {8, 8, 8}};
        double x, y;

        seed = seed * 1664525 + 1013904223;
        t.kind = seed >> 8 & 1 ? ELLIPSE : seed >> 9 & 1 ? BOX : DIAMOND;
        t.wide = 1 + (seed >> 10 & 15);
        t.high = (seed >> 14 & 7) == 0 ? 70 : 1 + (seed >> 17 & 31);
        t.light[seed >> 22 & 1] = 0.6;
        seed = seed * 1664525 + 1013904223;
        x = (double)((seed >> 8) % (uint32_t)w);
        y = (double)((seed >> 18) % (uint32_t)h);
        draw_thing(&p, &t, x, y);
    }
    return p;
}
