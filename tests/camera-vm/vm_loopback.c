/* vm_loopback.c: sources on v4l2loopback at /dev/videoNODE, for the formats that vivid lacks.
 *
 * usage: vm-loopback test NODE JPEG
 *        vm-loopback feed FPS NODE FORMAT WIDTHxHEIGHT FILE [NODE FORMAT WIDTHxHEIGHT
 * FILE]
 *        vm-loopback same Y4M YUYV WIDTH HEIGHT
 * The formats are MJPEG and Z16; frames come out as they
 * were fed in. "feed" writes files again and again, until it is ended. "same" compares
 * the first picture of 4:2:0 in one file with the one of YUYV in another. */
#define _GNU_SOURCE /* memmem */
#include <stdint.h>
#include "unit_test.h"
#include <fcntl.h>
#include <linux/videodev2.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/file.h>
#include <refocus/platform/source.h>
#include "../clock.h"

enum { WIDTH = 160, HEIGHT = 120, MOST_BYTES = 1 << 22 };
static const char *node, *jpeg;
static uint8_t bytes[MOST_BYTES];

/* The other end of the node: what it is set to, and who writes. */
struct feeder {
    int fd, period_ms;
    size_t size;
    atomic_bool quit;
    pthread_t thread;
};

static int open_output(uint32_t fourcc, int width, int height, size_t size)
{
    struct v4l2_format format;
    char path[64];
    int fd;

    snprintf(path, sizeof path, "/dev/video%.40s", node);
    fd = open(path, O_RDWR);
    memset(&format, 0, sizeof format);
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.pixelformat = fourcc;
    format.fmt.pix.width = (uint32_t)width;
    format.fmt.pix.height = (uint32_t)height;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.sizeimage = (uint32_t)size;
    if (fd < 0 || ioctl(fd, VIDIOC_S_FMT, &format) != 0 || format.fmt.pix.pixelformat != fourcc ||
        format.fmt.pix.width != (uint32_t)width) {
        perror(path);
        exit(1);
    }
    return fd;
}

static void *feed(void *argument)
{
    struct feeder *feeder = argument;

    while (!atomic_load(&feeder->quit)) {
        if (write(feeder->fd, bytes, feeder->size) < 0)
            perror("write");
        sleep_ms(feeder->period_ms);
    }
    return NULL;
}

static void begin_feed(struct feeder *feeder, uint32_t fourcc, int width, int height)
{
    atomic_init(&feeder->quit, false);
    feeder->period_ms = 40;
    feeder->fd = open_output(fourcc, width, height, feeder->size);
    assert_true(write(feeder->fd, bytes, feeder->size) > 0); /* the node is a camera now */
    assert_int_equal(pthread_create(&feeder->thread, NULL, feed, feeder), 0);
}

static void end_feed(struct feeder *feeder)
{
    atomic_store(&feeder->quit, true);
    pthread_join(feeder->thread, NULL);
    close(feeder->fd);
}

static struct refocus_source *started(uint32_t format, uint32_t flags)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source *source = NULL;
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_reason reason = {""};
    char name[64];

    snprintf(name, sizeof name, "v4l2:%.40s", node);
    config.format = format;
    config.flags = flags;
    if (refocus_source_open(&source, name, &reason) != REFOCUS_OK ||
        refocus_source_start(source, &config, &mode, &reason) != REFOCUS_OK)
        fail_msg("%s", reason.text);
    assert_int_equal(mode.format, format);
    return source;
}

static const struct refocus_frame *next(struct refocus_source *source)
{
    const struct refocus_frame *frame = NULL;
    struct refocus_reason reason;

    if (refocus_source_wait(source, 5000, &frame, &reason) != REFOCUS_OK)
        fail_msg("%s", reason.text);
    return frame;
}

TEST(depth_comes_to_the_last_bit)
{
    struct feeder feeder = {.size = WIDTH * HEIGHT * 2};
    static uint16_t samples[WIDTH * HEIGHT];
    struct refocus_converter *converter = NULL;
    struct refocus_source *source;

    for (size_t i = 0; i < feeder.size; i++) /* every byte's value, high and low */
        bytes[i] = (uint8_t)(i * 31 + i / 256);
    begin_feed(&feeder, V4L2_PIX_FMT_Z16, WIDTH, HEIGHT);
    source = started(REFOCUS_FRAME_Z16, 0);
    assert_int_equal(refocus_converter_create(&converter), REFOCUS_OK);
    for (int n = 0; n < 5; n++) {
        const struct refocus_frame *frame = next(source);

        assert_int_equal(frame->format, REFOCUS_FRAME_Z16);
        assert_int_equal(frame->width, WIDTH);
        assert_int_equal(frame->height, HEIGHT);
        assert_int_equal(refocus_convert_samples(converter, frame, samples, NULL), REFOCUS_OK);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            assert_int_equal(samples[i], bytes[2 * i] | bytes[2 * i + 1] << 8);
        refocus_source_release(source, frame);
    }
    refocus_converter_destroy(&converter);
    refocus_source_close(&source);
    end_feed(&feeder);
    printf("captured: Z16\n");
}

static size_t read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    size_t size;

    assert_non_null(file);
    size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    return size;
}

TEST(jpegs_become_pictures)
{
    struct feeder feeder = {.size = read_file(jpeg)};
    struct refocus_converter *converter = NULL;
    struct refocus_photo *photo = NULL;
    struct refocus_source *source;
    struct refocus_image out;
    size_t row;

    assert_int_equal(refocus_photo_read(&photo, jpeg, NULL, NULL), REFOCUS_OK);
    row = (size_t)photo->image->width * 3;
    out = refocus_image_packed(REFOCUS_FORMAT_RGB8, malloc(row * (size_t)photo->image->height),
                               photo->image->width, photo->image->height, (ptrdiff_t)row);
    assert_non_null(out.plane[0]);
    begin_feed(&feeder, V4L2_PIX_FMT_MJPEG, photo->image->width, photo->image->height);
    source = started(REFOCUS_FRAME_MJPEG, 0);
    assert_int_equal(refocus_converter_create(&converter), REFOCUS_OK);
    for (int n = 0; n < 5; n++) {
        const struct refocus_frame *frame = next(source);

        assert_true(frame->bytes >= feeder.size); /* this driver says how large its buffer is */
        assert_int_equal(refocus_convert_rgb8(converter, frame, &out, NULL), REFOCUS_OK);
        for (int y = 0; y < out.height; y++)
            assert_memory_equal(out.plane[0] + y * out.stride[0],
                                photo->image->plane[0] + y * photo->image->stride[0], row);
        refocus_source_release(source, frame);
    }
    printf("captured: MJPEG\n");
    /* The second half of the picture is missing: no picture comes out, and the stream goes on. */
    memset(bytes + feeder.size / 2, 0, feeder.size - feeder.size / 2);
    for (int n = 0, damaged = 0; damaged < 2; n++) {
        const struct refocus_frame *frame = next(source);

        damaged += refocus_convert_rgb8(converter, frame, &out, NULL) == REFOCUS_ERR_FORMAT;
        refocus_source_release(source, frame);
        assert_true(n < 20);
    }
    refocus_converter_destroy(&converter);
    refocus_source_close(&source);
    end_feed(&feeder);
    free(out.plane[0]);
    refocus_photo_free(&photo);
}

/* A camera of two sensors: both nodes at the same moments. */
static int feed_for_ever(int fps, char **argv, int nodes)
{
    struct {
        int fd;
        size_t size;
        uint8_t *data;
    } feeds[2];

    for (int i = 0; i < nodes; i++, argv += 4) {
        int width, height;

        if (sscanf(argv[2], "%dx%d", &width, &height) != 2)
            return 2;
        node = argv[0];
        feeds[i].size = read_file(argv[3]);
        feeds[i].data = malloc(feeds[i].size);
        if (!feeds[i].data)
            return 1;
        memcpy(feeds[i].data, bytes, feeds[i].size);
        feeds[i].fd =
            open_output(strcmp(argv[1], "MJPEG") == 0 ? V4L2_PIX_FMT_MJPEG : V4L2_PIX_FMT_Z16,
                        width, height, feeds[i].size);
    }
    for (;;) {
        for (int i = 0; i < nodes; i++)
            if (write(feeds[i].fd, feeds[i].data, feeds[i].size) < 0)
                return 1;
        sleep_ms(1000 / fps);
    }
}

/* A row of chroma is that of two rows. */
static int compare(const char *y4m, const char *yuyv, int width, int height)
{
    const size_t size = (size_t)width * (size_t)height;
    uint8_t *expected = malloc(2 * size);
    const uint8_t *luma;

    if (!expected || read_file(y4m) < size * 3 / 2)
        return 2;
    luma = memmem(bytes, 200, "FRAME\n", 6);
    if (!luma)
        return 2;
    luma += 6;
    for (size_t i = 0; i < size / 2; i++) { /* two pixels */
        const size_t across = (size_t)width / 2;
        const uint8_t *u = luma + size + i / across / 2 * across + i % across;
        const uint8_t pixels[4] = {luma[2 * i], u[0], luma[2 * i + 1], u[size / 4]};

        memcpy(expected + 4 * i, pixels, sizeof pixels);
    }
    if (read_file(yuyv) < 2 * size)
        return 2;
    for (size_t i = 0; i < 2 * size; i++)
        if (bytes[i] != expected[i]) {
            printf("byte %zu is %d, should be %d\n", i, bytes[i], expected[i]);
            return 1;
        }
    free(expected);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc >= 7 && (argc - 3) % 4 == 0 && argc <= 11 && strcmp(argv[1], "feed") == 0)
        return atoi(argv[2]) > 0 ? feed_for_ever(atoi(argv[2]), argv + 3, (argc - 3) / 4) : 2;
    if (argc == 6 && strcmp(argv[1], "same") == 0)
        return compare(argv[2], argv[3], atoi(argv[4]), atoi(argv[5]));
    if (argc != 4 || strcmp(argv[1], "test") != 0)
        return 2;
    node = argv[2];
    jpeg = argv[3];
    return unit_test_run(NULL, NULL);
}
