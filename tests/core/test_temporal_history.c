/* test_temporal_history.c: earlier frames show a sample of this one, and vote on its depth. */
#include <stdint.h>
#include "unit_test.h"

#include "depth/temporal.h"

/* Frames with weights vote against a surface at 1000. */
TEST(majorities)
{
    static const struct {
        struct rf_history history;
        int voters, mean; /* 0: the surface stays */
    } cases[] = {
        {{7, {1000, 1000, 9000, 9000, 9000, 9000, 9000}, {12, 12, 12, 12, 12, 12, 12}}, 0, 0},
        {{7, {1000, 9000, 9000, 9004, 9000, 9000, 9000}, {12, 12, 12, 12, 12, 12, 12}}, 6, 9001},
        {{7, {1000, 1000, 9000, 9000, 9000, 9000, 9000}, {4, 4, 12, 12, 12, 12, 12}}, 5, 9000},
        {{7, {9000, 5000, 3000, 9040, 7000, 4000, 6000}, {12, 12, 12, 12, 12, 12, 12}}, 2, 9020},
        {{6, {9000, 5000, 3000, 9040, 7000, 4000, 0}, {12, 12, 12, 12, 12, 12, 0}}, 0, 0},
        {{3, {9000, 9000, 1000, 0, 0, 0, 0}, {12, 12, 12, 0, 0, 0, 0}}, 0, 0},
        {{4, {9000, 9000, 9000, 1000, 0, 0, 0}, {12, 12, 12, 12, 0, 0, 0}}, 3, 9000},
        {{2, {9000, 9000, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0, 0}}, 2, 9000},
        {{1, {9000, 0, 0, 0, 0, 0, 0}, {12, 0, 0, 0, 0, 0, 0}}, 1, 9000},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint16_t mean = 0;

        assert_int_equal(rf_history_vote(&cases[i].history, 1000, 100, &mean), cases[i].voters);
        assert_int_equal(mean, cases[i].mean);
    }
}

/* The history follows a sample back until it was nowhere; what shows other things has no vote. */
TEST(goes_back)
{
    uint16_t disparity[4][9];
    uint8_t guide[4][9];
    struct rf_motion from[4][9];
    struct rf_frame frame[4];
    struct rf_history history;

    for (int k = 0; k < 4; k++) {
        frame[k] = (struct rf_frame){disparity[k], guide[k], from[k]};
        for (int i = 0; i < 9; i++) {
            disparity[k][i] = (uint16_t)(100 * k + i);
            guide[k][i] = (uint8_t)(k == 1 ? 80 : 60 + i);
            from[k][i] = (struct rf_motion){(int8_t)(k % 2 ? 0 : 1), (int8_t)(k % 2 ? -1 : 0)};
        }
    }
    rf_history_take(&history, frame, 4, 3, 4); /* by 5 and 2 to 3 */
    assert_int_equal(history.count, 3);
    assert_true(history.disparity[0] == 4 && history.disparity[1] == 202 &&
                history.disparity[2] == 303);
    assert_true(history.weight[0] == RF_ALIKE && history.weight[1] == RF_ALIKE - 2 &&
                history.weight[2] == RF_ALIKE - 1);
    from[1][5].x = RF_NOWHERE;
    rf_history_take(&history, frame, 4, 3, 4);
    assert_int_equal(history.count, 1);
    rf_history_take(&history, frame, 1, 3, 4);
    assert_int_equal(history.count, 1);
}
