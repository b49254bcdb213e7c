/* test_codec_memory.c: every allocation that a module of a picture format makes itself fails once:
 * REFOCUS_ERR_MEMORY, no crash, and nothing kept. Those of its library are not ours to refuse. */
#include "check.h"
#include "codec.h"
#include "convert.h"
#include "failing.h"
#include "read.h"

#include <dirent.h>

#define DECLARE(name) extern const struct rf_codec rf_codec_##name;
RF_CODECS(DECLARE)
#undef DECLARE

static const struct {
    const char *name;
    const struct rf_codec *codec;
} codecs[] = {
#define ROW(name) {#name, &rf_codec_##name},
    RF_CODECS(ROW)
#undef ROW
};

static int read_one(const struct rf_codec *codec, struct rf_bytes file, bool picture)
{
    struct refocus_photo_info info = {.struct_size = sizeof info};
    struct rf_extras extras = {.upright = false};
    struct refocus_reason reason = {""};
    struct rf_read read = {.reason = &reason, .info = &info, .orientation = 1};
    int status = rf_read_limits(&read.limits, NULL, &reason);

    read.picture_always = picture;
    status = status == REFOCUS_OK ? codec->read(&read, file, &extras) : status;
    rf_raster_free(&read.image);
    rf_raster_free(&read.samples);
    free(extras.exif.data);
    free(extras.icc.data);
    free(extras.xmp.data);
    return status;
}

static void fail_each(const char *name, const struct rf_codec *codec, struct rf_bytes file,
                      bool picture)
{
    long total;
    int status;

    failing.calls = failing.live = failing.fail_at = 0;
    status = read_one(codec, file, picture);
    assert_int_equal(failing.live, 0);
    total = failing.calls;
    assert_true(status != REFOCUS_OK || total >= 1);
    for (long k = 1; k <= total && status == REFOCUS_OK; k++) {
        int failed;

        failing.calls = failing.live = 0;
        failing.fail_at = k;
        failed = read_one(codec, file, picture);
        failing.fail_at = 0;
        if (failed != REFOCUS_ERR_MEMORY || failing.live != 0) {
            fail_msg("%s: allocation %ld of %ld: status %d, %ld kept", name, k, total, failed,
                     failing.live);
        }
    }
}

TEST(readers)
{
    for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++) {
        char folder[512], path[1024];
        const struct dirent *entry;
        DIR *directory;
        int files = 0;

        snprintf(folder, sizeof folder, "%s/tests/fuzz/file/corpus/%s", REFOCUS_SOURCE,
                 codecs[i].name);
        directory = opendir(folder);
        assert_non_null(directory);
        while ((entry = readdir(directory))) {
            struct refocus_blob blob;

            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            if (entry->d_name[0] == '.' ||
                refocus_file_read(path, 1 << 20, &blob, NULL) != REFOCUS_OK)
                continue;
            for (int picture = 0; picture < 2; picture++)
                fail_each(path, codecs[i].codec, (struct rf_bytes){blob.data, blob.size}, picture);
            free(blob.data);
            files++;
        }
        closedir(directory);
        assert_true(files >= 2);
    }
}

static int write_one(const struct rf_codec *codec)
{
    static const uint8_t pixels[3 * 7 * 5];
    static uint8_t profile[200], packet[50];
    const struct rf_extras extras = {.icc = {profile, sizeof profile},
                                     .xmp = {packet, sizeof packet}};
    const struct rf_rows rows = {pixels, 21, 7, 5, REFOCUS_FORMAT_RGB8};
    struct refocus_blob file = {NULL, 0};
    struct refocus_reason reason = {""};
    const int status = codec->write(&file, &rows, &extras, &reason);

    assert_true(status != REFOCUS_OK || file.size > 0);
    free(file.data);
    return status;
}

TEST(writers)
{
    for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++) {
        long total;

        if (!codecs[i].codec->write)
            continue;
        failing.calls = failing.live = failing.fail_at = 0;
        assert_int_equal(write_one(codecs[i].codec), REFOCUS_OK);
        total = failing.calls;
        assert_true(total >= 1);
        for (long k = 1; k <= total; k++) {
            failing.calls = failing.live = 0;
            failing.fail_at = k;
            assert_int_equal(write_one(codecs[i].codec), REFOCUS_ERR_MEMORY);
            failing.fail_at = 0;
            assert_int_equal(failing.live, 0);
        }
    }
}
