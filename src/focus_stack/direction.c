/* direction.c: tells which end of a focus stack is far, by the edges between its surfaces and by
 * what lies lower in the picture.
 *
 * A surface that ends before another one has an edge that is as blurred as it is itself: light from
 * behind passes beside it. So the step from one to the other is steepest in the frame that is
 * focused on the nearer one. With A and B the mean colours on either side, each in the frame that
 * is focused on it, and
 *
 *     p(i) = (I(i) - A) . (B - A) / |B - A|^2,    g = max over i of p(i + 1) - p(i - 1)
 *
 * of the samples i of a row or a column across the edge, an edge votes
 *
 *     (g(later) - g(earlier)) / (g(later) + g(earlier))
 *
 * for the frame that is later in the order of focus to be focused nearer. Texture of either side
 * adds to one or the other, and cancels in the mean of many edges. Votes weigh with the frames that
 * lie between, and a third of them is left where depth on one side was not measured: the edge may
 * be a drawing on the other. Where hardly any edge was measured on both sides, all may be drawings
 * that a few frames tell nothing of, such as the squares of a checkerboard: edges then tell
 * nothing.
 *
 * An order and its reverse get the same votes but for their sign, as long as depth is looked at
 * before nearer surfaces get their silhouettes back (silhouettes.c). It is smooth where it was not
 * measured: what fill.c leaves there has steps that are no edges.
 *
 * Some pictures have few edges, or such as show nothing: a table, a page, a row of things. What
 * lies lower is nearer in most pictures, for cameras look down on the ground. So where the mean of
 * the votes is below SURE, the correlation of depth and row, -1 to 1, is added with a weight of
 * LOWER, and likewise where it is the opposite and outweighs them: steps of depth are no edges
 * where something moved that was not found, or a frame is of another light.
 *
 * No votes come from where light is clipped: its blur is brighter and steeper than is known.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <string.h>

enum {
    SIDE = 12, /* samples on either side of an edge that are looked at */
    ACROSS = 2 * SIDE + 1,
    MEAN = 4,         /* samples at either end of these that tell the colour of a side */
    APART = 4,        /* surfaces are apart by this part of all depths */
    CONTRAST = 30,    /* codes that their colours differ by at least */
    FLAT = 50,        /* steps below 1 / FLAT of that difference count as so much */
    ONE = 256,        /* the vote of a step that one of both frames has alone */
    UNSURE = 128,     /* the weight of depth that was not measured, beside 255 more */
    LEAST_EDGES = 60, /* fewer tell nothing */
    MOST_DRAWN = 8,   /* more than so many edges for one that was measured tell nothing */
    CLIPPED = 250,    /* codes from here on */
};
static const double SURE = 0.05, LOWER = 0.2;

/* A row or a column of the map. */
struct track {
    const struct refocus_stack *stack;
    int number, length;
    bool is_column;
    ptrdiff_t first, step; /* samples of the map before it, and to the next one of it */
};

struct sums {
    int64_t votes, weights;
    int32_t edges, measured;
};

static int depth_at(const struct track *t, int i)
{
    return t->stack->depth[t->first + i * t->step];
}

/* How much depth changes between two samples. */
static int change(const struct track *t, int i, int j)
{
    return abs(depth_at(t, i) - depth_at(t, j));
}

/* Whether depth changes at sample i, more than at all samples within SIDE of it. */
static bool is_edge(const struct track *t, int i, int apart)
{
    const int own = change(t, i - 1, i + 1);

    if (2 * own < apart || change(t, i - SIDE, i + SIDE) < apart)
        return false;
    for (int d = 1 - SIDE; d < SIDE; d++)
        if (change(t, i + d - 1, i + d + 1) > own)
            return false;
    return true;
}

/* The frame that is focused on the depth of a sample. */
static int frame_at(const struct track *t, int i)
{
    const struct refocus_stack *s = t->stack;

    return rf_stack_clamp((depth_at(t, i) / 256 + s->sub / 2) / s->sub, s->count - 1);
}

/* The colours around sample i as frame k shows them; false: they are not known. */
static bool take(const struct track *t, int i, int k, uint8_t colour[ACROSS][3])
{
    const struct refocus_stack *s = t->stack;

    for (int d = -SIDE; d <= SIDE; d++) {
        const int x = t->is_column ? t->number : i + d, y = t->is_column ? i + d : t->number;

        uint8_t *const p = colour[d + SIDE];

        if (!rf_stack_pixel(s, k, x * s->reduced, y * s->reduced, p) || p[0] >= CLIPPED ||
            p[1] >= CLIPPED || p[2] >= CLIPPED)
            return false;
    }
    return true;
}

/* The greatest step from a towards b, sums of MEAN samples, in parts of their distance: both are
 * below 3 (255 MEAN)^2 < 2^22. */
static int steepest(uint8_t colour[ACROSS][3], const int a[3], const int b[3], int squared)
{
    int p[ACROSS] = {0}, most = squared / FLAT;

    for (int i = 0; i < ACROSS; i++)
        for (int c = 0; c < 3; c++)
            p[i] += (MEAN * colour[i][c] - a[c]) * (b[c] - a[c]);
    for (int i = 1; i + 1 < ACROSS; i++)
        most = p[i + 1] - p[i - 1] > most ? p[i + 1] - p[i - 1] : most;
    return most;
}

/* The weight of the depth of MEAN samples from i on: MEAN (UNSURE + 255) < 2^11 at the most. */
static int weight_of(const struct track *t, int i)
{
    int sum = MEAN * UNSURE;

    for (int d = 0; d < MEAN; d++)
        sum += t->stack->sure[t->first + (i + d) * t->step];
    return sum;
}

static void count_vote(const struct track *t, int i, struct sums *sums)
{
    const int k = frame_at(t, i - SIDE), l = frame_at(t, i + SIDE);
    uint8_t colour[2][ACROSS][3];
    int a[3] = {0}, b[3] = {0}, squared = 0;

    if (k == l || !take(t, i, k, colour[0]) || !take(t, i, l, colour[1]))
        return;
    for (int c = 0; c < 3; c++) {
        for (int d = 0; d < MEAN; d++) {
            a[c] += colour[0][d][c];
            b[c] += colour[1][ACROSS - 1 - d][c];
        }
        squared += (b[c] - a[c]) * (b[c] - a[c]);
    }
    if (squared < CONTRAST * CONTRAST * MEAN * MEAN)
        return;

    const int64_t first = steepest(colour[0], a, b, squared);
    const int64_t second = steepest(colour[1], a, b, squared);
    const int64_t vote = (first - second) * ONE / (first + second);
    const int left = weight_of(t, i - SIDE), right = weight_of(t, i + SIDE - MEAN + 1);
    const int64_t weight = left < right ? left : right;

    sums->votes += (k - l) * weight * vote;
    sums->weights += abs(k - l) * weight;
    sums->edges++;
    sums->measured += weight >= MEAN * (UNSURE + RF_STACK_MEASURED);
}

static void go_along(const struct track *t, struct sums *sums)
{
    const int apart = 256 * (t->stack->depths - 1) / APART;

    for (int i = SIDE; i + SIDE < t->length; i++)
        if (is_edge(t, i, apart))
            count_vote(t, i, sums);
}

/* The mean of the votes. */
static double of_edges(const struct refocus_stack *s)
{
    struct sums sums = {0};

    for (int y = 0; y < s->rows; y++)
        go_along(&(struct track){s, y, s->columns, false, (ptrdiff_t)y * s->columns, 1}, &sums);
    for (int x = 0; x < s->columns; x++)
        go_along(&(struct track){s, x, s->rows, true, x, s->columns}, &sums);
    if (sums.edges < LEAST_EDGES || sums.edges > MOST_DRAWN * sums.measured)
        return 0;
    return (double)sums.votes / ((double)ONE * (double)sums.weights);
}

/* The correlation of depth and row. Rows count from the middle, in halves: their sum is 0, and that
 * of their squares rows (rows^2 - 1) / 3 in each column. Sums of 2^16 times 2^16 for less than 2^30
 * samples stay below 2^63. */
static double of_rows(const struct refocus_stack *s)
{
    const double samples = (double)s->columns * s->rows;
    const double of_squares = samples * ((double)s->rows * s->rows - 1) / 3;
    int64_t both = 0;
    uint64_t sum = 0, squares = 0;

    for (int y = 0; y < s->rows; y++) {
        const uint16_t *const depth = s->depth + (size_t)y * (size_t)s->columns;
        uint64_t row = 0;

        for (int x = 0; x < s->columns; x++) {
            row += depth[x];
            squares += (uint64_t)depth[x] * depth[x];
        }
        sum += row;
        both += (2 * y + 1 - s->rows) * (int64_t)row;
    }
    const double variance = (double)squares - (double)sum * (double)sum / samples;

    return variance > 0 && of_squares > 0 ? (double)both / sqrt(variance * of_squares) : 0;
}

float rf_stack_direction(struct refocus_stack *s, uint32_t *by_rows)
{
    const size_t bytes = (size_t)s->columns * (size_t)s->rows * sizeof *s->depth;
    double direction, rows;

    memcpy(s->moved, s->depth, bytes);
    rf_stack_smooth(s);
    direction = of_edges(s);
    rows = LOWER * of_rows(s);
    *by_rows = fabs(direction) < SURE || (direction * rows < 0 && fabs(direction) < fabs(rows));
    if (*by_rows)
        direction += rows;
    memcpy(s->depth, s->moved, bytes);
    return (float)direction;
}

void rf_stack_reverse(struct refocus_stack *s)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;

    for (int k = 0, l = s->count - 1; k < l; k++, l--) {
        const struct rf_stack_frame frame = s->frame[k];

        s->frame[k] = s->frame[l];
        s->frame[l] = frame;
    }
    for (int k = 0; k < s->count; k++)
        s->frame[k].position = k;
    s->still = s->count - 1 - s->still;
    for (size_t i = 0; i < samples; i++)
        s->depth[i] = (uint16_t)(256 * (s->depths - 1) - s->depth[i]);
}
