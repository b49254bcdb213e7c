/* own_xmp.c: the XMP packets that this library writes are told from those of others. */
#include "own_xmp.h"

#include <string.h>

#include "xmp.h"

/* Beside an original the packet is more than depth: editable.c put that there. */
static bool is_of_a_result(struct rf_bytes packet)
{
    static const char name[] = RF_NS_REFOCUS;
    const size_t n = sizeof name - 1;

    for (size_t i = 0; i + n <= packet.size; i++)
        if (packet.data[i] == 'u' && memcmp(packet.data + i, name, n) == 0)
            return true;
    return false;
}

bool rf_xmp_is_ours(struct rf_bytes packet)
{
    return !is_of_a_result(packet) && packet.size > sizeof RF_XMP_OPENING &&
           memcmp(packet.data, RF_XMP_OPENING, sizeof RF_XMP_OPENING - 1) == 0;
}
