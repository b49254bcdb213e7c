/* disorder.c: how many samples of a focus stack show that its frames are out of order. */
#include "focus_stack/focus_stack.h"

/* Whether the sharpness of a sample has two peaks, and less than half of them between. */
static bool has_two_peaks(const struct refocus_stack *s, size_t i)
{
    int most = 0, left = 0;

    for (int k = 0; k < s->count; k++)
        most = s->frame[k].sharpness[i] > most ? s->frame[k].sharpness[i] : most;
    for (int k = 0; k < s->count; k++) {
        const int here = s->frame[k].sharpness[i];
        int right = 0;

        for (int j = k + 1; j < s->count; j++)
            right = s->frame[j].sharpness[i] > right ? s->frame[j].sharpness[i] : right;
        const int lower = left < right ? left : right;

        if (2 * here < lower && 3 * lower > most)
            return true;
        left = here > left ? here : left;
    }
    return false;
}

float rf_stack_disorder(const struct refocus_stack *s)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    int all = 0, wrong = 0;

    for (size_t i = 0; i < samples; i += RF_STACK_STRIDE)
        if (s->sure[i] >= RF_STACK_MEASURED) {
            all++;
            wrong += has_two_peaks(s, i);
        }
    return all ? (float)wrong / (float)all : 0;
}
