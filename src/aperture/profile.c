/* profile.c: how light is spread from the middle of an aperture to its edge, by the equations of
 * refocus_aperture_params. */
#include "aperture/aperture.h"

/* The share of the light that falls within the share v of the area. */
static double share_within(double edge, double v)
{
    if (edge >= 0)
        return (1 - edge) * v + edge * v * v * v * v * v;
    return (1 + edge) * v - edge * (2 * v - v * v);
}

double rf_profile_square(const struct rf_profile *profile, double share)
{
    const double hole = profile->hole * profile->hole;
    double low = 0, high = 1;

    if (profile->edge == 0)
        low = share;
    else
        for (int i = 0; i < 50; i++) {
            const double v = (low + high) / 2;

            if (share_within(profile->edge, v) < share)
                low = v;
            else
                high = v;
        }
    return hole + (1 - hole) * low;
}

double rf_profile_density(const struct rf_profile *profile, double square)
{
    const double hole = profile->hole * profile->hole, e = profile->edge;
    const double v = (square - hole) / (1 - hole);
    const double u = v > 1 ? 1 : v;

    if (v < 0)
        return 0;
    return e >= 0 ? (1 - e + 5 * e * u * u * u * u) / (1 + 4 * e)
                  : (1 + e - 2 * e * (1 - u)) / (1 - e);
}
