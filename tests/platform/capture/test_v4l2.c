/* test_v4l2.c: a V4L2 device that fails at each call in turn, once or from there on. Every answer
 * is an error that the headers name, and words say why; nothing stays open, mapped or allocated,
 * and the same source, and another one, works when the device does. */
#include "check.h"
#include "clock.h"
#include "fake_v4l2.h"

#include <errno.h>
#include <linux/videodev2.h>
#include <stdbool.h>
#include <refocus/platform/sink.h>

static struct refocus_reason reason;
static bool gone; /* the device fails for ever, and did */

/* Bits of the errors that may be the answer, beside those that the system gives. */
static unsigned bit(int status)
{
    return 1u << -status;
}

/* Whether it went well; when not, it is one of the errors that the function may give. */
static bool is_well(int status, unsigned others)
{
    const unsigned errors = bit(REFOCUS_ERR_GONE) | bit(REFOCUS_ERR_BUSY) |
                            bit(REFOCUS_ERR_PERMISSION) | bit(REFOCUS_ERR_IO) |
                            bit(REFOCUS_ERR_MEMORY) | others;

    if (status == REFOCUS_OK)
        return true;
    if (!fake.fail_at || fake.calls < fake.fail_at || fake.failure == EINTR)
        fail_msg("%d (%s) without a fault", status, reason.text);
    if (!(bit(status) & errors))
        fail_msg("%d (%s) when call %ld fails", status, reason.text, fake.fail_at);
    if (status != REFOCUS_ERR_ARGUMENT)
        assert_string_not_equal(reason.text, "");
    gone = fake.forever;
    return false;
}

/* The call again, with a device that has recovered. */
#define WORKS(others, call)                                                                        \
    do {                                                                                           \
        if (!is_well(call, others)) {                                                              \
            if (gone)                                                                              \
                return;                                                                            \
            assert_status(call, REFOCUS_OK);                                                       \
        }                                                                                          \
    } while (0)

static void look_at(const struct refocus_frame *frame)
{
    unsigned sum = 0;

    for (int i = 0; i < 3 && frame->plane[i]; i++)
        for (int x = 0; x < FAKE_WIDTH; x++)
            sum +=
                frame->plane[i][x] + frame->plane[i][(FAKE_HEIGHT / 2 - 1) * frame->stride[i] + x];
    assert_int_equal(sum, 0);
    assert_int_equal(frame->width, FAKE_WIDTH);
    assert_int_equal(frame->height, FAKE_HEIGHT);
    assert_false(frame->flags & REFOCUS_FRAME_CORRUPT);
}

static void stream(struct refocus_source *source, int frames)
{
    const struct refocus_frame *frame;

    for (int i = 0; i < frames; i++) {
        int status = refocus_source_wait(source, 1000, &frame, &reason);

        if (!is_well(status, bit(REFOCUS_ERR_TIMEOUT))) {
            if (gone)
                return;
            if (status != REFOCUS_ERR_TIMEOUT)
                assert_status(refocus_source_restart(source, NULL, &reason), REFOCUS_OK);
            assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
        }
        look_at(frame);
        if (i > 0) /* the first one is out until the end */
            refocus_source_release(source, frame);
    }
}

static void capture(struct refocus_source *source, bool exports)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_source_lens lens = refocus_source_lens_default();
    const unsigned lacks = bit(REFOCUS_ERR_UNSUPPORTED) | bit(REFOCUS_ERR_ARGUMENT);
    const struct refocus_frame *frame;
    int status;

    config.fps = 25;
    config.flags = exports ? REFOCUS_SOURCE_DMABUF : 0;
    WORKS(lacks, refocus_source_get_mode(source, 0, &mode));
    WORKS(0, refocus_source_get_lens(source, &lens, &reason));
    WORKS(lacks, refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_CONTINUOUS, 0, &reason));
    WORKS(lacks, refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_FIXED, 50, &reason));
    WORKS(lacks, refocus_source_lock_exposure(source, 1, &reason));
    WORKS(lacks, refocus_source_lock_exposure(source, 0, &reason));
    WORKS(lacks, refocus_source_set_control(source, "focus_absolute", 7, &reason));
    for (int round = 0; round < 2; round++) {
        refocus_source_stop(source);
        WORKS(bit(REFOCUS_ERR_UNSUPPORTED), refocus_source_start(source, &config, &mode, &reason));
        stream(source, 4);
        if (gone)
            return;
    }
    fake.changes = true;
    status = refocus_source_wait(source, 1000, &frame, &reason);
    if (fake.changes || status != REFOCUS_ERR_IO) /* the fault is here */
        is_well(status, bit(REFOCUS_ERR_TIMEOUT));
    fake.changes = false;
    if (gone)
        return;
    WORKS(bit(REFOCUS_ERR_UNSUPPORTED), refocus_source_restart(source, &mode, &reason));
    stream(source, 2);
}

static void show(struct refocus_sink *sink)
{
    static uint8_t pixels[FAKE_WIDTH * FAKE_HEIGHT * 3];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, FAKE_WIDTH,
                                                            FAKE_HEIGHT, (ptrdiff_t)FAKE_WIDTH * 3);

    for (int round = 0; round < 2; round++) {
        WORKS(bit(REFOCUS_ERR_UNSUPPORTED),
              refocus_sink_start(sink, FAKE_WIDTH, FAKE_HEIGHT, 25, &reason));
        for (int i = 0; i < 7; i++)
            WORKS(bit(REFOCUS_ERR_TIMEOUT), refocus_sink_write(sink, &image, &reason));
    }
}

/* The life of a source or a sink, from its opening to its end. */
static void live(bool exports)
{
    struct refocus_source *source = NULL;
    struct refocus_sink *sink = NULL;
    const unsigned lacks = bit(REFOCUS_ERR_UNSUPPORTED);

    fake.calls = fake.frames = 0;
    gone = false;
    if (fake.output) {
        if (is_well(refocus_sink_open(&sink, "v4l2:7", &reason), lacks))
            show(sink);
        refocus_sink_close(&sink, &reason);
    } else {
        if (is_well(refocus_source_open(&source, "v4l2:7", &reason), lacks))
            capture(source, exports);
        refocus_source_close(&source);
    }
    assert_int_equal(fake.fd, -1);
    assert_int_equal(fake.mapped, 0);
}

/* Faults of every kind at every call of a device of this kind. */
static void fail_everywhere(bool exports)
{
    static const int failures[] = {EIO, ENODEV, EBUSY, ENOMEM, EINVAL, EACCES, ENOTTY, EINTR};
    const int files = count_entries("fd");
    long all, good;

    fake.fail_at = 0;
    live(exports);
    all = fake.calls;
    good = fake.frames;
    assert_true(all > 50 && good >= 6);
    for (size_t i = 0; i < sizeof failures / sizeof *failures; i++)
        for (int forever = 0; forever < (failures[i] == EINTR ? 1 : 2); forever++)
            for (long at = 1; at <= all; at++) {
                fake.failure = failures[i];
                fake.forever = forever;
                fake.fail_at = at;
                live(exports);
                fake.fail_at = 0;
                fake.failure = 0;
                assert_int_equal(count_entries("fd"), files);
            }
    live(exports);
    assert_true(fake.calls == all && fake.frames == good);
}

TEST(cameras)
{
    fake.output = false;
    for (int kind = 0; kind < 4; kind++) {
        fake.multi = kind & 1;
        fail_everywhere(kind & 2);
    }
}

TEST(virtual_cameras)
{
    fake.output = true;
    for (int multi = 0; multi < 2; multi++) {
        fake.multi = multi;
        fail_everywhere(false);
    }
}

/* Frames that are refused cost no buffers, however many they are: each that was mapped is still
 * queued or shown after them. */
TEST(refused_frames)
{
    static uint8_t pixels[FAKE_WIDTH * FAKE_HEIGHT * 3];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, FAKE_WIDTH,
                                                            FAKE_HEIGHT, (ptrdiff_t)FAKE_WIDTH * 3);
    static const unsigned long requests[] = {VIDIOC_QBUF, VIDIOC_STREAMON};
    enum { REFUSALS = 9 };

    fake.output = true;
    for (int kind = 0; kind < 4; kind++)
        for (int shown = 0; shown <= 6; shown += 3) { /* buffers that were never queued, or were */
            struct refocus_sink *sink = NULL;

            fake.multi = kind & 1;
            assert_status(refocus_sink_open(&sink, "v4l2:7", &reason), REFOCUS_OK);
            assert_status(refocus_sink_start(sink, FAKE_WIDTH, FAKE_HEIGHT, 25, &reason),
                          REFOCUS_OK);
            for (int i = 0; i < shown; i++) {
                const int64_t now = rf_now_ns() / 1000;

                assert_status(refocus_sink_write(sink, &image, &reason), REFOCUS_OK);
                assert_in_range(fake.queued_at_us, now, now + 60 * 1000000);
            }
            fake.refused = requests[kind >> 1];
            fake.refusals = fake.streaming && kind >> 1 ? 0 : REFUSALS;
            for (int i = fake.refusals; i > 0; i--) {
                assert_status(refocus_sink_write(sink, &image, &reason), REFOCUS_ERR_IO);
                assert_string_not_equal(reason.text, "");
            }
            assert_int_equal(fake.refusals, 0);
            for (int i = 0; i < 2 * fake.buffers; i++)
                assert_status(refocus_sink_write(sink, &image, &reason), REFOCUS_OK);
            assert_int_equal(fake.queued | fake.done, (1u << fake.buffers) - 1);
            assert_status(refocus_sink_close(&sink, &reason), REFOCUS_OK);
        }
}

/* A buffer that the driver takes back at neither of two attempts is offered again later. */
TEST(refused_buffers)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source_mode mode = refocus_source_mode_default();

    fake.output = false;
    for (int multi = 0; multi < 2; multi++)
        for (int refusals = 1; refusals <= 6; refusals++) {
            struct refocus_source *source = NULL;
            const struct refocus_frame *frame;
            struct refocus_source_counters counters = refocus_source_counters_default();

            fake.multi = multi;
            assert_status(refocus_source_open(&source, "v4l2:7", &reason), REFOCUS_OK);
            assert_status(refocus_source_start(source, &config, &mode, &reason), REFOCUS_OK);
            assert_true(fake.buffers > 3);
            fake.refused = VIDIOC_QBUF;
            for (int i = 0; i < 3; i++) {
                assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
                fake.refusals = i == 0 ? refusals : fake.refusals;
                refocus_source_release(source, frame);
            }
            assert_int_equal(fake.refusals, 0);
            assert_int_equal(fake.queued | fake.done, (1u << fake.buffers) - 1);
            refocus_source_get_counters(source, &counters);
            assert_int_equal(counters.queued, counters.dequeued);
            assert_int_equal(counters.dequeued, 3);
            refocus_source_close(&source);
            assert_int_equal(fake.mapped, 0);
        }
}

static struct refocus_source *start(struct refocus_source_config config,
                                    struct refocus_source_mode *mode)
{
    struct refocus_source *source = NULL;

    assert_status(refocus_source_open(&source, "v4l2:7", &reason), REFOCUS_OK);
    assert_status(refocus_source_start(source, &config, mode, &reason), REFOCUS_OK);
    return source;
}

/* A driver tells its colours and the rate, and gives buffers that are too small. */
TEST(formats)
{
    static const struct {
        uint32_t space, encoding, range, matrix, full;
    } cases[] = {
        {V4L2_COLORSPACE_SMPTE170M, 0, 0, REFOCUS_MATRIX_BT601, false},
        {V4L2_COLORSPACE_REC709, 0, 0, REFOCUS_MATRIX_BT709, false},
        {V4L2_COLORSPACE_JPEG, 0, 0, REFOCUS_MATRIX_BT601, true},
        {V4L2_COLORSPACE_REC709, V4L2_YCBCR_ENC_601, 0, REFOCUS_MATRIX_BT601, false},
        {V4L2_COLORSPACE_SRGB, V4L2_YCBCR_ENC_709, V4L2_QUANTIZATION_FULL_RANGE,
         REFOCUS_MATRIX_BT709, true},
        {V4L2_COLORSPACE_SMPTE170M, V4L2_YCBCR_ENC_XV709, V4L2_QUANTIZATION_LIM_RANGE,
         REFOCUS_MATRIX_BT709, false},
    };
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source_mode mode = refocus_source_mode_default();

    fake.output = false;
    for (size_t i = 0; i < 2 * sizeof cases / sizeof *cases; i++) {
        struct refocus_source *source;
        const struct refocus_frame *frame;

        fake.multi = i % 2;
        fake.space = cases[i / 2].space;
        fake.encoding = cases[i / 2].encoding;
        fake.range = cases[i / 2].range;
        config.fps = 14.985;
        source = start(config, &mode);
        assert_true(fake.rate[0] == 1000 && fake.rate[1] == 14985 && mode.fps == 14.985);
        assert_int_equal(mode.format, fake.multi ? REFOCUS_FRAME_NV12 : REFOCUS_FRAME_YUYV);
        assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
        assert_int_equal(frame->matrix, cases[i / 2].matrix);
        assert_int_equal(!!(frame->flags & REFOCUS_FRAME_FULL_RANGE), cases[i / 2].full);
        refocus_source_stop(source);
        fake.length = 255; /* 256, 512 or 1024 are needed. */
        assert_status(refocus_source_start(source, &config, &mode, &reason), REFOCUS_ERR_IO);
        assert_string_equal(reason.text, "/dev/video7: the driver's strides or buffers are less "
                                         "than a picture");
        fake.length = 0;
        refocus_source_close(&source);
    }
    fake.space = fake.encoding = fake.range = 0;
}

/* A driver says of a frame when it was, where it begins in its buffer, by a clock that does not
 * count, and that it is damaged or holds less or more than it can. */
TEST(frames)
{
    enum { LENGTH = 2 * FAKE_WIDTH * FAKE_HEIGHT, MONOTONIC = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC };
    static const struct {
        bool multi;
        uint32_t bytes, offset, flags, is;
    } cases[] = {
        {false, 0, 0, MONOTONIC, REFOCUS_FRAME_MONOTONIC},
        {false, 0, 0, V4L2_BUF_FLAG_TIMESTAMP_COPY, 0},
        {false, 0, 0, MONOTONIC | V4L2_BUF_FLAG_ERROR,
         REFOCUS_FRAME_MONOTONIC | REFOCUS_FRAME_CORRUPT},
        {false, LENGTH - 1, 0, MONOTONIC, REFOCUS_FRAME_MONOTONIC | REFOCUS_FRAME_CORRUPT},
        {false, LENGTH + 1, 0, MONOTONIC, REFOCUS_FRAME_MONOTONIC | REFOCUS_FRAME_CORRUPT},
        {true, LENGTH / 2 + 64, 64, MONOTONIC, REFOCUS_FRAME_MONOTONIC},
        {true, LENGTH / 2 + 63, 64, MONOTONIC, REFOCUS_FRAME_MONOTONIC | REFOCUS_FRAME_CORRUPT},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct refocus_source_mode mode = refocus_source_mode_default();
        const struct refocus_frame *frame;
        struct refocus_source *source;
        bool corrupt = cases[i].is & REFOCUS_FRAME_CORRUPT;

        fake.multi = cases[i].multi;
        fake.filled.bytes = cases[i].bytes;
        fake.filled.offset = cases[i].offset;
        fake.filled.flags = cases[i].flags;
        fake.filled.us = 12345678;
        fake.sequence = 77;
        source = start(refocus_source_config_default(), &mode);
        assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
        assert_int_equal(frame->flags, cases[i].is);
        assert_true(frame->timestamp_ns == INT64_C(12345678000) && frame->sequence == 77);
        assert_true(!fake.multi || frame->stride[1] == 2 * frame->stride[0]);
        for (int k = 0; k < (fake.multi ? 2 : 1); k++) /* Memories begin at a page. */
            assert_int_equal((uintptr_t)frame->plane[k] % 4096, corrupt ? 0 : cases[i].offset);
        refocus_source_close(&source);
    }
    memset(&fake.filled, 0, sizeof fake.filled);
}

/* A stream that starts anew knows nothing of buffers that the driver did not take back before. */
TEST(starts_anew)
{
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_source *source = start(refocus_source_config_default(), &mode);
    const struct refocus_frame *frame, *kept;
    int status;

    fake.refused = VIDIOC_QBUF;
    fake.refusals = 1000;
    while ((status = refocus_source_wait(source, 1000, &frame, &reason)) == REFOCUS_OK)
        refocus_source_release(source, frame);
    assert_int_equal(status, REFOCUS_ERR_IO);
    fake.refusals = 0;
    assert_status(refocus_source_restart(source, &mode, &reason), REFOCUS_OK);
    assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
    assert_status(refocus_source_wait(source, 1000, &kept, &reason), REFOCUS_OK);
    refocus_source_release(source, frame);
    assert_int_equal((fake.queued | fake.done) >> kept->buffer & 1, 0);
    refocus_source_close(&source);
}
