/* test_gain_map.c: gain maps of Ultra HDR, ISO 21496-1 and Apple: metadata, the light they make,
 * and the tones that refocused light gets back. */
#include "check.h"

#include <math.h>

#include "gain_apply.h"
#include "gain_values.h"
#include "half.h"

static const int32_t one_channel[] = {0, 3000, -1000, 3000, 1000, 16, 32};

/* A photo of four quarters, red, green / blue, white, so many times as wide and as high as a map of
 * grey quarters. */
static struct bytes times_part(int times, struct bytes part, bool indexed, int orientation)
{
    struct bytes photo = make_jpeg(32 * times, 16 * times, false, false);

    if (orientation > 1)
        jpeg_insert_exif(&photo, make_exif(true, orientation));
    if (indexed)
        return make_mpf(photo, &part, 1, false);
    bytes_join(&photo, part);
    return photo;
}

static struct bytes with_part(struct bytes part, bool indexed, int orientation)
{
    return times_part(2, part, indexed, orientation);
}

static struct bytes xmp_part(const char *elements)
{
    struct bytes part = make_jpeg(32, 16, true, false), xmp = make_gain_xmp(elements);

    jpeg_insert_xmp(&part, (const char *)xmp.data);
    bytes_free(&xmp);
    return part;
}

static struct bytes iso_part(int channels, const int32_t *values)
{
    struct bytes part = make_jpeg(32, 16, channels == 1, false);
    struct bytes iso = make_gain_iso(channels, values);

    jpeg_insert(&part, 0xe2, "urn:iso:std:iso:ts:21496:-1", 28, iso.data, iso.size);
    bytes_free(&iso);
    return part;
}

static double light_at(const struct refocus_image *light, int x, int y, int c)
{
    uint16_t bits;

    memcpy(&bits, light->plane[0] + y * light->stride[0] + 6 * (ptrdiff_t)x + 2 * (ptrdiff_t)c, 2);
    return (double)rf_half_value(bits);
}

/* Channel c of the middle of a quarter is (S + base) 2^gain - other, S being 0 or 1. */
static void expect_quarter(const struct refocus_photo *photo, const struct refocus_image *light,
                           int quarter, int c, double gain, double base_offset, double other)
{
    const int x = light->width / 4 + quarter % 2 * light->width / 2;
    const int y = light->height / 4 + quarter / 2 * light->height / 2;
    const int code = photo->image->plane[0][y * photo->image->stride[0] + 3 * x + c];
    const double v = code / 255.0;
    const double s = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    const double expected = fmax(0, (s + base_offset) * exp2(gain) - other);

    if (fabs(light_at(light, x, y, c) - expected) > 0.02 * expected + 1e-4) {
        fail_msg("quarter %d, channel %d: %g, expected %g", quarter, c, light_at(light, x, y, c),
                 expected);
    }
}

/* Codes of the grey quarters, as make_jpeg() stores them. */
static double gain_of(int quarter, double least, double greatest, double gamma)
{
    return least + (greatest - least) * pow((32 + 64 * quarter) / 255.0, 1 / gamma);
}

static void check_light(struct bytes file, double least, double greatest, double gamma, double base,
                        double other)
{
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);
    struct refocus_light *light;

    assert_near(photo->info->gain_map_stops, greatest);
    assert_true(has_evidence(photo, "gain map: "));
    assert_int_equal(refocus_light_create(&light, photo), REFOCUS_OK);
    for (int quarter = 0; quarter < 4; quarter++) {
        for (int c = 0; c < 3; c++) {
            expect_quarter(photo, refocus_light_image(light), quarter, c,
                           gain_of(quarter, least, greatest, gamma), base, other);
        }
    }
    refocus_light_destroy(&light);
    refocus_photo_free(&photo);
}

TEST(light_of_maps)
{
    for (int indexed = 0; indexed < 2; indexed++) {
        check_light(with_part(xmp_part("<hdrgm:GainMapMax>3</hdrgm:GainMapMax>"
                                       "<hdrgm:HDRCapacityMax>3</hdrgm:HDRCapacityMax>"),
                              indexed, 1),
                    0, 3, 1, 1 / 64.0, 1 / 64.0);
        check_light(
            with_part(xmp_part("<hdrgm:GainMapMin><rdf:Seq><rdf:li>-1</rdf:li><rdf:li>-1</rdf:li>"
                               "<rdf:li>-1</rdf:li></rdf:Seq></hdrgm:GainMapMin>"
                               "<hdrgm:GainMapMax>4</hdrgm:GainMapMax>"
                               "<hdrgm:Gamma>2</hdrgm:Gamma><hdrgm:OffsetSDR>0</hdrgm:OffsetSDR>"
                               "<hdrgm:OffsetHDR>0.01</hdrgm:OffsetHDR>"
                               "<hdrgm:HDRCapacityMax>3.5</hdrgm:HDRCapacityMax>"),
                      indexed, 1),
            -1, 4, 2, 0, 0.01);
        check_light(with_part(iso_part(1, one_channel), indexed, 1), -1, 3, 1, 0.016, 0.032);
        /* Adobe's programs choose such offsets for a bright photo */
        check_light(with_part(xmp_part("<hdrgm:GainMapMax>0.753</hdrgm:GainMapMax>"
                                       "<hdrgm:Gamma>0.25</hdrgm:Gamma>"
                                       "<hdrgm:OffsetSDR>10.308957</hdrgm:OffsetSDR>"
                                       "<hdrgm:OffsetHDR>10.308957</hdrgm:OffsetHDR>"
                                       "<hdrgm:HDRCapacityMax>4</hdrgm:HDRCapacityMax>"),
                              indexed, 1),
                    0, 0.753, 0.25, 10.308957, 10.308957);
        /* a quarter as wide and high as the photo, grey */
        check_light(times_part(4, iso_part(1, one_channel), indexed, 1), -1, 3, 1, 0.016, 0.032);
    }
}

/* A lamp of one pixel, in one channel or with only < 0 in all, has all of the light that the sample
 * of its block stands for, and what is beside it has none of that. */
static void lamp_of(int only)
{
    enum { SIDE = 16, BLOCKS = 4, X = 5, Y = 6 };
    const double dark = pow((60 / 255.0 + 0.055) / 1.055, 2.4), offset = 1 / 64.0;
    uint8_t codes[3 * SIDE * SIDE], samples[3 * BLOCKS * BLOCKS] = {0};
    uint16_t halves[3 * SIDE * SIDE];
    const struct refocus_image base =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, codes, SIDE, SIDE, 3 * SIDE);
    struct rf_gain_map map = {.samples = {.pixels = samples,
                                          .width = BLOCKS,
                                          .height = BLOCKS,
                                          .sample = REFOCUS_SAMPLE_U8,
                                          .max_value = 255}};

    memset(codes, 60, sizeof codes);
    for (int c = 0; c < 3; c++) {
        codes[3 * (Y * SIDE + X) + c] = only < 0 || c == only ? 255 : 60;
        map.values.gamma[c] = 1;
        map.values.base_offset[c] = map.values.other_offset[c] = offset;
        map.values.greatest[c] =
            log2((15 * dark + 8 + 16 * offset) / (15 * dark + 1 + 16 * offset));
    }
    rf_gain_make_curves(&map);
    for (map.samples.channels = 1; map.samples.channels <= 3; map.samples.channels += 2) {
        memset(samples, 0, sizeof samples);
        for (int c = 0; c < map.samples.channels; c++)
            if (map.samples.channels == 1 || only < 0 || c == only)
                samples[map.samples.channels * (Y / 4 * BLOCKS + X / 4) + c] = 255;
        assert_int_equal(rf_gain_apply(&map, &base, halves), REFOCUS_OK);
        for (int i = 0; i < 3 * SIDE * SIDE; i++) {
            const bool lamp = i / 3 == Y * SIDE + X, lit = lamp && (only < 0 || i % 3 == only);
            const double expected = lit ? 8 : dark;

            /* A map of one channel keeps the lamp's hue. */
            if (lamp && !lit && map.samples.channels == 1) {
                assert_true((double)rf_half_value(halves[i]) > 2 * dark);
                assert_true((double)rf_half_value(halves[i]) < 8 * dark);
                continue;
            }
            if (fabs((double)rf_half_value(halves[i]) / expected - 1) > 0.01) {
                fail_msg("%d channels, value %d: %g, expected %g", (int)map.samples.channels, i,
                         (double)rf_half_value(halves[i]), expected);
            }
        }
    }
}

TEST(lamp)
{
    for (int only = -1; only < 3; only++)
        lamp_of(only);
}

/* The map is turned with its photo: quarter 0 of the upright one was quarter 2. */
TEST(turned)
{
    struct refocus_photo *photo =
        read_photo(with_part(iso_part(1, one_channel), true, 6), REFOCUS_OK);
    const struct rf_gain_map *const map = rf_photo_gain_map(photo);

    assert_int_equal(photo->image->width, 32);
    assert_int_equal(map->samples.width, 16);
    assert_int_equal(map->samples.height, 32);
    assert_in_range(map->samples.pixels[0], 156, 164);
    assert_in_range(map->samples.pixels[15], 28, 36);
    refocus_photo_free(&photo);
}

/* Each channel has a gain of its own. */
TEST(three_channels)
{
    static const int32_t values[] = {0,    3000, 0, 1000, 1000, 0,    0, 0, 2000,
                                     1000, 0,    0, 0,    3000, 1000, 0, 0};
    struct refocus_photo *photo = read_photo(with_part(iso_part(3, values), true, 1), REFOCUS_OK);
    struct refocus_light *light;

    assert_int_equal(refocus_light_create(&light, photo), REFOCUS_OK);
    for (int c = 0; c < 3; c++) /* white, where the map is white too */
        expect_quarter(photo, refocus_light_image(light), 3, c, c + 1, 0, 0);
    refocus_light_destroy(&light);
    refocus_photo_free(&photo);
}

/* An iPhone's note: its headroom, tag 0x21, and gain, 0x30, in hundredths. */
static struct bytes iphone_exif(int headroom, int gain)
{
    struct bytes exif = {NULL, 0};

    bytes_add(&exif, "MM\0*\0\0\0\10\0\1\207\151\0\4\0\0\0\1\0\0\0\32\0\0\0\0", 26);
    bytes_add(&exif, "\0\1\222\174\0\7\0\0\0\74\0\0\0\54\0\0\0\0", 18); /* the note, at 44 */
    bytes_add(&exif, "Apple iOS\0\0\1MM\0\2", 16);
    bytes_add(&exif, "\0\41\0\12\0\0\0\1\0\0\0\54\0\60\0\12\0\0\0\1\0\0\0\64\0\0\0\0", 28);
    bytes_number(&exif, (uint32_t)headroom, 4, true); /* at 44 of the note */
    bytes_number(&exif, 100, 4, true);
    bytes_number(&exif, (uint32_t)gain, 4, true);
    bytes_number(&exif, 100, 4, true);
    return exif;
}

static struct bytes iphone_photo(int headroom, int gain, const char *extra)
{
    struct bytes part = make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", extra);
    struct bytes photo = make_jpeg(64, 32, false, false);

    jpeg_insert_exif(&photo, iphone_exif(headroom, gain));
    return make_mpf(photo, &part, 1, true);
}

TEST(apple)
{
    static const struct {
        int headroom, gain;
        double stops;
    } notes[] = {{50, 0, 1.8}, {50, 1, 1.6},  {50, 200, 1.601 - 0.202},
                 {150, 0, 3},  {150, 1, 2.3}, {150, 200, 2.303 - 0.606}};
    struct refocus_photo *photo;
    struct refocus_light *light;

    for (size_t i = 0; i < sizeof notes / sizeof *notes; i++) {
        photo = read_photo(iphone_photo(notes[i].headroom, notes[i].gain, NULL), REFOCUS_OK);
        assert_near(photo->info->gain_map_stops, notes[i].stops);
        refocus_photo_free(&photo);
    }
    photo = read_photo(iphone_photo(150, 0, NULL), REFOCUS_OK);
    assert_int_equal(refocus_light_create(&light, photo), REFOCUS_OK);
    for (int quarter = 0; quarter < 4; quarter++) {
        const double linear = pow(((32 + 64 * quarter) / 255.0 + 0.099) / 1.099, 1 / 0.45);

        expect_quarter(photo, refocus_light_image(light), quarter, quarter % 3,
                       log2(1 + 7 * linear), 0, 0);
    }
    refocus_light_destroy(&light);
    refocus_photo_free(&photo);
    photo = read_photo(iphone_photo(150, 0,
                                    "xmlns:HDRGainMap=\"http://ns.apple.com/HDRGainMap/1.0/\" "
                                    "HDRGainMap:HDRGainMapHeadroom=\"4\""),
                       REFOCUS_OK);
    assert_near(photo->info->gain_map_stops, 2);
    refocus_photo_free(&photo);
    photo = read_photo(iphone_photo(150, 900, NULL), REFOCUS_OK); /* no headroom at all */
    assert_near(photo->info->gain_map_stops, 0);
    refocus_photo_free(&photo);
}

/* Maps that say nothing of use leave the photo as it is, with a line that says why. */
static void expect_passed_over(struct bytes file, const char *why)
{
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);
    struct refocus_light *light = (struct refocus_light *)1;

    if (!has_evidence(photo, why))
        fail_msg("no evidence says \"%s\"", why);
    assert_true(photo->info->gain_map_stops == 0);
    assert_null(rf_photo_gain_map(photo));
    assert_int_equal(refocus_light_create(&light, photo), REFOCUS_ERR_UNSUPPORTED);
    assert_null(light);
    refocus_photo_free(&photo);
}

TEST(passed_over)
{
    static const char *const damaged[] = {
        "",
        "<hdrgm:GainMapMax>3</hdrgm:GainMapMax>",
        "<hdrgm:GainMapMax>nan</hdrgm:GainMapMax><hdrgm:HDRCapacityMax>3</hdrgm:HDRCapacityMax>",
        "<hdrgm:GainMapMax>3 2</hdrgm:GainMapMax><hdrgm:HDRCapacityMax>3</hdrgm:HDRCapacityMax>",
        ("<hdrgm:GainMapMax>1 2 3 4</hdrgm:GainMapMax>"
         "<hdrgm:HDRCapacityMax>3</hdrgm:HDRCapacityMax>"),
    };
    static const int32_t bad[][7] = {
        {0, 3000, 0, 17000, 1000, 0, 0},      {0, 3000, 1, 0, 1000, 0, 0},
        {0, 3000, 0, 3000, 0, 0, 0},          {0, 3000, 0, 3000, 1000, 256001, 0},
        {0, 3000, 0, 3000, 1000, 0, -256001}, {0, -1, 0, 3000, 1000, 0, 0},
    };
    struct bytes part, file;

    for (size_t i = 0; i < sizeof damaged / sizeof *damaged; i++)
        expect_passed_over(with_part(xmp_part(damaged[i]), true, 1), "its metadata is damaged");
    expect_passed_over(
        with_part(xmp_part("<hdrgm:BaseRenditionIsHDR>True</hdrgm:BaseRenditionIsHDR>"
                           "<hdrgm:GainMapMax>3</hdrgm:GainMapMax>"
                           "<hdrgm:HDRCapacityMax>3</hdrgm:HDRCapacityMax>"),
                  true, 1),
        "not the darker rendition");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect_passed_over(with_part(iso_part(1, bad[i]), true, 1), "gain map: passed over");
    expect_passed_over(
        with_part(make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", NULL), true, 1),
        "does not say its headroom");
    for (size_t tag = 61; tag <= 73; tag += 12) { /* one of the iPhone's two numbers alone */
        struct bytes exif = iphone_exif(150, 100);

        exif.data[tag] = 0x7f;
        file = make_jpeg(64, 32, false, false);
        jpeg_insert_exif(&file, exif);
        part = make_auxiliary("urn:com:apple:photo:2020:aux:hdrgainmap", NULL);
        expect_passed_over(make_mpf(file, &part, 1, true), "does not say its headroom");
    }
    part = iso_part(1, one_channel); /* pixels are damaged */
    memset(part.data + part.size - 20, 0, 18);
    expect_passed_over(with_part(part, true, 1), "gain map: passed over, it is damaged");
    part = iso_part(1, one_channel); /* cut, where no index says that it is there */
    file = with_part(part, false, 1);
    file.size -= 10;
    {
        struct refocus_photo *photo = read_photo(file, REFOCUS_OK);

        assert_null(rf_photo_gain_map(photo));
        refocus_photo_free(&photo);
    }
}

/* A map beyond the limits is none; the photo is read. */
TEST(limits)
{
    const struct refocus_read_limits few = {.struct_size = sizeof few, .max_pixels = 64 * 32};
    struct bytes part = make_jpeg(64, 48, true, false), iso = make_gain_iso(1, one_channel), file;
    struct refocus_photo *photo;

    jpeg_insert(&part, 0xe2, "urn:iso:std:iso:ts:21496:-1", 28, iso.data, iso.size);
    bytes_free(&iso);
    file = with_part(part, true, 1);
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &few, NULL),
                     REFOCUS_OK);
    assert_true(has_evidence(photo, "beyond the limits"));
    assert_null(rf_photo_gain_map(photo));
    refocus_photo_free(&photo);
    bytes_free(&file);
}

/* Cut anywhere, ISO's metadata is damaged; so is it with a denominator of 0. */
static void check_iso(struct bytes iso, size_t denominator)
{
    struct rf_gain_values values;

    assert_null(rf_gain_from_iso((struct rf_bytes){iso.data, iso.size}, &values));
    for (int c = 0; c < 3; c++) {
        assert_near(values.least[c], -1);
        assert_near(values.greatest[c], 3);
        assert_near(values.gamma[c], 1);
        assert_near(values.base_offset[c], 0.016);
        assert_near(values.other_offset[c], 0.032);
    }
    assert_near(values.other_headroom, 3);
    for (size_t size = 0; size < iso.size; size++) {
        uint8_t *const cut = malloc(size ? size : 1);

        memcpy(cut, iso.data, size);
        assert_non_null(rf_gain_from_iso((struct rf_bytes){cut, size}, &values));
        free(cut);
    }
    memset(iso.data + denominator, 0, 4);
    assert_non_null(rf_gain_from_iso((struct rf_bytes){iso.data, iso.size}, &values));
    bytes_free(&iso);
}

TEST(iso_metadata)
{
    struct bytes iso = make_gain_iso(1, one_channel);
    struct rf_gain_values values;

    iso.data[1] = 1; /* a later version */
    assert_non_null(rf_gain_from_iso((struct rf_bytes){iso.data, iso.size}, &values));
    bytes_free(&iso);
    check_iso(make_gain_iso(1, one_channel), 9);
    check_iso(make_gain_iso_common(1, one_channel), 5);
}

/* Metadata of ISO that cannot be used is no reason to pass over what XMP says. */
TEST(xmp_beside_damaged_iso)
{
    static const char *const elements = "<hdrgm:GainMapMax>2</hdrgm:GainMapMax>"
                                        "<hdrgm:HDRCapacityMax>2</hdrgm:HDRCapacityMax>";
    struct bytes part = xmp_part(elements);

    jpeg_insert(&part, 0xe2, "urn:iso:std:iso:ts:21496:-1", 28, "\0\1\0\0\100", 5);
    check_light(with_part(part, true, 1), 0, 2, 1, 1 / 64.0, 1 / 64.0);
}

/* Light that nothing changed has the photo's codes; light between two quarters their tones. */
TEST(tones)
{
    struct refocus_photo *photo =
        read_photo(with_part(iso_part(1, one_channel), true, 1), REFOCUS_OK);
    const int width = photo->image->width, height = photo->image->height;
    const size_t row = 3 * (size_t)width;
    uint8_t *const out = calloc((size_t)height, row);
    struct refocus_image to =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, width, height, (ptrdiff_t)row);
    struct refocus_light *light;
    struct refocus_image from;
    uint16_t *pixels;
    int bright = 0;

    assert_int_equal(refocus_light_create(&light, photo), REFOCUS_OK);
    from = *refocus_light_image(light);
    assert_int_equal(refocus_light_to_base(light, &from, 0, 0, 0, &to), REFOCUS_OK);
    for (int y = 0; y < height; y++) {
        assert_memory_equal(out + (size_t)y * row,
                            photo->image->plane[0] + y * photo->image->stride[0], row);
    }
    /* All light halved: white, at 7 times white in the light, stays nearly white. */
    pixels = malloc(row * 2 * (size_t)height);
    for (int i = 0; i < 3 * width * height; i++) {
        uint16_t bits;

        memcpy(&bits, from.plane[0] + 2 * (ptrdiff_t)i, 2);
        pixels[i] = rf_half_of(rf_half_value(bits) / 2);
    }
    from.plane[0] = (uint8_t *)pixels;
    assert_int_equal(refocus_light_to_base(light, &from, 0, 0, 0, &to), REFOCUS_OK);
    for (int i = 0; i < 16 * 32; i++)
        bright += out[(16 + (size_t)i / 32) * row + 3 * (32 + (size_t)i % 32) + 1] > 200;
    assert_in_range(bright, 300, 512);
    /* A part lies where it is said to. */
    to.width = from.width = 8;
    to.height = from.height = 4;
    from = *refocus_light_image(light);
    from.plane[0] += 20 * from.stride[0] + 6 * 40;
    from.width = 8;
    from.height = 4;
    assert_int_equal(refocus_light_to_base(light, &from, 40, 20, 0, &to), REFOCUS_OK);
    assert_memory_equal(out, photo->image->plane[0] + 20 * photo->image->stride[0] + 3 * 40, 24);
    assert_int_equal(refocus_light_to_base(light, &from, 57, 20, 0, &to), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_light_to_base(light, &from, 40, 29, 0, &to), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_light_to_base(light, &from, -1, 0, 0, &to), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_light_to_base(light, &from, 40, 20, 2, &to), REFOCUS_ERR_ARGUMENT);
    to.width = 7;
    assert_int_equal(refocus_light_to_base(light, &from, 0, 0, 0, &to), REFOCUS_ERR_ARGUMENT);
    free(pixels);
    free(out);
    refocus_light_destroy(&light);
    refocus_photo_free(&photo);
}

/* Every half comes back, and values between two go to the nearest. */
TEST(halves)
{
    for (int half = 0; half < RF_HALF_MOST; half++) {
        const float a = rf_half_value((uint16_t)half), b = rf_half_value((uint16_t)(half + 1));

        assert_int_equal(rf_half_of(a), half);
        assert_int_equal(rf_half_of(a + (b - a) * 0.25f), half);
        assert_int_equal(rf_half_of(a + (b - a) * 0.75f), half + 1);
    }
    assert_int_equal(rf_half_of(NAN), 0);
    assert_int_equal(rf_half_of(-1), 0);
    assert_int_equal(rf_half_of(INFINITY), RF_HALF_MOST);
}
