/* focus_stack.h: the frames of a focus stack and the planes that depth is made from. */
#ifndef RF_FOCUS_STACK_H
#define RF_FOCUS_STACK_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <refocus/stack.h>

#include "support/pool.h"

enum {
    RF_STACK_MOST_SAMPLES = 3 << 20, /* at the most, in the maps that the work is done on */
    RF_STACK_FEW = 9,                /* frames, up to which depths lie between: model.c */
    RF_STACK_FEW_DEPTHS = 24,
    RF_STACK_MODELS = 6,
    RF_STACK_SQUARES = 3,     /* sizes that sharpness is summed over: costs.c */
    RF_STACK_PATHS_APART = 8, /* elements beside the costs of a path, never a minimum */
    RF_STACK_GREY = 4096,     /* stands for 0 in `colour`, more than any difference below it */
    RF_STACK_LEVELS = 4,      /* pictures that frames are aligned by, each half the last */
    RF_STACK_RADII = 24,      /* labels of apertures: radii of blur from 0 on, in samples */
    RF_STACK_MARGIN =
        24, /* samples by which frames go on beyond their border, RADII at the least */
    RF_STACK_LONGER = 960,   /* samples along the longer side, at the most */
    RF_STACK_MEASURED = 128, /* confidence of depth, of 255, from which on it counts as measured */
    RF_STACK_STRIDE = 13,    /* samples from one that is looked at to the next, in statistics */
    RF_STACK_NOISE = 1600,   /* squared sharpness of 20 codes: texture that noise hides */
    RF_STACK_WHITE = 250,    /* codes from which on a pixel is clipped */
    RF_STACK_NEAR = 242,     /* Noise and JPEG leave what is clipped above this. */
    RF_STACK_CLIPPED = 1 << 15, /* all of the pixels that a tap stands for */
};

struct rf_deep;
struct rf_transfer;

/* The photo in focus everywhere, R, G and B, 8 bits. */
struct rf_stack_photo {
    uint8_t *rgb;
    ptrdiff_t stride;
};

/* z -> c z + t in the complex plane, about the middle of the picture: scale and rotation, shift in
 * pixels. It maps places in the reference to those in a frame. */
struct rf_similarity {
    double c[2], t[2];
};

struct rf_stack_frame {
    double position;
    int added; /* number in the order that frames came in, from 1 */
    uint8_t *rgb;
    uint16_t *sharpness;              /* sums of second differences, Q4, of the work's size */
    uint16_t *small[RF_STACK_LEVELS]; /* luminance in Q4 for the alignment, finest first */
    struct rf_similarity from_reference;
    uint16_t *colour[2];   /* R - G and B - G, Q4 from RF_STACK_GREY on, of level 1 of `small` */
    const uint8_t *moving; /* places that it is not used for; NULL: of the reference */
};

struct refocus_stack {
    int width, height;
    int reduced;       /* a sample of the work is a square of so many pixels */
    int columns, rows; /* samples of the work */
    int small_by;      /* the finest picture of the alignment is smaller by so much */
    int most, count, reference;
    int still; /* the reference in the order of positions, once the stack is finished */
    bool finished, without_positions;
    uint32_t align, order, kind;
    double alike;      /* the least correlation of neighbours once they are aligned */
    atomic_int moving; /* samples where something moves */
    int matched;       /* frames that got the exposure of the reference */
    double exposure;   /* factor by which that of a matched frame differed at the most */
    int threads;
    struct rf_pool *pool; /* while a frame is added or the stack is finished */
    int sub;              /* depths from a frame to the next: 1 where steps are fine */
    int depths;           /* told apart in all: (count - 1) sub + 1 */
    int labels; /* depths of `most` frames, rounded up so that costs of a sample fill vectors */
    struct rf_stack_frame frame[REFOCUS_STACK_MOST_FRAMES]; /* in the order of their positions */

    /* One block of 3 bytes a pixel: luminance of the frame that is added, as it is and smooth (Q4);
     * then the photo before the light of blur is taken out, and before it is whitened. */
    uint8_t *before, *luma;
    uint16_t *smooth;
    uint16_t *moved;  /* sharpness in the geometry of the reference */
    uint8_t *guide;   /* R, G, B of the work's size */
    uint8_t *cost;    /* `labels` of a sample */
    int16_t *sum;     /* aggregated, `labels` of a sample */
    int16_t *path;    /* rf_stack_path(): what reaches the last row and the next, each way */
    size_t path_size; /* elements, of one way */
    uint32_t *column; /* sums of a column, for each worker, square and frame */
    /* Labels cost by these planes, each in the geometry of the reference: sharpness of the frames,
     * or errors of blur. */
    const uint16_t *plane[REFOCUS_STACK_MOST_FRAMES];
    int planes;
    /* Apertures have these, too: */
    uint16_t *error; /* a plane for each radius, Q4 codes, in the memory of `sum` */
    uint32_t *table; /* summed areas of a frame and its margin */
    uint16_t *code;  /* Q4, of Q12 light */
    int farthest;    /* depth that is the end of the range, Q8 labels */
    uint16_t *depth; /* a sample each, Q8 labels */
    uint8_t *sure;
    uint16_t *depth_row; /* one row of the photo for each worker */
    uint8_t *sure_row;
    struct rf_transfer *transfer;
    double radius;  /* K of the whole range in pixels; 0: no blur explains the frames */
    uint32_t noise; /* squared sharpness of noise, in quarters of a squared code */
    int models;
    int16_t share[RF_STACK_MODELS][RF_STACK_FEW]
                 [RF_STACK_FEW_DEPTHS];                   /* shares of the sharpness, Q12 */
    int16_t shares[RF_STACK_MODELS][RF_STACK_FEW_DEPTHS]; /* sums of them over all frames */
    void *block;
};

/* Steps of a walk over the rows of the map, 1 downwards or -1 upwards: from `begin`, counted from
 * where the walk enters, to before `end`. */
struct rf_stack_part {
    int way, begin, end;
    bool second; /* the walk the other way has been in these rows */
};
typedef void rf_stack_part_fn(void *context, struct rf_stack_part part);

/* Walks over all rows, down and up at the same time: each takes the half first where it enters, so
 * that they never meet in one row, and then the other. */
void rf_stack_both_ways(struct rf_pool *pool, rf_stack_part_fn *part, void *context, int rows);

/* The memory of one of them. */
static inline int16_t *rf_stack_path(const struct refocus_stack *stack, int way)
{
    return stack->path + (way > 0 ? 0 : stack->path_size);
}

/* Luminance, sharpness and the small pictures of a frame that has its pixels. */
void rf_stack_measure(struct refocus_stack *stack, struct rf_stack_frame *frame);

/* Depth of frames of one focus and several apertures; sets `blur` and `order_margin`. */
void rf_stack_apertures(struct refocus_stack *stack, struct refocus_stack_result *result);
/* Finds `error`, the planes of RF_STACK_RADII labels, of frames that are aligned. */
void rf_stack_blur_errors(struct refocus_stack *stack);

/* Puts frames without positions in the order of their focus; returns order_margin of stack.h. */
float rf_stack_find_order(struct refocus_stack *stack);

/* Finds from_reference of all frames; the reference is frame `reference` in order of position. */
void rf_stack_align(struct refocus_stack *stack, int reference);
/* Likewise, but each with the reference itself: the order of frames need not be known. */
void rf_stack_align_each(struct refocus_stack *stack, int reference);
/* Correlation of the luminance of two pictures of w x h pixels, `pitch` from row to row. What lies
 * outside of the frame is below 0. */
double rf_stack_correlation(const uint16_t *reference, const int16_t *frame, ptrdiff_t pitch, int w,
                            int h);
/* The shift of whole pixels, up to a third of a side, at which a frame is most alike. */
void rf_stack_best_shift(const uint16_t *reference, const uint16_t *frame, int width, int height,
                         double t[2]);
/* A picture of a level of `small` as the reference sees it, -1 outside of the frame. */
void rf_stack_warp(const struct refocus_stack *stack, const struct rf_stack_frame *frame, int level,
                   const uint16_t *in, int16_t *out);
/* `colour` of a frame that has its pixels. */
void rf_stack_measure_colour(const struct refocus_stack *stack, struct rf_stack_frame *frame);
/* How far the farthest corner is moved, in pixels. */
double rf_similarity_reach(const struct rf_similarity *s, int width, int height);

/* Frames that are aligned get the exposure of the reference. */
void rf_stack_match_exposure(struct refocus_stack *stack);
/* Finds what moves, in frames that are aligned. */
void rf_stack_find_moving(struct refocus_stack *stack);
/* A row of the photo in the mask of what moves in a frame; NULL: nothing moves. */
const uint8_t *rf_stack_moving_row(const struct refocus_stack *stack, int k, int y);
int rf_stack_moving_column(const struct refocus_stack *stack, int x);
/* The two rows of the mask that a row of the photo lies between, Q8 below the first. */
struct rf_stack_mask {
    const uint8_t *row[2]; /* NULL: nothing moves */
    int below;
};
struct rf_stack_mask rf_stack_moving_mask(const struct refocus_stack *stack, int k, int y);
/* How much of a pixel moves, Q8: between the middles of the mask's pixels in proportion. */
int rf_stack_moving_share(const struct refocus_stack *stack, const struct rf_stack_mask *mask,
                          int x);
/* Frames get the highest cost in a row of samples where something moves. */
void rf_stack_leave_out(struct refocus_stack *stack, int y);
/* Depths from a frame to the next for so many frames. */
int rf_stack_sub(int frames);
/* The model of defocus, for sub > 1: once frames lie on each other. */
void rf_stack_model(struct refocus_stack *stack);
/* Adds to the costs of a sample by mean squares of sharpness, each in Q2 codes. */
void rf_stack_model_costs(const struct refocus_stack *stack, uint8_t *cost, const uint32_t *mean);
/* Finds `noise`, from samples that show nothing else, once frames lie on each other; 0: there is
 * hardly any. */
void rf_stack_find_noise(struct refocus_stack *stack);
/* Sharpness of the frames as the reference sees it becomes what labels cost by. */
void rf_stack_sharpness(struct refocus_stack *stack);
/* The strongest texture in any frame at each sample, as its mean square of sharpness less noise,
 * and how sure a depth is that has to stand out against noise alone. In the memory of `sum`. */
struct rf_stack_faint {
    uint32_t *strongest, *block; /* block: the strongest of each block of samples */
    uint8_t *sure;
};

static inline struct rf_stack_faint rf_stack_faint(const struct refocus_stack *s)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    uint32_t *const first = (uint32_t *)(void *)s->sum;

    return (struct rf_stack_faint){first, first + samples, (uint8_t *)(first + 2 * samples)};
}

/* Depth of faint texture counts as measured where no edge is near. */
void rf_stack_take_faint(struct refocus_stack *stack);
/* Costs, guide and confidence, from the planes. */
void rf_stack_costs(struct refocus_stack *stack);
/* Adds up the costs along eight directions. */
void rf_stack_aggregate(struct refocus_stack *stack);
/* The least sum of each sample, between frames by a parabola. */
void rf_stack_choose(struct refocus_stack *stack);
/* Returns `disorder` of stack.h, from sharpness that has been moved to the reference. */
float rf_stack_disorder(const struct refocus_stack *stack);
/* Returns `direction` of stack.h, and `by_rows`, once depth is filled. */
float rf_stack_direction(struct refocus_stack *stack, uint32_t *by_rows);
/* Frames without positions, and depth, become as if frames had been added in reverse. */
void rf_stack_reverse(struct refocus_stack *stack);
/* Depth beside a nearer surface, which windows of sharpness take for it, is filled once more. */
void rf_stack_silhouettes(struct refocus_stack *stack);
/* Depth that was not measured becomes that of the sure samples around it; votes go along rows and
 * then columns, or columns first. */
void rf_stack_fill(struct refocus_stack *stack, bool columns_first);
/* Depth along silhouettes loses its combs and teeth. */
void rf_stack_median(struct refocus_stack *stack);
/* Depth that was not measured becomes smooth between what was. */
void rf_stack_smooth(struct refocus_stack *stack);

/* A row of the photo in focus everywhere; frames that do not show a place leave it to the next one
 * towards the reference, which shows all. */
void rf_stack_compose_row(const struct refocus_stack *stack, uint8_t *out, const uint16_t *depth,
                          int y);
/* The focus that a depth is composed of, both Q8 frames. */
uint16_t rf_stack_focus(const struct refocus_stack *stack, uint16_t depth);
/* The pixel of the reference at a place as frame k shows it; false: it does not, or moves there. */
bool rf_stack_pixel(const struct refocus_stack *stack, int k, int x, int y, uint8_t out[3]);
/* Disparity of a depth in Q8 frames: on the line between the positions of two frames. */
uint16_t rf_stack_disparity(const struct refocus_stack *stack, int depth);
/* Takes the light of blurred foreground out of the background beside it. */
void rf_stack_decontaminate(struct refocus_stack *stack, const struct rf_stack_photo *photo);
/* Makes what is clipped white again. */
void rf_stack_whiten(struct refocus_stack *stack, const struct rf_stack_photo *photo);
/* Memory for what follows, beside the stack's own. */
uint64_t rf_stack_light_bytes(struct refocus_stack *stack);
/* Writes the light of the photo, with what it lacks where it is clipped. */
void rf_stack_find_light(struct refocus_stack *stack, const struct rf_stack_photo *photo,
                         struct rf_deep *out, void *work);
/* How much is clipped, of RF_STACK_CLIPPED, of the pixels that a tap stands for at each sample, and
 * the largest disparity of these (0: none is). */
struct rf_stack_clipped {
    uint16_t *share, *disparity;
};
/* Finds that for taps that are so many pixels apart, in the memory of the costs; `moved` is the
 * disparity of the samples. */
struct rf_stack_clipped rf_stack_find_clipped(struct refocus_stack *stack,
                                              const struct rf_stack_photo *photo, int apart);
/* Places in a frame of the places of a row of the reference: x + i dx, Q32 pixels. */
struct rf_stack_line {
    int64_t x, y, dx, dy;
};

/* The line of the places x, x + step, ... of row y of the reference, in pixels. */
struct rf_stack_line rf_stack_line(const struct refocus_stack *stack,
                                   const struct rf_stack_frame *frame, double x, double y,
                                   double step);
/* Whether a frame shows place x of a line. */
bool rf_stack_reaches(const struct refocus_stack *stack, const struct rf_stack_line *line, int x);
/* The lines of a row of samples in all frames. */
void rf_stack_sample_lines(const struct refocus_stack *stack, struct rf_stack_line *line, int y);
/* The guide of a sample becomes what frame k shows there. */
void rf_stack_guide(struct refocus_stack *stack, const struct rf_stack_line *line, int k, int x,
                    int y);
/* Depth of a row of pixels, Q8 frames, and whether it was measured, 0 to 255. */
void rf_stack_depth_row(const struct refocus_stack *stack, uint16_t *depth, uint8_t *sure, int y);

enum { RF_STACK_STILL, RF_STACK_PERHAPS, RF_STACK_MOVING };

static inline bool rf_stack_moves(const uint8_t *row, int column)
{
    return row && row[column] == RF_STACK_MOVING;
}

/* Squared sharpness, Q2 codes: at most 4080^2 < 2^24, so that 17 x 17 of them fit 33 bits. */
static inline uint32_t rf_stack_squared(uint16_t sharpness)
{
    const uint32_t v = sharpness >> 3;

    return v * v;
}

static inline int rf_stack_clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

static inline bool rf_stack_is_clipped(const uint8_t *p)
{
    return p[0] >= RF_STACK_WHITE || p[1] >= RF_STACK_WHITE || p[2] >= RF_STACK_WHITE;
}

/* The largest difference of two samples of the guide in a channel. */
static inline int rf_stack_difference(const uint8_t *p, const uint8_t *q)
{
    int most = abs(p[0] - q[0]);

    most = abs(p[1] - q[1]) > most ? abs(p[1] - q[1]) : most;
    return abs(p[2] - q[2]) > most ? abs(p[2] - q[2]) : most;
}

#endif
