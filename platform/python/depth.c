/* depth.c: depth maps become disparities, and get the size and the edges of their photo. */
#include "module.h"

/* (samples, out, meaning, flags, value_near, value_far, metres_per_unit, near_m, far_m, speckle,
 * confidence, photo or None) */
static PyObject *depth_to_disparity(PyObject *module, PyObject *args)
{
    struct refocus_depth_map map = refocus_depth_map_default();
    struct refocus_repair_params params = refocus_repair_params_default();
    struct refocus_depth_report report = refocus_depth_report_default();
    struct rf_buffers buffers = {0};
    PyObject *samples, *out, *confidence, *picture;
    struct refocus_image photo;
    struct rf_rows rows;
    uint16_t *to = NULL;
    ptrdiff_t stride = 0;
    int status = REFOCUS_OK;

    if (!PyArg_ParseTuple(args, "OOIIdddddiOO", &samples, &out, &map.meaning, &map.flags,
                          &map.value_near, &map.value_far, &map.metres_per_unit, &map.near_m,
                          &map.far_m, &params.speckle, &confidence, &picture))
        return NULL;
    if (rf_map_rows_get(&buffers, samples, 0, "depth", &rows) != 0)
        goto end;
    map.sample = rows.type == 'B'   ? REFOCUS_SAMPLE_U8
                 : rows.type == 'H' ? REFOCUS_SAMPLE_U16
                 : rows.type == 'f' ? REFOCUS_SAMPLE_F32
                                    : 0;
    if (!map.sample) {
        PyErr_SetString(PyExc_TypeError, "depth: has to be uint8, uint16 or float32");
        goto end;
    }
    if (rows.rows > REFOCUS_MAX_SIDE || rows.row_bytes / rows.item > REFOCUS_MAX_SIDE) {
        status = REFOCUS_ERR_SIZE;
        goto end;
    }
    map.samples = rows.first;
    map.stride = rows.stride;
    map.width = (int32_t)(rows.row_bytes / rows.item);
    map.height = (int32_t)rows.rows;
    if (rf_map16_get(&buffers, out, "out", map.width, map.height, &to, &stride) != 0 ||
        rf_bytes_get(&buffers, confidence, 1, "confidence", map.width, map.height,
                     &params.confidence, &params.confidence_stride) != 0 ||
        rf_image_get_if_any(&buffers, picture, "photo", &photo, &params.photo) != 0)
        goto end;
    Py_BEGIN_ALLOW_THREADS status = refocus_depth_repair(&map, &params, to, stride, &report);
    Py_END_ALLOW_THREADS end : rf_buffers_release(&buffers);
    if (PyErr_Occurred())
        return NULL;
    return status == REFOCUS_OK ? rf_struct_make("depth_report", &report)
                                : rf_raise(module, status, NULL);
}

/* (photo, disparity, out, threads, confidence) */
static PyObject *upsample(PyObject *module, PyObject *args)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();
    struct rf_buffers buffers = {0};
    struct refocus_image photo;
    struct refocus_disparity map;
    PyObject *picture, *disparity, *out, *confidence;
    uint8_t *bytes = NULL;
    uint16_t *to;
    ptrdiff_t stride;
    int status = REFOCUS_OK;

    if (!PyArg_ParseTuple(args, "OOOiO", &picture, &disparity, &out, &params.threads, &confidence))
        return NULL;
    if (rf_image_get(&buffers, picture, 0, "photo", &photo) == 0 &&
        rf_disparity_get(&buffers, disparity, "disparity", &map) == 0 &&
        rf_map16_get(&buffers, out, "out", photo.width, photo.height, &to, &stride) == 0 &&
        rf_bytes_get(&buffers, confidence, 0, "confidence", map.width, map.height, &bytes,
                     &params.confidence_stride) == 0) {
        params.confidence = bytes;
        Py_BEGIN_ALLOW_THREADS status = refocus_upsample(&photo, &map, &params, to, stride);
        Py_END_ALLOW_THREADS
    }
    rf_buffers_release(&buffers);
    if (PyErr_Occurred())
        return NULL;
    if (status != REFOCUS_OK)
        return rf_raise(module, status, NULL);
    Py_RETURN_NONE;
}

/* (photo, disparity, out, threads) */
static PyObject *depth_edges(PyObject *module, PyObject *args)
{
    struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();
    struct rf_buffers buffers = {0};
    struct refocus_image photo;
    struct refocus_disparity map;
    PyObject *picture, *disparity, *out;
    uint16_t *to;
    ptrdiff_t stride;
    int status = REFOCUS_OK;

    if (!PyArg_ParseTuple(args, "OOOi", &picture, &disparity, &out, &params.threads))
        return NULL;
    if (rf_image_get(&buffers, picture, 0, "photo", &photo) == 0 &&
        rf_disparity_get(&buffers, disparity, "disparity", &map) == 0 &&
        rf_map16_get(&buffers, out, "out", photo.width, photo.height, &to, &stride) == 0) {
        Py_BEGIN_ALLOW_THREADS status =
            refocus_depth_edges(&photo, &map, &params, to, stride, &report);
        Py_END_ALLOW_THREADS
    }
    rf_buffers_release(&buffers);
    if (PyErr_Occurred())
        return NULL;
    return status == REFOCUS_OK ? rf_struct_make("depth_edges_report", &report)
                                : rf_raise(module, status, NULL);
}

PyMethodDef rf_depth_methods[] = {{"depth_to_disparity", depth_to_disparity, METH_VARARGS, NULL},
                                  {"upsample", upsample, METH_VARARGS, NULL},
                                  {"depth_edges", depth_edges, METH_VARARGS, NULL},
                                  {NULL, NULL, 0, NULL}};
