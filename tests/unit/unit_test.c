/* unit_test.c: the list of a program's tests. */
#include "unit_test.h"

#include <stdlib.h>

enum { MOST = 64 };

static struct CMUnitTest tests[MOST]; /* cmocka passes over those without a function */
static int count;

void unit_test_enter(struct CMUnitTest test)
{
    if (count == MOST)
        abort();
    tests[count++] = test;
}

int unit_test_run(CMFixtureFunction set_up, CMFixtureFunction tear_down)
{
    if (count == 0)
        abort(); /* cmocka passes a program without tests */
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
