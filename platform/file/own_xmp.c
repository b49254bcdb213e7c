/* own_xmp.c: the XMP packets that this library writes are told from those of others. */
#include "own_xmp.h"

#include <string.h>

bool rf_xmp_is_ours(struct rf_bytes packet)
{
    return packet.size > sizeof RF_XMP_OPENING &&
           memcmp(packet.data, RF_XMP_OPENING, sizeof RF_XMP_OPENING - 1) == 0;
}
