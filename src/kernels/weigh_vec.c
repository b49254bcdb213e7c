/* weigh_vec.c: light times weight, some tiles' rows at a time. */
#include "colour/transfer.h"
#include "kernels/weigh_vec.h"

enum { TILES = RF_WEIGH_TILES, EACH = (int)RF_TILE / (int)VEC_U16 };

/* The brightest channels of a tile's row, white at most. Returns whether any exceeds 16383. */
static bool look(uint16_t *most, uint16_t *const light[3], int x)
{
    vec_u16 large = vec_u16_set(0);

    for (int j = 0; j < EACH; j++, x += (int)VEC_U16) {
        const vec_u16 red = vec_u16_load(light[0] + x), green = vec_u16_load(light[1] + x);
        const vec_u16 both = vec_u16_max(red, green);
        const vec_u16 all = vec_u16_max(both, vec_u16_load(light[2] + x));

        vec_u16_store(most + j * (int)VEC_U16, vec_u16_min(all, vec_u16_set(RF_LIGHT_MAX)));
        large = vec_u16_or(large, vec_u16_and(all, vec_u16_set(49152)));
    }
    return vec_u16_any(large);
}

static bool are_same(const struct rf_weigh_job *job, int x)
{
    vec_u16 differ = vec_u16_set(0);

    for (int c = 0; c < 3; c++)
        for (int i = x; i < x + RF_TILE; i += (int)VEC_U16)
            differ = vec_u16_or(
                differ, vec_u16_xor(vec_u16_load(job->near[c] + i), vec_u16_load(job->far[c] + i)));
    return !vec_u16_any(differ);
}

/* Light of a tile's row by weights in Q15, which become those of the plane. Returns the greater of
 * `brightest` and that light. */
static inline vec_u16 multiply(uint16_t *const light[3], uint16_t *weight, const uint16_t *fine,
                               int x, vec_u16 brightest, const bool large)
{
    for (int end = x + RF_TILE; x < end; x += (int)VEC_U16, fine += VEC_U16) {
        const vec_u16 w = vec_u16_load(fine), eight = rf_whole_eighths(w);

        vec_u16_store(weight + x, rf_eighth(w));
        for (int c = 0; c < 3; c++) {
            const vec_u16 v = vec_u16_load(light[c] + x);
            const vec_u16 once = vec_s16_scale(v, eight);
            vec_u16 product = vec_s16_scale(vec_u16_add(v, v), eight);

            if (large)
                product = vec_u16_select(vec_u16_at_most(v, vec_u16_set(16383)), product,
                                         vec_u16_add(once, once));
            vec_u16_store(light[c] + x, product);
            brightest = vec_u16_max(brightest, product);
        }
    }
    return brightest;
}

static void copy_tile(const struct rf_weigh_job *job, int x)
{
    for (int i = x; i < x + RF_TILE; i += (int)VEC_U16) {
        vec_u16_store(job->far_weight + i, vec_u16_load(job->near_weight + i));
        for (int c = 0; c < 3; c++)
            vec_u16_store(job->far[c] + i, vec_u16_load(job->near[c] + i));
    }
}

/* Whole tiles. Where the background is what is seen, so is its light times weight. */
static void weigh_tiles(const struct rf_weigh_job *job, int first, int tiles)
{
    struct rf_weigh_run run;
    bool large = false; /* highlights beyond four times white */

    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        run.same[i] = are_same(job, x);
        large |= look(run.near + i * RF_TILE, job->near, x);
        if (!run.same[i])
            large |= look(run.far + i * RF_TILE, job->far, x);
    }
    rf_look_up_weights(&run, job->light_weight, tiles);
    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        const uint16_t *near = run.near + i * RF_TILE, *far = run.far + i * RF_TILE;
        uint16_t *most = &job->brightest[x / RF_TILE], here;
        vec_u16 brightest = vec_u16_set(0);

        brightest = large ? multiply(job->near, job->near_weight, near, x, brightest, true)
                          : multiply(job->near, job->near_weight, near, x, brightest, false);
        if (run.same[i])
            copy_tile(job, x);
        else if (large)
            brightest = multiply(job->far, job->far_weight, far, x, brightest, true);
        else
            brightest = multiply(job->far, job->far_weight, far, x, brightest, false);
        here = vec_u16_greatest(brightest);
        *most = here > *most ? here : *most;
    }
}

static void RF_VEC(rf_weigh)(const struct rf_weigh_job *job, int n)
{
    struct rf_weigh_job rest = *job;
    const int whole = n / RF_TILE;

    for (int i = 0; i < whole; i += TILES)
        weigh_tiles(job, i * RF_TILE, whole - i < TILES ? whole - i : TILES);
    for (int c = 0; c < 3; c++) {
        rest.near[c] += whole * RF_TILE;
        rest.far[c] += whole * RF_TILE;
    }
    rest.near_weight += whole * RF_TILE;
    rest.far_weight += whole * RF_TILE;
    rest.brightest += whole;
    rf_weigh_c(&rest, n - whole * RF_TILE);
}

void RF_VEC(rf_weigh_use)(struct rf_kernels *kernels)
{
    kernels->weigh = RF_VEC(rf_weigh);
}
