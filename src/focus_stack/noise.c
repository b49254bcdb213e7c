/* noise.c: how strong the noise in the frames of a focus stack is.
 *
 * Sharpness of texture rises from frame to frame up to the one in focus and falls from there, so
 * that its steps add up to twice its range at the most. That of noise goes up and down: samples
 * whose steps add up to two and a half times their range show it. Its strength is what the flattest
 * tenth of them has in the least sharp frame. Where hardly any sample is of that kind, there is no
 * noise to speak of.
 */
#include "focus_stack/focus_stack.h"

#include <stdlib.h>
#include <string.h>

enum {
    VALUES = 1 << 13, /* sharpness is below, in half codes */
    FLAT = 10,        /* one noisy sample in so many is flat */
    MANY = 10,        /* one sample in so many is noisy at the least */
};

static int sharpness_of(const struct refocus_stack *s, int k, size_t i)
{
    return s->frame[k].sharpness[i] >> 3;
}

/* The least sharpness of a sample in half codes; -1: its steps are those of texture. */
static int least_of_noise(const struct refocus_stack *s, size_t i)
{
    int least = sharpness_of(s, 0, i), most = least, steps = 0;

    for (int k = 1; k < s->count; k++) {
        const int here = sharpness_of(s, k, i);

        steps += abs(here - sharpness_of(s, k - 1, i));
        least = here < least ? here : least;
        most = here > most ? here : most;
    }
    return 2 * steps > 5 * (most - least) ? least : -1;
}

void rf_stack_find_noise(struct refocus_stack *s)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    uint32_t *count = (uint32_t *)(void *)s->moved, all = 0, noisy = 0, below = 0, value = 0;

    memset(count, 0, VALUES * sizeof *count);
    for (size_t i = 0; i < samples; i += RF_STACK_STRIDE) {
        const int least = least_of_noise(s, i);

        all++;
        if (least >= 0) {
            count[least]++;
            noisy++;
        }
    }
    s->noise = 0;
    if (noisy * MANY < all || !noisy)
        return;
    while ((below += count[value]) * FLAT <= noisy)
        value++;
    s->noise = value * value;
}
