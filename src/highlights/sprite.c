/* sprite.c: the shape and the light of the sprites that highlights are drawn as. */
#include "highlights/sprite.h"

#include <assert.h>
#include <math.h>

#include "aperture/aperture.h"
#include "highlights/ramp.h"
#include "highlights/known.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum {
    BLURRED = 128,  /* Q7.8: a splatted highlight begins to have its light at this blur */
    WHOLLY = 384,   /* Q7.8: it has all of its light from this blur on */
    HEIGHTS = 64,   /* at which the area of a cut aperture is measured */
    STEPS = 8,      /* by which that of a cut circle is */
    FAINT = 128,    /* light of a run below this is rounded to 1/256 */
    MOST_TIMES = 8, /* a sprite is drawn so often at the most: means saturate before */
    SMALL = 1024,   /* Q7.8: the area of discs is that of their chords up to here */
};

/* The place of a run, in half pixels from the middle of the photo, and the two circles that a lens
 * leaves of the aperture there (aperture/cat_eye.h): how far one of them is pushed, in radii. */
struct cut {
    const struct refocus_aperture *aperture;
    bool cuts;
    double x, y;
};

static struct cut cut_at(const struct rf_visibility *tile, const struct rf_splat_run *run)
{
    const struct rf_splat *splat = tile->splat;
    const struct rf_viewport *view = splat->window.view;
    const double w = view->photo_width, h = view->photo_height;
    const double x =
        2 * (view->x0 + tile->tx * RF_TILE) + 1 - w + (run->from + run->to) * (1.0 / RF_SPLAT_UNIT);
    const double y = 2 * (view->y0 + tile->ty * RF_TILE) + 1 - h + run->middle;
    const double each = (double)splat->cat_eye * sqrt(x * x + y * y) / (w * w + h * h);

    return (struct cut){splat->aperture, splat->cat_eye > 0, each * x, each * y};
}

static double half_chord(double height)
{
    return height * height < 1 ? sqrt(1 - height * height) : 0;
}

/* Leaves of a chord what is within both circles. */
static void cut_chord(const struct cut *cut, double height, double ends[2])
{
    const double wide = cut->aperture->squeeze_x, y = height / cut->aperture->squeeze_y;
    const double out = half_chord(y - cut->y), in = half_chord(y + cut->y);
    double from = cut->x - out > -cut->x - in ? cut->x - out : -cut->x - in;
    double to = cut->x + out < -cut->x + in ? cut->x + out : -cut->x + in;

    if (from > to)
        from = to = (from + to) / 2;
    for (int k = 0; k < 2; k++)
        ends[k] = ends[k] < from * wide ? from * wide : ends[k] > to * wide ? to * wide : ends[k];
}

/* Where a chord begins and ends at a height, in parts of the radius. */
static void chord_at(const struct cut *cut, int set, double height, double ends[2])
{
    if (rf_aperture_is_disc(cut->aperture)) {
        ends[0] = -1; /* the circles lie within it */
        ends[1] = 1;
    } else {
        int16_t(*const chord)[2] = cut->aperture->tables->chord[set];
        const double at = (height + 1) * (RF_CHORDS / 2);
        const int row = (int)floor(at);

        for (int k = 0; k < 2; k++)
            ends[k] = row < 0 || row >= RF_CHORDS
                          ? 0
                          : (chord[row][k] + (at - row) * (chord[row + 1][k] - chord[row][k])) *
                                (1.0 / 16384);
    }
    if (cut->cuts)
        cut_chord(cut, height, ends);
}

/* How many chords a row of the aperture may have. */
static int chord_sets(const struct refocus_aperture *a)
{
    return rf_aperture_is_disc(a) || !a->chord_sets ? 1 : a->chord_sets;
}

/* The area of the aperture for a radius of 1. */
static double area_of(const struct cut *cut, const struct rf_summed_side *summed)
{
    const double pi = 3.14159265358979;
    const struct refocus_aperture *a = cut->aperture;
    const double d = sqrt(cut->x * cut->x + cut->y * cut->y) / STEPS;
    double sum = 0;

    if (summed) { /* were it as bright all over as where it is brightest */
        const int side = a->summed->side;

        return 4.0 * summed->before[side][side] / ((double)summed->most * side * side) *
               a->squeeze_x * a->squeeze_y;
    }
    if (!cut->cuts)
        return rf_aperture_is_disc(a) ? pi : a->chord_area;
    if (rf_aperture_is_disc(a)) { /* pi less 4 half chords along d, by Simpson's rule */
        for (int i = 0; i <= STEPS; i++)
            sum += half_chord(i * d) * (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2);
        return pi - 4 * sum * d / 3;
    }
    for (int i = 0; i < HEIGHTS; i++)
        for (int set = 0; set < chord_sets(a); set++) {
            double ends[2];

            chord_at(cut, set, (2 * i + 1) * (1.0 / HEIGHTS) - 1, ends);
            sum += ends[1] - ends[0];
        }
    return sum * (2.0 / HEIGHTS);
}

/* The area that chords of a small disc cover in pixels: rows have the mean of those a quarter of a
 * pixel above and below their middle (kernels/discs.h), which add up to less or more than it has.
 */
static double area_of_chords(double radius)
{
    double sum = 0;

    for (int i = 0; 0.5 * i + 0.25 < radius; i++) {
        const double y = 0.5 * i + 0.25;

        sum += 2 * sqrt(radius * radius - y * y);
    }
    return sum;
}

/* The area of a run's sprite in pixels. */
static double area_in_pixels(const struct cut *cut, const struct rf_summed_side *summed,
                             const struct rf_splat_run *run)
{
    const double radius = run->radius / 256.0;

    return run->radius < SMALL && rf_aperture_is_disc(cut->aperture) && !cut->cuts
               ? area_of_chords(radius)
               : area_of(cut, summed) * radius * radius;
}

int rf_sprite_layers(const struct rf_splat *splat)
{
    return chord_sets(splat->aperture) * (splat->fringe != 0 ? 2 : 1);
}

/* Part that the radius is shorter by on a side of the focus, Q8 (gather/tile_rays.c). */
static int shorter(const struct rf_splat *splat, bool green, bool before)
{
    if (splat->fringe == 0 || ((splat->fringe > 0) != before) == green)
        return 0;
    return (int)floor(fabs((double)splat->fringe) * 256 + 0.5);
}

static bool is_green(const struct rf_splat *splat, const struct rf_splat_run *run)
{
    return run->layer >= chord_sets(splat->aperture);
}

void rf_sprite_set_layer(struct rf_splat_run *run, const struct rf_splat *splat, int layer)
{
    const bool before = run->blur < 0;
    const int size = before ? -run->blur : run->blur;
    int own, other;

    run->layer = layer;
    own = shorter(splat, is_green(splat, run), before);
    other = shorter(splat, is_green(splat, run), !before);
    run->radius = size - size * own / 256;
    run->across = (256.0 - other) / (256.0 - own);
}

/* The unit of lengths of a disc: place and chord of a run fit 16 bits (kernels/discs.h). */
static int unit_of(const struct rf_splat_run *run)
{
    const int radius = run->radius >> 8;

    static_assert(RF_SPLAT_UNIT / 2 * (2 * (479 + RF_TILE + RF_HIGHLIGHT_RUN)) <= INT16_MAX &&
                      RF_SPLAT_UNIT / 4 *
                              (2 * (REFOCUS_MAX_BLUR_RADIUS + 3 + RF_TILE + RF_HIGHLIGHT_RUN)) <=
                          INT16_MAX,
                  "the place of a run and a chord");
    return radius <= 223 ? 0 : radius <= 479 ? 1 : RF_DISC_MOST_UNIT;
}

static void set_channels(struct rf_sprite *sprite, const struct rf_splat *splat,
                         const struct rf_splat_run *run)
{
    const bool fringed = splat->fringe != 0, green = fringed && is_green(splat, run);

    sprite->job.planes = !fringed ? 3 : green ? 1 : 2;
    for (int p = 0; p < sprite->job.planes; p++)
        sprite->channel[p] = !fringed ? p : green ? 1 : 2 * p;
}

/* How much of its light a run has, Q8. What a photo holds above white is in focus, too, where
 * pixels have their own light; what was estimated is not. */
static int part_of_light(const struct rf_splat *splat, int blur)
{
    return splat->window.known ? blur < RF_KNOWN_FROM ? 0 : 256 : rf_ramp(blur, BLURRED, WHOLLY);
}

/* Sets the light of each pixel of the run that a pixel sees whole, Q14, times 2^(15 - shift) /
 * RF_SPLAT_UNIT: all of it, over the aperture's area. Returns whether there is any. */
static bool set_light(struct rf_sprite *sprite, const struct rf_splat *splat,
                      const struct rf_splat_run *run, double area, double each[3])
{
    struct rf_disc_job *const job = &sprite->job;
    const int blurred = part_of_light(splat, run->blur < 0 ? -run->blur : run->blur);
    const int seen = (run->to - run->from) >> job->unit;
    bool any = false;

    static_assert(RF_SPLAT_UNIT << 8 <= 1 << 14, "the length of one pixel, shifted");
    static_assert(RF_SPLAT_UNIT * RF_HIGHLIGHT_RUN << 4 <= 1 << 14, "that of the longest run");
    job->shift = 8 + job->unit;
    for (int length = RF_SPLAT_UNIT >> job->unit; length < seen; length *= 2)
        job->shift--;
    for (int p = 0; p < job->planes; p++) {
        sprite->whole[p] = run->light[sprite->channel[p]] * (4.0 * blurred / 65536);
        each[p] = sprite->whole[p] / area * (double)(1 << (15 - job->shift)) / seen;
        sprite->faint[p] = each[p] < FAINT - 1;
        each[p] *= sprite->faint[p] ? 256 : 1;
        sprite->whole[p] *= sprite->faint[p] ? 256 : 1;
        any = any || each[p] >= 0.5;
    }
    return any;
}

/* Stores that light in 16 bits. Where known light exceeds these, lengths are shifted by more bits,
 * as far as the longest part of the run that a pixel sees lets them, and the sprite is drawn more
 * often. Estimated light stays at that: it is that of large highlights, hardly blurred, whose edges
 * would be too wide by it (.8 dB at nightlights, K = 10). */
static void store_light(struct rf_sprite *sprite, const double each[3], bool known)
{
    struct rf_disc_job *const job = &sprite->job;
    double most = 0, scale = 1;
    int longest = 1;

    for (int p = 0; known && p < job->planes; p++)
        most = each[p] > most ? each[p] : most;
    for (int y = job->first; y < job->end && most > INT16_MAX; y++) {
        const int wide = rf_smaller(job->right[y] - job->left[y], job->to - job->from);

        longest = rf_larger(longest, wide);
    }
    while (most * scale > INT16_MAX && longest << (job->shift + 1) <= INT16_MAX) {
        job->shift++;
        scale /= 2;
    }
    sprite->times = 1;
    while (most * scale > (double)INT16_MAX * sprite->times && sprite->times < MOST_TIMES)
        sprite->times++;
    for (int p = 0; p < job->planes; p++) {
        const double light = each[p] * scale / sprite->times + 0.5;

        job->each[p] = (int16_t)(light < INT16_MAX ? light : INT16_MAX);
        sprite->most[p] = job->each[p] + 1;
    }
}

/* Sets the chord of each row. A disc's rows are as wide to both sides. Behind the focus an iris is
 * seen as it is, and pixels see through it to the other side; before it the other way round. Chords
 * are means, as those of kernels->half_chords. */
static void set_chords(struct rf_disc_job *job, const struct rf_splat *splat, const struct cut *cut,
                       const struct rf_splat_run *run)
{
    const int sets = chord_sets(splat->aperture),
              radius = run->blur < 0 ? -run->radius : run->radius;
    double chord[2 * (RF_TILE - 1 + RF_HIGHLIGHT_STACK)][2];
    const double unit = radius * ((RF_SPLAT_UNIT >> job->unit) / (2 * 256.0)) / run->rows;

    if (rf_aperture_is_disc(splat->aperture) && !cut->cuts) {
        splat->exec->kernels->half_chords(job->right, run->radius, -run->middle, run->rows,
                                          job->unit);
        for (int y = 0; y < RF_TILE; y++)
            job->left[y] = (int16_t)-job->right[y];
        return;
    }
    /* Rows of the tile see the run through heights half a pixel apart. */
    for (int i = 0; i < 2 * (RF_TILE - 1 + run->rows); i++)
        chord_at(cut, run->layer % sets,
                 256 * ((i - run->rows - run->middle) * 0.5 + 0.25) / radius, chord[i]);
    for (int y = 0; y < RF_TILE; y++) {
        double first = 0, last = 0;

        for (int k = 2 * y; k < 2 * (y + run->rows); k++) {
            first -= unit * chord[k][1];
            last -= unit * chord[k][0];
        }
        job->left[y] = (int16_t)floor((first < last ? first : last) + 0.5);
        job->right[y] = (int16_t)floor((first < last ? last : first) + 0.5);
    }
}

bool rf_sprite_reaches(const struct rf_splat_run *run)
{
    const int far = run->radius / 256 + run->rows;
    const int y = run->middle >> 1;

    return run->radius != 0 && run->from - RF_SPLAT_UNIT * far < RF_SPLAT_UNIT * RF_TILE &&
           run->to + RF_SPLAT_UNIT * far > 0 && y - far < RF_TILE && y + far >= 0;
}

bool rf_sprite_make(struct rf_sprite *sprite, const struct rf_visibility *tile,
                    const struct rf_splat_run *run)
{
    const struct rf_splat *splat = tile->splat;
    const struct refocus_aperture *const a = splat->aperture;
    struct rf_disc_job *const job = &sprite->job;
    struct cut cut;
    double each[3];

    if (!rf_sprite_reaches(run))
        return false;
    *job = (struct rf_disc_job){.unit = unit_of(run)};
    sprite->summed = !a->summed                                  ? NULL
                     : run->blur < 0 && rf_aperture_has_sides(a) ? &a->summed->in_front
                                                                 : &a->summed->behind;
    set_channels(sprite, splat, run);
    cut = cut_at(tile, run);
    if (!set_light(sprite, splat, run, area_in_pixels(&cut, sprite->summed, run), each))
        return false;
    if (sprite->summed)
        rf_sprite_set_extent(sprite, splat, run);
    else
        set_chords(job, splat, &cut, run);
    job->end = RF_TILE;
    while (job->first < RF_TILE && job->left[job->first] == job->right[job->first])
        job->first++;
    while (job->end > job->first && job->left[job->end - 1] == job->right[job->end - 1])
        job->end--;
    job->from = (int16_t)(run->from >> job->unit);
    job->to = (int16_t)(job->from + ((run->to - run->from) >> job->unit));
    store_light(sprite, each, splat->window.known != NULL);
    return job->first < job->end;
}
