/* draw_disc.c: adds the light of a run of highlight pixels, drawn as discs, to a tile. */
#include "kernels/kernels.h"

void rf_draw_disc_c(uint16_t *const mean[3], const struct rf_disc_job *job)
{
    for (int y = job->first; y < job->end; y++) {
        for (int x = 0; x < RF_TILE; x++) {
            const int at = (64 >> job->unit) * x;
            const int first = at + job->left[y], last = at + job->right[y];
            const int from = first > job->from ? first : job->from;
            const int to = last < job->to ? last : job->to;
            const int i = y * RF_TILE + x;
            int seen = to > from ? to - from : 0;

            if (job->visible)
                seen =
                    (seen / 2 & job->visible[i]) + (seen / 2 & job->visible[RF_TILE * RF_TILE + i]);
            for (int c = 0; c < job->planes; c++) {
                const int scaled = seen << job->shift;
                const int light = mean[c][i] + ((scaled * job->each[c] + (1 << 14)) >> 15);

                mean[c][i] = (uint16_t)(light < 65535 ? light : 65535);
            }
        }
    }
}
