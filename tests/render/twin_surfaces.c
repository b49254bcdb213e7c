/* twin_surfaces.c: the level surfaces of a noisy map, in double precision. See
 * src/tiles/surfaces.c. */
#include "twin_surfaces.h"

static double blur_at(const struct twin *t, int x, int y)
{
    return t->map_blur[twin_at(t, x, y)];
}

/* How far a pixel is from the line through its neighbours, twice. */
static double off_line(const struct twin *t, int x, int y, int dx, int dy)
{
    return fabs(2 * blur_at(t, x, y) - blur_at(t, x - dx, y - dy) - blur_at(t, x + dx, y + dy));
}

bool twin_is_level(const struct twin *t, int tx, int ty, double noise, double spread,
                   double *middle)
{
    enum { EACH = TWIN_TILE / TWIN_CELL, INNER = TWIN_TILE - 2 };
    const int x0 = tx * TWIN_TILE, y0 = ty * TWIN_TILE;
    double mean[EACH * EACH] = {0}, least = 1e9, most = -1e9;
    int off = 0;

    for (int y = 1; y <= INNER; y++)
        for (int x = 1; x <= INNER; x++)
            off += off_line(t, x0 + x, y0 + y, 1, 0) > noise / 16 &&
                   off_line(t, x0 + x, y0 + y, 0, 1) > noise / 16;
    for (int y = 0; y < TWIN_TILE; y++)
        for (int x = 0; x < TWIN_TILE; x++)
            mean[y / TWIN_CELL * EACH + x / TWIN_CELL] +=
                blur_at(t, x0 + x, y0 + y) / (TWIN_CELL * TWIN_CELL);
    *middle = 0;
    for (int i = 0; i < EACH * EACH; i++) {
        *middle += mean[i] / (EACH * EACH);
        least = fmin(least, mean[i]);
        most = fmax(most, mean[i]);
    }
    return noise > 0 && spread <= 3 * noise && 4 * off >= 3 * INNER * INNER &&
           most - least <= fmax(fmax(1, 5 * noise / 8), fabs(*middle) / 8);
}

void twin_insert_surface(struct twin_surfaces *surfaces, const struct twin_surface *surface)
{
    int k = surfaces->count++;

    for (; k > 0 && surfaces->at[k - 1].middle > surface->middle; k--)
        surfaces->at[k] = surfaces->at[k - 1];
    surfaces->at[k] = *surface;
}

static void join(struct twin_surfaces *surfaces)
{
    int count = 0;

    for (int k = 0; k < surfaces->count; k++) {
        const struct twin_surface next = surfaces->at[k];
        struct twin_surface *const last = &surfaces->at[count ? count - 1 : 0];

        if (!count || next.middle - last->middle > fmax(next.noise, last->noise) / 2)
            surfaces->at[count++] = next;
        else if (next.own)
            *last = next;
    }
    surfaces->count = count;
}

static int clamped_bin(double width, double s)
{
    const int bin = twin_bin_of(width, s);

    return bin < 0 ? 0 : bin > TWIN_BINS ? TWIN_BINS : bin;
}

static bool has_any(const bool *has, int first, int end)
{
    for (int b = first; b < end; b++)
        if (has[b])
            return true;
    return false;
}

/* A side on which nothing is 2 to 5/2 of the noise away ends there, and others at 3/2. */
static void set_bins(struct twin_surface *surface, const struct twin_reach *reach)
{
    const double noise = fmin(surface->noise, reach->widest / 4), middle = surface->middle;
    const int near = clamped_bin(reach->width, middle - 2 * noise);
    const int far = clamped_bin(reach->width, middle + 2 * noise);

    surface->noise = noise;
    surface->first = near + 1;
    surface->end = far;
    if (has_any(reach->has, clamped_bin(reach->width, middle - 5 * noise / 2), near))
        surface->first = clamped_bin(reach->width, middle - 3 * noise / 2) + 1;
    if (has_any(reach->has, far, clamped_bin(reach->width, middle + 5 * noise / 2)))
        surface->end = clamped_bin(reach->width, middle + 3 * noise / 2);
}

void twin_settle_surfaces(struct twin_surfaces *surfaces, const struct twin_reach *reach)
{
    int count = 0;

    join(surfaces);
    for (int k = 0; k < surfaces->count; k++) {
        struct twin_surface *const surface = &surfaces->at[k];
        struct twin_surface *const before = &surfaces->at[k ? k - 1 : 0];

        set_bins(surface, reach);
        if (k > 0 && before->end > surface->first)
            before->end = surface->first =
                twin_bin_of(reach->width, (before->middle + surface->middle) / 2);
    }
    for (int k = 0; k < surfaces->count; k++) {
        const struct twin_surface surface = surfaces->at[k];

        if (surface.first < surface.end && !has_any(reach->sure, surface.first, surface.end))
            surfaces->at[count++] = surface;
    }
    surfaces->count = count;
}
