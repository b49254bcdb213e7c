/* upsample.h: brings a disparity map of any size to the photo's. */
#ifndef RF_UPSAMPLE_H
#define RF_UPSAMPLE_H

#include <stdbool.h>

#include <refocus/image.h>

#include "image/planes.h"
#include "kernels/kernels.h"
#include "support/arena.h"
#include "support/executor.h"

enum {
    RF_UPSAMPLE_PAD = 2,    /* samples beyond the map's border, repeated */
    RF_UPSAMPLE_BLOCK = 16, /* pixels that are settled together */
};

/* Planes of bytes, and of three colours. */
struct rf_bytes {
    uint8_t *at;
    ptrdiff_t stride;
};

struct rf_colours_u8 {
    uint8_t *channel[3];
    ptrdiff_t stride;
};

/* For each row the number of blocks in its list, and then these: 1 + rf_upsample_blocks(). */
struct rf_block_lists {
    uint16_t *at;
    ptrdiff_t stride;
};

/* A span: the columns of pixels between the same columns of samples, up to the next span. */
struct rf_span {
    int32_t begin; /* first column of the span */
    int32_t alike; /* the first one whose pixels lie the same way */
    int32_t shown; /* the one in the middle of the column of samples of this number */
};

/*
 * Where no two neighbours among the 4 x 4 samples around a pixel are farther apart than
 * 1/24 of the range, it takes their mean by nearness. Elsewhere these samples are
 * sorted into surfaces, and the 8 x 8 samples around show what each looks like in the
 * photo: the pixel goes to the surface with the most of nearness times likeness (Bayes'
 * rule: nearness is what is expected before looking), and takes the plane through its
 * samples. So no disparity between two surfaces is invented. Where that choice was a
 * close one, a median of 3 x 3 follows that those who were sure weigh most in; it leans
 * to the near: what is thin is in front, and most of it lies between samples. A map
 * that has more columns or rows than the photo is sampled first.
 *
 * All the memory is the caller's. Elements -2 to samples + 1 of rows -2 to samples + 1
 * of `coarse`, `colour` and `trust` are used.
 */
struct rf_upsampler {
    const struct rf_kernels *kernels;
    const struct refocus_image *photo;
    const struct refocus_disparity *map;
    const uint8_t *confidence; /* one for each sample of the map, or NULL */
    ptrdiff_t confidence_stride;
    int columns, rows; /* samples that are used: rf_upsample_samples() */
    bool in_strips;    /* in less memory: no plane but out has the photo's size */

    struct rf_disparity_q16 coarse; /* samples */
    struct rf_colours_u8 colour;    /* the photo at the samples, quartered */
    struct rf_bytes trust;          /* confidence of the samples; not used without */
    struct rf_disparity_q16 wide;   /* rows x width: each row of samples as long as the photo's */
    struct rf_disparity_q16
        settled;                   /* height x width: the final value of pixels that are not sure */
    struct rf_bytes sure;          /* height x width: 255 or 0 */
    struct rf_block_lists unsure;  /* blocks of a row with pixels that are not sure */
    int first_wide, first_row;     /* the first rows of wide, and of settled, sure and unsure: 0 but
                                      in strips */
    int first_band;                /* the band that is item 0 */
    struct rf_disparity_q16 spare; /* in strips: rows x columns, for dequantising */
    struct rf_taps *across, *down; /* width and height of them */
    struct rf_span *span;          /* columns + 2 of them */
    struct rf_run *run;
    struct rf_shares shares; /* the caller's: rf_upsample_share() bytes for each worker */

    struct rf_disparity_q16 out;
};

static inline int rf_upsample_blocks(int width)
{
    return (width + RF_UPSAMPLE_BLOCK - 1) / RF_UPSAMPLE_BLOCK;
}

static inline int rf_upsample_samples(int samples, int size)
{
    return samples < size ? samples : size;
}

/* Sets the pointers to memory for the size of up->photo and for `columns` and `rows`, or with
 * arena->base == NULL only counts. The memory of trust is only for a map with confidence. */
void rf_upsampler_lay_out(struct rf_upsampler *up, struct rf_arena *arena);

/* Loads samples, what the photo shows there and the confidence in them. Spans are known then. */
void rf_upsample_load(struct rf_upsampler *up, struct rf_pool *pool);

/* Writes the map at the photo's size to up->out. */
void rf_upsample(struct rf_upsampler *up, struct rf_pool *pool);

/* Finds where spans begin, and which of the last few has pixels that lie the same way. */
void rf_find_spans(struct rf_upsampler *up);

/* Writes rows y0 to y1 - 1 of pixels, whose taps begin in row `first` of the samples. */
void rf_upsample_rows(const struct rf_upsampler *up, int first, int y0, int y1, int worker);

/* Bytes of a worker's share. */
uint64_t rf_upsample_share(void);

#endif
