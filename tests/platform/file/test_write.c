/* test_write.c: pictures into files: what is read back, and what an error leaves behind. */
#include "check.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/refocus-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char path[400];
    struct dirent *entry;
    DIR *const list = opendir(folder);

    (void)state;
    while (list && (entry = readdir(list))) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        unlink(path);
    }
    closedir(list);
    return rmdir(folder);
}

static int count_files(void)
{
    struct dirent *entry;
    DIR *const list = opendir(folder);
    int count = 0;

    while (list && (entry = readdir(list)))
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(list);
    return count;
}

static const char *in_folder(const char *name)
{
    static char path[128];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

/* The pattern in a format, rows top-down or bottom-up, with gaps between them. */
struct picture {
    struct refocus_image image;
    uint8_t *memory;
};

static struct picture make_picture(uint32_t format, int width, int height, bool flipped)
{
    const int bytes = format >= REFOCUS_FORMAT_RGBA8 ? 4 : 3;
    const ptrdiff_t stride = width * bytes + 5;
    const bool swap = format == REFOCUS_FORMAT_BGR8 || format == REFOCUS_FORMAT_BGRA8;
    struct picture picture;

    picture.memory = malloc((size_t)stride * (size_t)height);
    picture.image =
        refocus_image_packed(format, picture.memory + (flipped ? (height - 1) * stride : 0), width,
                             height, flipped ? -stride : stride);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            uint8_t *const p = picture.image.plane[0] + y * picture.image.stride[0] + x * bytes;
            for (int c = 0; c < 3; c++)
                p[swap ? 2 - c : c] = (uint8_t)pattern(x, y, c, 255);
            if (bytes == 4)
                p[3] = 77;
        }
    }
    return picture;
}

static struct refocus_photo *read_back(const char *path)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;

    assert_int_equal(refocus_photo_read(&photo, path, NULL, &reason), REFOCUS_OK);
    return photo;
}

static void lossless(const char *name)
{
    for (uint32_t format = REFOCUS_FORMAT_RGB8; format <= REFOCUS_FORMAT_BGRA8; format++) {
        for (int flipped = 0; flipped < 2; flipped++) {
            struct picture picture = make_picture(format, 13, 9, flipped);
            struct refocus_reason reason;
            struct refocus_photo *photo;

            assert_int_equal(refocus_image_write(in_folder(name), &picture.image, NULL, &reason),
                             REFOCUS_OK);
            assert_string_equal(reason.text, "");
            free(picture.memory);
            photo = read_back(in_folder(name));
            for (int i = 0; i < 13 * 9 * 3; i++) {
                const int x = i / 3 % 13, y = i / 39;
                assert_int_equal(pixel_at(photo->image, x, y)[i % 3], pattern(x, y, i % 3, 255));
            }
            refocus_photo_free(&photo);
        }
    }
}

TEST(ppm_round_trip)
{
    lossless("a.ppm");
}

TEST(grey_round_trip)
{
    static const char *const names[] = {"d.pgm", "d.pfm",
#ifdef RF_HAVE_PNG
                                        "d.PNG"
#endif
    };
    uint16_t samples[3 * 4];
    struct refocus_reason reason;
    struct refocus_photo *depth;

    for (int i = 0; i < 12; i++)
        samples[i] = (uint16_t)pattern(i % 3, i / 3, 0, 65535);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        for (int flipped = 0; flipped < 2; flipped++) {
            assert_int_equal(refocus_gray16_write(in_folder(names[k]), samples + (flipped ? 9 : 0),
                                                  3, 4, flipped ? -6 : 6, &reason),
                             REFOCUS_OK);
            assert_int_equal(
                refocus_depth_read(&depth, in_folder(names[k]), NULL, 0, 0, NULL, &reason),
                REFOCUS_OK);
            for (int i = 0; i < 12; i++) {
                const int y = flipped ? 3 - i / 3 : i / 3;
                const unsigned v = samples[y * 3 + i % 3];
                if (depth->depth->sample == REFOCUS_SAMPLE_F32)
                    assert_true(float_at(depth->depth, i % 3, i / 3) == (float)(v / 65535.0));
                else
                    assert_int_equal(sample_at(depth->depth, i % 3, i / 3), v);
            }
            refocus_photo_free(&depth);
        }
    }
}

#if defined(RF_HAVE_PNG) || defined(RF_HAVE_JPEG)
/* The least that libpng takes for an ICC profile, made longer with noise. */
static struct bytes make_icc(size_t size)
{
    static const uint8_t d50[12] = {0, 0, 0xf6, 0xd6, 0, 1, 0, 0, 0, 0, 0xd3, 0x2d};
    struct bytes icc = {calloc(1, size), size};

    for (int i = 0; i < 4; i++)
        icc.data[i] = (uint8_t)(size >> (24 - 8 * i));
    icc.data[8] = 2;
    memcpy(icc.data + 12, "mntrRGB XYZ ", 12);
    memcpy(icc.data + 36, "acsp", 4);
    memcpy(icc.data + 68, d50, 12);
    /* libpng finds profiles "too short" that zlib makes too small. */
    for (size_t i = 132; i < size; i++)
        icc.data[i] = (uint8_t)((i * i * 2654435761u) >> 13);
    return icc;
}
#endif

#ifdef RF_HAVE_PNG
TEST(png_round_trip)
{
    lossless("a.png");
}
#endif

#if defined(RF_HAVE_PNG) || defined(RF_HAVE_JPEG)
static int times_in_file(const char *name, const char *word)
{
    struct refocus_blob file;
    int times = 0;

    assert_int_equal(refocus_file_read(in_folder(name), UINT64_MAX, &file, NULL), REFOCUS_OK);
    for (size_t i = 0; i + strlen(word) <= file.size; i++)
        times += memcmp(file.data + i, word, strlen(word)) == 0;
    free(file.data);
    return times;
}

static void keeps_exif_and_icc(const char *name, size_t icc_size)
{
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 20, 10, false);
    struct bytes exif = make_exif(false, 1), icc = make_icc(icc_size);
    const struct refocus_blob exif_blob = {exif.data, exif.size};
    const struct refocus_blob icc_blob = {icc.data, icc.size};
    const struct refocus_write_options options = {
        .struct_size = sizeof(struct refocus_write_options), .exif = &exif_blob, .icc = &icc_blob};
    struct refocus_reason reason;
    struct refocus_photo *photo;

    assert_int_equal(refocus_image_write(in_folder(name), &picture.image, &options, &reason),
                     REFOCUS_OK);
    assert_string_equal(reason.text, "");
    photo = read_back(in_folder(name));
    assert_int_equal(photo->exif.size, exif.size);
    assert_int_equal(times_in_file(name, "eXIf"), strstr(name, ".png") ? 1 : 0);
    assert_string_equal(photo->info->camera, "Maker Model X");
    assert_int_equal(photo->icc.size, icc.size);
    assert_memory_equal(photo->icc.data, icc.data, icc.size);
    refocus_photo_free(&photo);
    free(picture.memory);
    bytes_free(&exif);
    bytes_free(&icc);
}

#ifdef RF_HAVE_JPEG
/* JFIF's segment follows the first marker at once, and EXIF the whole of it. */
static void jfif_is_first(const char *name)
{
    static const uint8_t jfif[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0};
    uint8_t begin[24];
    FILE *const file = fopen(in_folder(name), "rb");

    assert_non_null(file);
    assert_int_equal(fread(begin, 1, sizeof begin, file), sizeof begin);
    fclose(file);
    assert_memory_equal(begin, jfif, sizeof jfif);
    assert_int_equal(begin[20], 0xff);
    assert_int_equal(begin[21], 0xe1);
}
#endif

TEST(exif_and_icc)
{
#ifdef RF_HAVE_PNG
    keeps_exif_and_icc("e.png", 1000);
#endif
#ifdef RF_HAVE_JPEG
    keeps_exif_and_icc("e.jpg", 1000);
    jfif_is_first("e.jpg");
    keeps_exif_and_icc("e.jpg", 65519);
    keeps_exif_and_icc("e.jpeg", 200000);
#endif
}

/* Data that does not fit is left out, and the reason says so. */
static void left_out(const char *name, const struct refocus_write_options *options)
{
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 20, 10, false);
    struct refocus_reason reason;
    struct refocus_photo *photo;

    assert_int_equal(refocus_image_write(in_folder(name), &picture.image, options, &reason),
                     REFOCUS_OK);
    assert_non_null(strstr(reason.text, "left out"));
    photo = read_back(in_folder(name));
    assert_null(photo->exif.data);
    assert_null(photo->icc.data);
    refocus_photo_free(&photo);
    free(picture.memory);
}

TEST(too_large_or_damaged_extras)
{
    struct bytes large = {calloc(1, 70000), 70000};
    const struct refocus_blob blob = {large.data, large.size};

#ifdef RF_HAVE_JPEG
    left_out("l.jpg", &(struct refocus_write_options){
                          .struct_size = sizeof(struct refocus_write_options), .exif = &blob});
#endif
#ifdef RF_HAVE_PNG
    left_out("l.png", &(struct refocus_write_options){
                          .struct_size = sizeof(struct refocus_write_options), .icc = &blob});
#endif
    bytes_free(&large);
}
#endif

#ifdef RF_HAVE_JPEG
TEST(jpeg_formats_and_quality)
{
    long size[2] = {0, 0};

    for (uint32_t format = REFOCUS_FORMAT_RGB8; format <= REFOCUS_FORMAT_BGRA8; format++) {
        uint8_t pixels[32 * 32 * 4];
        const int bytes = format >= REFOCUS_FORMAT_RGBA8 ? 4 : 3;
        const bool swap = format == REFOCUS_FORMAT_BGR8 || format == REFOCUS_FORMAT_BGRA8;
        struct refocus_image image;
        struct refocus_photo *photo;

        for (int i = 0; i < 32 * 32; i++) {
            uint8_t *const p = pixels + i * bytes;
            p[swap ? 2 : 0] = i < 512 ? 200 : 20; /* the upper half is red */
            p[1] = 60;
            p[swap ? 0 : 2] = 90;
        }
        /* Bottom-up: what was above is below. */
        image = refocus_image_packed(format, pixels + 31 * 32 * bytes, 32, 32, -32 * bytes);
        assert_int_equal(refocus_image_write(in_folder("j.jpg"), &image, NULL, NULL), REFOCUS_OK);
        photo = read_back(in_folder("j.jpg"));
        assert_in_range(pixel_at(photo->image, 5, 25)[0], 195, 205);
        assert_in_range(pixel_at(photo->image, 5, 5)[0], 15, 25);
        assert_in_range(pixel_at(photo->image, 5, 5)[2], 85, 95);
        refocus_photo_free(&photo);
    }
    for (int i = 0; i < 2; i++) {
        struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 64, 64, false);
        const struct refocus_write_options options = {
            .struct_size = sizeof(struct refocus_write_options), .quality = i ? 100 : 20};
        struct stat facts;

        assert_int_equal(refocus_image_write(in_folder("q.jpg"), &picture.image, &options, NULL),
                         REFOCUS_OK);
        assert_int_equal(stat(in_folder("q.jpg"), &facts), 0);
        size[i] = (long)facts.st_size;
        free(picture.memory);
    }
    assert_true(size[0] * 2 < size[1]);
}
#endif

static void refused(const char *name, const struct refocus_image *image,
                    const struct refocus_write_options *options, int expected)
{
    struct refocus_reason reason;
    const int before = count_files();
    const int status = refocus_image_write(name, image, options, &reason);

    check_status(status, expected, reason.text, __FILE__, __LINE__);
    assert_int_equal(count_files(), before);
}

TEST(refusals)
{
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 4, 3, false);
    struct refocus_image bad = picture.image;
    const uint16_t samples[6] = {0};

    refused(in_folder("x.gif"), &picture.image, NULL, REFOCUS_ERR_UNSUPPORTED);
    refused(in_folder("x.pgm"), &picture.image, NULL, REFOCUS_ERR_UNSUPPORTED);
    refused(in_folder("png"), &picture.image, NULL, REFOCUS_ERR_UNSUPPORTED);
    refused(in_folder("x.ppm"), &picture.image,
            &(struct refocus_write_options){.struct_size = sizeof(struct refocus_write_options),
                                            .quality = 101},
            REFOCUS_ERR_ARGUMENT);
    refused(in_folder("x.ppm"), NULL, NULL, REFOCUS_ERR_ARGUMENT);
    refused("/does/not/exist/x.ppm", &picture.image, NULL, REFOCUS_ERR_IO);
    refused("/dev/null/x.ppm", &picture.image, NULL, REFOCUS_ERR_IO);
    bad.width = 0;
    refused(in_folder("x.ppm"), &bad, NULL, REFOCUS_ERR_ARGUMENT);
    bad = picture.image;
    bad.stride[0] = 11;
    refused(in_folder("x.ppm"), &bad, NULL, REFOCUS_ERR_ARGUMENT);
    bad = picture.image;
    bad.format = 9;
    refused(in_folder("x.ppm"), &bad, NULL, REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_gray16_write(in_folder("x.ppm"), samples, 3, 2, 6, NULL),
                     REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(refocus_gray16_write(in_folder("x.pgm"), samples, 3, 2, 7, NULL),
                     REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_gray16_write(in_folder("x.pgm"), NULL, 3, 2, 6, NULL),
                     REFOCUS_ERR_ARGUMENT);
#ifndef RF_HAVE_PNG
    refused(in_folder("x.png"), &picture.image, NULL, REFOCUS_ERR_UNSUPPORTED);
#endif
#ifndef RF_HAVE_JPEG
    refused(in_folder("x.jpg"), &picture.image, NULL, REFOCUS_ERR_UNSUPPORTED);
#endif
    free(picture.memory);
}

/* A disk that fills up, played by a limit on the size of files. */
static void full_disk(const char *name)
{
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 200, 100, false);
    struct rlimit before;
    struct refocus_reason reason;
    FILE *file = fopen(in_folder(name), "wb");
    char old[8] = "";
    int files, status;

    fputs("old", file);
    fclose(file);
    files = count_files();
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){1000, before.rlim_max}), 0);
    status = refocus_image_write(in_folder(name), &picture.image, NULL, &reason);
    setrlimit(RLIMIT_FSIZE, &before);
    check_status(status, REFOCUS_ERR_IO, reason.text, __FILE__, __LINE__);
    assert_int_equal(count_files(), files);
    file = fopen(in_folder(name), "rb");
    assert_int_equal(fread(old, 1, 8, file), 3);
    fclose(file);
    assert_string_equal(old, "old");
    free(picture.memory);
}

TEST(full_disk_leaves_the_old_file)
{
    full_disk("f.ppm");
#ifdef RF_HAVE_PNG
    full_disk("f.png");
#endif
#ifdef RF_HAVE_JPEG
    full_disk("f.jpg");
#endif
}

/* How often somebody was asked, and the question that is answered with yes. */
struct asked {
    int count, yes;
};

static int is_cancelled(void *user)
{
    struct asked *const asked = user;

    return ++asked->count == asked->yes;
}

/* A picture of 200 rows that is cancelled: nobody is asked again, the old file stays, and nothing
 * is beside it. */
TEST(a_cancelled_picture_is_left_out)
{
    static const struct {
        const char *name;
        int least; /* `cancelled` is asked at least so often. */
    } formats[] = {{"c.ppm", 200},
#ifdef RF_HAVE_PNG
                   {"c.png", 200},
#endif
#ifdef RF_HAVE_JPEG
                   {"c.jpg", 2},
#endif
                   {"c.pfm", 200}};
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 150, 200, false);
    const int before = count_files();

    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        struct asked asked = {0, 0};
        struct refocus_write_options options = refocus_write_options_default();
        struct refocus_reason reason;
        struct refocus_blob old, now;
        int times;

        options.cancelled = is_cancelled;
        options.user = &asked;
        assert_int_equal(
            refocus_image_write(in_folder(formats[i].name), &picture.image, &options, &reason),
            REFOCUS_OK);
        times = asked.count;
        assert_true(times >= formats[i].least);
        assert_int_equal(refocus_file_read(in_folder(formats[i].name), UINT64_MAX, &old, NULL),
                         REFOCUS_OK);
        for (int yes = 1; yes <= times; yes += yes + 6 < times ? 6 : 1) {
            asked = (struct asked){0, yes};
            assert_int_equal(
                refocus_image_write(in_folder(formats[i].name), &picture.image, &options, &reason),
                REFOCUS_ERR_CANCELLED);
            assert_string_equal(reason.text, "cancelled");
            assert_int_equal(asked.count, yes);
            assert_int_equal(count_files(), before + 1);
        }
        assert_int_equal(refocus_file_read(in_folder(formats[i].name), UINT64_MAX, &now, NULL),
                         REFOCUS_OK);
        assert_int_equal(now.size, old.size);
        assert_memory_equal(now.data, old.data, old.size);
        free(old.data);
        free(now.data);
        remove(in_folder(formats[i].name));
    }
    free(picture.memory);
}

TEST(a_folder_is_in_the_way)
{
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 4, 3, false);

    assert_int_equal(mkdir(in_folder("taken.ppm"), 0700), 0);
    refused(in_folder("taken.ppm"), &picture.image, NULL, REFOCUS_ERR_IO);
    rmdir(in_folder("taken.ppm"));
    free(picture.memory);
}

TEST(umask_is_honoured)
{
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 4, 3, false);
    const mode_t before = umask(027);
    struct stat facts;

    unlink(in_folder("u.ppm"));
    assert_int_equal(refocus_image_write(in_folder("u.ppm"), &picture.image, NULL, NULL),
                     REFOCUS_OK);
    umask(before);
    assert_int_equal(stat(in_folder("u.ppm"), &facts), 0);
    assert_int_equal(facts.st_mode & 0777, 0640);
    free(picture.memory);
}

TEST(a_name_without_folder)
{
    struct picture picture = make_picture(REFOCUS_FORMAT_RGB8, 4, 3, false);
    char before[4096];

    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    assert_int_equal(refocus_image_write("bare.ppm", &picture.image, NULL, NULL), REFOCUS_OK);
    assert_int_equal(access("bare.ppm", R_OK), 0);
    assert_int_equal(chdir(before), 0);
    free(picture.memory);
}

/* Deep pictures come back as they are from the formats that hold them; others refuse them. */
TEST(deep_pictures)
{
    static uint16_t codes[5 * 4 * 3];
    static float light[5 * 4 * 3];
    struct refocus_image deep[2];
    struct refocus_reason reason;

    for (int i = 0; i < 5 * 4 * 3; i++) {
        codes[i] = (uint16_t)(i * 1111);
        light[i] = (float)(i - 7) * 0.77f;
    }
    deep[0] = refocus_image_packed(REFOCUS_FORMAT_RGB16, codes + 45, 5, 4, -30);
    deep[1] = refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, light, 5, 4, 60);
    for (int k = 0; k < 2; k++) {
        const char *const name = k ? "deep.pfm" : "deep.png";
        struct refocus_photo *photo;
        int status = refocus_image_write(in_folder(name), &deep[k], NULL, &reason);

        if (!k && status == REFOCUS_ERR_UNSUPPORTED) /* a build without libpng */
            continue;
        assert_int_equal(status, REFOCUS_OK);
        assert_int_equal(refocus_photo_read(&photo, in_folder(name), NULL, &reason), REFOCUS_OK);
        assert_int_equal(photo->deep->format, deep[k].format);
        for (int y = 0; y < 4; y++)
            assert_memory_equal(photo->deep->plane[0] + y * photo->deep->stride[0],
                                deep[k].plane[0] + y * deep[k].stride[0], k ? 60 : 30);
        refocus_photo_free(&photo);
        for (int other = 0; other < 3; other++) {
            const char *const names[] = {"no.ppm", k ? "no.png" : "no.pfm", "no.jpg"};

            assert_int_equal(refocus_image_write(in_folder(names[other]), &deep[k], NULL, &reason),
                             REFOCUS_ERR_UNSUPPORTED);
            assert_int_not_equal(access(in_folder(names[other]), F_OK), 0);
        }
    }
    deep[0].format = REFOCUS_FORMAT_RGBA16;
    assert_int_equal(refocus_image_write(in_folder("no.png"), &deep[0], NULL, &reason),
                     REFOCUS_ERR_ARGUMENT);
}

int main(void)
{
    return unit_test_run(make_folder, remove_folder);
}
