/* aperture_shapes.c: three ways to say what shape an aperture has, and where the rays go that a
 * render takes through it.
 *
 * The shapes are a disc, the hexagon of an iris of six blades, and a mask that is drawn below.
 * Lights out of focus show these shapes.
 *
 *     aperture_shapes > shapes.svg    32 rays of each, on the open pixels of a blur of K = 20
 */
#include <stdint.h>
#include <stdio.h>
#include <refocus/aperture.h>

enum { RAYS = 32, SIDE = 9, K = 20 };

/* '#' is open; seen from behind the camera. */
static const char *const key_hole[SIDE] = {"...###...", "..#####..", "..#####..",
                                           "..#####..", "...###...", "...###...",
                                           "..#####..", "..#####..", ".#######."};

/* Rays are the mirror image of the mask: see aperture.h. Q15 becomes pixels. */
static double pixels(int16_t q15)
{
    return -K * q15 / 32768.0;
}

static int draw(const struct refocus_aperture *aperture, int column)
{
    static struct refocus_ray open[(2 * K + 1) * (2 * K + 1)];
    struct refocus_ray rays[RAYS];
    int status;
    const int capacity = sizeof open / sizeof *open;
    const int count = refocus_aperture_full_rays(aperture, K, capacity, open);

    if (count < 0)
        return count;
    if (count > capacity)
        return REFOCUS_ERR_SIZE;
    printf("<g transform=\"translate(%d %d)\">\n", (2 * column + 1) * (K + 4), K + 4);
    for (int i = 0; i < count; i++)
        printf("<rect x=\"%.2f\" y=\"%.2f\" width=\"1\" height=\"1\" fill-opacity=\"%.2f\"/>\n",
               pixels(open[i].u) - 0.5, pixels(open[i].v) - 0.5, open[i].weight / 255.0);
    status = refocus_aperture_rays(aperture, RAYS, rays);
    for (int i = 0; i < RAYS && status == REFOCUS_OK; i++)
        printf("<circle cx=\"%.2f\" cy=\"%.2f\" r=\"0.7\" fill=\"red\"/>\n", pixels(rays[i].u),
               pixels(rays[i].v));
    printf("</g>\n");
    return status;
}

int main(void)
{
    static uint8_t mask[SIDE][SIDE]; /* 255 = open */
    struct refocus_aperture *shapes[3] = {NULL};
    int status;

    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            mask[y][x] = key_hole[y][x] == '#' ? 255 : 0;
    status = refocus_aperture_create_disc(&shapes[0]);
    if (status == REFOCUS_OK)
        status = refocus_aperture_create_polygon(&shapes[1], 6, 15);
    if (status == REFOCUS_OK)
        status = refocus_aperture_create_mask(&shapes[2], mask[0], SIDE, SIDE, sizeof mask[0]);
    printf("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" fill=\"gray\">\n",
           6 * (K + 4), 2 * (K + 4));
    for (int i = 0; i < 3 && status == REFOCUS_OK; i++)
        status = draw(shapes[i], i);
    printf("</svg>\n");
    for (int i = 0; i < 3; i++)
        refocus_aperture_destroy(&shapes[i]); /* at the end of all renders that use it */
    if (status != REFOCUS_OK)
        fprintf(stderr, "aperture_shapes: %s\n", refocus_strerror(status));
    return status == REFOCUS_OK ? 0 : 1;
}
