/* test_memory.c: every allocation fails once, in every reader and writer: REFOCUS_ERR_MEMORY, no
 * crash, and nothing kept. The linker sends the library's calls here; libpng and expat take
 * theirs from the library. */
#include "gain_values.h"
#include "read.h"
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

TEST(readers)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);

    for (int i = 0; i < count; i++) {
        if (samples[i].photo)
            fail_each_in(&samples[i], false);
        if (samples[i].depth)
            fail_each_in(&samples[i], true);
    }
    free_samples(samples, count);
}

#if defined(RF_HAVE_JPEG) && defined(RF_HAVE_XMP)
static int make_light(const struct refocus_photo *photo)
{
    struct refocus_light *light;
    const int status = refocus_light_create(&light, photo);

    assert_true((light != NULL) == (status == REFOCUS_OK));
    refocus_light_destroy(&light);
    return status;
}

/* The light of a gain map, and the memory that is stated for it. */
TEST(lights)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);

    for (int i = 0; i < count; i++) {
        struct refocus_photo *photo;
        long total;

        if (strcmp(samples[i].name, "gain.jpg") != 0)
            continue;
        assert_int_equal(refocus_photo_read_memory(&photo, samples[i].bytes.data,
                                                   samples[i].bytes.size, NULL, NULL),
                         REFOCUS_OK);
        failing.calls = failing.live = 0;
        failing.held = failing.peak = 0;
        assert_int_equal(make_light(photo), REFOCUS_OK);
        assert_int_equal(failing.live, 0);
        assert_in_range(failing.peak, 100 << 10, (850 << 10) + 6 * 16 * 16);
        total = failing.calls;
        assert_true(total >= 3);
        for (long k = 1; k <= total; k++) {
            failing.calls = failing.live = 0;
            failing.fail_at = k;
            assert_int_equal(make_light(photo), REFOCUS_ERR_MEMORY);
            failing.fail_at = 0;
            assert_int_equal(failing.live, 0);
        }
        refocus_photo_free(&photo);
    }
    free_samples(samples, count);
}
#endif

#ifdef RF_HAVE_HEIC
/* libheif's own memory is not ours to refuse; this is what the heic_*.c ask for. */
TEST(heic)
{
    struct sample sample = {.name = "heic"};

    if (!find_photos()) {
        print_message("SKIPPED: no photos in %s\n", photos_folder);
        skip();
    }
    sample.bytes = load("phone/apple-heic-pug.heic");
    fail_each_in(&sample, true);
    bytes_free(&sample.bytes);
}

/* A gain map beside XMP, and one that is decoded from a copy of the file. */
TEST(heic_gain_maps)
{
    static const char *const names[] = {"gain_xmp", "toned"};

    for (int i = 0; i < 2; i++) {
        struct sample sample = {.name = names[i]};
        struct refocus_photo *photo = NULL;
        struct refocus_blob blob;
        char path[1024];

        snprintf(path, sizeof path, REFOCUS_SOURCE "/tests/fuzz/file/corpus/photo/%s.heic",
                 names[i]);
        assert_int_equal(refocus_file_read(path, 1 << 20, &blob, NULL), REFOCUS_OK);
        sample.bytes = bytes_copy(blob.data, blob.size);
        free(blob.data);
        if (refocus_photo_read_memory(&photo, sample.bytes.data, sample.bytes.size, NULL, NULL) ==
            REFOCUS_ERR_UNSUPPORTED) {
            print_message("SKIPPED: libheif has no decoder of HEVC here\n");
        } else {
            assert_non_null(photo);
#ifdef RF_HAVE_XMP
            assert_true(photo->info->gain_map_stops == 2);
#endif
            fail_each_in(&sample, false);
        }
        refocus_photo_free(&photo);
        bytes_free(&sample.bytes);
    }
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
            (photo->deep->plane[0] ? 27 : 9) * (size_t)photo->image->width *
                (size_t)photo->image->height +
            9 * (size_t)photo->depth->width * (size_t)photo->depth->height;
    if (failing.peak > bound || failing.peak == 0)
        fail_msg("%s: %zu bytes at the most, %zu are stated", sample->name, failing.peak, bound);
    refocus_photo_free(&photo);
}

TEST(stated_peak)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);
    struct sample large = {.name = "large.pgm"};

    for (int i = 0; i < count; i++)
        if (samples[i].photo)
            peak_of(&samples[i]);
    free_samples(samples, count);
    bytes_text(&large.bytes, "P5\n700 500\n65535\n");
    for (int i = 0; i < 700 * 500; i++)
        bytes_number(&large.bytes, 1000, 2, true);
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

TEST(writers)
{
    static const char *const endings[] = {
        ".ppm",  ".pgm", ".pfm",
#ifdef RF_HAVE_PNG
        ".png",
#endif
#ifdef RF_HAVE_JPEG
        ".jpg",
#endif
#ifdef RF_HAVE_HEIC
        ".heic",
#endif
    };

    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char path[64];
        long total;

        snprintf(path, sizeof path, "/tmp/refocus-memory-%ld%s", (long)getpid(), endings[i]);
        if (strcmp(endings[i], ".heic") == 0 && write_one(path, 0) == REFOCUS_ERR_UNSUPPORTED)
            continue; /* libheif has no encoder here */
        assert_int_equal(write_one(path, 0), REFOCUS_OK);
        total = failing.calls;
        assert_int_equal(unlink(path), 0);
        for (long k = 1; k <= total; k++) {
            const int status = write_one(path, k);
            if (status != REFOCUS_ERR_MEMORY || access(path, F_OK) == 0)
                fail_msg("%s: allocation %ld: status %d", path, k, status);
        }
    }
}

#if defined(RF_HAVE_JPEG) && defined(RF_HAVE_PNG) && defined(RF_HAVE_XMP)
static int write_depth(const char *path, const char *original, long fail)
{
    const uint16_t samples[6] = {1, 2, 3, 4, 5, 6};
    struct refocus_depth_write depth = refocus_depth_write_default();
    int status;

    depth.disparity = samples;
    depth.width = 3;
    depth.height = 2;
    depth.stride = 6;
    failing.calls = failing.live = 0;
    failing.fail_at = fail;
    status = refocus_photo_write_depth(path, original, &depth, NULL);
    failing.fail_at = 0;
    /* A PNG is made in memory; see write_kept(). */
    assert_true(failing.live == -1 || (fail && failing.live == 0));
    return status;
}

TEST(depth_writers)
{
    struct bytes jpeg = make_jpeg(16, 8, false, false);
    char original[64], path[64];
    FILE *file;
    long total;

    snprintf(original, sizeof original, "/tmp/refocus-memory-%ld-o.jpg", (long)getpid());
    snprintf(path, sizeof path, "/tmp/refocus-memory-%ld.jpg", (long)getpid());
    file = fopen(original, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(jpeg.data, 1, jpeg.size, file), jpeg.size);
    assert_int_equal(fclose(file), 0);
    bytes_free(&jpeg);
    assert_int_equal(write_depth(path, original, 0), REFOCUS_OK);
    total = failing.calls;
    assert_true(total > 4);
    assert_int_equal(unlink(path), 0);
    for (long k = 1; k <= total; k++)
        if (write_depth(path, original, k) != REFOCUS_ERR_MEMORY || access(path, F_OK) == 0)
            fail_msg("%s: allocation %ld", path, k);
    assert_int_equal(unlink(original), 0);
}

static int write_kept(const char *path, const struct refocus_photo *photo, long fail, int streams)
{
    uint8_t pixels[12 * 3] = {0};
    uint16_t halves[12 * 3] = {0};
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 4, 3, 12);
    const struct refocus_image light =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, halves, 4, 3, 24);
    const uint16_t samples[6] = {1, 2, 3, 4, 5, 6};
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_editable editable = refocus_editable_default();
    struct refocus_write_options options = refocus_write_options_default();
    int status;

    depth.disparity = samples;
    depth.width = 3;
    depth.height = 2;
    depth.stride = 6;
    editable.depth = &depth;
    options.keep = photo;
    if (!strstr(path, ".png") && photo->info->original_used == 0)
        options.editable = &editable;                     /* the photo and depth go into the file */
    options.light = strstr(path, ".jpg") ? &light : NULL; /* a gain map lies behind it */
    failing.calls = failing.live = 0;
    failing.fail_at = fail;
    status = refocus_image_write(path, &image, &options, NULL);
    failing.fail_at = 0;
    /* The C library gets the memory of files in memory, which is not counted until it is freed. */
    if (failing.live > 0 || failing.live < -streams ||
        (status == REFOCUS_OK && failing.live != -streams))
        fail_msg("%s: allocation %ld keeps %ld", path, fail, failing.live);
    return status;
}

/* Make believe that a photo is of another container, with a gain map and a portrait matte. */
static void become(struct refocus_photo *photo, const char *container)
{
    struct rf_photo *const inner = (struct rf_photo *)(void *)photo;

    inner->kept.kind = RF_KEPT_NOTHING;
    strcpy(inner->info.container, container);
    inner->gain.samples = (struct rf_raster){.pixels = calloc(12, 1),
                                             .width = 4,
                                             .height = 3,
                                             .channels = 1,
                                             .sample = REFOCUS_SAMPLE_U8,
                                             .max_value = 255};
    rf_gain_make_apple(&inner->gain, 4);
    inner->matte = *photo->depth;
    inner->matte.value_near = 255;
}

/* The photo's packets lose depth and keep other properties, in an extended packet too; one without
 * an original becomes editable. `streams` pictures are written in memory on the way to a JPEG, the
 * gain map among them, which a HEIC does not have. */
static void keepers_of(bool has_original, const char *container, int streams)
{
    static const char *const endings[] = {
        ".jpg",
        ".png",
#ifdef RF_HAVE_HEIC
        ".heic",
#endif
    };
    struct gdepth gdepth = {.format = "RangeInverse",
                            .extra = "xmlns:q=\"q:\" q:a=\"1\"",
                            .depth = make_png(30, 20, 0, 16)};
    struct refocus_photo *photo;

    if (has_original)
        gdepth.original = make_png(50, 30, 2, 8);
    photo = read_photo(make_gdepth_extended(gdepth, 6000, 7, -1), REFOCUS_OK);
    if (container)
        become(photo, container);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const int in_memory = i == 0 ? streams : i == 2 ? streams - 1 : 0;
        char path[64];
        long total;
        int status;

        snprintf(path, sizeof path, "/tmp/refocus-memory-%ld%s", (long)getpid(), endings[i]);
        status = write_kept(path, photo, 0, in_memory);
        if (i == 2 && status == REFOCUS_ERR_UNSUPPORTED)
            continue; /* libheif has no encoder here */
        assert_int_equal(status, REFOCUS_OK);
        total = failing.calls;
        assert_true(total > 4);
        assert_int_equal(unlink(path), 0);
        for (long k = 1; k <= total; k++)
            if (write_kept(path, photo, k, in_memory) != REFOCUS_ERR_MEMORY ||
                access(path, F_OK) == 0)
                fail_msg("%s: allocation %ld", path, k);
    }
    refocus_photo_free(&photo);
}

TEST(keepers)
{
    keepers_of(true, NULL, 1);
    keepers_of(false, NULL, 2);
    keepers_of(false, "HEIC", 4);
    keepers_of(false, "PPM", 3);
}
#endif

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

TEST(files)
{
    const uint16_t samples[12] = {0};
    char path[64];

    snprintf(path, sizeof path, "/tmp/refocus-memory-%ld.pgm", (long)getpid());
    assert_int_equal(refocus_gray16_write(path, samples, 4, 3, 8, NULL), REFOCUS_OK);
    for (int depth = 0; depth < 2; depth++) {
        assert_int_equal(read_path(path, depth, 0), REFOCUS_OK);
        for (long k = failing.calls; k >= 1; k--)
            assert_int_equal(read_path(path, depth, k), REFOCUS_ERR_MEMORY);
    }
    assert_int_equal(unlink(path), 0);
}
