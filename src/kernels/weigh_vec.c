/* weigh_vec.c: multiplies the light of three planes by its weights, some tiles' rows at a time. */
#include "kernels/weigh_planes_vec.h"

void RF_VEC(rf_weigh)(const struct rf_weigh_job *job, int n)
{
    const int tiles = n / RF_TILE, whole = tiles * RF_TILE;
    const struct rf_weigh_job rest = {
        {job->near[0] + whole, job->near[1] + whole, job->near[2] + whole},
        {job->far[0] + whole, job->far[1] + whole, job->far[2] + whole},
        job->near_weight + whole,
        job->far_weight + whole,
        job->brightest + tiles,
        job->light_weight};

    rf_weigh_planes_vec(job, n, 3);
    rf_weigh_c(&rest, n - whole);
}
