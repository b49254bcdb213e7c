/* aperture.c: creates apertures: discs, polygons, masks, irises and figures. */
#include "aperture/aperture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/format.h"

const struct refocus_aperture rf_disc = {
    .id = 1, .shape = RF_SHAPE_DISC, .squeeze_x = 1, .squeeze_y = 1};

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

static int open_polygon(const struct refocus_aperture *a, double x, double y)
{
    for (int i = 0; i < a->blades; i++) {
        const int j = (i + 1) % a->blades;
        const double ex = a->corner_x[j] - a->corner_x[i];
        const double ey = a->corner_y[j] - a->corner_y[i];

        /* Corners run counter-clockwise as seen, so with y down the inside is where
         * the cross product is not positive. */
        if (ex * (y - a->corner_y[i]) - ey * (x - a->corner_x[i]) > 0)
            return 0;
    }
    return 255;
}

static int open_mask(const struct refocus_aperture *a, double x, double y)
{
    const int side = a->width > a->height ? a->width : a->height;
    const double px = x * side / 2 + a->width / 2.0;
    const double py = y * side / 2 + a->height / 2.0;

    if (px < 0 || py < 0 || px >= a->width || py >= a->height)
        return 0;
    return a->mask[(int)py * REFOCUS_MAX_APERTURE_SIDE + (int)px];
}

/* The light, 0 to 255, of a place that is open by `open` and whose rho^2 is `square`. */
static int lit(const struct refocus_aperture *a, int open, double square)
{
    if (rf_profile_is_even(&a->behind))
        return open;
    return (int)floor(open * rf_profile_density(&a->behind, square) + 0.5);
}

int rf_aperture_open(const struct refocus_aperture *a, double x, double y)
{
    double square;

    switch (a->shape) {
    case RF_SHAPE_DISC:
        return x * x + y * y <= 1 ? 255 : 0;
    case RF_SHAPE_POLYGON:
        return open_polygon(a, x, y);
    case RF_SHAPE_MASK:
        x /= a->squeeze_x;
        y /= a->squeeze_y;
        return lit(a, open_mask(a, x, y), x * x + y * y);
    case RF_SHAPE_OUTLINE:
        square = rf_outline_square(a, x / a->squeeze_x, -y / a->squeeze_y);
        return square <= 1 ? lit(a, 255, square) : 0;
    }
    return 0;
}

static uint64_t hash(uint64_t h, const void *bytes, size_t size)
{
    const uint8_t *byte = bytes;

    for (size_t i = 0; i < size; i++) /* FNV-1a */
        h = (h ^ byte[i]) * UINT64_C(0x100000001b3);
    return h;
}

static int create(struct refocus_aperture **aperture, enum rf_shape shape)
{
    *aperture = calloc(1, sizeof **aperture);
    if (!*aperture)
        return REFOCUS_ERR_MEMORY;
    (*aperture)->shape = shape;
    (*aperture)->squeeze_x = (*aperture)->squeeze_y = 1;
    (*aperture)->id = 1;
    return REFOCUS_OK;
}

int refocus_aperture_create_disc(struct refocus_aperture **aperture)
{
    return aperture ? create(aperture, RF_SHAPE_DISC) : REFOCUS_ERR_ARGUMENT;
}

int refocus_aperture_create_polygon(struct refocus_aperture **aperture, int blades,
                                    double rotation_deg)
{
    struct refocus_aperture *a;
    int status;

    if (!aperture)
        return REFOCUS_ERR_ARGUMENT;
    *aperture = NULL;
    if (blades < 3 || blades > 16 || !isfinite(rotation_deg))
        return REFOCUS_ERR_ARGUMENT;
    status = create(aperture, RF_SHAPE_POLYGON);
    if (status)
        return status;
    a = *aperture;
    a->blades = blades;
    rotation_deg = fmod(rotation_deg, 360);
    for (int i = 0; i < blades; i++) {
        double s, c;

        rf_sincos_turns(rotation_deg / 360 + (double)i / blades, &s, &c);
        a->corner_x[i] = c;
        a->corner_y[i] = -s; /* y down */
    }
    a->id = hash(2, a->corner_x, sizeof a->corner_x);
    a->id = hash(a->id, a->corner_y, sizeof a->corner_y);
    rf_chords_make(a);
    return REFOCUS_OK;
}

/* Reduces the mask to a grid of RF_CURVE_SIDE^2 cells: each is the mean of 8 x 8 points. */
static void reduce(struct refocus_aperture *a)
{
    for (int j = 0; j < RF_CURVE_SIDE; j++) {
        for (int i = 0; i < RF_CURVE_SIDE; i++) {
            int sum = 0;

            for (int v = 0; v < 8; v++)
                for (int u = 0; u < 8; u++)
                    sum += open_mask(a, (2 * i + (2 * u + 1) / 8.0) / RF_CURVE_SIDE - 1,
                                     (2 * j + (2 * v + 1) / 8.0) / RF_CURVE_SIDE - 1);
            a->reduced[j * RF_CURVE_SIDE + i] = (uint8_t)((sum + 32) / 64);
        }
    }
}

int refocus_aperture_create_mask(struct refocus_aperture **aperture, const uint8_t *mask, int width,
                                 int height, ptrdiff_t stride)
{
    struct refocus_aperture *a;
    int status, any = 0;

    if (!aperture)
        return REFOCUS_ERR_ARGUMENT;
    *aperture = NULL;
    if (!mask || width < 1 || height < 1 || width > REFOCUS_MAX_APERTURE_SIDE ||
        height > REFOCUS_MAX_APERTURE_SIDE || !rf_good_stride(stride, width, height))
        return REFOCUS_ERR_ARGUMENT;
    status = create(aperture, RF_SHAPE_MASK);
    if (status)
        return status;
    a = *aperture;
    a->width = width;
    a->height = height;
    for (int y = 0; y < height; y++)
        memcpy(a->mask + y * REFOCUS_MAX_APERTURE_SIDE, mask + y * stride, (size_t)width);
    reduce(a);
    for (int i = 0; i < RF_CURVE_SIDE * RF_CURVE_SIDE; i++)
        any |= a->reduced[i];
    if (!any) {
        refocus_aperture_destroy(aperture);
        return REFOCUS_ERR_ARGUMENT;
    }
    a->id = hash(3, a->mask, sizeof a->mask);
    a->id = hash(a->id, &width, sizeof width);
    a->id = hash(a->id, &height, sizeof height);
    return REFOCUS_OK;
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
    a->id = hash(a->id, &p->squeeze, sizeof p->squeeze);
    a->id = hash(a->id, &p->hole, sizeof p->hole);
    a->id = hash(a->id, &p->edge_behind, sizeof p->edge_behind);
    a->id = hash(a->id, &p->edge_before, sizeof p->edge_before);
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
        status = create(aperture, RF_SHAPE_OUTLINE);
        if (status == REFOCUS_OK) {
            rf_outline_make(*aperture, p);
            (*aperture)->figure = p->figure != REFOCUS_FIGURE_NONE;
            (*aperture)->id = hash(4, (*aperture)->vertex_x, sizeof(*aperture)->vertex_x);
            (*aperture)->id =
                hash((*aperture)->id, (*aperture)->vertex_y, sizeof(*aperture)->vertex_y);
        }
    }
    if (status == REFOCUS_OK && !is_simple(p))
        add_profiles(*aperture, p);
    if (status == REFOCUS_OK)
        rf_chords_make(*aperture);
    return status;
}

void refocus_aperture_destroy(struct refocus_aperture **aperture)
{
    if (!aperture)
        return;
    free(*aperture);
    *aperture = NULL;
}
