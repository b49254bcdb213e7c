/* silhouette_run.h: a run of pixels with those around it, as it goes down the photo, and the noise
 * of its depths. */
#ifndef RF_SILHOUETTE_RUN_H
#define RF_SILHOUETTE_RUN_H

#include "highlights/highlights.h"

enum {
    RF_RUN = 32,       /* pixels that are looked at together: most hold nothing bright at a jump */
    RF_RUN_AROUND = 6, /* pixels on each side that tell whose light it is */
    RF_RUN_SIDE = 2 * RF_RUN_AROUND + 1,
    RF_RUN_LANES = 16, /* columns that are looked at to count in RF_RUN_SIDE of them */
    RF_RUN_COLUMNS = RF_RUN + RF_RUN_LANES,
    RF_RUN_KEPT = 16, /* rows, of which RF_RUN_SIDE are in use */
    RF_RUN_DARK = RF_LIGHT_MAX / 2,
};

/* A run of pixels from x0 on, from column RF_RUN_AROUND on, with those around it: the light of the
 * brightest channel, which is RF_RUN_DARK outside of the window, and disparities by rf_signed16().
 * As it goes down the photo, each row is copied and compared with its neighbours once: row y of the
 * window is row y % RF_RUN_KEPT here, and rows first to next - 1 are there. */
struct rf_silhouette_run {
    int x0, first, next;
    int16_t light[RF_RUN_SIDE][RF_RUN_COLUMNS];
    int16_t disparity[RF_RUN_KEPT][RF_RUN_COLUMNS + 2];
    /* How far pixels lie off the lines through their neighbours, a quarter of it. */
    int16_t off_line[RF_RUN_KEPT][RF_RUN_COLUMNS + 2];
    /* They are counted and added in each column, from row first + 1 to next - 2. */
    int16_t noisy[RF_RUN_COLUMNS + 2];
    uint16_t off[RF_RUN_COLUMNS + 2];
};

static inline int rf_run_row(int y)
{
    return (int)((unsigned)y % RF_RUN_KEPT);
}

/* Disparity as a signed number: baseline x86 has no unsigned extremes of 16 bits. */
static inline int16_t rf_signed16(int disparity)
{
    return (int16_t)(disparity - 32768);
}

static inline int16_t rf_min16(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static inline int16_t rf_max16(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

/* Brings the run to row y, with the RF_RUN_AROUND rows above and below it. `next` is INT_MIN where
 * nothing of it is known. */
void rf_run_go_to(const struct rf_silhouette_window *w, int y, struct rf_silhouette_run *run);

/* Copies the light of row y of the run and around it. */
void rf_run_take_light(const struct rf_silhouette_window *w, int y, struct rf_silhouette_run *run);

/* The pixels of row y, where the run is, that are not noise, of those given, a bit each. */
uint32_t rf_run_without_noise(const struct rf_silhouette_run *run, int y, uint32_t pixels);

#endif
