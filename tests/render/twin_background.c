/* twin_background.c: the hidden background in double precision; see src/background/mark.h. */
#include "twin.h"

/* Rows from one end to the other: a step straight costs half a pixel of blur, one
 * diagonally half of sqrt 2. */
static void dilate_rows(const struct twin *t, double *most, int from, int step)
{
    for (int i = 0; i < t->height; i++) {
        const int y = from + i * step;

        for (int x = 0; x < t->width; x++) {
            double *m = &most[y * t->width + x];

            *m = t->blur[y * t->width + x];
            for (int dx = -1; i > 0 && dx <= 1; dx++)
                if (x + dx >= 0 && x + dx < t->width)
                    *m = fmax(*m, most[(y - step) * t->width + x + dx] - (dx ? sqrt(2) / 2 : 0.5));
        }
    }
}

/* Unknown pixels are those that something farther could be seen through: NaN. */
static void mark(struct twin *t)
{
    const size_t bytes = (size_t)t->width * (size_t)t->height * sizeof(double);
    double *down = malloc(bytes), *up = malloc(bytes);

    assert_true(down && up);
    dilate_rows(t, down, 0, 1);
    dilate_rows(t, up, t->height - 1, -1);
    for (int y = 0; y < t->height; y++) {
        for (int x = 0; x < t->width; x++) {
            const int p = y * t->width + x;
            bool foreground = false;

            for (int q = 0; q < t->width && !foreground; q++)
                foreground = fmax(down[y * t->width + q], up[y * t->width + q]) >
                             t->blur[p] + abs(q - x) / 2.0;
            t->background_blur[p] = foreground ? NAN : t->blur[p];
            for (int c = 0; c < 3; c++)
                t->background[c][p] = t->smooth[c][p];
        }
    }
    free(down);
    free(up);
}

struct place {
    int x, y;
};

/* The pixel some steps away; beyond the picture, the nearest one of it. */
static int pixel(const struct twin *t, struct place p, struct place step, int steps)
{
    const int x = p.x + steps * step.x, y = p.y + steps * step.y;

    return (y < 0           ? 0
            : y < t->height ? y
                            : t->height - 1) *
               t->width +
           (x < 0          ? 0
            : x < t->width ? x
                           : t->width - 1);
}

/* Whether pixel b is far before blur `a`, and farther out of focus. */
static bool hides(const struct twin *t, double a, int b)
{
    return a - t->blur[b] > 4 && a + t->blur[b] < 0;
}

static double distance(const struct twin *t, int a, int b)
{
    double sum = 0;

    for (int c = 0; c < 3; c++)
        sum += fabs(t->smooth[c][a] - t->smooth[c][b]);
    return sum;
}

/* Counts the pixels around that hide blur s. */
static int sides(const struct twin *t, struct place p, double s)
{
    int count = 0;

    for (int i = 0; i < 9; i++)
        count += hides(t, s, pixel(t, p, (struct place){i % 3 - 1, i / 3 - 1}, 1));
    return count;
}

/* Whether p is mixed with the surface that lies a step from it. */
static bool is_mixed(const struct twin *t, struct place at, struct place step)
{
    const int p = pixel(t, at, step, 0), f = pixel(t, at, step, 1);
    const int a = pixel(t, at, step, -1), b = pixel(t, at, step, -2);
    const struct place out = {at.x - 2 * step.x, at.y - 2 * step.y};
    const double s = t->blur[p];

    if (out.x < 0 || out.x >= t->width || out.y < 0 || out.y >= t->height || !hides(t, s, f) ||
        !hides(t, s, pixel(t, at, step, 2)) || t->blur[a] < s || t->blur[a] > s + 4 ||
        t->blur[b] < s || t->blur[b] > s + 4 || sides(t, out, s))
        return false;
    return distance(t, p, a) > 4 * distance(t, a, b) &&
           distance(t, p, a) + distance(t, p, f) <= 1.125 * distance(t, a, f);
}

/* Mixtures of the background and a surface before it are unknown, too. */
static void mark_mixed(struct twin *t)
{
    for (int p = 0; p < t->width * t->height; p++) {
        const struct place at = {p % t->width, p / t->width};
        int mixed = 0;

        for (int i = 0; i < 9; i++)
            mixed += is_mixed(t, at, (struct place){i % 3 - 1, i / 3 - 1});
        if (mixed && 2 * mixed >= sides(t, at, t->blur[p]))
            t->background_blur[p] = NAN;
    }
}

/* A level of the pyramid: planes of light, and blur in the fourth. */
struct level {
    int width, height;
    double *plane[4];
    bool *inpainted; /* none of it is known; NULL in level 0 */
};

static struct level coarser(const struct level *fine)
{
    struct level coarse = {(fine->width + 1) / 2, (fine->height + 1) / 2, {0}, NULL};

    coarse.inpainted = calloc((size_t)coarse.width * (size_t)coarse.height, sizeof(bool));
    assert_non_null(coarse.inpainted);
    for (int c = 0; c < 4; c++) {
        coarse.plane[c] = malloc((size_t)coarse.width * (size_t)coarse.height * sizeof(double));
        assert_non_null(coarse.plane[c]);
    }
    return coarse;
}

/* The children of a parent that are in the picture. Returns their number. */
static int children(const struct level *fine, const struct level *coarse, int parent, int child[4])
{
    int n = 0;

    for (int j = 0; j < 4; j++) {
        const int x = parent % coarse->width * 2 + j % 2, y = parent / coarse->width * 2 + j / 2;

        if (x < fine->width && y < fine->height)
            child[n++] = y * fine->width + x;
    }
    return n;
}

/* Parents: the farthest blur of known children, and the mean of the light of those that are not
 * far in front of it. */
static void push(const struct level *fine, struct level *coarse, double apart)
{
    for (int i = 0; i < coarse->width * coarse->height; i++) {
        double sum[3] = {0}, farthest = NAN;
        int child[4], count = 0;
        const int n = children(fine, coarse, i, child);

        for (int j = 0; j < n; j++)
            farthest = fmax(farthest, fine->plane[3][child[j]]);
        for (int j = 0; j < n; j++) {
            if (isnan(fine->plane[3][child[j]]) || farthest - fine->plane[3][child[j]] > apart)
                continue;
            count++;
            for (int c = 0; c < 3; c++)
                sum[c] += fine->plane[c][child[j]];
        }
        for (int c = 0; c < 3; c++)
            coarse->plane[c][i] = sum[c] / count;
        coarse->plane[3][i] = farthest;
    }
}

/* The parent beside the own one, on the child's side. */
static int beside(int child, int parents)
{
    const int other = child % 2 ? child / 2 + 1 : child / 2 - 1;

    return other < 0 || other >= parents ? child / 2 : other;
}

/* Light and blur of two parents, 3 and 1 quarters of the light; the deeper one's alone, unless the
 * other one is inpainted, and its blur, where they are more than a quarter of the largest blur
 * apart. */
struct parents {
    double light[3], blur;
    bool inpainted;
};

static struct parents mix(struct parents near, struct parents far, double apart)
{
    struct parents mixed = far.blur - near.blur > apart ? far : near;

    if (near.blur - far.blur > apart && !far.inpainted)
        return near;
    if (far.blur - near.blur > apart && !near.inpainted)
        return far;
    for (int c = 0; c < 3; c++)
        mixed.light[c] = (3 * near.light[c] + far.light[c]) / 4;
    return mixed;
}

static struct parents parent(const struct level *coarse, int x, int y)
{
    const int p = y * coarse->width + x;

    return (struct parents){{coarse->plane[0][p], coarse->plane[1][p], coarse->plane[2][p]},
                            coarse->plane[3][p],
                            coarse->inpainted[p]};
}

/* Unknown children: of the four nearest parents, down and then across. */
static void pull(struct level *fine, const struct level *coarse, double apart)
{
    for (int y = 0; y < fine->height; y++) {
        for (int x = 0; x < fine->width; x++) {
            const int p = y * fine->width + x;
            const int x0 = x / 2, x1 = beside(x, coarse->width);
            const int y0 = y / 2, y1 = beside(y, coarse->height);
            struct parents both;

            if (!isnan(fine->plane[3][p]))
                continue;
            both = mix(mix(parent(coarse, x0, y0), parent(coarse, x0, y1), apart),
                       mix(parent(coarse, x1, y0), parent(coarse, x1, y1), apart), apart);
            for (int c = 0; c < 3; c++)
                fine->plane[c][p] = both.light[c];
            fine->plane[3][p] = both.blur;
            if (fine->inpainted)
                fine->inpainted[p] = true;
        }
    }
}

void twin_background(struct twin *t)
{
    struct level level[32] = {
        {t->width,
         t->height,
         {t->background[0], t->background[1], t->background[2], t->background_blur},
         NULL}};
    int levels = 1;

    mark(t);
    mark_mixed(t);
    while (level[levels - 1].width > 1 || level[levels - 1].height > 1) {
        level[levels] = coarser(&level[levels - 1]);
        push(&level[levels - 1], &level[levels], t->K / 4);
        levels++;
    }
    while (--levels > 0) {
        pull(&level[levels - 1], &level[levels], t->K / 4);
        for (int c = 0; c < 4; c++)
            free(level[levels].plane[c]);
        free(level[levels].inpainted);
    }
}
