/* fuzz_gain_map.c: any bytes as ISO's metadata of a gain map: what is taken is within its bounds.
 */
#include "fuzz.h"

#include <math.h>

#include "gain_values.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct rf_gain_map map;

    if (rf_gain_from_iso((struct rf_bytes){data, size}, &map.values))
        return 0;
    rf_gain_make_curves(&map);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 256; i++)
            if (!(fabsf(map.gain[c][i]) <= 16.001f))
                abort();
    }
    return 0;
}
