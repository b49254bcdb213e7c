/* weigh1.c: multiplies the light of one plane by the weights of eq. 5. */
#include "kernels/weigh_planes.h"

void rf_weigh1_c(const struct rf_weigh1_job *job, int n)
{
    const struct rf_weigh_job planes = {{job->near},     {job->far},     job->near_weight,
                                        job->far_weight, job->brightest, job->light_weight};

    rf_weigh_planes(&planes, n, 1);
}
