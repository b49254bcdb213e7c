/* twin.h: the methods once more, in double precision and from their descriptions: nothing is
 * rounded but the place of a pixel, nothing is kept in a table. A twin of a picture holds the
 * passes of one lens setting. */
#ifndef RENDER_TWIN_H
#define RENDER_TWIN_H

#include "pictures.h"

enum { TWIN_TILE = 16 };

/* A pixel whose disparity is not the map's: see src/highlights/highlights.h. Which ones they
 * are is a property of the photo, not of the lens. */
struct twin_silhouette {
    int x, y, disparity;
};

struct twin {
    int width, height;
    const struct refocus_settings *params;
    double K, df;
    int unit; /* pixels: blurs of up to 127 pixels have bins and tolerances of one pixel, larger
                 ones coarser ones */
    const uint16_t *disparity;
    const struct twin_silhouette *silhouette;
    int silhouettes;
    double *light[3], *smooth[3], *background[3]; /* 0 to 1 */
    double *map_blur;                             /* signed blur in pixels, of the map alone */
    double *blur;                                 /* signed blur in pixels, with the silhouettes */
    double *background_blur;
};

/* The planes of a photo; all NaN or of the photo itself where a method has no use for them. */
void twin_create(struct twin *twin, const struct picture *picture,
                 const struct refocus_settings *params, const struct twin_silhouette *silhouette,
                 int silhouettes);
void twin_destroy(struct twin *twin);

/* The passes before the rays. */
void twin_prefilter(struct twin *twin);
void twin_background(struct twin *twin);

/* Pixel (x, y), the border repeated. */
static inline int twin_at(const struct twin *t, int x, int y)
{
    x = x < 0 ? 0 : x >= t->width ? t->width - 1 : x;
    y = y < 0 ? 0 : y >= t->height ? t->height - 1 : y;
    return y * t->width + x;
}

/* Where ray (u, v) of (x, y) hits blur s. */
static inline int twin_hit(const struct twin *t, int x, int y, struct refocus_ray ray, double s)
{
    return twin_at(t, x + (int)floor(ray.u / 32768.0 * s + 0.5),
                   y + (int)floor(ray.v / 32768.0 * s + 0.5));
}

/* Blurs in cells of 4 x 4 pixels, of whole tiles; `foreground` is the greatest of pixels whose
 * background has another. */
enum { TWIN_CELL = 4 };
struct twin_cell {
    double least, most, foreground;
};
struct twin_cells {
    int across, down;
    struct twin_cell *cell;
};
void twin_cells(const struct twin *twin, struct twin_cells *cells); /* cells->cell is to be freed */

/* Half a tile, or all of it, whose rays go the same way. */
struct twin_strip {
    int x, y, height;
};

/* Whether the background is taken for slab [low, high] where rays that are moved by (dx, dy) hit
 * it: in the cells around there nothing is deeper, the background shows it just so, and some is
 * nearer. */
bool twin_is_deepest(const struct twin *t, const struct twin_cells *cells, struct twin_strip strip,
                     int dx, int dy, double low, double high);

/* Weighted sums over the rays of a pixel, eq. 5. */
struct twin_sum {
    double light[3], weight;
};
void twin_add(const struct twin *t, struct twin_sum *sum, double *const light[3], int at,
              double share);
void twin_encode(const struct twin *t, const struct twin_sum *sum, uint8_t rgb[3]);

/* Codes to light and back, by the curve of the blend. */
double twin_to_light(uint32_t blend, double code);
double twin_to_code(uint32_t blend, double light);

/* The pictures. Ray sets are the library's. */
void twin_sweep(struct twin *twin, uint8_t *rgb);
void twin_search(struct twin *twin, uint8_t *rgb);

/* A list of rays; to be freed. */
struct refocus_ray *twin_rays(const struct refocus_aperture *aperture, int rays, double K,
                              int *count);

#endif
