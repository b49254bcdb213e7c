/* files.c: photos from files, whose pixels numpy sees where they are, and pictures into files. */
#include <refocus/platform/file.h>
#include "module.h"

#define PHOTO "refocus._core.photo"

/* Pixels of a photo: a buffer that keeps the photo as long as somebody looks at it. */
struct pixels {
    PyObject_HEAD PyObject *photo;
    void *bytes;
    Py_ssize_t size;
};

static int get_buffer(PyObject *self, Py_buffer *view, int flags)
{
    struct pixels *const pixels = (struct pixels *)self;

    return PyBuffer_FillInfo(view, self, pixels->bytes, pixels->size, 0, flags);
}

static void end_pixels(PyObject *self)
{
    PyTypeObject *const type = Py_TYPE(self);

    Py_XDECREF(((struct pixels *)self)->photo);
    ((freefunc)PyType_GetSlot(type, Py_tp_free))(self);
    Py_DECREF(type);
}

static PyType_Slot pixels_slots[] = {{Py_tp_dealloc, end_pixels},
                                     {Py_bf_getbuffer, get_buffer},
                                     {Py_tp_doc, "Pixels of a photo."},
                                     {0, NULL}};
static PyType_Spec pixels_spec = {.name = "refocus._core.Pixels",
                                  .basicsize = sizeof(struct pixels),
                                  .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION,
                                  .slots = pixels_slots};

/* A type of its own for each module: (pixels, rows, bytes of a row), or None without pixels. */
static PyObject *make_pixels(PyObject *type, PyObject *photo, const struct refocus_image *image)
{
    allocfunc allocate;
    struct pixels *pixels;

    if (!image->plane[0])
        Py_RETURN_NONE;
    allocate = (allocfunc)PyType_GetSlot((PyTypeObject *)type, Py_tp_alloc);
    pixels = (struct pixels *)allocate((PyTypeObject *)type, 0);
    if (!pixels)
        return NULL;
    Py_INCREF(photo);
    pixels->photo = photo;
    pixels->bytes = image->plane[0];
    pixels->size = (Py_ssize_t)image->stride[0] * image->height;
    return Py_BuildValue("Niin", pixels, (int)image->width, (int)image->height,
                         (Py_ssize_t)image->stride[0]);
}

static void end_photo(PyObject *capsule)
{
    struct refocus_photo *photo = PyCapsule_GetPointer(capsule, PHOTO);

    refocus_photo_free(&photo);
}

/* The exception of a file, with its name before the words. */
static PyObject *raise_of_file(PyObject *module, int status, const char *path,
                               const struct refocus_reason *reason)
{
    char words[1024];

    PyOS_snprintf(words, sizeof words, "%.700s: %s", path,
                  reason->text[0] ? reason->text : refocus_strerror(status));
    return rf_raise(module, status, words);
}

static PyObject *make_photo(PyObject *module, int status, struct refocus_photo *photo,
                            const char *path, const struct refocus_reason *reason)
{
    PyObject *capsule;

    if (status != REFOCUS_OK)
        return raise_of_file(module, status, path, reason);
    capsule = PyCapsule_New(photo, PHOTO, end_photo);
    if (!capsule)
        refocus_photo_free(&photo);
    return capsule;
}

/* (path, second) */
static PyObject *photo_read(PyObject *module, PyObject *args)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason = {{0}};
    const char *path;
    int second, status;

    if (!PyArg_ParseTuple(args, "yp", &path, &second))
        return NULL;
    Py_BEGIN_ALLOW_THREADS status = second ? refocus_photo_read_second(&photo, path, NULL, &reason)
                                           : refocus_photo_read(&photo, path, NULL, &reason);
    Py_END_ALLOW_THREADS return make_photo(module, status, photo, path, &reason);
}

static PyObject *photo_read_memory(PyObject *module, PyObject *args)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason = {{0}};
    Py_buffer bytes;
    int status;

    if (!PyArg_ParseTuple(args, "y*", &bytes))
        return NULL;
    Py_BEGIN_ALLOW_THREADS status =
        refocus_photo_read_memory(&photo, bytes.buf, (size_t)bytes.len, NULL, &reason);
    Py_END_ALLOW_THREADS PyBuffer_Release(&bytes);
    return make_photo(module, status, photo, "bytes", &reason);
}

/* (path, unit or None, near_m, far_m) */
static PyObject *depth_read(PyObject *module, PyObject *args)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason = {{0}};
    const char *path, *unit;
    double near_m, far_m;
    int status;

    if (!PyArg_ParseTuple(args, "yzdd", &path, &unit, &near_m, &far_m))
        return NULL;
    Py_BEGIN_ALLOW_THREADS status =
        refocus_depth_read(&photo, path, unit, near_m, far_m, NULL, &reason);
    Py_END_ALLOW_THREADS return make_photo(module, status, photo, path, &reason);
}

static PyObject *blob(const struct refocus_blob *bytes)
{
    return PyBytes_FromStringAndSize((const char *)bytes->data, (Py_ssize_t)bytes->size);
}

static PyObject *evidence(const struct refocus_photo_info *info)
{
    PyObject *const lines = PyList_New(0);

    for (int i = 0; lines && i < info->evidence_count; i++) {
        PyObject *const line = PyUnicode_FromString(info->evidence[i]);

        if (!line || PyList_Append(lines, line) != 0) {
            Py_XDECREF(line);
            Py_DECREF(lines);
            return NULL;
        }
        Py_DECREF(line);
    }
    return lines;
}

/* {image, deep: (pixels, width, height, stride) or None; info, evidence, exif, icc; depth, matte:
 * (width, height) or None; confidence: bytes or None} */
static PyObject *photo_parts(PyObject *module, PyObject *args)
{
    PyObject *capsule, *type, *parts;
    const struct refocus_photo *photo;
    const struct refocus_depth_map *depth, *matte;

    if (!PyArg_ParseTuple(args, "O", &capsule))
        return NULL;
    photo = PyCapsule_GetPointer(capsule, PHOTO);
    if (!photo)
        return NULL;
    type = PyType_FromModuleAndSpec(module, &pixels_spec, NULL);
    if (!type)
        return NULL;
    depth = photo->depth;
    matte = photo->matte;
    parts = Py_BuildValue(
        "{s:N,s:N,s:N,s:N,s:N,s:N,s:N,s:N,s:N}", "image", make_pixels(type, capsule, photo->image),
        "deep", make_pixels(type, capsule, photo->deep), "info",
        rf_struct_make("photo_info", photo->info), "evidence", evidence(photo->info), "exif",
        blob(&photo->exif), "icc", blob(&photo->icc), "depth",
        depth->samples ? Py_BuildValue("ii", (int)depth->width, (int)depth->height)
                       : Py_BuildValue(""),
        "matte",
        matte->samples ? Py_BuildValue("ii", (int)matte->width, (int)matte->height)
                       : Py_BuildValue(""),
        "confidence",
        photo->confidence ? PyBytes_FromStringAndSize((const char *)photo->confidence,
                                                      (Py_ssize_t)depth->width * depth->height)
                          : Py_BuildValue(""));
    Py_DECREF(type);
    return parts;
}

/* (photo, matte instead of depth, out, confidence: receives 0 for what was filled, picture that
 * holes are filled by or None) */
static PyObject *photo_disparity(PyObject *module, PyObject *args)
{
    struct refocus_depth_report report = refocus_depth_report_default();
    struct refocus_repair_params params = refocus_repair_params_default();
    const struct refocus_photo *photo;
    const struct refocus_depth_map *map;
    struct rf_buffers buffers = {0};
    struct refocus_image image;
    PyObject *capsule, *out, *confidence, *picture;
    uint16_t *to;
    ptrdiff_t stride;
    int is_matte, status = REFOCUS_OK;

    if (!PyArg_ParseTuple(args, "OpOOO", &capsule, &is_matte, &out, &confidence, &picture))
        return NULL;
    photo = PyCapsule_GetPointer(capsule, PHOTO);
    if (!photo)
        return NULL;
    map = is_matte ? photo->matte : photo->depth;
    if (!map->samples)
        return rf_raise(module, REFOCUS_ERR_NO_DEPTH, NULL);
    if (rf_map16_get(&buffers, out, "out", map->width, map->height, &to, &stride) == 0 &&
        rf_bytes_get(&buffers, confidence, 1, "confidence", map->width, map->height,
                     &params.confidence, &params.confidence_stride) == 0 &&
        rf_image_get_if_any(&buffers, picture, "photo", &image, &params.photo) == 0) {
        Py_BEGIN_ALLOW_THREADS status = refocus_depth_repair(map, &params, to, stride, &report);
        Py_END_ALLOW_THREADS
    }
    rf_buffers_release(&buffers);
    if (PyErr_Occurred())
        return NULL;
    return status == REFOCUS_OK ? rf_struct_make("depth_report", &report)
                                : rf_raise(module, status, NULL);
}

/* (path, picture, quality, photo or None): what had to be left out, in words */
static PyObject *image_write(PyObject *module, PyObject *args)
{
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_reason reason = {{0}};
    struct rf_buffers buffers = {0};
    struct refocus_image image;
    PyObject *picture, *keep;
    const char *path;
    int status = REFOCUS_OK;

    if (!PyArg_ParseTuple(args, "yOiO", &path, &picture, &options.quality, &keep))
        return NULL;
    if (keep != Py_None) {
        options.keep = PyCapsule_GetPointer(keep, PHOTO);
        if (!options.keep)
            return NULL;
        options.exif = &options.keep->exif;
        options.icc = &options.keep->icc;
    }
    if (rf_image_get(&buffers, picture, 0, "image", &image) == 0) {
        Py_BEGIN_ALLOW_THREADS status = refocus_image_write(path, &image, &options, &reason);
        Py_END_ALLOW_THREADS
    }
    rf_buffers_release(&buffers);
    if (PyErr_Occurred())
        return NULL;
    return status == REFOCUS_OK ? PyUnicode_FromString(reason.text)
                                : raise_of_file(module, status, path, &reason);
}

/* (path, samples, width, height) */
static PyObject *gray16_write(PyObject *module, PyObject *args)
{
    struct refocus_reason reason = {{0}};
    struct rf_buffers buffers = {0};
    struct refocus_disparity map;
    PyObject *samples;
    const char *path;
    int status = REFOCUS_ERR_ARGUMENT;

    if (!PyArg_ParseTuple(args, "yO", &path, &samples))
        return NULL;
    if (rf_disparity_get(&buffers, samples, "samples", &map) == 0 && map.bits == 16) {
        Py_BEGIN_ALLOW_THREADS status =
            refocus_gray16_write(path, map.samples, map.width, map.height, map.stride, &reason);
        Py_END_ALLOW_THREADS
    }
    rf_buffers_release(&buffers);
    if (PyErr_Occurred())
        return NULL;
    if (status != REFOCUS_OK)
        return raise_of_file(module, status, path, &reason);
    Py_RETURN_NONE;
}

static PyObject *file_formats(PyObject *module, PyObject *args)
{
    (void)module, (void)args;
    return PyUnicode_FromString(refocus_file_formats());
}

PyMethodDef rf_files_methods[] = {{"photo_read", photo_read, METH_VARARGS, NULL},
                                  {"photo_read_memory", photo_read_memory, METH_VARARGS, NULL},
                                  {"depth_read", depth_read, METH_VARARGS, NULL},
                                  {"photo_parts", photo_parts, METH_VARARGS, NULL},
                                  {"photo_disparity", photo_disparity, METH_VARARGS, NULL},
                                  {"image_write", image_write, METH_VARARGS, NULL},
                                  {"gray16_write", gray16_write, METH_VARARGS, NULL},
                                  {"file_formats", file_formats, METH_NOARGS, NULL},
                                  {NULL, NULL, 0, NULL}};
