/* test_gain_write.c: a picture and the light that it shows become an Ultra HDR photo, whose light
 * is read again by either of its metadata, and whose index and directory say where all lies. */
#include "check.h"

#include <math.h>
#include <unistd.h>

#include "gain_make.h"
#include "half.h"
#include "jpeg_walk.h"
#include "mpf.h"
#include "read.h"
#include "tone.h"

enum { W = 66, H = 42, X = 44, Y = 20, RADIUS = 9 };
static char path[64];

static int make_name(void **state)
{
    (void)state;
    snprintf(path, sizeof path, "/tmp/refocus-gain-%ld.jpg", (long)getpid());
    return 0;
}

static int remove_it(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

/* A slope, and a disc of six times white of the light of a warm lamp. */
struct scene {
    uint8_t codes[3 * W * H];
    uint16_t halves[3 * W * H];
    struct refocus_image base, light;
};

static bool is_lit(int x, int y)
{
    return (x - X) * (x - X) + (y - Y) * (y - Y) < RADIUS * RADIUS;
}

static struct scene *make_scene(void)
{
    static const float lamp[3] = {6, 3, 0.5f};
    struct scene *const scene = malloc(sizeof *scene);

    for (int i = 0; i < 3 * W * H; i++) {
        const int x = i / 3 % W, y = i / 3 / W, c = i % 3;
        const float light = is_lit(x, y) ? lamp[c] : rf_tone_light(40 + x + 20 * c);
        int code = 0;

        while (code < 255 && rf_tone_light(code) < light)
            code++;
        scene->codes[i] = (uint8_t)code;
        scene->halves[i] = rf_half_of(light);
    }
    scene->base = refocus_image_packed(REFOCUS_FORMAT_RGB8, scene->codes, W, H, 3 * W);
    scene->light = refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, scene->halves, W, H, 6 * W);
    return scene;
}

static struct bytes write_scene(const struct scene *scene, const struct refocus_photo *keep)
{
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_reason reason;
    struct refocus_blob blob;
    struct bytes bytes;

    options.light = &scene->light;
    options.keep = keep;
    assert_int_equal(refocus_image_write(path, &scene->base, &options, &reason), REFOCUS_OK);
    assert_string_equal(reason.text, "");
    assert_int_equal(refocus_file_read(path, 1 << 20, &blob, NULL), REFOCUS_OK);
    bytes = bytes_copy(blob.data, blob.size);
    free(blob.data);
    return bytes;
}

/* The mean light around a pixel of the lamp, or of the slope, is what was written; the picture may
 * be smaller by a whole number. */
static void expect_light(struct bytes file, int step)
{
    static const int places[][2] = {{X, Y}, {X - 4, Y + 2}, {10, 10}, {20, 34}};
    struct scene *const scene = make_scene();
    struct refocus_photo *photo = read_photo(file, REFOCUS_OK);
    struct refocus_light *light;

    assert_int_equal(refocus_light_create(&light, photo), REFOCUS_OK);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        for (int c = 0; c < 3; c++) {
            double sums[2] = {0, 0};

            for (int at = 0; at < 16; at += step) {
                const int x = places[i][0] + at % 4, y = places[i][1] + at / 4;
                const struct refocus_image *const own = refocus_light_image(light);
                uint16_t half;

                memcpy(&half, own->plane[0] + y / step * own->stride[0] + 6 * (x / step) + 2 * c,
                       2);
                sums[0] += (double)rf_half_value(half);
                sums[1] += (double)rf_half_value(scene->halves[3 * (y * W + x) + c]);
            }
            if (fabs(sums[0] / sums[1] - 1) > 0.05 * step) {
                fail_msg("place %zu, channel %d: %g, expected %g", i, c, sums[0] * step / 16,
                         sums[1] * step / 16);
            }
        }
    }
    refocus_light_destroy(&light);
    refocus_photo_free(&photo);
    free(scene);
}

/* Spoil a word of the file, wherever it is; it must be there. */
static struct bytes without(struct bytes file, const char *word)
{
    struct bytes copy = bytes_copy(file.data, file.size);
    const size_t n = strlen(word);
    int found = 0;

    for (size_t i = 0; i + n <= copy.size; i++) {
        if (memcmp(copy.data + i, word, n) == 0) {
            copy.data[i + n - 1] = 'x';
            found++;
        }
    }
    assert_int_equal(found, 2); /* in the main picture, and with the map */
    return copy;
}

/* Light of a pixel of the written photo over that of the scene, in stops. */
static double stops_off(const struct scene *scene, const struct refocus_light *light, int i)
{
    const struct refocus_image *const own = refocus_light_image(light);
    uint16_t half;

    memcpy(&half, own->plane[0] + i / (3 * W) * own->stride[0] + 2 * (i % (3 * W)), 2);
    return log2((double)rf_half_value(half) / (double)rf_half_value(scene->halves[i]));
}

/* A highlight has its light up to its last pixel, and what is beside it nothing of that. */
TEST(each_pixel_has_its_light)
{
    struct scene *const scene = make_scene();
    struct refocus_photo *photo;
    struct refocus_light *light;
    double sum = 0;
    int count = 0;

    photo = read_photo(write_scene(scene, NULL), REFOCUS_OK);
    assert_int_equal(refocus_light_create(&light, photo), REFOCUS_OK);
    for (int i = 0; i < 3 * W * H; i += 3) {
        const int x = i / 3 % W, y = i / 3 / W;

        /* The brightest channel of a pixel that has one of the other kind beside it. */
        if (x > 0 && is_lit(x, y) != is_lit(x - 1, y)) {
            sum += fabs(stops_off(scene, light, i));
            count++;
        }
    }
    assert_true(sum / count < 0.09);
    refocus_light_destroy(&light);
    refocus_photo_free(&photo);
    free(scene);
}

TEST(either_metadata)
{
    struct scene *const scene = make_scene();
    struct bytes file = write_scene(scene, NULL);

    expect_light(without(file, "urn:iso:std"), 1);
    expect_light(without(file, "hdrgm:Version"), 1);
    expect_light(bytes_copy(file.data, file.size), 1);
    bytes_free(&file);
    free(scene);
}

static size_t number_behind(const struct bytes *file, const char *word)
{
    const size_t n = strlen(word);

    for (size_t i = 0; i + n < file->size; i++)
        if (memcmp(file->data + i, word, n) == 0)
            return (size_t)strtoul((const char *)file->data + i + n, NULL, 10);
    return 0;
}

TEST(places)
{
    struct scene *const scene = make_scene();
    struct bytes file = write_scene(scene, NULL);
    const struct rf_bytes bytes = {file.data, file.size};
    struct rf_jpeg_walk walk;
    struct rf_bytes tiff = {NULL, 0};
    struct rf_mpf mpf;
    size_t end, base;

    assert_true(rf_jpeg_walk_begin(&walk, bytes));
    while (rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT)
        if (walk.marker == 0xe2)
            rf_jpeg_after(walk.segment, rf_jpeg_mpf_signature, sizeof rf_jpeg_mpf_signature, &tiff);
    end = walk.position;
    assert_non_null(tiff.data);
    base = (size_t)(tiff.data - file.data);
    assert_true(rf_mpf_parse(tiff, &mpf));
    assert_int_equal(mpf.count, 2);
    assert_int_equal(mpf.image[0].type, 0x30000);
    assert_int_equal(mpf.image[0].size, end);
    assert_int_equal(mpf.image[0].offset, 0);
    assert_int_equal(base + mpf.image[1].offset, end);
    assert_int_equal(end + mpf.image[1].size, file.size);
    assert_memory_equal(file.data + end, "\xff\xd8\xff", 3);
    assert_int_equal(number_behind(&file, "Item:Semantic=\"GainMap\" Item:Length=\""),
                     file.size - end);
    bytes_free(&file);
    free(scene);
}

/* A display that showed all of the photo's light shows all of the result's, no earlier. */
TEST(headroom)
{
    static const int32_t values[] = {0, 5000, 0, 1000, 1000, 16, 16};
    struct bytes photo = make_jpeg(W, H, false, false), part = make_jpeg(8, 8, true, false);
    struct bytes iso = make_gain_iso(1, values);
    struct scene *const scene = make_scene();
    struct refocus_photo *keep, *result;

    jpeg_insert(&part, 0xe2, "urn:iso:std:iso:ts:21496:-1", 28, iso.data, iso.size);
    bytes_free(&iso);
    bytes_join(&photo, part);
    keep = read_photo(photo, REFOCUS_OK);
    result = read_photo(write_scene(scene, keep), REFOCUS_OK);
    assert_near(rf_photo_gain_map(result)->values.other_headroom, 5);
    refocus_photo_free(&result);
    result = read_photo(write_scene(scene, NULL), REFOCUS_OK);
    assert_near(rf_photo_gain_map(result)->values.other_headroom,
                rf_photo_gain_map(result)->values.greatest[0]);
    refocus_photo_free(&result);
    refocus_photo_free(&keep);
    free(scene);
}

/* Light of another size is that of the same view. Whatever its halves are, the map can be read. */
TEST(other_light)
{
    static const uint16_t wild[] = {0xffff, 0x7c00, 0x7bff, 0x8000, 0, 0x7e00, 1};
    struct scene *const scene = make_scene();
    struct refocus_photo *photo;

    for (int y = 0; y < H / 2; y++)
        for (int x = 0; x < W / 2; x++)
            memmove(scene->codes + 3 * (y * (W / 2) + x), scene->codes + 6 * (y * W + x), 3);
    scene->base = refocus_image_packed(REFOCUS_FORMAT_RGB8, scene->codes, W / 2, H / 2, 3 * W / 2);
    expect_light(write_scene(scene, NULL), 2);
    for (int i = 0; i < 3 * W * H; i++)
        scene->halves[i] = wild[i % 7];
    for (int side = 1; side <= 3; side++) {
        scene->base.width = side;
        scene->base.height = 4 - side;
        photo = read_photo(write_scene(scene, NULL), REFOCUS_OK);
        assert_non_null(rf_photo_gain_map(photo));
        refocus_photo_free(&photo);
    }
    free(scene);
}

#ifdef RF_HAVE_PNG
static const uint16_t disparity[4] = {0, 1000, 40000, 65535};

/* A photo as a HEIC is read, with a gain map of one or three channels and a matte. */
static struct refocus_photo *heic(bool grey, int channels, const int32_t *values)
{
    struct bytes parts[2] = {
        make_jpeg(32, 16, grey, false),
        make_auxiliary("urn:com:apple:photo:2018:aux:portraiteffectsmatte", NULL)};
    struct bytes iso = make_gain_iso(channels, values);
    struct refocus_photo *photo;

    jpeg_insert(&parts[0], 0xe2, "urn:iso:std:iso:ts:21496:-1", 28, iso.data, iso.size);
    bytes_free(&iso);
    photo = read_photo(make_mpf(make_jpeg(64, 32, false, false), parts, 2, true), REFOCUS_OK);
    assert_non_null(rf_photo_gain_map(photo));
    ((struct rf_photo *)(void *)photo)->kept.kind = RF_KEPT_NOTHING;
    strcpy(((struct rf_photo *)(void *)photo)->info.container, "HEIC");
    return photo;
}

/* The editable result of a photo, read again. */
static struct refocus_photo *edited(const struct refocus_photo *photo,
                                    struct refocus_reason *reason)
{
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_editable editable = refocus_editable_default();
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_photo *again;

    depth.disparity = disparity;
    depth.width = depth.height = 2;
    depth.stride = 4;
    editable.depth = &depth;
    options.keep = photo;
    options.editable = &editable;
    assert_int_equal(refocus_image_write(path, photo->image, &options, reason), REFOCUS_OK);
    assert_int_equal(refocus_photo_read(&again, path, NULL, NULL), REFOCUS_OK);
    assert_int_equal(again->info->original_used, 1);
    return again;
}

/* Three channels of one pair of offsets have their gains again; where offsets differ, or the gains
 * of one sample, the map is left out. */
TEST(channels_that_differ)
{
    static const struct {
        bool grey, is_kept;
        int32_t values[17];
    } kinds[] = {
        {false,
         true,
         {0, 3000, -1000, 3000, 1000, 16, 32, 0, 2000, 2000, 16, 32, 0, 1000, 500, 16, 32}},
        {false,
         false,
         {0, 3000, 0, 3000, 1000, 16, 32, 0, 3000, 1000, 17, 32, 0, 3000, 1000, 16, 32}},
        {false,
         false,
         {0, 3000, 0, 3000, 1000, 16, 32, 0, 3000, 1000, 16, 32, 0, 3000, 1000, 16, 31}},
        {true,
         false,
         {0, 3000, 0, 3000, 1000, 16, 32, 0, 3000, 1000, 16, 32, 0, 3000, 900, 16, 32}},
        {true,
         true,
         {0, 3000, 0, 3000, 1000, 16, 32, 0, 3000, 1000, 16, 32, 0, 3000, 1000, 16, 32}}};

    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct refocus_reason reason;
        struct refocus_photo *photo = heic(kinds[i].grey, 3, kinds[i].values);
        struct refocus_photo *again = edited(photo, &reason);
        const struct rf_gain_map *const maps[2] = {rf_photo_gain_map(photo),
                                                   rf_photo_gain_map(again)};
        const int channels = kinds[i].grey ? 1 : 3;

        assert_int_equal(maps[1] != NULL, kinds[i].is_kept);
        assert_string_equal(reason.text, kinds[i].is_kept
                                             ? ""
                                             : "its original is written without the photo's HDR "
                                               "gain map, whose channels differ");
        for (int j = 0; maps[1] && j < channels * 32 * 16; j++) {
            const float a = maps[0]->gain[j % channels][maps[0]->samples.pixels[j]];
            const float b = maps[1]->gain[j % channels][maps[1]->samples.pixels[j]];

            assert_true(fabsf(a - b) < 0.1f);
        }
        refocus_photo_free(&again);
        refocus_photo_free(&photo);
    }
}

/* The original that the result of a HEIC holds is a JPEG, with gain map and matte behind it. */
TEST(original_of_heic)
{
    static const int32_t values[] = {0, 3000, -1000, 3000, 2000, 16, 32};
    struct refocus_photo *photo = heic(true, 1, values);
    struct refocus_photo *again = edited(photo, NULL);

    assert_non_null(photo->matte->samples);
    assert_non_null(again->matte->samples);
    for (int i = 0; i < 4; i++) { /* the depth lies as the picture does */
        assert_int_equal(sample_at(again->depth, i % 2, i / 2),
                         again->depth->value_near == 0 ? 65535 - disparity[i] : disparity[i]);
    }
    for (int y = 0; y < 32; y++) {
        for (int i = 0; i < 3 * 64; i++) {
            const int a = pixel_at(photo->image, 0, y)[i], b = pixel_at(again->image, 0, y)[i];

            assert_true(abs(a - b) < 12);
        }
    }
    for (int y = 0; y < 16; y++) {
        for (int x = 0; x < 32; x++) {
            const struct rf_gain_map *const maps[2] = {rf_photo_gain_map(photo),
                                                       rf_photo_gain_map(again)};
            float gain[2];

            for (int i = 0; i < 2; i++)
                gain[i] = maps[i]->gain[0][maps[i]->samples.pixels[32 * y + x]];
            assert_true(fabsf(gain[0] - gain[1]) < 0.1f);
            assert_true(
                abs((int)sample_at(photo->matte, x, y) - (int)sample_at(again->matte, x, y)) < 6);
        }
    }
    refocus_photo_free(&again);
    refocus_photo_free(&photo);
}
#endif

/* Floats become the gain map that halves of the same light become. */
TEST(floats)
{
    struct scene *const scene = make_scene();
    const struct bytes halves = write_scene(scene, NULL);
    float *const light = malloc(3 * W * H * sizeof *light);
    struct bytes own;

    for (int i = 0; i < 3 * W * H; i++)
        light[i] = rf_half_value(scene->halves[i]);
    scene->light = refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, light, W, H, 12 * W);
    own = write_scene(scene, NULL);
    assert_int_equal(own.size, halves.size);
    assert_memory_equal(own.data, halves.data, halves.size);
    free(own.data);
    free(halves.data);
    free(light);
    free(scene);
}

TEST(refused)
{
    struct scene *const scene = make_scene();
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_reason reason;

    options.light = &scene->light;
    strcpy(strrchr(path, '.'), ".png");
    assert_int_equal(refocus_image_write(path, &scene->base, &options, &reason),
                     REFOCUS_ERR_UNSUPPORTED);
    assert_non_null(strstr(reason.text, "gain map"));
    strcpy(strrchr(path, '.'), ".jpg");
    unlink(path); /* another test may have written it */
    scene->base.format = REFOCUS_FORMAT_BGR8;
    assert_int_equal(refocus_image_write(path, &scene->base, &options, NULL), REFOCUS_ERR_ARGUMENT);
    scene->base.format = REFOCUS_FORMAT_RGB8;
    scene->light.stride[0] = 3 * W;
    assert_int_equal(refocus_image_write(path, &scene->base, &options, NULL), REFOCUS_ERR_ARGUMENT);
    options.light = &scene->base;
    assert_int_equal(refocus_image_write(path, &scene->base, &options, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_not_equal(access(path, F_OK), 0);
    free(scene);
}

int main(void)
{
    return unit_test_run(make_name, remove_it);
}
