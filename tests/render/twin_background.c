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

/* A level of the pyramid: planes of light, and blur in the fourth. */
struct level {
    int width, height;
    double *plane[4];
};

static struct level coarser(const struct level *fine)
{
    struct level coarse = {(fine->width + 1) / 2, (fine->height + 1) / 2, {0}};

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

/* Light and blur of two parents, 3 and 1 quarters of the light; the deeper one's alone, and its
 * blur, where they are more than a quarter of the largest blur apart. */
struct parents {
    double light[3], blur;
};

static struct parents mix(struct parents near, struct parents far, double apart)
{
    if (near.blur - far.blur > apart)
        return near;
    if (far.blur - near.blur > apart)
        return far;
    for (int c = 0; c < 3; c++)
        near.light[c] = (3 * near.light[c] + far.light[c]) / 4;
    return near;
}

static struct parents parent(const struct level *coarse, int x, int y)
{
    const int p = y * coarse->width + x;

    return (struct parents){{coarse->plane[0][p], coarse->plane[1][p], coarse->plane[2][p]},
                            coarse->plane[3][p]};
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
        }
    }
}

void twin_background(struct twin *t)
{
    struct level level[32] = {
        {t->width,
         t->height,
         {t->background[0], t->background[1], t->background[2], t->background_blur}}};
    int levels = 1;

    mark(t);
    while (level[levels - 1].width > 1 || level[levels - 1].height > 1) {
        level[levels] = coarser(&level[levels - 1]);
        push(&level[levels - 1], &level[levels], t->K / 4);
        levels++;
    }
    while (--levels > 0) {
        pull(&level[levels - 1], &level[levels], t->K / 4);
        for (int c = 0; c < 4; c++)
            free(level[levels].plane[c]);
    }
}
