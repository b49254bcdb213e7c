/* tally.c: how much those around a pixel that look like it are near, and how much far. */
#include "kernels/kernels.h"

static inline uint16_t difference(uint8_t a, uint8_t b)
{
    return (uint16_t)(a > b ? a - b : b - a);
}

/* The square of a number in Q16. */
static inline uint16_t squared(uint16_t v)
{
    return (uint16_t)((uint32_t)v * v >> 16);
}

/* (1 - (difference / 73)^2)^8 in Q16: 65535 - 12.25 * 73^2 = 255. */
static inline uint16_t likeness(uint16_t all)
{
    const uint16_t least = all > 73 ? 73 : all, square = (uint16_t)(least * least);
    const uint16_t off = (uint16_t)(12 * square + (square >> 2));

    return squared(squared(squared((uint16_t)(65535 - off))));
}

static inline void tally_row(struct rf_votes *votes, const struct rf_vote_window *w, int y)
{
    const ptrdiff_t at = (ptrdiff_t)y * w->step * w->stride;
    const uint8_t *restrict first = w->colour[0] + at, *restrict second = w->colour[1] + at;
    const uint8_t *restrict third = w->colour[2] + at;
    const uint16_t *restrict voter = w->voter + at;
    const uint8_t *restrict nearness = w->nearness + y * w->nearness_stride;
    const uint8_t a = w->own[0], b = w->own[1], c = w->own[2];
    const uint16_t least = w->least, middle = w->middle, most = w->most;
    uint32_t near = 0, all = 0, near_value = 0, all_value = 0;
    const int n = w->columns;

    for (int x = 0; x < n; x++) {
        const uint16_t d = voter[x];
        const uint16_t alike = (uint16_t)(difference(first[x], a) + difference(second[x], b) +
                                          difference(third[x], c));
        const uint16_t votes_too = (uint16_t)(d >= least && d <= most ? 0xffff : 0);
        const uint16_t is_near = (uint16_t)(d > middle ? 0xffff : 0);
        const uint16_t weight =
            (uint16_t)((uint16_t)((likeness(alike) >> 8) * nearness[x]) >> 5 & votes_too);
        const uint32_t value = (uint32_t)weight * (uint16_t)((uint16_t)(d - least) >> 5);

        near += (uint16_t)(weight & is_near);
        all += weight;
        near_value += is_near ? value : 0;
        all_value += value;
    }
    votes->near += near;
    votes->far += all - near;
    votes->near_value += near_value;
    votes->far_value += all_value - near_value;
}

struct rf_votes RF_VEC(rf_tally)(const struct rf_vote_window *w)
{
    struct rf_votes votes = {0, 0, 0, 0};

    for (int y = 0; y < w->rows; y++)
        tally_row(&votes, w, y);
    return votes;
}
