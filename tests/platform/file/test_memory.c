/* test_memory.c: every allocation fails once, in every reader and writer: REFOCUS_ERR_MEMORY, no
 * crash, and nothing kept. The linker sends the library's calls here; libpng and expat take
 * theirs from the library. */
#include "failing.h"
#include "photos.h"
#include "samples.h"

#include <unistd.h>

static int read_one(const struct sample *sample, bool depth, bool *photo_made)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    const int status =
        depth ? refocus_depth_read_memory(&photo, sample->bytes.data, sample->bytes.size, NULL, 0,
                                          0, NULL, &reason)
              : refocus_photo_read_memory(&photo, sample->bytes.data, sample->bytes.size, NULL,
                                          &reason);

    *photo_made = photo != NULL;
    refocus_photo_free(&photo);
    return status;
}

static void fail_each_in(const struct sample *sample, bool depth)
{
    bool made;
    long total;

    failing.calls = failing.live = failing.fail_at = 0;
    assert_int_equal(read_one(sample, depth, &made), REFOCUS_OK);
    assert_int_equal(failing.live, 0);
    total = failing.calls;
    assert_true(total >= 2);
    for (long k = 1; k <= total; k++) {
        int status;
        failing.calls = failing.live = 0;
        failing.fail_at = k;
        status = read_one(sample, depth, &made);
        failing.fail_at = 0;
        if (status != REFOCUS_ERR_MEMORY || made || failing.live != 0) {
            fail_msg("%s: allocation %ld of %ld: status %d, %ld kept", sample->name, k, total,
                     status, failing.live);
        }
    }
}

static void readers(void **state)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);

    (void)state;
    for (int i = 0; i < count; i++) {
        if (samples[i].photo) {
            fail_each_in(&samples[i], false);
        }
        if (samples[i].depth) {
            fail_each_in(&samples[i], true);
        }
    }
    free_samples(samples, count);
}

#ifdef RF_HAVE_HEIC
/* libheif's own memory is not ours to refuse; this is what heic.c asks for. */
static void heic(void **state)
{
    struct sample sample = {.name = "heic"};

    (void)state;
    if (!find_photos()) {
        print_message("SKIPPED: no photos in %s\n", photos_folder);
        skip();
    }
    sample.bytes = load("phone/apple-heic-pug.heic");
    fail_each_in(&sample, true);
    bytes_free(&sample.bytes);
}
#endif

/* The bound that file.h states for reading; XMP is taken for no more than the file. */
static void peak_of(const struct sample *sample)
{
    struct refocus_photo *photo = NULL;
    size_t bound;

    failing.held = failing.peak = 0;
    assert_int_equal(
        refocus_photo_read_memory(&photo, sample->bytes.data, sample->bytes.size, NULL, NULL),
        REFOCUS_OK);
    bound = (128u << 10) + (strstr(sample->name, ".jpg") ? 8 * sample->bytes.size : 0) +
            9 * (size_t)photo->image->width * (size_t)photo->image->height +
            9 * (size_t)photo->depth->width * (size_t)photo->depth->height;
    if (failing.peak > bound || failing.peak == 0) {
        fail_msg("%s: %zu bytes at the most, %zu are stated", sample->name, failing.peak, bound);
    }
    refocus_photo_free(&photo);
}

static void stated_peak(void **state)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);
    struct sample large = {.name = "large.pgm"};

    (void)state;
    for (int i = 0; i < count; i++) {
        if (samples[i].photo) {
            peak_of(&samples[i]);
        }
    }
    free_samples(samples, count);
    bytes_text(&large.bytes, "P5\n700 500\n65535\n");
    for (int i = 0; i < 700 * 500; i++) {
        bytes_number(&large.bytes, 1000, 2, true);
    }
    peak_of(&large);
    assert_true(failing.peak >= 5 * 700 * 500); /* the photo and its samples */
    bytes_free(&large.bytes);
#ifdef RF_HAVE_PNG
    large.name = "large.png";
    large.bytes = make_png(400, 300, 2, 16);
    peak_of(&large);
    assert_true(failing.peak >= 9 * 400 * 300);
    bytes_free(&large.bytes);
#endif
#if defined(RF_HAVE_JPEG) && defined(RF_HAVE_PNG) && defined(RF_HAVE_XMP)
    large.name = "large.jpg";
    large.bytes = make_gdepth_extended((struct gdepth){.format = "RangeInverse",
                                                       .depth = make_png(300, 200, 0, 16),
                                                       .original = make_png(500, 300, 2, 8)},
                                       60000, 7, -1);
    peak_of(&large);
    bytes_free(&large.bytes);
#endif
}

static int write_one(const char *path, long fail)
{
    uint8_t pixels[12 * 3] = {0};
    uint16_t samples[12] = {0};
    struct bytes exif = make_exif(true, 1);
    const struct refocus_blob blob = {exif.data, exif.size};
    const struct refocus_write_options options = {
        .struct_size = sizeof(struct refocus_write_options), .exif = &blob};
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 4, 3, 12);
    struct refocus_reason reason;
    int status;

    failing.calls = failing.live = 0;
    failing.fail_at = fail;
    status = strstr(path, ".p") && !strstr(path, ".ppm")
                 ? refocus_gray16_write(path, samples, 4, 3, 8, &reason)
                 : refocus_image_write(path, &image, &options, &reason);
    failing.fail_at = 0;
    assert_int_equal(failing.live, 0);
    bytes_free(&exif);
    return status;
}

static void writers(void **state)
{
    static const char *const endings[] = {
        ".ppm", ".pgm", ".pfm",
#ifdef RF_HAVE_PNG
        ".png",
#endif
#ifdef RF_HAVE_JPEG
        ".jpg",
#endif
    };

    (void)state;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char path[64];
        long total;

        snprintf(path, sizeof path, "/tmp/refocus-memory-%ld%s", (long)getpid(), endings[i]);
        assert_int_equal(write_one(path, 0), REFOCUS_OK);
        total = failing.calls;
        assert_int_equal(unlink(path), 0);
        for (long k = 1; k <= total; k++) {
            const int status = write_one(path, k);
            if (status != REFOCUS_ERR_MEMORY || access(path, F_OK) == 0) {
                fail_msg("%s: allocation %ld: status %d", path, k, status);
            }
        }
    }
}

static int read_path(const char *path, bool depth, long fail)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    int status;

    failing.calls = failing.live = 0;
    failing.fail_at = fail;
    status = depth ? refocus_depth_read(&photo, path, NULL, 0, 0, NULL, &reason)
                   : refocus_photo_read(&photo, path, NULL, &reason);
    failing.fail_at = 0;
    assert_true((photo != NULL) == (status == REFOCUS_OK));
    refocus_photo_free(&photo);
    assert_int_equal(failing.live, 0);
    return status;
}

static void files(void **state)
{
    const uint16_t samples[12] = {0};
    char path[64];

    (void)state;
    snprintf(path, sizeof path, "/tmp/refocus-memory-%ld.pgm", (long)getpid());
    assert_int_equal(refocus_gray16_write(path, samples, 4, 3, 8, NULL), REFOCUS_OK);
    for (int depth = 0; depth < 2; depth++) {
        assert_int_equal(read_path(path, depth, 0), REFOCUS_OK);
        for (long k = failing.calls; k >= 1; k--) {
            assert_int_equal(read_path(path, depth, k), REFOCUS_ERR_MEMORY);
        }
    }
    assert_int_equal(unlink(path), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(readers),
#ifdef RF_HAVE_HEIC
        cmocka_unit_test(heic),
#endif
        cmocka_unit_test(stated_peak), cmocka_unit_test(writers), cmocka_unit_test(files),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
