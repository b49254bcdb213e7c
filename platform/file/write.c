/* Pictures into files, by the end of the name. */
#include "internal.h"

#include <string.h>
#include <strings.h>

enum ending { ENDING_UNKNOWN, ENDING_JPEG, ENDING_PNG, ENDING_PPM, ENDING_PGM, ENDING_PFM };

static enum ending find_ending(const char *path)
{
    static const struct {
        const char *text;
        enum ending ending;
    } known[] = {
        {".jpg", ENDING_JPEG}, {".jpeg", ENDING_JPEG}, {".png", ENDING_PNG},
        {".ppm", ENDING_PPM},  {".pgm", ENDING_PGM},   {".pfm", ENDING_PFM},
    };
    const char *const dot = strrchr(path, '.');

    for (size_t i = 0; dot && i < sizeof known / sizeof *known; i++) {
        if (strcasecmp(dot, known[i].text) == 0) {
            return known[i].ending;
        }
    }
    return ENDING_UNKNOWN;
}

/* What this build cannot encode is refused before a file is made. */
static int check_encoder(enum ending ending, struct refocus_reason *reason)
{
#ifndef RF_HAVE_JPEG
    if (ending == ENDING_JPEG) {
        return rf_absent_format(reason, "JPEG", "TurboJPEG");
    }
#endif
#ifndef RF_HAVE_PNG
    if (ending == ENDING_PNG) {
        return rf_absent_format(reason, "PNG", "libpng");
    }
#endif
    (void)ending;
    (void)reason;
    return REFOCUS_OK;
}

static int write_rows(const char *path, enum ending ending, const struct rf_rows *rows,
                      const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct rf_store store;
    int status = check_encoder(ending, reason);

    if (status == REFOCUS_OK) {
        status = rf_store_open(&store, path, reason);
    }
    if (status != REFOCUS_OK) {
        return status;
    }
    store.unsynced = options && options->unsynced;
    switch (ending) {
    case ENDING_JPEG:
        status = rf_write_jpeg(&store, rows, options, reason);
        break;
    case ENDING_PNG:
        status = rf_write_png(&store, rows, options, reason);
        break;
    case ENDING_PFM:
        status = rf_write_pfm(&store, rows, reason);
        break;
    default:
        status = rf_write_ppm(&store, rows, reason);
        break;
    }
    return rf_store_close(&store, status, reason);
}

static bool fits(int64_t width, int64_t height, ptrdiff_t stride, int64_t pixel_bytes)
{
    return width >= 1 && width <= REFOCUS_MAX_SIDE && height >= 1 && height <= REFOCUS_MAX_SIDE &&
           rf_good_rows(stride, width * pixel_bytes, height);
}

int refocus_image_write(const char *path, const struct refocus_image *image,
                        const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_rows rows;
    enum ending ending;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!path || !image || !image->plane[0] || rf_format_bytes(image->format) == 0 ||
        !fits(image->width, image->height, image->stride[0], rf_format_bytes(image->format)) ||
        (options && (options->quality < 0 || options->quality > 100))) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                       "the picture or the quality is out of its range");
    }
    ending = find_ending(path);
    if (ending != ENDING_JPEG && ending != ENDING_PNG && ending != ENDING_PPM) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "a picture is written as .jpg, .jpeg, .png or .ppm; end the name "
                       "in one of them");
    }
    rows.top = image->plane[0];
    rows.stride = image->stride[0];
    rows.width = image->width;
    rows.height = image->height;
    rows.format = image->format;
    return write_rows(path, ending, &rows, options, reason);
}

int refocus_gray16_write(const char *path, const uint16_t *samples, int width, int height,
                         ptrdiff_t stride, struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_rows rows;
    enum ending ending;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!path || !samples || stride % 2 != 0 || !fits(width, height, stride, 2)) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "the samples are out of their range");
    }
    ending = find_ending(path);
    if (ending != ENDING_PNG && ending != ENDING_PGM && ending != ENDING_PFM) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "a depth map is written as .png, .pgm or .pfm; end the name in one "
                       "of them");
    }
    rows.top = (const uint8_t *)samples;
    rows.stride = stride;
    rows.width = width;
    rows.height = height;
    rows.format = REFOCUS_FORMAT_NONE;
    return write_rows(path, ending, &rows, NULL, reason);
}
