/* test_limits.c: each limit of a reading is kept, to the pixel, byte or element. */
#include "check.h"

#include <sys/stat.h>
#include <unistd.h>

/* A photo with limits, one of which is just enough or one too few. Frees the bytes. */
static int read_within(struct bytes file, struct refocus_read_limits limits)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    const int status = refocus_photo_read_memory(&photo, file.data, file.size, &limits, &reason);

    assert_true((photo != NULL) == (status == REFOCUS_OK));
    assert_true((reason.text[0] != '\0') == (status != REFOCUS_OK));
    refocus_photo_free(&photo);
    bytes_free(&file);
    return status;
}

/* Read with a member of the limits set to enough, and to one less. */
#define NEEDS(file, member, enough)                                                                \
    do {                                                                                           \
        struct refocus_read_limits within = refocus_read_limits_default();                         \
        within.member = (enough);                                                                  \
        assert_int_equal(read_within(file, within), REFOCUS_OK);                                   \
        within.member--;                                                                           \
        assert_int_equal(read_within(file, within), REFOCUS_ERR_SIZE);                             \
    } while (0)

static struct bytes grey(bool tall)
{
    const char text[] = "P5\n4 3\n255\n............", upright[] = "P5\n3 4\n255\n............";

    return bytes_copy(tall ? upright : text, sizeof text - 1);
}

TEST(pictures)
{
    NEEDS(grey(false), max_side, 4);
    NEEDS(grey(true), max_side, 4);
    NEEDS(grey(false), max_pixels, 12);
    NEEDS(grey(false), max_bytes, 36);
    NEEDS(grey(false), max_memory, 23 + 12 + 36); /* file, samples, RGB */
}

/* A side beyond the default, with so few pixels that nothing else forbids it. */
TEST(sides)
{
    struct refocus_read_limits limits = refocus_read_limits_default();
    char text[40000] = "P5 32769 1 255\n";
    const size_t size = strlen(text) + 32769;

    assert_int_equal(read_within(bytes_copy(text, size), limits), REFOCUS_ERR_SIZE);
    limits.max_side = UINT32_MAX;
    assert_int_equal(read_within(bytes_copy(text, size), limits), REFOCUS_OK);
    memcpy(text, "P5 65536", 8);
    assert_int_equal(read_within(bytes_copy(text, size), limits), REFOCUS_ERR_SIZE);
}

static void refused_at_once(const char *path)
{
    struct refocus_reason reason;
    struct refocus_photo *photo;
    struct refocus_blob blob;

    assert_int_equal(refocus_photo_read(&photo, path, NULL, &reason), REFOCUS_ERR_IO);
    assert_non_null(strstr(reason.text, "give the name of a file"));
    assert_int_equal(refocus_file_read(path, UINT64_MAX, &blob, NULL), REFOCUS_ERR_IO);
    assert_null(blob.data);
}

/* A pipe without a writer would be waited for, for ever. */
TEST(files_alone)
{
    const char *const pipe = "test-limits.fifo";

    unlink(pipe);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    refused_at_once(pipe);
    unlink(pipe);
    refused_at_once("/dev/zero");
    refused_at_once("/");
}

#ifdef RF_HAVE_JPEG
static uint32_t count(const struct bytes *jpeg, uint8_t marker)
{
    uint32_t n = 0;

    for (size_t i = 0; i + 1 < jpeg->size; i++)
        n += jpeg->data[i] == 0xff && jpeg->data[i + 1] == marker;
    return n;
}

TEST(jpeg_scans)
{
    struct bytes jpeg = make_jpeg(64, 64, false, true);
    const uint32_t scans = count(&jpeg, 0xda);
    const size_t size = jpeg.size;

    bytes_free(&jpeg);
    assert_in_range(scans, 2, 100);
    NEEDS(make_jpeg(64, 64, false, true), max_scans, scans);
    /* The coefficients are kept between scans. */
    NEEDS(make_jpeg(64, 64, false, true), max_memory, size + 64 * 64 * 3 * 3);
    jpeg = make_jpeg(64, 64, false, false);
    /* A copy stays for pictures that are made from it. */
    NEEDS(bytes_copy(jpeg.data, jpeg.size), max_memory, 2 * jpeg.size + 64 * 64 * 3);
    bytes_free(&jpeg);
}

static struct bytes jpeg_of_segments(int more)
{
    struct bytes jpeg = make_jpeg(16, 16, true, false);

    for (int i = 0; i < more; i++)
        jpeg_insert(&jpeg, 0xef, "x", 1, "y", 1);
    return jpeg;
}

TEST(jpeg_segments)
{
    struct refocus_read_limits limits = refocus_read_limits_default();

    limits.max_segments = 20;
    assert_int_equal(read_within(jpeg_of_segments(0), limits), REFOCUS_OK);
    assert_int_equal(read_within(jpeg_of_segments(20), limits), REFOCUS_ERR_SIZE);
}
#endif

#ifdef RF_HAVE_PNG
/* A text that could not be unpacked is not looked at. */
TEST(png_texts)
{
    struct bytes png = make_png(3, 2, 2, 8), text = {NULL, 0};
    const size_t header = 33;

    png_chunk(&text, "zTXt", "a\0\0no zlib at all", 18);
    png.data = realloc(png.data, png.size + text.size);
    memmove(png.data + header + text.size, png.data + header, png.size - header);
    memcpy(png.data + header, text.data, text.size);
    png.size += text.size;
    bytes_free(&text);
    refocus_photo_free(&(struct refocus_photo *){read_photo(png, REFOCUS_OK)});
}
#endif

#if defined(RF_HAVE_JPEG) && defined(RF_HAVE_PNG) && defined(RF_HAVE_XMP)
static struct bytes with_depth(void)
{
    return make_gdepth((struct gdepth){.format = "RangeInverse",
                                       .extra = "GDepth:Near=\"1\" GDepth:Far=\"8\"",
                                       .depth = make_png(6, 4, 0, 8),
                                       .original = make_jpeg(16, 16, false, false)},
                       0);
}

static struct bytes with_xmp(const char *inside)
{
    struct bytes jpeg = make_jpeg(16, 16, true, false);

    jpeg_insert_xmp(&jpeg, inside);
    return jpeg;
}

TEST(xmp)
{
    struct refocus_read_limits limits = refocus_read_limits_default();
    struct refocus_photo *photo = NULL;
    struct bytes jpeg;

    NEEDS(with_depth(), max_pixels, 6 * 4 + 16 * 16); /* both pictures of the packet */
    NEEDS(with_depth(), max_depth, 3);
    limits.max_elements = 5;
    assert_int_equal(read_within(with_depth(), limits), REFOCUS_ERR_SIZE);
    limits = refocus_read_limits_default();
    limits.max_metadata = 100;
    assert_int_equal(read_within(with_depth(), limits), REFOCUS_ERR_SIZE);
    /* Without depth the photo is as good. */
    limits = refocus_read_limits_default();
    limits.max_elements = 5;
    jpeg = with_xmp("<a><b/><b/><b/><b/><b/></a>");
    assert_int_equal(refocus_photo_read_memory(&photo, jpeg.data, jpeg.size, &limits, NULL),
                     REFOCUS_OK);
    assert_true(has_evidence(photo, "beyond the limits"));
    refocus_photo_free(&photo);
    limits.max_elements = 8;
    assert_int_equal(refocus_photo_read_memory(&photo, jpeg.data, jpeg.size, &limits, NULL),
                     REFOCUS_OK);
    assert_false(has_evidence(photo, "beyond the limits"));
    refocus_photo_free(&photo);
    bytes_free(&jpeg);
}
#endif
