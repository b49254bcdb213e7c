/* weigh.c: multiplies the light of three planes by the weights of eq. 5. */
#include "kernels/weigh_planes.h"

void rf_weigh_c(const struct rf_weigh_job *job, int n)
{
    rf_weigh_planes(job, n, 3);
}
