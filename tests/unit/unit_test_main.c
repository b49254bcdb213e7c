/* unit_test_main.c: the program of tests that need nothing but to be run. */
#include "unit_test.h"

int main(void)
{
    return unit_test_run(NULL, NULL);
}
