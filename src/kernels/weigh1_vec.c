/* weigh1_vec.c: multiplies the light of one plane by its weights, some tiles' rows at a time. */
#include "kernels/weigh_planes_vec.h"

void RF_VEC(rf_weigh1)(const struct rf_weigh1_job *job, int n)
{
    const int tiles = n / RF_TILE, whole = tiles * RF_TILE;
    const struct rf_weigh_job planes = {{job->near},     {job->far},     job->near_weight,
                                        job->far_weight, job->brightest, job->light_weight};
    const struct rf_weigh1_job rest = {job->near + whole,        job->far + whole,
                                       job->near_weight + whole, job->far_weight + whole,
                                       job->brightest + tiles,   job->light_weight};

    rf_weigh_planes_vec(&planes, n, 1);
    rf_weigh1_c(&rest, n - whole);
}
