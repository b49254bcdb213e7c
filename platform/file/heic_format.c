/* heic_format.c: HEIC and AVIF as a picture format, which needs libheif; HEIC is written, too. */
#include <string.h>

#include "format.h"
#include "heic_read.h"
#include "heic_write.h"

/* ISO 14496-12: a file begins with a size, "ftyp", the main brand, a version and compatible
 * brands. */
static bool recognise(struct rf_bytes file)
{
    static const char brands[][5] = {"heic", "heix", "hevc", "hevx", "heim",
                                     "heis", "mif1", "msf1", "avif", "avis"};

    if (file.size < 12 || memcmp(file.data + 4, "ftyp", 4) != 0)
        return false;
    for (size_t i = 0; i < sizeof brands / sizeof *brands; i++)
        if (memcmp(file.data + 8, brands[i], 4) == 0)
            return true;
    return false;
}

const struct rf_format rf_format_heic = {
    .name = "HEIC",
    .library = "libheif",
    .endings = {".heic"},
    .writes_pictures = true,
    .has_second = true,
    .recognise = recognise,
#ifdef RF_HAVE_HEIC
    .read = rf_read_heic,
    .write = rf_write_heic,
#endif
};
