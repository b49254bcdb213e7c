/* unit_test.h: tests by cmocka that enter themselves into the list of their program, so that none
 * is written and not run. */
#ifndef UNIT_TEST_H
#define UNIT_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#include <cmocka.h>

/* Called before main() by TEST(). */
void unit_test_enter(struct CMUnitTest test);

/* Run the tests of the program in the order of its source, between two fixtures of them all or
 * NULL; returns how many failed. A program has a main() of its own only if it does more than that.
 */
int unit_test_run(CMFixtureFunction set_up, CMFixtureFunction tear_down);

#ifdef __cplusplus
}
#endif

/* A test that is followed by its body, alone or between fixtures of its own; `fixture` is theirs.
 */
#define TEST(name) TEST_BETWEEN(name, NULL, NULL)
#define TEST_BETWEEN(name, set_up, tear_down)                                                      \
    static void name(void **state);                                                                \
    __attribute__((constructor)) static void enter_##name(void)                                    \
    {                                                                                              \
        const struct CMUnitTest test = {#name, name, set_up, tear_down, NULL};                     \
        unit_test_enter(test);                                                                     \
    }                                                                                              \
    static void name(__attribute__((unused)) void **fixture)

#endif
