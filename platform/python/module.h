/* module.h: what the files of the Python module share. */
#ifndef RF_PYTHON_MODULE_H
#define RF_PYTHON_MODULE_H

/* Buffers are part of the stable interface from Python 3.11 on. */
#ifndef Py_LIMITED_API
#define Py_LIMITED_API 0x030b0000
#endif
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <refocus/refocus.h>

/* Memory of Python objects that a call, or a renderer, works on: none of it is copied. */
enum { RF_MOST_BUFFERS = 12, RF_MOST_MAPS = 4 };
struct rf_buffers {
    int count, map_count;
    Py_buffer buffer[RF_MOST_BUFFERS];
    struct refocus_disparity map[RF_MOST_MAPS]; /* maps that a struct of parameters points at */
};

/* Rows of a buffer: samples of one row follow each other, the rows are stride bytes apart. */
struct rf_rows {
    char *first;
    Py_ssize_t stride, rows, columns, row_bytes, item;
    char type; /* as in the struct module: B, H, e, f, d */
};

void rf_buffers_release(struct rf_buffers *buffers);

/* All return 0, or -1 with a Python exception. WHAT names the argument in it. */
/* A map has one sample for each column. */
int rf_map_rows_get(struct rf_buffers *buffers, PyObject *object, int writable, const char *what,
                    struct rf_rows *rows);
int rf_image_get(struct rf_buffers *buffers, PyObject *tuple, int writable, const char *what,
                 struct refocus_image *image);
/* A picture to read, held in MEMORY; NULL for None. */
int rf_image_get_if_any(struct rf_buffers *buffers, PyObject *tuple, const char *what,
                        struct refocus_image *memory, const struct refocus_image **image);
int rf_disparity_get(struct rf_buffers *buffers, PyObject *object, const char *what,
                     struct refocus_disparity *map);
/* A map of 16 bits to be written, of WIDTH x HEIGHT. */
int rf_map16_get(struct rf_buffers *buffers, PyObject *object, const char *what, int32_t width,
                 int32_t height, uint16_t **samples, ptrdiff_t *stride);
/* A byte for each sample of a map; None leaves NULL. */
int rf_bytes_get(struct rf_buffers *buffers, PyObject *object, int writable, const char *what,
                 int32_t width, int32_t height, uint8_t **samples, ptrdiff_t *stride);

/* No struct of parameters is larger. */
enum { RF_MOST_STRUCT = 16384 };

/* STRUCT gets its defaults, then what the dictionary has. */
int rf_struct_get(struct rf_buffers *buffers, PyObject *dictionary, const char *name, void *into);
/* The other way round: a new dictionary, or NULL. */
PyObject *rf_struct_make(const char *name, const void *from);

/* Raises the exception of a status: WORDS, or those of refocus_strerror(). Returns NULL. */
PyObject *rf_raise(PyObject *module, int status, const char *words);

/* Functions of the module, each in the file of that name. */
extern PyMethodDef rf_renderer_methods[], rf_depth_methods[], rf_optics_methods[],
    rf_files_methods[];
#endif
