/* buffers.c: memory of Python objects as pictures and maps of the library, without a copy. */
#include "module.h"

void rf_buffers_release(struct rf_buffers *buffers)
{
    while (buffers->count > 0)
        PyBuffer_Release(&buffers->buffer[--buffers->count]);
    buffers->map_count = 0;
}

/* The letter of a native type, or 0: other byte orders are not read. */
static char type_of(const char *format)
{
    if (!format)
        return 'B';
    if (*format == '@' || *format == '=' || *format == (PY_BIG_ENDIAN ? '>' : '<'))
        format++;
    return *format && !format[1] ? *format : 0;
}

static int rows_get(struct rf_buffers *buffers, PyObject *object, int writable, const char *what,
                    struct rf_rows *rows)
{
    Py_buffer *const b = &buffers->buffer[buffers->count];
    Py_ssize_t within;

    if (buffers->count == RF_MOST_BUFFERS) {
        PyErr_Format(PyExc_ValueError, "%s: too many buffers", what);
        return -1;
    }
    if (PyObject_GetBuffer(object, b, writable ? PyBUF_RECORDS : PyBUF_RECORDS_RO) != 0)
        return -1;
    buffers->count++;
    if (b->ndim < 2 || !b->shape || !b->strides || b->shape[0] < 1) {
        PyErr_Format(PyExc_ValueError, "%s: needs rows and columns, not %d dimensions", what,
                     b->ndim);
        return -1;
    }
    within = b->itemsize;
    for (int i = b->ndim - 1; i > 0; i--) {
        if (b->shape[i] != 1 && b->strides[i] != within) {
            PyErr_Format(PyExc_ValueError,
                         "%s: samples within a row must follow each other; "
                         "numpy.ascontiguousarray() makes a copy where they do",
                         what);
            return -1;
        }
        within *= b->shape[i];
    }
    *rows = (struct rf_rows){.first = b->buf,
                             .stride = b->strides[0],
                             .rows = b->shape[0],
                             .columns = b->shape[1],
                             .row_bytes = within,
                             .item = b->itemsize,
                             .type = type_of(b->format)};
    if (!rows->type) {
        PyErr_Format(PyExc_TypeError, "%s: samples of type '%s' cannot be read", what, b->format);
        return -1;
    }
    return 0;
}

int rf_map_rows_get(struct rf_buffers *buffers, PyObject *object, int writable, const char *what,
                    struct rf_rows *rows)
{
    if (rows_get(buffers, object, writable, what, rows) != 0)
        return -1;
    if (rows->row_bytes == rows->columns * rows->item)
        return 0;
    PyErr_Format(PyExc_ValueError,
                 "%s: needs one sample for each pixel, not %zd; take one channel, as by "
                 "numpy.ascontiguousarray(map[:, :, 0])",
                 what, rows->columns ? rows->row_bytes / rows->item / rows->columns : 0);
    return -1;
}

int rf_image_get(struct rf_buffers *buffers, PyObject *tuple, int writable, const char *what,
                 struct refocus_image *image)
{
    unsigned int format, matrix, range, transfer;
    int width, height;
    float gamma, white;
    PyObject *planes;

    if (!PyArg_ParseTuple(tuple, "IiiO!IIIff", &format, &width, &height, &PyTuple_Type, &planes,
                          &matrix, &range, &transfer, &gamma, &white))
        return -1;
    *image = refocus_image_packed(format, NULL, width, height, 0);
    image->matrix = matrix;
    image->range = range;
    image->transfer = transfer;
    image->gamma = gamma;
    image->white = white;
    if (PyTuple_Size(planes) != refocus_format_planes(format)) {
        PyErr_Format(PyExc_ValueError, "%s: %d planes are needed, not %zd", what,
                     refocus_format_planes(format), PyTuple_Size(planes));
        return -1;
    }
    for (int i = 0; i < refocus_format_planes(format); i++) {
        const Py_ssize_t row_bytes = refocus_plane_row_bytes(format, i, width);
        const Py_ssize_t count = refocus_plane_rows(format, i, height);
        struct rf_rows rows;

        if (rows_get(buffers, PyTuple_GetItem(planes, i), writable, what, &rows) != 0)
            return -1;
        if (rows.row_bytes != row_bytes || rows.rows != count) {
            PyErr_Format(PyExc_ValueError,
                         "%s: plane %d has %zd rows of %zd bytes, not %zd rows of %zd", what, i,
                         rows.rows, rows.row_bytes, count, row_bytes);
            return -1;
        }
        image->plane[i] = (uint8_t *)rows.first;
        image->stride[i] = rows.stride;
    }
    return 0;
}

int rf_image_get_if_any(struct rf_buffers *buffers, PyObject *tuple, const char *what,
                        struct refocus_image *memory, const struct refocus_image **image)
{
    *image = tuple == Py_None ? NULL : memory;
    return *image ? rf_image_get(buffers, tuple, 0, what, memory) : 0;
}

/* Whether a side is one of a picture; the library itself would see it cut to 32 bits. */
static int check_sides(const struct rf_rows *rows, const char *what)
{
    if (rows->rows <= REFOCUS_MAX_SIDE && rows->row_bytes / rows->item <= REFOCUS_MAX_SIDE)
        return 0;
    PyErr_Format(PyExc_ValueError, "%s: no side may be larger than %d", what, REFOCUS_MAX_SIDE);
    return -1;
}

int rf_disparity_get(struct rf_buffers *buffers, PyObject *object, const char *what,
                     struct refocus_disparity *map)
{
    struct rf_rows rows;

    if (rf_map_rows_get(buffers, object, 0, what, &rows) != 0 || check_sides(&rows, what) != 0)
        return -1;
    if (rows.type != 'B' && rows.type != 'H') {
        PyErr_Format(PyExc_TypeError,
                     "%s: disparities are uint8 or uint16; depth_to_disparity() makes them", what);
        return -1;
    }
    *map = refocus_disparity16(NULL, (int32_t)(rows.row_bytes / rows.item), (int32_t)rows.rows,
                               rows.stride);
    map->bits = rows.type == 'B' ? 8 : 16;
    map->samples = rows.first;
    return 0;
}

/* Samples of a type, of a size that is known. */
static int sized_get(struct rf_buffers *buffers, PyObject *object, int writable, const char *what,
                     char type, int32_t width, int32_t height, struct rf_rows *rows)
{
    if (rf_map_rows_get(buffers, object, writable, what, rows) != 0)
        return -1;
    if (rows->type != type) {
        PyErr_Format(PyExc_TypeError, "%s: has to be %s", what, type == 'H' ? "uint16" : "uint8");
        return -1;
    }
    if (rows->rows != height || rows->row_bytes / rows->item != width) {
        PyErr_Format(PyExc_ValueError, "%s: has %zd rows of %zd samples, not %d of %d", what,
                     rows->rows, rows->row_bytes / rows->item, (int)height, (int)width);
        return -1;
    }
    return 0;
}

int rf_map16_get(struct rf_buffers *buffers, PyObject *object, const char *what, int32_t width,
                 int32_t height, uint16_t **samples, ptrdiff_t *stride)
{
    struct rf_rows rows;

    if (sized_get(buffers, object, 1, what, 'H', width, height, &rows) != 0)
        return -1;
    *samples = (uint16_t *)(void *)rows.first;
    *stride = rows.stride;
    return 0;
}

int rf_bytes_get(struct rf_buffers *buffers, PyObject *object, int writable, const char *what,
                 int32_t width, int32_t height, uint8_t **samples, ptrdiff_t *stride)
{
    struct rf_rows rows;

    if (object == Py_None)
        return 0;
    if (sized_get(buffers, object, writable, what, 'B', width, height, &rows) != 0)
        return -1;
    *samples = (uint8_t *)rows.first;
    *stride = rows.stride;
    return 0;
}
