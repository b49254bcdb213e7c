/* tally.c: how much those around a pixel that look like it are near, and how much far. */
#include "kernels/kernels.h"

enum { LANES = RF_VOTE_COLUMNS };

/* Sums over the rows of LANES columns. */
struct lanes {
    uint16_t near[LANES], all[LANES];
    uint32_t near_value[LANES], all_value[LANES];
};
static_assert(RF_MOST_VOTE_ROWS * (255 * 255 / 32) <= UINT16_MAX, "weights of a column fit");

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

static inline void add_row(struct lanes *sums, const struct rf_vote_window *w, int x, int y)
{
    const ptrdiff_t at = (ptrdiff_t)y * w->step * w->stride + x;
    const uint8_t *restrict first = w->colour[0] + at, *restrict second = w->colour[1] + at;
    const uint8_t *restrict third = w->colour[2] + at;
    const uint16_t *restrict voter = w->voter + at;
    const uint8_t *restrict nearness = w->nearness + y * w->nearness_stride + x;
    const uint8_t a = w->own[0], b = w->own[1], c = w->own[2];
    const uint16_t least = w->least, middle = w->middle, most = w->most;

    for (int i = 0; i < LANES; i++) {
        const uint16_t d = voter[i];
        const uint16_t alike = (uint16_t)(difference(first[i], a) + difference(second[i], b) +
                                          difference(third[i], c));
        const uint16_t is_voter = (uint16_t)(d >= least && d <= most ? 0xffff : 0);
        const uint16_t is_near = (uint16_t)(d > middle ? 0xffff : 0);
        const uint16_t weight =
            (uint16_t)((uint16_t)((likeness(alike) >> 8) * nearness[i]) >> 5 & is_voter);
        const uint16_t near_weight = weight & is_near,
                       above = (uint16_t)((uint16_t)(d - least) >> 5);

        sums->near[i] = (uint16_t)(sums->near[i] + near_weight);
        sums->all[i] = (uint16_t)(sums->all[i] + weight);
        sums->near_value[i] += (uint32_t)near_weight * above;
        sums->all_value[i] += (uint32_t)weight * above;
    }
}

struct rf_votes RF_VEC(rf_tally)(const struct rf_vote_window *w)
{
    struct rf_votes votes = {0, 0, 0, 0};
    uint32_t all = 0, all_value = 0;

    for (int x = 0; x < w->columns; x += LANES) {
        struct lanes sums = {{0}, {0}, {0}, {0}};

        for (int y = 0; y < w->rows; y++)
            add_row(&sums, w, x, y);
        for (int i = 0; i < LANES; i++) {
            votes.near += sums.near[i];
            votes.near_value += sums.near_value[i];
            all += sums.all[i];
            all_value += sums.all_value[i];
        }
    }
    votes.far = all - votes.near;
    votes.far_value = all_value - votes.near_value;
    return votes;
}
