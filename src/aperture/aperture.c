#include "aperture/aperture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct refocus_aperture rf_disc = {.id = 1, .shape = RF_SHAPE_DISC};

void rf_sincos_turns(double turns, double *sine, double *cosine)
{
    const double pi = 3.14159265358979323846;
    const double quarters = floor(turns * 4 + 0.5);
    const double x = (turns * 4 - quarters) * (pi / 2); /* -pi/4 .. pi/4 */
    const double xx = x * x;
    const double s = x * (1 - xx / 6 * (1 - xx / 20 * (1 - xx / 42 * (1 - xx / 72 *
                     (1 - xx / 110 * (1 - xx / 156))))));
    const double c = 1 - xx / 2 * (1 - xx / 12 * (1 - xx / 30 * (1 - xx / 56 *
                     (1 - xx / 90 * (1 - xx / 132)))));
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

int rf_aperture_open(const struct refocus_aperture *aperture, double x, double y)
{
    switch (aperture->shape) {
    case RF_SHAPE_DISC:
        return x * x + y * y <= 1 ? 255 : 0;
    case RF_SHAPE_POLYGON:
        return open_polygon(aperture, x, y);
    case RF_SHAPE_MASK:
        return open_mask(aperture, x, y);
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
    return REFOCUS_OK;
}

/* Mean of the mask over each cell of a RF_CURVE_SIDE^2 grid, of 8 x 8 points a cell. */
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

int refocus_aperture_create_mask(struct refocus_aperture **aperture, const uint8_t *mask,
                                 int width, int height, ptrdiff_t stride)
{
    struct refocus_aperture *a;
    int status, any = 0;

    if (!aperture)
        return REFOCUS_ERR_ARGUMENT;
    *aperture = NULL;
    if (!mask || width < 1 || height < 1 || width > REFOCUS_MAX_APERTURE_SIDE ||
        height > REFOCUS_MAX_APERTURE_SIDE ||
        (height > 1 && stride < width && stride > -width))
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

void refocus_aperture_destroy(struct refocus_aperture **aperture)
{
    if (!aperture)
        return;
    free(*aperture);
    *aperture = NULL;
}
