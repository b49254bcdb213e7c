/* optics.c: formulas of lenses, and the disparity in focus. */
#include "module.h"

static PyObject *disparity_of_depth(PyObject *module, PyObject *args)
{
    struct refocus_depth_range range;
    double depth;

    (void)module;
    if (!PyArg_ParseTuple(args, "(dd)d", &range.near_m, &range.far_m, &depth))
        return NULL;
    return PyFloat_FromDouble(refocus_disparity_of_depth(&range, depth));
}

static PyObject *depth_of_disparity(PyObject *module, PyObject *args)
{
    struct refocus_depth_range range;
    double disparity;

    (void)module;
    if (!PyArg_ParseTuple(args, "(dd)d", &range.near_m, &range.far_m, &disparity))
        return NULL;
    return PyFloat_FromDouble(refocus_depth_of_disparity(&range, disparity));
}

static PyObject *max_blur_radius(PyObject *module, PyObject *args)
{
    struct refocus_lens lens;
    struct refocus_depth_range range;
    double width;

    (void)module;
    if (!PyArg_ParseTuple(args, "(ddd)(dd)d", &lens.focal_length_mm, &lens.f_number,
                          &lens.sensor_width_mm, &range.near_m, &range.far_m, &width))
        return NULL;
    return PyFloat_FromDouble(refocus_max_blur_radius(&lens, &range, width));
}

static PyObject *f_number_of_blur(PyObject *module, PyObject *args)
{
    struct refocus_lens lens;
    struct refocus_depth_range range;
    double width, blur;

    (void)module;
    if (!PyArg_ParseTuple(args, "(ddd)(dd)dd", &lens.focal_length_mm, &lens.f_number,
                          &lens.sensor_width_mm, &range.near_m, &range.far_m, &width, &blur))
        return NULL;
    return PyFloat_FromDouble(refocus_f_number_of_blur(&lens, &range, width, blur));
}

static PyObject *hyperfocal_m(PyObject *module, PyObject *args)
{
    struct refocus_lens lens;
    double acuity;

    (void)module;
    if (!PyArg_ParseTuple(args, "(ddd)d", &lens.focal_length_mm, &lens.f_number,
                          &lens.sensor_width_mm, &acuity))
        return NULL;
    return PyFloat_FromDouble(refocus_hyperfocal_m(&lens, acuity));
}

static PyObject *depth_of_field_m(PyObject *module, PyObject *args)
{
    struct refocus_depth_of_field found;
    double focus, hyperfocal;

    (void)module;
    if (!PyArg_ParseTuple(args, "dd", &focus, &hyperfocal))
        return NULL;
    found = refocus_depth_of_field_m(focus, hyperfocal);
    return rf_struct_make("depth_of_field", &found);
}

/* A point with a radius, or a rectangle: (map, x, y, radius) or (map, x, y, width, height). */
static PyObject *focus_at(PyObject *module, PyObject *args)
{
    struct rf_buffers buffers = {0};
    struct refocus_disparity map;
    PyObject *object;
    int x, y, size, height = 0, status;
    float focus = 0;

    if (!PyArg_ParseTuple(args, "Oiii|i", &object, &x, &y, &size, &height))
        return NULL;
    if (rf_disparity_get(&buffers, object, "disparity", &map) != 0) {
        rf_buffers_release(&buffers);
        return NULL;
    }
    status = PyTuple_Size(args) == 4 ? refocus_focus_at_point(&map, x, y, size, &focus)
                                     : refocus_focus_in_rectangle(&map, x, y, size, height, &focus);
    rf_buffers_release(&buffers);
    return status == REFOCUS_OK ? PyFloat_FromDouble((double)focus)
                                : rf_raise(module, status, NULL);
}

PyMethodDef rf_optics_methods[] = {{"disparity_of_depth", disparity_of_depth, METH_VARARGS, NULL},
                                   {"depth_of_disparity", depth_of_disparity, METH_VARARGS, NULL},
                                   {"max_blur_radius", max_blur_radius, METH_VARARGS, NULL},
                                   {"f_number_of_blur", f_number_of_blur, METH_VARARGS, NULL},
                                   {"hyperfocal_m", hyperfocal_m, METH_VARARGS, NULL},
                                   {"depth_of_field_m", depth_of_field_m, METH_VARARGS, NULL},
                                   {"focus_at", focus_at, METH_VARARGS, NULL},
                                   {NULL, NULL, 0, NULL}};
