/* depth_fit.c: measures how well the edges and surfaces of a map of disparities fit the exact ones.
 */
#include "depth_fit.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { EDGE = 65535 / 20 }; /* a step of one pixel of blur at K = 20 */

static bool both(const uint8_t *known, size_t a, size_t b)
{
    return !known || (known[a] && known[b]);
}

/* Pixels on either side of a step. */
static void find_edges(const uint16_t *d, const uint8_t *known, int w, int h, uint8_t *edge)
{
    memset(edge, 0, (size_t)w * (size_t)h);
    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x;

            if (x + 1 < w && both(known, i, i + 1) && abs(d[i] - d[i + 1]) >= EDGE)
                edge[i] = edge[i + 1] = 1;
            if (y + 1 < h && both(known, i, i + (size_t)w) && abs(d[i] - d[i + (size_t)w]) >= EDGE)
                edge[i] = edge[i + (size_t)w] = 1;
        }
    }
}

static bool any_within(const uint8_t *edge, int w, int h, int x, int y, int reach)
{
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < w && j < h && edge[(size_t)j * (size_t)w + (size_t)i])
                return true;
    return false;
}

/* Edges beside a hole are not known: what is found there is neither true nor false. */
static bool beside_hole(const uint8_t *known, int w, int h, int x, int y, int reach)
{
    for (int j = y - reach; known && j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < w && j < h && !known[(size_t)j * (size_t)w + (size_t)i])
                return true;
    return false;
}

int depth_fit(const struct quality_scene *scene, const uint8_t *known, const uint16_t *d,
              struct depth_fit *fit)
{
    const int w = scene->width, h = scene->height;
    uint8_t *edge = malloc((size_t)w * (size_t)h), *found = malloc((size_t)w * (size_t)h);
    long edges = 0, hits = 0, founds = 0, trues = 0, smooth = 0, beside = 0;
    double smooth_sum = 0, beside_sum = 0;

    if (!edge || !found) {
        free(edge);
        free(found);
        return -1;
    }
    find_edges(scene->disparity, known, w, h, edge);
    find_edges(d, known, w, h, found);
    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x;
            const double error = abs(d[i] - scene->disparity[i]) / 65535.0;

            if (known && !known[i])
                continue;
            edges += edge[i];
            hits += edge[i] && any_within(found, w, h, x, y, 1);
            if (found[i] && !beside_hole(known, w, h, x, y, 1)) {
                founds++;
                trues += any_within(edge, w, h, x, y, 1);
            }
            if (beside_hole(known, w, h, x, y, 4))
                continue;
            if (any_within(edge, w, h, x, y, 4)) {
                beside++;
                beside_sum += error;
            } else {
                smooth++;
                smooth_sum += error;
            }
        }
    }
    *fit = (struct depth_fit){100.0 * (double)hits / (double)(edges ? edges : 1),
                              100.0 * (double)trues / (double)(founds ? founds : 1),
                              smooth_sum / (double)(smooth ? smooth : 1),
                              beside_sum / (double)(beside ? beside : 1)};
    free(edge);
    free(found);
    return 0;
}
