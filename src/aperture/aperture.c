/* aperture.c: creates apertures: discs, polygons, masks, irises and figures. */
#include "aperture/aperture.h"
#include "aperture/shape.h"

#include <math.h>
#include <stdlib.h>

void rf_sincos_turns(double turns, double *sine, double *cosine)
{
    const double pi = 3.14159265358979323846;
    const double quarters = floor(turns * 4 + 0.5);
    const double x = (turns * 4 - quarters) * (pi / 2); /* -pi/4 .. pi/4 */
    const double xx = x * x;
    const double s =
        x *
        (1 -
         xx / 6 * (1 - xx / 20 * (1 - xx / 42 * (1 - xx / 72 * (1 - xx / 110 * (1 - xx / 156))))));
    const double c =
        1 - xx / 2 * (1 - xx / 12 * (1 - xx / 30 * (1 - xx / 56 * (1 - xx / 90 * (1 - xx / 132)))));
    const int quarter = (int)(quarters - 4 * floor(quarters / 4));

    *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
    *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
}

uint64_t rf_shape_hash(uint64_t h, const void *bytes, size_t size)
{
    const uint8_t *byte = bytes;

    for (size_t i = 0; i < size; i++) /* FNV-1a */
        h = (h ^ byte[i]) * UINT64_C(0x100000001b3);
    return h;
}

int rf_shape_create(struct refocus_aperture **aperture, const struct rf_shape *shape)
{
    struct {
        struct refocus_aperture aperture;
        struct rf_aperture_tables tables;
    } *block = calloc(1, sizeof *block);

    *aperture = NULL;
    if (!block)
        return REFOCUS_ERR_MEMORY;
    *aperture = &block->aperture;
    (*aperture)->tables = &block->tables;
    (*aperture)->shape = shape;
    (*aperture)->squeeze_x = (*aperture)->squeeze_y = 1;
    (*aperture)->id = 1;
    return REFOCUS_OK;
}

int rf_shape_light(const struct refocus_aperture *a, int open, double square)
{
    if (rf_profile_is_even(&a->behind))
        return open;
    return (int)floor(open * rf_profile_density(&a->behind, square) + 0.5);
}

int rf_aperture_open(const struct refocus_aperture *a, double x, double y)
{
    return a->shape->open(a, x, y);
}

bool rf_aperture_is_fine(const struct refocus_aperture *a)
{
    return a->shape->is_fine || a->figure || a->behind.hole > 0 || a->before.hole > 0 ||
           a->behind.edge > 0 || a->before.edge > 0;
}

bool rf_aperture_fills_square(const struct refocus_aperture *a)
{
    return a->shape->fills_square;
}

static bool in(double value, double least, double most)
{
    return value >= least && value <= most; /* NaN is in no range */
}

static bool good_params(const struct refocus_aperture_params *p)
{
    const bool iris = p->curvature != 0 || p->opening != 0;

    return p->reserved == 0 && (p->blades == 0 || (p->blades >= 3 && p->blades <= 16)) &&
           in(p->rotation_deg, -3600, 3600) && in(p->curvature, 0, 1) && in(p->opening, 0, 1) &&
           in(p->squeeze, 0.5, 2) && in(p->hole, 0, 0.9) && in(p->edge_behind, -1, 1) &&
           in(p->edge_before, -1, 1) && p->figure < REFOCUS_FIGURE_COUNT && !(p->figure && iris) &&
           !(p->mask && (p->figure || p->blades || p->rotation_deg != 0 || iris));
}

/* Whether light is spread evenly over a shape that is not squeezed. */
static bool is_simple(const struct refocus_aperture_params *p)
{
    return p->squeeze == 1 && p->hole == 0 && p->edge_behind == 0 && p->edge_before == 0;
}

/* Adds everything else that rays depend on beside the outline: squeeze, hole and edges. */
static void add_profiles(struct refocus_aperture *a, const struct refocus_aperture_params *p)
{
    a->squeeze_x = p->squeeze < 1 ? p->squeeze : 1;
    a->squeeze_y = p->squeeze > 1 ? 1 / p->squeeze : 1;
    a->behind = (struct rf_profile){p->hole, p->edge_behind};
    a->before = (struct rf_profile){p->hole, p->edge_before};
    a->id = rf_shape_hash(a->id, &p->squeeze, sizeof p->squeeze);
    a->id = rf_shape_hash(a->id, &p->hole, sizeof p->hole);
    a->id = rf_shape_hash(a->id, &p->edge_behind, sizeof p->edge_behind);
    a->id = rf_shape_hash(a->id, &p->edge_before, sizeof p->edge_before);
}

int refocus_aperture_create(struct refocus_aperture **aperture,
                            const struct refocus_aperture_params *params)
{
    struct refocus_aperture_params own;
    const struct refocus_aperture_params *const p = &own;
    int status;

    if (!aperture)
        return REFOCUS_ERR_ARGUMENT;
    *aperture = NULL;
    status = refocus_struct_read(
        &own, sizeof own, REFOCUS_SIZE_TO(struct refocus_aperture_params, mask_stride), params);
    if (status)
        return status;
    if (!good_params(p))
        return REFOCUS_ERR_ARGUMENT;
    if (p->mask) {
        status = refocus_aperture_create_mask(aperture, p->mask, p->mask_width, p->mask_height,
                                              p->mask_stride);
    } else if (is_simple(p) && !p->figure && (p->blades == 0 || p->opening == 1)) {
        return refocus_aperture_create_disc(aperture);
    } else if (is_simple(p) && !p->figure && p->curvature == 0 && p->opening == 0) {
        return refocus_aperture_create_polygon(aperture, p->blades, p->rotation_deg);
    } else {
        status = rf_outline_create(aperture, p);
    }
    if (status == REFOCUS_OK && !is_simple(p))
        add_profiles(*aperture, p);
    if (status == REFOCUS_OK)
        rf_chords_make(*aperture);
    if (status == REFOCUS_OK)
        rf_summed_light_make(*aperture);
    return status;
}

void refocus_aperture_destroy(struct refocus_aperture **aperture)
{
    if (!aperture)
        return;
    free(*aperture);
    *aperture = NULL;
}
