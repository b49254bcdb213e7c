/* weigh1_vec.c: light of one plane, and chroma, times weight; as weigh_vec.c. */
#include "colour/transfer.h"
#include "kernels/weigh_vec.h"

enum { TILES = RF_WEIGH_TILES };

/* Where weights are: light, white at most. */
static void look(uint16_t *at, const uint16_t *light)
{
    for (int x = 0; x < RF_TILE; x += (int)VEC_U16)
        vec_u16_store(at + x, vec_u16_min(vec_u16_load(light + x), vec_u16_set(RF_LIGHT_MAX)));
}

static bool are_same(const uint16_t *near, const uint16_t *far)
{
    vec_u16 differ = vec_u16_set(0);

    for (int x = 0; x < RF_TILE; x += (int)VEC_U16)
        differ = vec_u16_or(differ, vec_u16_xor(vec_u16_load(near + x), vec_u16_load(far + x)));
    return !vec_u16_any(differ);
}

/* Light of a tile's row by weights in Q15, which become those of the plane. Returns the greater of
 * `brightest` and that light. */
static vec_u16 multiply(uint16_t *light, uint16_t *weight, const uint16_t *fine, vec_u16 brightest)
{
    for (int x = 0; x < RF_TILE; x += (int)VEC_U16) {
        const vec_u16 v = vec_u16_load(light + x), w = vec_u16_load(fine + x);
        const vec_u16 product = vec_s16_scale(vec_u16_add(v, v), rf_whole_eighths(w));

        vec_u16_store(weight + x, rf_eighth(w));
        vec_u16_store(light + x, product);
        brightest = vec_u16_max(brightest, product);
    }
    return brightest;
}

static void copy(uint16_t *to, const uint16_t *from)
{
    for (int x = 0; x < RF_TILE; x += (int)VEC_U16)
        vec_u16_store(to + x, vec_u16_load(from + x));
}

/* Whole tiles. Where the background is what is seen, so is its light times weight. */
static void weigh_tiles(const struct rf_weigh1_job *job, int first, int tiles)
{
    struct rf_weigh_run run;

    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        run.same[i] = are_same(job->near + x, job->far + x);
        look(run.near + i * RF_TILE, job->near + x);
        if (!run.same[i])
            look(run.far + i * RF_TILE, job->far + x);
    }
    rf_look_up_weights(&run, job->light_weight, tiles);
    for (int i = 0, x = first; i < tiles; i++, x += RF_TILE) {
        uint16_t *most = &job->brightest[x / RF_TILE], here;
        vec_u16 brightest =
            multiply(job->near + x, job->near_weight + x, run.near + i * RF_TILE, vec_u16_set(0));

        if (run.same[i]) {
            copy(job->far_weight + x, job->near_weight + x);
            copy(job->far + x, job->near + x);
        } else {
            brightest =
                multiply(job->far + x, job->far_weight + x, run.far + i * RF_TILE, brightest);
        }
        here = vec_u16_greatest(brightest);
        *most = here > *most ? here : *most;
    }
}

static void RF_VEC(rf_weigh1)(const struct rf_weigh1_job *job, int n)
{
    const int tiles = n / RF_TILE, whole = tiles * RF_TILE;
    const struct rf_weigh1_job rest = {job->near + whole,        job->far + whole,
                                       job->near_weight + whole, job->far_weight + whole,
                                       job->brightest + tiles,   job->light_weight};

    for (int i = 0; i < tiles; i += TILES)
        weigh_tiles(job, i * RF_TILE, tiles - i < TILES ? tiles - i : TILES);
    rf_weigh1_c(&rest, n - whole);
}

static void RF_VEC(rf_weigh_chroma)(uint16_t *chroma, const uint16_t *weight, int n)
{
    int i = 0;

    for (; i + (int)VEC_U16 <= 2 * n; i += (int)VEC_U16)
        vec_u16_store(chroma + i,
                      vec_s16_scale(vec_u16_load(chroma + i),
                                    rf_eight_times(vec_u16_twice(vec_u16_load(weight + i)))));
    rf_weigh_chroma_c(chroma + i, weight + i, n - i / 2);
}

void RF_VEC(rf_weigh1_use)(struct rf_kernels *kernels)
{
    kernels->weigh1 = RF_VEC(rf_weigh1);
    kernels->weigh_chroma = RF_VEC(rf_weigh_chroma);
}
