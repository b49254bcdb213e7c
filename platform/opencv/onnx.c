/* onnx.c: the input size of a network is read from its ONNX file. */
#include "onnx.h"

#include <stdbool.h>
#include <stdint.h>

/* Fields of ONNX's messages, by their numbers in onnx.proto. */
enum {
    MODEL_GRAPH = 7,
    GRAPH_INPUT = 11,
    VALUE_TYPE = 2,
    TYPE_TENSOR = 1,
    TENSOR_SHAPE = 2,
    SHAPE_SIDE = 1,
    SIDE_VALUE = 1,
    SIDES = 4,
    MOST_FIELDS = 1 << 20, /* number of fields of a message that are looked at */
};

/* A message in the file, from where the file stands to `end`. */
struct field {
    uint32_t number, wire;
    uint64_t value; /* value of wire type 0, else the length of the bytes that follow */
};

static bool read_varint(FILE *file, int64_t end, uint64_t *value)
{
    *value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
        const int c = (int64_t)ftello(file) < end ? getc(file) : EOF;

        if (c == EOF)
            return false;
        *value |= (uint64_t)(c & 127) << shift;
        if (!(c & 128))
            return true;
    }
    return false;
}

static bool next(FILE *file, int64_t end, struct field *field)
{
    uint64_t key;

    if ((int64_t)ftello(file) >= end || !read_varint(file, end, &key))
        return false;
    field->number = (uint32_t)(key >> 3);
    field->wire = key & 7;
    switch (field->wire) {
    case 0:
        return read_varint(file, end, &field->value);
    case 1:
        field->value = 8;
        break;
    case 2:
        if (!read_varint(file, end, &field->value))
            return false;
        break;
    case 5:
        field->value = 4;
        break;
    default:
        return false;
    }
    return field->value <= (uint64_t)(end - (int64_t)ftello(file));
}

static bool skip(FILE *file, const struct field *field)
{
    return field->wire == 0 || fseeko(file, (off_t)field->value, SEEK_CUR) == 0;
}

/* Go into the next message `number`; *inner is its end. */
static bool enter(FILE *file, int64_t end, uint32_t number, int64_t *inner)
{
    struct field field;

    for (int n = 0; n < MOST_FIELDS && next(file, end, &field); n++) {
        if (field.number == number && field.wire == 2) {
            *inner = (int64_t)ftello(file) + (int64_t)field.value;
            return true;
        }
        if (!skip(file, &field))
            break;
    }
    return false;
}

/* The value of a side; 0 = open. */
static int read_side(FILE *file, int64_t end)
{
    struct field field;

    while (next(file, end, &field)) {
        if (field.number == SIDE_VALUE && field.wire == 0)
            return field.value <= 65535 ? (int)field.value : 0;
        if (!skip(file, &field))
            break;
    }
    return 0;
}

/* Sides of a value; the number of them. */
static int read_shape(FILE *file, int64_t end, int side[SIDES])
{
    static const uint32_t way[] = {VALUE_TYPE, TYPE_TENSOR, TENSOR_SHAPE};
    int64_t inner;
    int n = 0;

    for (int i = 0; i < 3; i++)
        if (!enter(file, end, way[i], &end))
            return 0;
    while (n <= SIDES && enter(file, end, SHAPE_SIDE, &inner)) {
        const int value = read_side(file, inner);

        if (n < SIDES)
            side[n] = value;
        n++;
        if (fseeko(file, (off_t)inner, SEEK_SET) != 0)
            break;
    }
    return n;
}

int rf_onnx_input_size(FILE *file, int *width, int *height)
{
    int64_t end, input, size;
    int side[SIDES];

    if (fseeko(file, 0, SEEK_END) != 0 || (size = (int64_t)ftello(file)) < 0 ||
        fseeko(file, 0, SEEK_SET) != 0 || !enter(file, size, MODEL_GRAPH, &end))
        return -1;
    while (enter(file, end, GRAPH_INPUT, &input)) {
        if (read_shape(file, input, side) == SIDES && (side[1] == 3 || side[1] == 0)) {
            *height = side[2];
            *width = side[3];
            return 0;
        }
        if (fseeko(file, (off_t)input, SEEK_SET) != 0)
            break;
    }
    return -1;
}
