/* lommel.c: Lommel's functions by series of Bessel functions.
 *
 *     V_n(u, v) = sum over s of (-1)^s (v/u)^(n+2s) J_(n+2s)(v)        eq. 14
 *     I(u, v) = (2/u)^2 (1 + V_0^2 + V_1^2 - 2 V_0 cos b - 2 V_1 sin b),
 *     b = (u + v^2/u) / 2
 *
 * inside the geometric circle, v <= u, where the powers shrink. (The paper prints the form with
 * U_1^2 + U_2^2, powers of u/v, which is the same but loses all digits for large u.) All of it
 * is IEEE additions and multiplications: the same bits everywhere.
 */
#include "papers/lommel.h"

#include "aperture/aperture.h"

enum { MOST_ORDERS = 2100 };

/* Computes J_0(v) .. J_n(v) by Miller's backward recurrence, J_(k-1) = (2k/v) J_k - J_(k+1), and
 * J_0 + 2 J_2 + 2 J_4 + ... = 1. Returns n, beyond which they are below 1e-12. */
static int bessel(double v, double *j)
{
    const int n = (int)v + 12 + (int)(v / 8) + (v < 4 ? 8 : 16);
    const int top = n + 20 + n / 16;
    double above = 0, here = 1e-200, sum = 0;

    for (int k = top; k >= 0; k--) {
        const double below = 2 * k / v * here - above;

        if (k <= n)
            j[k] = here;
        if (k % 2 == 0)
            sum += k > 0 ? 2 * here : here;
        above = here;
        here = below;
        if (here > 1e200 || here < -1e200) {
            here *= 1e-200;
            above *= 1e-200;
            sum *= 1e-200;
            for (int i = k; i <= n; i++)
                j[i] *= 1e-200;
        }
    }
    for (int k = 0; k <= n; k++)
        j[k] /= sum;
    return n;
}

double rf_lommel(double u, double v)
{
    const double two_pi = 6.28318530717958647692;
    double j[MOST_ORDERS], V[2] = {1, 0}, power = 1, sine, cosine;

    if (v > 1e-9) {
        const int n = bessel(v, j);

        V[0] = 0;
        for (int k = 0; k <= n && power > 1e-16; k++) {
            V[k % 2] += (k / 2 % 2 ? -1 : 1) * power * j[k];
            power *= v / u;
        }
    }
    rf_sincos_turns((u + v * v / u) / 2 / two_pi, &sine, &cosine);
    return 4 / (u * u) * (1 + V[0] * V[0] + V[1] * V[1] - 2 * V[0] * cosine - 2 * V[1] * sine);
}
