/* fuzz_xmp_edit.c: any bytes as a packet of XMP that is edited: what was cut is gone, what was put
 * in is there, and to cut again changes nothing. */
#define _GNU_SOURCE /* memmem */
#include "fuzz.h"

#include "xmp_edit.h"

static const char insert[] =
    "<rdf:Description xmlns:rdf=\"" RF_NS_RDF "\" rdf:about=\"\" xmlns:z=\"z:\" z:z=\"zzz\"/>";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_reading reading;
    struct rf_xmp_edit first = {.cut = size > 0 ? data[0] * 4u | 3u : 0},
                       second = {.cut = first.cut};
    struct rf_bytes packet;

    fuzz_begin(&reading);
    if (size > 0 && data[0] & 1)
        first.insert = (struct rf_bytes){(const uint8_t *)insert, sizeof insert - 1};
    if (rf_xmp_edit(&reading.read, (struct rf_bytes){data, size}, &first) == REFOCUS_OK &&
        first.outcome == RF_XMP_CHANGED) {
        packet = (struct rf_bytes){(const uint8_t *)first.packet.data, first.packet.size};
        if (rf_xmp_edit(&reading.read, packet, &second) != REFOCUS_OK ||
            second.outcome != RF_XMP_SAME || second.found != 0)
            abort();
        if (first.insert.size > 0 && !memmem(packet.data, packet.size, insert, sizeof insert - 1))
            abort();
    }
    free(first.packet.data);
    free(second.packet.data);
    fuzz_end(&reading);
    return 0;
}
