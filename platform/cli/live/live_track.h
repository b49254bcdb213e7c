/* live_track.h: a rectangle of the picture that goes with what it shows. */
#ifndef RF_CLI_LIVE_TRACK_H
#define RF_CLI_LIVE_TRACK_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/image.h>

enum {
    LIVE_TRACK_SIDE = 24,  /* samples of the pattern, at most, each way */
    LIVE_TRACK_REACH = 12, /* samples that it is looked for away from where it should be */
    LIVE_TRACK_SEEN = LIVE_TRACK_SIDE + 2 * LIVE_TRACK_REACH,
    LIVE_TRACK_SAMPLES = LIVE_TRACK_SIDE * LIVE_TRACK_SIDE,
};

/* The patterns are the brightness in the rectangle, reduced to some samples. All zeros: none. */
struct live_tracker {
    double box[4]; /* x, y, width and height in pixels */
    double speed[2];
    double step; /* pixels from one sample to the next */
    int columns, rows;
    bool has_pattern, gone; /* gone: it was not found in the last frame */
    double likeness;        /* In the last frame: normalised cross-correlation, 1 for the same */
    uint8_t pattern[LIVE_TRACK_SAMPLES]; /* As it looked of late. */
    uint8_t first[LIVE_TRACK_SAMPLES];   /* As it looked when it was pointed at. */
    int32_t window[LIVE_TRACK_SAMPLES];  /* weights of the samples */
    uint64_t lost;                       /* frames in which it was not found */
};

/* Follow what the next frame shows there. */
void live_track_begin(struct live_tracker *tracker, const double box[4]);
/* Move the box with its subject; false: it is not to be found, and the box stays where it was. */
bool live_track_frame(struct live_tracker *tracker, const struct refocus_image *photo);

#endif
