/* weigh_vec.c: light times weight, some tiles' rows at a time. */
#include "colour/transfer.h"
#include "kernels/weigh_vec.h"

enum { TILES = RF_WEIGH_TILES, EACH = (int)RF_TILE / (int)VEC_U16 };

/* The brightest channels of a tile's row, white at most. */
static void look(uint16_t *most, uint16_t *const light[3], int x)
{
    for (int j = 0; j < EACH; j++, x += (int)VEC_U16) {
        const vec_u16 red = vec_u16_load(light[0] + x), green = vec_u16_load(light[1] + x);
        const vec_u16 both = vec_u16_max(red, green);
        const vec_u16 all = vec_u16_max(both, vec_u16_load(light[2] + x));

        vec_u16_store(most + j * (int)VEC_U16, vec_u16_min(all, vec_u16_set(RF_LIGHT_MAX)));
    }
}

static bool are_same(const struct rf_weigh_job *job, int x)
{
    vec_u16 differ = vec_u16_set(0);

    for (int c = 0; c < 3; c++)
        for (int i = x; i < x + RF_TILE; i += (int)VEC_U16)
            differ = vec_u16_or(differ, vec_u16_xor(vec_u16_load(job->near[c] + i),
                                                    vec_u16_load(job->far[c] + i)));
    return !vec_u16_any(differ);
}

/* Returns the greater of `brightest` and the light of a tile's row. */
static vec_u16 multiply(uint16_t *const light[3], const uint16_t *weight,
                        const struct rf_weights *weights, int x, vec_u16 brightest)
{
    vec_u16 odd[RF_ODD_LIGHTS];

    for (int i = 0; i < RF_ODD_LIGHTS; i++)
        odd[i] = vec_u16_set(weights->odd[i]);
    for (int end = x + RF_TILE; x < end; x += (int)VEC_U16) {
        const vec_u16 eight = rf_eight_times(vec_u16_load(weight + x));

        for (int c = 0; c < 3; c++) {
            const vec_u16 v = vec_u16_load(light[c] + x);
            const vec_u16 large = vec_s16_scale(v, eight);
            const vec_u16 one = vec_u16_or(
                vec_u16_or(vec_u16_equal(v, odd[0]), vec_u16_equal(v, odd[1])),
                vec_u16_or(vec_u16_equal(v, odd[2]), vec_u16_equal(v, odd[3])));
            const vec_u16 small =
                vec_s16_scale(vec_u16_sub(vec_u16_add(v, v), one), eight);
            const vec_u16 product = vec_u16_select(
                vec_u16_at_most(v, vec_u16_set(16383)), small, vec_u16_add(large, large));

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
    const struct rf_weights *weights = job->weights;
    struct rf_weigh_run run;

    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        run.same[i] = are_same(job, x);
        look(run.near + i * RF_TILE, job->near, x);
        if (!run.same[i])
            look(run.far + i * RF_TILE, job->far, x);
    }
    rf_look_up_weights(job->near_weight + first, job->far_weight + first, &run,
                       weights->light_weight, tiles);
    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        uint16_t *most = &job->brightest[x / RF_TILE], here;
        vec_u16 brightest =
            multiply(job->near, job->near_weight, weights, x, vec_u16_set(0));

        if (run.same[i])
            copy_tile(job, x);
        else
            brightest = multiply(job->far, job->far_weight, weights, x, brightest);
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
