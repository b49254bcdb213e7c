/* test_looks.c: earlier frames look at a sample of this one, and vote on its depth. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "depth/temporal.h"

/* Looks with weights vote against a surface at 1000. */
static void majorities(void **state)
{
    static const struct {
        struct rf_looks looks;
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

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint16_t mean = 0;

        assert_int_equal(rf_vote_of_looks(&cases[i].looks, 1000, 100, &mean), cases[i].voters);
        assert_int_equal(mean, cases[i].mean);
    }
}

/* Looks follow a sample back until it was nowhere; what shows other things has no vote. */
static void looks_go_back(void **state)
{
    uint16_t disparity[4][9];
    uint8_t guide[4][9];
    struct rf_motion from[4][9];
    struct rf_frame frame[4];
    struct rf_looks looks;

    (void)state;
    for (int k = 0; k < 4; k++) {
        frame[k] = (struct rf_frame){disparity[k], guide[k], from[k]};
        for (int i = 0; i < 9; i++) {
            disparity[k][i] = (uint16_t)(100 * k + i);
            guide[k][i] = (uint8_t)(k == 1 ? 80 : 60 + i);
            from[k][i] = (struct rf_motion){(int8_t)(k % 2 ? 0 : 1), (int8_t)(k % 2 ? -1 : 0)};
        }
    }
    rf_look_back(&looks, frame, 4, 3, 4); /* by 5 and 2 to 3 */
    assert_int_equal(looks.count, 3);
    assert_true(looks.disparity[0] == 4 && looks.disparity[1] == 202 && looks.disparity[2] == 303);
    assert_true(looks.weight[0] == RF_ALIKE && looks.weight[1] == RF_ALIKE - 2 &&
                looks.weight[2] == RF_ALIKE - 1);
    from[1][5].x = RF_NOWHERE;
    rf_look_back(&looks, frame, 4, 3, 4);
    assert_int_equal(looks.count, 1);
    rf_look_back(&looks, frame, 1, 3, 4);
    assert_int_equal(looks.count, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(majorities),
        cmocka_unit_test(looks_go_back),
    };

    return cmocka_run_group_tests_name("looks", tests, NULL, NULL);
}
