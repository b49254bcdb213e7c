/* test_highlight_lists.c: runs of highlights are found in their list, and rows of one highlight are
 * splatted as one, however many runs lie between them; noise of the map parts no runs and makes no
 * silhouettes. */
#include <stdint.h>
#include <stdlib.h>
#include "unit_test.h"
#include <string.h>

#include "highlights/estimate.h"
#include "highlights/highlights.h"
#include "highlights/in_window.h"
#include "kernels/kernels.h"
#include "support/places.h"

static uint32_t noise(uint32_t *seed)
{
    *seed = *seed * 1664525 + 1013904223;
    return *seed >> 8;
}

/* Each place around, by a search from the first run on. */
TEST(the_first_run_is_found)
{
    enum { RUNS = 40, SIDE = 12 };
    static struct rf_highlight run[RUNS];
    uint32_t seed = 5;

    for (int count = 0; count <= RUNS; count++) {
        for (int i = 0; i < count; i++)
            run[i] = (struct rf_highlight){.x = (uint16_t)(noise(&seed) % SIDE),
                                           .y = (uint16_t)(noise(&seed) % SIDE)};
        rf_sort_places(run, (uint32_t)count, sizeof *run);
        for (int y = -1; y <= SIDE; y++)
            for (int x = -1; x <= SIDE; x++) {
                int first = 0;

                while (first < count &&
                       (run[first].y < y || (run[first].y == y && run[first].x < x)))
                    first++;
                assert_ptr_equal(rf_first_run(run, run + count, x, y), run + first);
            }
    }
}

/* A window of 16 rows that is all one highlight, in runs of 4 pixels: more in a row than a byte
 * counts. */
TEST(rows_of_wide_photos_are_stacked)
{
    enum { WIDTH = 4096, COUNT = 4, IN_ROW = WIDTH / COUNT, BLUR = 40 * 256 };
    const uint32_t runs = IN_ROW * RF_TILE;
    int16_t *const blur = malloc((size_t)WIDTH * RF_TILE * sizeof *blur);
    struct rf_highlight *const run = malloc(runs * sizeof *run);
    struct rf_bins *const bins = calloc(WIDTH / RF_TILE, sizeof *bins);
    static struct rf_highlight_list part[RF_HIGHLIGHT_PARTS];
    struct rf_highlights highlights = {part, NULL, NULL};
    const struct rf_viewport view = {.photo_width = WIDTH,
                                     .photo_height = RF_TILE,
                                     .width = WIDTH,
                                     .height = RF_TILE,
                                     .tiles_x = WIDTH / RF_TILE,
                                     .tiles_y = 1};
    struct rf_highlight_window window = {
        .view = &view, .blur = {blur, WIDTH, 0}, .highlights = &highlights, .bins = bins};
    struct rf_pool pool;
    const struct rf_executor exec = {.pool = &pool};

    assert_non_null(blur);
    assert_non_null(run);
    assert_non_null(bins);
    part[0] = (struct rf_highlight_list){run, 0, runs};
    assert_int_equal(rf_pool_start(&pool, 1, NULL, NULL), REFOCUS_OK);
    for (int i = 0; i < WIDTH * RF_TILE; i++)
        blur[i] = BLUR;
    for (uint32_t i = 0; i < runs; i++) {
        const struct rf_highlight one = {.x = (uint16_t)(i % IN_ROW * COUNT),
                                         .y = (uint16_t)(i / IN_ROW),
                                         .count = COUNT,
                                         .size = UINT8_MAX};
        rf_list_highlight(&highlights, &one);
    }
    rf_sort_highlights(&exec, &highlights);
    rf_mark_highlights(&exec, &window, true);
    for (uint32_t i = 0; i < runs; i++) {
        assert_int_equal(run[i].blur, BLUR);
        assert_int_equal(run[i].rows, run[i].y % RF_HIGHLIGHT_STACK ? 0 : RF_HIGHLIGHT_STACK);
        assert_int_equal(run[i].below, (run[i].y + 1) % RF_HIGHLIGHT_STACK ? IN_ROW : 0);
    }
    rf_pool_end(&pool);
    free(blur);
    free(run);
    free(bins);
}

/* A run whose blurs differ by noise alone has one blur, their mean. */
TEST(noise_parts_no_runs)
{
    enum { COUNT = 16, BLUR = 10 * 256, NOISE = 300 };
    int16_t blur[RF_TILE * RF_TILE];
    struct rf_highlight run = {.y = 3, .count = COUNT};
    struct rf_highlight_list part = {&run, 1, 1};
    struct rf_highlights highlights = {&part, NULL, NULL};
    struct rf_bins bins = {.noise = NOISE};
    const struct rf_viewport view = {.photo_width = RF_TILE,
                                     .photo_height = RF_TILE,
                                     .width = RF_TILE,
                                     .height = RF_TILE,
                                     .tiles_x = 1,
                                     .tiles_y = 1};
    const struct rf_highlight_window window = {
        .view = &view, .blur = {blur, RF_TILE, 0}, .highlights = &highlights, .bins = &bins};
    struct rf_pool pool;
    const struct rf_executor exec = {.pool = &pool};

    assert_int_equal(rf_pool_start(&pool, 1, NULL, NULL), REFOCUS_OK);
    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        blur[i] = (int16_t)(BLUR + (i % 2 ? NOISE : -NOISE));
    rf_mark_highlights(&exec, &window, true);
    assert_int_equal(run.blur, BLUR);
    bins.noise = 0;
    rf_mark_highlights(&exec, &window, true);
    assert_int_equal(run.blur, RF_NO_BLUR);
    rf_pool_end(&pool);
}

enum { SQUARE = 64, SIDE_OF_IT = 24, NEAR = 52000, FAR = 26000 };

/* The silhouettes of a bright square before something dark; of a map with noise of so many codes,
 * uniform, and a photo in which every other pixel of both is as bright. */
static uint32_t silhouettes_of(int codes, bool mottled)
{
    static uint16_t light[SQUARE * SQUARE], disparity[SQUARE * SQUARE];
    const struct rf_viewport view = {.photo_width = SQUARE,
                                     .photo_height = SQUARE,
                                     .width = SQUARE,
                                     .height = SQUARE,
                                     .tiles_x = SQUARE / RF_TILE,
                                     .tiles_y = SQUARE / RF_TILE};
    const struct rf_silhouette_window window = {
        &view, {{light, light, light}, SQUARE}, {disparity, SQUARE}, NULL};
    static struct rf_silhouette pixel[SQUARE * SQUARE];
    struct rf_silhouettes list = {.pixel = pixel, .capacity = SQUARE * SQUARE};
    struct rf_kernels kernels;
    const struct rf_executor exec = {.kernels = &kernels};
    uint32_t seed = 3, cpu = REFOCUS_CPU_AUTO;

    assert_true(rf_kernels_select(&kernels, &cpu));
    for (int i = 0; i < SQUARE * SQUARE; i++) {
        const int x = abs(i % SQUARE - SQUARE / 2), y = abs(i / SQUARE - SQUARE / 2);
        const bool near = x < SIDE_OF_IT / 2 && y < SIDE_OF_IT / 2;
        const bool beside = x <= SIDE_OF_IT / 2 && y <= SIDE_OF_IT / 2;

        light[i] = near ? RF_LIGHT_MAX : beside ? RF_LIGHT_MAX / 3 : RF_LIGHT_MAX / 50;
        if (mottled)
            light[i] = noise(&seed) % 2 ? RF_LIGHT_MAX : RF_LIGHT_MAX / 50;
        disparity[i] = (uint16_t)((near ? NEAR : FAR) - codes +
                                  (codes ? (int)(noise(&seed) % (2u * (uint32_t)codes)) : 0));
    }
    rf_find_silhouettes(&exec, &window, (struct rf_rect){0, 0, SQUARE, SQUARE}, &list);
    return list.count;
}

/* Noise of the map makes none, and takes none away where a jump is more than noise. */
TEST(noise_makes_no_silhouettes)
{
    enum { NOISE = 2300 }; /* a standard deviation of 2 % */
    const uint32_t clean = silhouettes_of(0, false);

    assert_int_equal(clean, 4 * SIDE_OF_IT);
    assert_in_range(silhouettes_of(NOISE, false), clean, clean * 5 / 4);
    assert_true(silhouettes_of(NOISE, true) < 3 * silhouettes_of(0, true));
}

/* Where a photo is looked at: no pixel that has lost as much lies elsewhere, however many pixels
 * its cells are wide. */
TEST(lost_light_is_found)
{
    enum { SIDE = 4096 };
    static float lost[2 * RF_GRID_SIDE];
    uint32_t seed = 7;
    int found = 0;

    for (int width = 1; width < SIDE; width += 1 + width / 9) {
        const struct rf_photo_source photo = {.width = width, .height = 2};
        const struct rf_light_grid grid = {
            .photo = &photo, .width = rf_smaller(width, RF_GRID_SIDE), .height = 2};
        const struct rf_estimate estimate = {&grid, lost, 1};
        uint8_t reaches[RF_GRID_SIDE];

        for (int i = 0; i < 2 * grid.width; i++)
            lost[i] = noise(&seed) % 6 ? -1 : (float)(noise(&seed) % 3);
        for (int y = 0; y < 2; y++) {
            const struct rf_estimate_row row = rf_estimate_row(&estimate, y);
            const bool any = rf_estimate_reaches(&row, 0.5f, reaches);

            for (int x = 0; x < width; x++) {
                if (rf_estimate_at(&row, x) < 0.5f)
                    continue;
                assert_true(any && reaches[rf_grid_cell(x, width, grid.width)]);
                found++;
            }
        }
    }
    assert_true(found > SIDE);
}
