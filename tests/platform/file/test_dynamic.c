/* test_dynamic.c: Google's Dynamic Depth, and depth in the directory of Ultra HDR. */
#include "check.h"
#include "dynamic_write.h"

#include <math.h>

#define URIS                                                                                       \
    "DepthMap:DepthURI=\"android/depthmap\" DepthMap:ConfidenceURI=\"android/confidencemap\" "
#define METRES "DepthMap:Near=\"0.5\" DepthMap:Far=\"8\" DepthMap:Units=\"Meters\" "

/* Depth of 6 x 4 with confidence, and a gain map before it, in a file of a kind. */
static struct dynamic with(const char *map, bool plain)
{
    return (struct dynamic){.plain = plain,
                            .map = map,
                            .gain = make_jpeg(16, 16, true, false),
                            .depth = make_png(6, 4, 0, 8),
                            .confidence = make_png(6, 4, 0, 8)};
}

static void check_samples(const struct refocus_photo *photo)
{
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_DYNAMIC);
    assert_int_equal(photo->depth->width, 6);
    assert_int_equal(photo->depth->height, 4);
    assert_non_null(photo->confidence);
    assert_true(has_evidence(photo, "weighs it"));
    for (int i = 0; i < 24; i++) {
        assert_int_equal(sample_at(photo->depth, i % 6, i / 6), pattern(i % 6, i / 6, 0, 255));
        assert_int_equal(photo->confidence[i], pattern(i % 6, i / 6, 0, 255));
    }
}

TEST(formats_and_units)
{
    struct refocus_photo *photo = read_photo(
        make_dynamic(with("DepthMap:Format=\"RangeInverse\" " METRES URIS, false), 0), REFOCUS_OK);

    check_samples(photo);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
    assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
    assert_true(photo->depth->near_m == 0.5 && photo->depth->far_m == 8);
    assert_int_equal(photo->info->original_used, 0);
    refocus_photo_free(&photo);

    photo = read_photo(make_dynamic(with("DepthMap:Format=\"rangelinear\" " METRES URIS, false), 0),
                       REFOCUS_OK);
    check_samples(photo);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    assert_near(photo->depth->metres_at_zero, 0.5);
    assert_near(photo->depth->metres_per_unit, 7.5 / 255);
    refocus_photo_free(&photo);
}

/* Dioptres are metres where the nearest has most of them. "None" and nothing are none. */
TEST(dioptres_and_no_unit)
{
    static const char *const none[] = {
        "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"2\" DepthMap:Far=\"9\" " URIS,
        "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"2\" DepthMap:Far=\"9\" "
        "DepthMap:Units=\"None\" " URIS,
        "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"2\" DepthMap:Far=\"9\" "
        "DepthMap:Units=\"Diopters\" " URIS,
        "DepthMap:ItemSemantic=\"Segmentation\" DepthMap:Format=\"RangeLinear\" " METRES URIS,
    };
    struct refocus_photo *photo;

    for (int i = 0; i < 2; i++) {
        photo = read_photo(
            make_dynamic(with(i ? "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"4\" "
                                  "DepthMap:Far=\"0.5\" DepthMap:Units=\"Diopters\" " URIS
                                : "DepthMap:Format=\"RangeLinear\" DepthMap:Near=\"4\" "
                                  "DepthMap:Far=\"0\" DepthMap:Units=\"diopters\" " URIS,
                              false),
                         0),
            REFOCUS_OK);
        check_samples(photo);
        assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
        assert_near(photo->depth->near_m, 0.25);
        assert_true(i ? photo->depth->far_m == 2 : isinf(photo->depth->far_m));
        refocus_photo_free(&photo);
    }
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        photo = read_photo(make_dynamic(with(none[i], false), 0), REFOCUS_OK);
        check_samples(photo);
        assert_true(photo->depth->near_m == 0 && photo->depth->far_m == 0);
        assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
        assert_true(has_evidence(photo, "no metres"));
        refocus_photo_free(&photo);
    }
}

/* The directory of Ultra HDR names items by what they are, with and without a DepthMap. */
TEST(directory_of_ultra_hdr)
{
    for (int i = 0; i < 2; i++) {
        struct refocus_photo *photo = read_photo(
            make_dynamic(with(i ? "DepthMap:Format=\"RangeInverse\" " METRES : NULL, true), 0),
            REFOCUS_OK);

        check_samples(photo);
        assert_true(photo->depth->value_near == 0 && photo->depth->value_far == 255);
        assert_true(photo->depth->near_m == (i ? 0.5 : 0));
        assert_true(has_evidence(photo, "no Format") == !i);
        refocus_photo_free(&photo);
    }
}

/* Padding behind each item; and something else behind the main picture, which no item counts. */
TEST(places)
{
    static const size_t padding[] = {0, 1, 7, 0, 5}, between[] = {0, 0, 0, 9, 400};

    for (int i = 0; i < 10; i++) {
        struct dynamic dynamic = with("DepthMap:Format=\"RangeInverse\" " URIS, i % 2);
        struct refocus_photo *photo;

        dynamic.padding = padding[i / 2];
        dynamic.between = between[i / 2];
        photo = read_photo(make_dynamic(dynamic, 0), REFOCUS_OK);
        check_samples(photo);
        assert_true(has_evidence(photo, "from the end of the file") == (dynamic.between > 0));
        refocus_photo_free(&photo);
    }
}

TEST(original_and_orientation)
{
    for (int i = 0; i < 2; i++) {
        struct dynamic dynamic = with("DepthMap:Format=\"RangeInverse\" " URIS, i);
        struct refocus_photo *photo;
        int x, y;

        dynamic.original = make_png(9, 7, 2, 8);
        photo = read_photo(make_dynamic(dynamic, 6), REFOCUS_OK);
        assert_int_equal(photo->info->original_used, 1);
        assert_int_equal(photo->image->width, 7);
        assert_int_equal(photo->image->height, 9);
        assert_int_equal(photo->depth->width, 4);
        assert_int_equal(photo->depth->height, 6);
        upright_place(6, 6, 4, 5, 1, &x, &y);
        assert_int_equal(sample_at(photo->depth, x, y), pattern(5, 1, 0, 255));
        assert_int_equal(photo->confidence[y * 4 + x], pattern(5, 1, 0, 255));
        refocus_photo_free(&photo);
    }
}

TEST(confidence_of_all_kinds)
{
    struct dynamic dynamic = with("DepthMap:Format=\"RangeInverse\" " URIS, false);
    const struct gdepth gdepth = {.format = "RangeInverse",
                                  .extra = "GDepth:Confidence=\"AAAA\"",
                                  .depth = make_png(6, 4, 0, 8)};
    struct bytes png = make_png(6, 4, 0, 8), text = {NULL, 0}, coded;
    struct refocus_photo *photo;

    bytes_free(&dynamic.confidence);
    dynamic.confidence = make_png(6, 4, 0, 16);
    photo = read_photo(make_dynamic(dynamic, 0), REFOCUS_OK);
    for (int i = 0; i < 24; i++)
        assert_int_equal(photo->confidence[i], pattern(i % 6, i / 6, 0, 65535) * 255 / 65535);
    refocus_photo_free(&photo);
    dynamic = with("DepthMap:Format=\"RangeInverse\" " URIS, false);
    bytes_free(&dynamic.confidence);
    dynamic.confidence = make_png(5, 4, 0, 8);
    photo = read_photo(make_dynamic(dynamic, 0), REFOCUS_OK);
    assert_null(photo->confidence);
    assert_true(has_evidence(photo, "not as many as the depth"));
    refocus_photo_free(&photo);
    /* GDepth has it as text. */
    read_photo(make_gdepth(gdepth, 0), REFOCUS_ERR_FORMAT);
    coded = base64(png.data, png.size);
    bytes_text(&text, "GDepth:Confidence=\"");
    bytes_text(&text, (const char *)coded.data);
    bytes_text(&text, "\"");
    photo = read_photo(make_gdepth((struct gdepth){.format = "RangeInverse",
                                                   .extra = (const char *)text.data,
                                                   .depth = make_png(6, 4, 0, 8)},
                                   0),
                       REFOCUS_OK);
    assert_int_equal(photo->confidence[8], pattern(2, 1, 0, 255));
    refocus_photo_free(&photo);
    bytes_free(&png);
    bytes_free(&coded);
    bytes_free(&text);
}

TEST(damaged)
{
    static const char *const bad[] = {
        "DepthMap:Format=\"RangeSquare\" " URIS,
        "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"8\" DepthMap:Far=\"2\" " URIS,
        "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"x\" " URIS,
        "DepthMap:Format=\"RangeLinear\" " URIS,
        "DepthMap:Format=\"RangeInverse\" DepthMap:DepthURI=\"elsewhere\"",
    };
    const char *map = "DepthMap:Format=\"RangeInverse\" " URIS;
    struct dynamic dynamic;
    struct refocus_photo *photo;
    struct bytes file;

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        read_photo(make_dynamic(with(bad[i], false), 0), REFOCUS_ERR_FORMAT);
    for (int i = 0; i < 3; i++) { /* parts that are no picture, or one in colour */
        dynamic = with(map, false);
        bytes_free(i ? &dynamic.confidence : &dynamic.depth);
        *(i ? &dynamic.confidence : &dynamic.depth) =
            i == 2 ? make_png(6, 4, 2, 8) : bytes_copy("no picture", 10);
        read_photo(make_dynamic(dynamic, 0), REFOCUS_ERR_FORMAT);
    }
    /* An editor wrote the main picture alone; and a file that was cut. */
    file = make_dynamic((struct dynamic){.map = map, .depth = make_png(6, 4, 0, 8)}, 0);
    dynamic.depth = make_png(6, 4, 0, 8);
    photo = read_photo(bytes_copy(file.data, file.size - dynamic.depth.size), REFOCUS_OK);
    bytes_free(&dynamic.depth);
    assert_null(photo->depth->samples);
    assert_true(has_evidence(photo, "the depth is lost"));
    refocus_photo_free(&photo);
    read_photo(bytes_copy(file.data, file.size - 1), REFOCUS_ERR_FORMAT);
    bytes_free(&file);
}

/* Beside the directory by URIs there is one by meanings: each counts the same bytes by itself. */
TEST(two_directories)
{
    struct bytes jpeg = make_jpeg(48, 32, false, false), png = make_png(6, 4, 0, 8);
    struct refocus_photo *photo;
    char text[1200];

    snprintf(text, sizeof text,
             "<x xmlns:C=\"http://ns.google.com/photos/1.0/container/\" "
             "xmlns:I=\"http://ns.google.com/photos/1.0/container/item/\" "
             "xmlns:c=\"http://ns.google.com/photos/dd/1.0/container/\" "
             "xmlns:i=\"http://ns.google.com/photos/dd/1.0/item/\" "
             "xmlns:m=\"http://ns.google.com/photos/dd/1.0/camera/\" "
             "xmlns:d=\"http://ns.google.com/photos/dd/1.0/depthmap/\">"
             "<C:Directory><C:Item I:Semantic=\"Primary\"/>"
             "<C:Item I:Semantic=\"Other\" I:Length=\"%zu\"/></C:Directory>"
             "<c:Directory><c:Item i:DataURI=\"primary\"/>"
             "<c:Item i:DataURI=\"depth\" i:Length=\"%zu\"/></c:Directory>"
             "<m:DepthMap d:Format=\"RangeInverse\" d:DepthURI=\"depth\"/></x>",
             png.size, png.size);
    jpeg_insert_xmp(&jpeg, text);
    bytes_join(&jpeg, png);
    bytes_text(&jpeg, "something");
    photo = read_photo(jpeg, REFOCUS_OK);
    assert_int_equal(photo->depth->width, 6);
    assert_int_equal(sample_at(photo->depth, 3, 2), pattern(3, 2, 0, 255));
    refocus_photo_free(&photo);
}

static void check_items(const char *items, int count, int expected)
{
    struct bytes jpeg = make_jpeg(16, 16, false, false), text = {NULL, 0};
    struct refocus_photo *photo;

    bytes_text(&text, "<x xmlns:c=\"http://ns.google.com/photos/dd/1.0/container/\" "
                      "xmlns:i=\"http://ns.google.com/photos/dd/1.0/item/\" "
                      "xmlns:d=\"http://ns.google.com/photos/dd/1.0/depthmap/\"><c:Directory>");
    for (int i = 0; i < count; i++)
        bytes_text(&text, items);
    bytes_text(&text, "</c:Directory></x>");
    jpeg_insert_xmp(&jpeg, (const char *)text.data);
    bytes_text(&jpeg, "something");
    photo = read_photo(jpeg, expected);
    refocus_photo_free(&photo);
    bytes_free(&text);
}

/* Lengths that overflow, that are no lengths, and more items than anything has. */
TEST(hostile_directories)
{
    check_items("<c:Item i:DataURI=\"a\" i:Length=\"1\"/>", 32, REFOCUS_OK);
    check_items("<c:Item i:DataURI=\"a\" i:Length=\"1\"/>", 33, REFOCUS_ERR_SIZE);
    check_items("<c:Item i:Semantic=\"Depth\" i:Length=\"9e15\" i:Padding=\"9e15\"/>", 32,
                REFOCUS_ERR_FORMAT);
    check_items("<c:Item i:Semantic=\"Depth\" i:Length=\"1e16\"/>", 2, REFOCUS_ERR_FORMAT);
    check_items("<c:Item i:Semantic=\"Depth\" i:Length=\"-1\"/>", 2, REFOCUS_ERR_FORMAT);
    check_items("<c:Item i:Semantic=\"Depth\" i:Padding=\"one\"/>", 2, REFOCUS_ERR_FORMAT);
    check_items("<c:Item i:Semantic=\"Depth\"/>", 2, REFOCUS_ERR_FORMAT); /* no bytes */
    check_items("<c:Item i:Semantic=\"Depth\"/>", 1, REFOCUS_OK);         /* the main picture */
}

/* Metres are written where both ends are known and in order. */
TEST(metres_are_written)
{
    static const struct {
        double near, far;
        bool written;
    } cases[] = {{2, 8, true},  {2, INFINITY, true}, {0, 8, false},
                 {2, 0, false}, {2, 2, false},       {0, 0, false}};

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct refocus_depth_write depth = refocus_depth_write_default();
        struct rf_text text = {NULL, 0, 0, false};
        struct rf_behind behind = {.count = 0};

        depth.near_m = cases[i].near;
        depth.far_m = cases[i].far;
        rf_behind_add(&behind, "Depth", "depth", (struct refocus_blob){NULL, 0});
        rf_dynamic_put(&text, &behind, &depth);
        rf_text_put(&text, "", 1);
        assert_false(text.failed);
        assert_int_equal(!!strstr(text.data, "DepthMap:Near=\"2\""), cases[i].written);
        assert_int_equal(!!strstr(text.data, "DepthMap:Near"), cases[i].written);
        assert_int_equal(!!strstr(text.data, "DepthMap:Far=\"8\""),
                         cases[i].far == 8 && cases[i].written);
        assert_int_equal(!!strstr(text.data, "Meters"), cases[i].written);
        free(text.data);
        behind.count = 0;
        text = (struct rf_text){NULL, 0, 0, false};
        rf_dynamic_put(&text, &behind, &depth); /* no depth is there */
        assert_int_equal(text.size, 0);
        free(text.data);
    }
}
