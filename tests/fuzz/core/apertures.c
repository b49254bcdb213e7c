/* apertures.c: the apertures of inputs. The tables of one take longer to make than a small picture
 * to render, so that the last ones are kept. */
#include "apertures.h"

enum { APERTURES = 16, KEPT = 3 * APERTURES + 1 }; /* apertures of each of three kinds, the disc */

static struct refocus_aperture_params take_opening(struct input *in, int wild)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();

    p.figure = (uint32_t)take_in(in, wild, 0, REFOCUS_FIGURE_COUNT - 1);
    p.blades = take_in(in, wild, 2, 16);
    if (p.blades == 2)
        p.blades = 0;
    p.rotation_deg = (double)take_fraction(in, wild, 360);
    p.curvature = p.figure ? 0 : (double)take_fraction(in, wild, 1);
    p.opening = p.figure ? 0 : (double)take_fraction(in, wild, 1);
    p.squeeze = 0.5 + (double)take_fraction(in, wild, 1.5f);
    p.hole = (double)take_fraction(in, wild, 0.9f);
    p.edge_behind = 1 - (double)take_fraction(in, wild, 2);
    p.edge_before = take(in, 1) & 1 ? p.edge_behind : -p.edge_behind;
    return p;
}

/* Puts the words of one of few apertures in place of those of an input, which choose it. */
static void choose(struct input *in, struct input *other, uint8_t words[40])
{
    uint32_t number = 0;

    for (int i = 0; i < 20; i++)
        number += take(in, 1);
    number %= APERTURES;
    for (int i = 0; i < 40; i++)
        words[i] = (uint8_t)((number = number * 1103515245 + 12345) >> 24);
    *other = (struct input){words, 40};
}

/* The words that an aperture is made of. */
struct shape {
    uint32_t kind;
    int32_t blades;
    double rotation;
    uint8_t mask[16];
    struct refocus_aperture_params params;
};

static int make_aperture(struct refocus_aperture **aperture, const struct shape *shape)
{
    switch (shape->kind) {
    case 1:
        return refocus_aperture_create_disc(aperture);
    case 2:
        return refocus_aperture_create_polygon(aperture, shape->blades, shape->rotation);
    case 3:
        return refocus_aperture_create_mask(aperture, shape->mask, 4, 4, 4);
    case 4:
        return refocus_aperture_create(aperture, &shape->params);
    default:
        return REFOCUS_OK;
    }
}

struct kept {
    struct shape shape;
    struct refocus_aperture *aperture;
};

const struct refocus_aperture *take_aperture(struct input *in, int wild, int few)
{
    static struct kept ring[2][KEPT];
    static int oldest[2];
    struct kept *kept = ring[few && !wild];
    struct shape shape;
    struct input other;
    uint8_t words[40];
    int status;

    memset(&shape, 0, sizeof shape);
    shape.kind = take(in, 1) % 5;
    if (shape.kind == 0) /* none, which would take the place of one that is kept */
        return NULL;
    if (few && !wild && shape.kind > 1) {
        choose(in, &other, words);
        in = &other;
    }
    if (shape.kind == 2) {
        shape.blades = take_in(in, wild, 3, 16);
        shape.rotation = (double)take_fraction(in, wild, 360);
    }
    for (int i = 0; i < 16 && shape.kind == 3; i++)
        shape.mask[i] = (uint8_t)take(in, 1);
    if (shape.kind == 4)
        shape.params = take_opening(in, wild);
    for (int i = 0; i < KEPT; i++)
        if (kept[i].aperture && memcmp(&kept[i].shape, &shape, sizeof shape) == 0)
            return kept[i].aperture;
    kept += oldest[few && !wild]++ % KEPT;
    refocus_aperture_destroy(&kept->aperture);
    kept->shape = shape;
    status = make_aperture(&kept->aperture, &shape);
    check(status == REFOCUS_OK || status == REFOCUS_ERR_ARGUMENT);
    check(status == REFOCUS_OK || !kept->aperture);
    return kept->aperture;
}
