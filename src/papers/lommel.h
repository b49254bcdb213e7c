/* lommel.h: how light is spread within a circle of confusion. */
#ifndef RF_LOMMEL_H
#define RF_LOMMEL_H

/*
 * The intensity of light behind a circular aperture that is out of focus, E. Lommel 1885, Potmesil
 * & Chakravarty 1981 eq. 13, in units of the middle of a point in focus:
 *
 *     I(u, v) = |2 integral 0..1 J0(v t) exp(-i u t^2 / 2) t dt|^2
 *
 * u > 0 says how far out of focus, v <= 2000 where in the circle; the geometric circle of
 * confusion ends at v = u, and I is for 0 <= v <= u.
 */
double rf_lommel(double u, double v);

#endif
