/* test_opencv.c: depth of pictures by OpenCV and networks that the test makes itself. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "unit_test.h"
#include <refocus/platform/opencv.h>

enum { W = 320, H = 200 };

static struct refocus_image picture(uint8_t *pixels)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
}

/* ONNX by hand: protobuf fields, all shorter than 128 bytes. */
struct message {
    uint8_t bytes[512];
    size_t size;
};

static void put_number(struct message *m, int field, int value)
{
    m->bytes[m->size++] = (uint8_t)(field << 3 | (field > 15 ? 128 : 0));
    if (field > 15)
        m->bytes[m->size++] = (uint8_t)(field >> 4);
    if (value >= 128)
        m->bytes[m->size++] = (uint8_t)(value | 128);
    m->bytes[m->size++] = (uint8_t)(value >= 128 ? value >> 7 : value);
}

static void put_bytes(struct message *m, int field, const void *bytes, size_t size)
{
    m->bytes[m->size++] = (uint8_t)(field << 3 | 2);
    if (size >= 128)
        m->bytes[m->size++] = (uint8_t)(size | 128);
    m->bytes[m->size++] = (uint8_t)(size >= 128 ? size >> 7 : size);
    memcpy(m->bytes + m->size, bytes, size);
    m->size += size;
}

static void put(struct message *m, int field, const struct message *part)
{
    put_bytes(m, field, part->bytes, part->size);
}

static void put_text(struct message *m, int field, const char *text)
{
    put_bytes(m, field, text, strlen(text));
}

static struct message value(const char *name, int channels)
{
    const int sizes[] = {1, channels, 32, 48};
    struct message info = {{0}, 0}, type = info, tensor = info, shape = info;

    for (int i = 0; i < 4; i++) {
        struct message dim = {{0}, 0};

        put_number(&dim, 1, sizes[i]);
        put(&shape, 1, &dim);
    }
    put_number(&tensor, 1, 1);
    put(&tensor, 2, &shape);
    put(&type, 1, &tensor);
    put_text(&info, 1, name);
    put(&info, 2, &type);
    return info;
}

/* y = 2 R + G: a 1 x 1 convolution of a 48 x 32 picture. */
static void write_network(const char *path)
{
    static const float weights[3] = {2, 1, 0};
    struct message model = {{0}, 0}, graph = model, node = model, tensor = model, opset = model;
    struct message attribute = model;
    const struct message in = value("x", 3), out = value("y", 1);
    FILE *file = fopen(path, "wb");

    put_text(&node, 1, "x");
    put_text(&node, 1, "w");
    put_text(&node, 2, "y");
    put_text(&node, 3, "c");
    put_text(&node, 4, "Conv");
    put_text(&attribute, 1, "kernel_shape");
    put_number(&attribute, 8, 1);
    put_number(&attribute, 8, 1);
    put_number(&attribute, 20, 7);
    put(&node, 5, &attribute);
    put_number(&tensor, 1, 1);
    put_number(&tensor, 1, 3);
    put_number(&tensor, 1, 1);
    put_number(&tensor, 1, 1);
    put_number(&tensor, 2, 1);
    put_text(&tensor, 8, "w");
    put_bytes(&tensor, 9, weights, sizeof weights);
    put(&graph, 1, &node);
    put_text(&graph, 2, "g");
    put(&graph, 5, &tensor);
    put(&graph, 11, &in);
    put(&graph, 12, &out);
    put_number(&opset, 2, 11);
    put_number(&model, 1, 6);
    put(&model, 7, &graph);
    put(&model, 8, &opset);
    assert_non_null(file);
    assert_int_equal(fwrite(model.bytes, 1, model.size, file), model.size);
    fclose(file);
}

/* The network that write_network() writes. */
static struct refocus_network network_of(float mean_red, float scale)
{
    struct refocus_network network = refocus_network_default();

    network.width = 48;
    network.height = 32;
    network.mean[0] = mean_red;
    network.scale = scale;
    return network;
}

TEST(estimate)
{
    static const struct {
        const char *name;
        int width, height;
    } known[] = {{"tcmonodepth", 320, 192},
                 {"midas-small", 256, 256},
                 {"depth-anything-small", 518, 518},
                 {"", 0, 0}};
    static uint8_t pixels[3 * W * H];
    const struct refocus_image photo = picture(pixels);
    struct refocus_network network = network_of(10, 0.5f), fitted = refocus_network_default();
    struct refocus_estimate result = refocus_estimate_default();
    struct refocus_cv_reason reason;
    char path[] = "/tmp/refocus-onnx-XXXXXX";
    const int file = mkstemp(path);

    assert_true(file >= 0);
    for (int i = 0; i < W * H; i++) {
        pixels[3 * i] = (uint8_t)(i % W < W / 2 ? 200 : 40);
        pixels[3 * i + 1] = 100;
        pixels[3 * i + 2] = 255;
    }
    write_network(path);
    /* The file says 48 x 32, whatever the preset does. */
    assert_int_equal(refocus_cv_network(0, &fitted), REFOCUS_OK);
    assert_int_equal(refocus_cv_network_fit(&fitted, path, &reason), REFOCUS_OK);
    assert_int_equal(fitted.width, 48);
    assert_int_equal(fitted.height, 32);
    assert_int_equal(refocus_cv_network_fit(&fitted, "/no/such/file", &reason), REFOCUS_ERR_IO);
    for (network.inverse = 0; network.inverse < 2; network.inverse++) {
        const float sign = network.inverse ? -1 : 1;

        assert_int_equal(refocus_cv_estimate(&photo, path, &network, &result, &reason), REFOCUS_OK);
        assert_int_equal(result.width, 48);
        assert_int_equal(result.height, 32);
        for (int y = 0; y < 32; y++) {
            assert_true(fabsf(result.samples[48 * y + 5] - sign * 240) < 0.01f);
            assert_true(fabsf(result.samples[48 * y + 40] - sign * 80) < 0.01f);
        }
        refocus_cv_estimate_free(&result);
    }
    /* Cut off, empty, gone, of another kind. */
    for (int size = 90; size >= 0; size -= 30) {
        assert_int_equal(ftruncate(file, size), 0);
        assert_int_equal(refocus_cv_estimate(&photo, path, &network, &result, &reason),
                         REFOCUS_ERR_FORMAT);
        assert_null(result.samples);
        fitted.width = 77; /* cut off: it stays */
        assert_int_equal(refocus_cv_network_fit(&fitted, path, &reason), REFOCUS_OK);
        assert_int_equal(fitted.width, 77);
    }
    close(file);
    unlink(path);
    assert_int_equal(refocus_cv_estimate(&photo, path, &network, &result, &reason), REFOCUS_ERR_IO);
    network.width = 1;
    assert_int_equal(refocus_cv_estimate(&photo, path, &network, &result, &reason),
                     REFOCUS_ERR_ARGUMENT);
    for (uint32_t i = 0; refocus_cv_network_name(i); i++) {
        assert_int_equal(refocus_cv_network(i, &network), REFOCUS_OK);
        assert_string_equal(refocus_cv_network_name(i), known[i].name);
        assert_true(network.width == known[i].width && network.height == known[i].height);
    }
    assert_int_equal(refocus_cv_network(99, &network), REFOCUS_ERR_ARGUMENT);
}

/* Read once, run often, on pictures of any size. */
TEST(estimator)
{
    static uint8_t pixels[3 * W * H];
    struct refocus_image photo = picture(pixels);
    struct refocus_network network = network_of(0, 1);
    struct refocus_estimator *net = NULL;
    struct refocus_estimate result = refocus_estimate_default();
    struct refocus_cv_reason reason;
    char path[] = "/tmp/refocus-onnx-XXXXXX";
    const int file = mkstemp(path);

    assert_true(file >= 0);
    write_network(path);
    assert_int_equal(refocus_cv_estimator_create(&net, path, &network, &reason), REFOCUS_OK);
    unlink(path);
    for (int n = 1; n < 6; n++) {
        memset(pixels, 10 * n, sizeof pixels);
        photo.width = W / n;
        assert_int_equal(refocus_cv_estimator_run(net, &photo, &result, &reason), REFOCUS_OK);
        assert_int_equal(result.width, 48);
        for (int i = 0; i < 48 * 32; i++)
            assert_true(fabsf(result.samples[i] - (float)(30 * n)) < 0.01f);
        refocus_cv_estimate_free(&result);
    }
    photo.width = 0;
    assert_int_equal(refocus_cv_estimator_run(net, &photo, &result, &reason), REFOCUS_ERR_ARGUMENT);
    assert_null(result.samples);
    assert_int_equal(refocus_cv_estimator_run(NULL, &photo, &result, NULL), REFOCUS_ERR_ARGUMENT);
    refocus_cv_estimator_destroy(&net);
    assert_null(net);
    refocus_cv_estimator_destroy(&net);
    refocus_cv_estimator_destroy(NULL);
    assert_int_equal(refocus_cv_estimator_create(&net, path, &network, &reason), REFOCUS_ERR_IO);
    assert_int_equal(ftruncate(file, 0), 0);
    close(file);
    assert_int_equal(refocus_cv_estimator_create(NULL, path, &network, NULL), REFOCUS_ERR_ARGUMENT);
    assert_null(net);
}

/* Structs as an older program has them, of the first layout, and as a newer one does. */
static const uint32_t no_sizes[] = {0, 4, REFOCUS_MAX_STRUCT_SIZE + 1, UINT32_MAX};
enum { NO_SIZES = sizeof no_sizes / sizeof *no_sizes };

TEST(networks_of_any_size)
{
    struct newer {
        struct refocus_network known;
        uint32_t added, behind;
    } older, newer, untouched;
    struct refocus_estimator *net = NULL;
    char path[] = "/tmp/refocus-onnx-XXXXXX";
    const int file = mkstemp(path);

    assert_true(file >= 0);
    close(file);
    write_network(path);
    memset(&older, 0xa5, sizeof older);
    newer = older;
    older.known.struct_size = REFOCUS_SIZE_TO(struct refocus_network, inverse);
    newer.known.struct_size = offsetof(struct newer, behind);
    for (int i = 0; i < 2; i++) {
        struct newer got = i ? newer : older;

        assert_int_equal(refocus_cv_network(0, &got.known), REFOCUS_OK);
        assert_int_equal(got.known.width, 320);
        assert_int_equal(refocus_cv_network_fit(&got.known, path, NULL), REFOCUS_OK);
        assert_int_equal(got.known.width, 48);
        assert_int_equal(got.known.struct_size, (i ? newer : older).known.struct_size);
        assert_true(got.added == (i ? 0 : older.added) && got.behind == older.behind);
        assert_int_equal(refocus_cv_estimator_create(&net, path, &got.known, NULL), REFOCUS_OK);
        refocus_cv_estimator_destroy(&net);
        if (i == 0)
            continue;
        got.added = 1; /* asks for something that is not here */
        assert_int_equal(refocus_cv_network_fit(&got.known, path, NULL), REFOCUS_ERR_UNSUPPORTED);
        assert_int_equal(refocus_cv_estimator_create(&net, path, &got.known, NULL),
                         REFOCUS_ERR_UNSUPPORTED);
        assert_null(net);
    }
    for (int i = 0; i < NO_SIZES; i++) {
        newer.known.struct_size = no_sizes[i];
        untouched = newer;
        assert_int_equal(refocus_cv_network(0, &newer.known), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_cv_network_fit(&newer.known, path, NULL), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_cv_estimator_create(&net, path, &newer.known, NULL),
                         REFOCUS_ERR_ARGUMENT);
        assert_memory_equal(&newer, &untouched, sizeof newer);
    }
    unlink(path);
}

TEST(estimates_of_any_size)
{
    static uint8_t pixels[3 * W * H];
    struct newer {
        struct refocus_estimate known;
        uint64_t added, behind;
    } older, newer, untouched;
    const struct refocus_image photo = picture(pixels);
    const struct refocus_network network = network_of(0, 1);
    struct refocus_estimator *net = NULL;
    char path[] = "/tmp/refocus-onnx-XXXXXX";
    const int file = mkstemp(path);

    assert_true(file >= 0);
    close(file);
    write_network(path);
    memset(&older, 0xa5, sizeof older);
    newer = older;
    older.known.struct_size = REFOCUS_SIZE_TO(struct refocus_estimate, samples);
    newer.known.struct_size = offsetof(struct newer, behind);
    assert_int_equal(refocus_cv_estimator_create(&net, path, &network, NULL), REFOCUS_OK);
    for (int i = 0; i < 4; i++) {
        struct newer got = i % 2 ? newer : older;

        if (i < 2)
            assert_int_equal(refocus_cv_estimator_run(net, &photo, &got.known, NULL), REFOCUS_OK);
        else
            assert_int_equal(refocus_cv_estimate(&photo, path, &network, &got.known, NULL),
                             REFOCUS_OK);
        assert_true(got.known.width == 48 && got.known.height == 32 && got.known.samples);
        refocus_cv_estimate_free(&got.known);
        assert_null(got.known.samples);
        assert_true(got.known.width == 0 && got.known.reserved == 0);
        assert_int_equal(got.known.struct_size, (i % 2 ? newer : older).known.struct_size);
        assert_true(got.added == (i % 2 ? 0 : older.added) && got.behind == older.behind);
    }
    for (int i = 0; i < NO_SIZES; i++) {
        newer.known.struct_size = no_sizes[i];
        untouched = newer;
        assert_int_equal(refocus_cv_estimator_run(net, &photo, &newer.known, NULL),
                         REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_cv_estimate(&photo, path, &network, &newer.known, NULL),
                         REFOCUS_ERR_ARGUMENT);
        refocus_cv_estimate_free(&newer.known);
        assert_memory_equal(&newer, &untouched, sizeof newer);
    }
    refocus_cv_estimator_destroy(&net);
    unlink(path);
}
