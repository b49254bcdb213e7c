/* renderer.c: apertures and renderers as capsules, and what is done with them. */
#include <stdbool.h>
#include <string.h>
#include <unistd.h>
#include "module.h"

#define RENDERER "refocus._core.renderer"
#define APERTURE "refocus._core.aperture"

struct renderer {
    struct refocus_renderer *renderer; /* NULL when it is closed */
    int calls;                         /* calls under way, which run without Python's lock */
    bool keeps;                        /* the library reads photo and map after prepare */
    pid_t owner;                       /* the process that its threads are in; 0: it has none */
    struct rf_buffers scene, maps;     /* memory that the library may still read */
};

/* The words of the last error of a renderer, which come on the thread that called. */
static _Thread_local char last_words[256];

static void keep_words(void *user, const char *text)
{
    (void)user;
    PyOS_snprintf(last_words, sizeof last_words, "%s", text);
}

/* A child by fork() has the memory of a renderer, and none of its threads, which would be waited
 * for without end. */
static bool is_of_another_process(const struct renderer *r)
{
    return r->owner && r->owner != getpid();
}

static void close_renderer(struct renderer *r)
{
    if (!is_of_another_process(r))
        refocus_renderer_destroy(&r->renderer);
    r->renderer = NULL;
    rf_buffers_release(&r->scene);
    rf_buffers_release(&r->maps);
}

static void end_renderer(PyObject *capsule)
{
    struct renderer *const r = PyCapsule_GetPointer(capsule, RENDERER);

    close_renderer(r);
    PyMem_Free(r);
}

static void end_aperture(PyObject *capsule)
{
    struct refocus_aperture *aperture = PyCapsule_GetPointer(capsule, APERTURE);

    refocus_aperture_destroy(&aperture);
}

static PyObject *aperture_create(PyObject *module, PyObject *args)
{
    struct refocus_aperture_params params;
    struct refocus_aperture *aperture = NULL;
    struct rf_buffers buffers = {0};
    PyObject *dictionary, *mask, *capsule;
    struct rf_rows rows;
    int status;

    if (!PyArg_ParseTuple(args, "OO", &dictionary, &mask) ||
        rf_struct_get(NULL, dictionary, "aperture_params", &params) != 0)
        return NULL;
    if (mask != Py_None) {
        if (rf_map_rows_get(&buffers, mask, 0, "mask", &rows) == 0 && rows.type != 'B')
            PyErr_SetString(PyExc_TypeError, "mask: has to be uint8");
        if (!PyErr_Occurred() &&
            (rows.rows > REFOCUS_MAX_APERTURE_SIDE || rows.row_bytes > REFOCUS_MAX_APERTURE_SIDE))
            PyErr_Format(PyExc_ValueError, "mask: no side may be larger than %d",
                         REFOCUS_MAX_APERTURE_SIDE);
        if (PyErr_Occurred()) {
            rf_buffers_release(&buffers);
            return NULL;
        }
        params.mask = (const uint8_t *)rows.first;
        params.mask_stride = rows.stride;
        params.mask_width = (int32_t)rows.row_bytes;
        params.mask_height = (int32_t)rows.rows;
    }
    status = refocus_aperture_create(&aperture, &params);
    rf_buffers_release(&buffers);
    if (status != REFOCUS_OK)
        return rf_raise(module, status, NULL);
    capsule = PyCapsule_New(aperture, APERTURE, end_aperture);
    if (!capsule)
        refocus_aperture_destroy(&aperture);
    return capsule;
}

static bool has_one_thread(const struct refocus_renderer *renderer)
{
    struct refocus_renderer_info info = refocus_renderer_info_default();

    refocus_renderer_get_info(renderer, &info);
    return info.threads == 1;
}

static PyObject *renderer_create(PyObject *module, PyObject *dictionary)
{
    struct refocus_renderer_params params;
    struct renderer *r;
    PyObject *capsule;
    int status;

    if (rf_struct_get(NULL, dictionary, "renderer_params", &params) != 0)
        return NULL;
    r = PyMem_Calloc(1, sizeof *r);
    if (!r)
        return PyErr_NoMemory();
    params.papers = refocus_papers();
    params.log.message = keep_words;
    r->keeps = params.in_place || params.deep;
    r->owner = getpid();
    last_words[0] = 0;
    Py_BEGIN_ALLOW_THREADS status = refocus_renderer_create(&r->renderer, &params);
    if (status == REFOCUS_OK && has_one_thread(r->renderer))
        r->owner = 0;
    Py_END_ALLOW_THREADS capsule =
        status == REFOCUS_OK ? PyCapsule_New(r, RENDERER, end_renderer) : NULL;
    if (!capsule) {
        refocus_renderer_destroy(&r->renderer);
        PyMem_Free(r);
    }
    return status == REFOCUS_OK ? capsule : rf_raise(module, status, last_words);
}

/* The renderer of a capsule, which stays open until end_call(). */
static struct renderer *begin_call(PyObject *module, PyObject *capsule)
{
    struct renderer *const r = PyCapsule_GetPointer(capsule, RENDERER);

    if (r && (!r->renderer || is_of_another_process(r))) {
        rf_raise(module, REFOCUS_ERR_STATE,
                 r->renderer ? "the renderer is of the process before the fork; create one here"
                             : "the renderer is closed");
        return NULL;
    }
    if (r)
        r->calls++;
    last_words[0] = 0;
    return r;
}

/* An error of a call becomes an exception. Returns None or NULL. */
static PyObject *end_call(PyObject *module, struct renderer *r, int status)
{
    r->calls--;
    if (PyErr_Occurred())
        return NULL;
    if (status != REFOCUS_OK)
        return rf_raise(module, status, last_words);
    Py_RETURN_NONE;
}

static PyObject *renderer_destroy(PyObject *module, PyObject *capsule)
{
    struct renderer *r;

    r = PyCapsule_GetPointer(capsule, RENDERER);
    if (!r)
        return NULL;
    if (r->calls > 0 && !is_of_another_process(r))
        return rf_raise(module, REFOCUS_ERR_BUSY, "the renderer is used by another thread");
    close_renderer(r);
    Py_RETURN_NONE;
}

static int get_scene(struct rf_buffers *buffers, PyObject *const part[6],
                     struct refocus_image image[2], struct refocus_disparity map[3],
                     struct refocus_scene *scene)
{
    uint8_t *confidence = NULL;

    if (rf_image_get(buffers, part[0], 0, "photo", &image[0]) != 0 ||
        rf_disparity_get(buffers, part[1], "disparity", &map[0]) != 0)
        return -1;
    scene->photo = &image[0];
    scene->disparity = &map[0];
    if (part[2] != Py_None) {
        if (rf_disparity_get(buffers, part[2], "matte", &map[1]) != 0)
            return -1;
        scene->matte = &map[1];
    }
    if (rf_image_get_if_any(buffers, part[3], "behind", &image[1], &scene->behind) != 0)
        return -1;
    if (part[4] != Py_None) {
        if (rf_disparity_get(buffers, part[4], "behind_disparity", &map[2]) != 0)
            return -1;
        scene->behind_disparity = &map[2];
    }
    if (rf_bytes_get(buffers, part[5], 0, "confidence", map[0].width, map[0].height, &confidence,
                     &scene->confidence_stride) != 0)
        return -1;
    scene->confidence = confidence;
    return 0;
}

static PyObject *prepare_scene(PyObject *module, PyObject *args)
{
    struct refocus_scene scene = refocus_scene_default(NULL, NULL);
    struct refocus_image image[2];
    struct refocus_disparity map[3];
    struct rf_buffers buffers = {0};
    PyObject *capsule, *part[6];
    struct renderer *r;
    int status = REFOCUS_ERR_BUSY;

    if (!PyArg_ParseTuple(args, "OOOIOOOO", &capsule, &part[0], &part[1], &scene.depth_edges,
                          &part[2], &part[3], &part[4], &part[5]))
        return NULL;
    r = begin_call(module, capsule);
    if (!r)
        return NULL;
    if (get_scene(&buffers, part, image, map, &scene) == 0) {
        Py_BEGIN_ALLOW_THREADS status = refocus_prepare_scene(r->renderer, &scene);
        Py_END_ALLOW_THREADS
    }
    /* Only a busy renderer still has the scene of before, and uses it. */
    if (status != REFOCUS_ERR_BUSY)
        rf_buffers_release(&r->scene);
    if (status == REFOCUS_OK && r->keeps)
        r->scene = buffers;
    else
        rf_buffers_release(&buffers);
    return end_call(module, r, status);
}

static int get_settings(struct rf_buffers *buffers, PyObject *dictionary,
                        struct refocus_settings *settings)
{
    const struct {
        const char *key, *name;
        void *into;
    } part[] = {{"render", "render_params", &settings->render},
                {"highlights", "highlight_params", &settings->highlights},
                {"thin", "thin_params", &settings->thin},
                {"look", "look_params", &settings->look},
                {"focus", "focus_params", &settings->focus},
                {"field", "field_params", &settings->field},
                {"search", "search_params", &settings->search},
                {"jittered", "jittered_params", &settings->jittered},
                {"scatter", "scatter_params", &settings->scatter},
                {"interpolated", "interpolated_params", &settings->interpolated},
                {"foveated", "foveated_params", &settings->foveated},
                {"diffusion", "diffusion_params", &settings->diffusion}};

    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        PyObject *const fields = PyDict_GetItemString(dictionary, part[i].key);

        if (!fields) {
            PyErr_Format(PyExc_KeyError, "settings without %s", part[i].key);
            return -1;
        }
        if (rf_struct_get(buffers, fields, part[i].name, part[i].into) != 0)
            return -1;
    }
    return 0;
}

static PyObject *render(PyObject *module, PyObject *args)
{
    struct refocus_settings settings;
    struct refocus_image out;
    struct rf_buffers maps = {0}, pictures = {0};
    PyObject *capsule, *dictionary, *aperture, *picture;
    struct renderer *r;
    int status = REFOCUS_ERR_BUSY;

    if (!PyArg_ParseTuple(args, "OO!OO", &capsule, &PyDict_Type, &dictionary, &aperture, &picture))
        return NULL;
    r = begin_call(module, capsule);
    if (!r)
        return NULL;
    if (get_settings(&maps, dictionary, &settings) == 0 &&
        rf_image_get(&pictures, picture, 1, "out", &out) == 0) {
        if (aperture != Py_None)
            settings.render.aperture = PyCapsule_GetPointer(aperture, APERTURE);
        if (!PyErr_Occurred()) {
            Py_BEGIN_ALLOW_THREADS status = refocus_render_settings(r->renderer, &settings, &out);
            Py_END_ALLOW_THREADS
        }
    }
    rf_buffers_release(&pictures);
    if (status == REFOCUS_ERR_BUSY) {
        rf_buffers_release(&maps);
    } else {
        rf_buffers_release(&r->maps);
        r->maps = maps;
    }
    return end_call(module, r, status);
}

static PyObject *cancel(PyObject *module, PyObject *capsule)
{
    struct renderer *r;

    r = begin_call(module, capsule);
    if (!r)
        return NULL;
    refocus_cancel(r->renderer);
    return end_call(module, r, REFOCUS_OK);
}

static PyObject *get_view(PyObject *module, PyObject *args)
{
    struct rf_buffers buffers = {0};
    PyObject *capsule, *out;
    uint16_t *samples;
    ptrdiff_t stride;
    unsigned int view;
    int width, height, status = REFOCUS_OK;
    struct renderer *r;

    if (!PyArg_ParseTuple(args, "OIOii", &capsule, &view, &out, &width, &height))
        return NULL;
    r = begin_call(module, capsule);
    if (!r)
        return NULL;
    if (rf_map16_get(&buffers, out, "out", width, height, &samples, &stride) == 0) {
        Py_BEGIN_ALLOW_THREADS status = refocus_get_view(r->renderer, view, samples, stride);
        Py_END_ALLOW_THREADS
    }
    rf_buffers_release(&buffers);
    return end_call(module, r, status);
}

static PyObject *get_depth_edges(PyObject *module, PyObject *capsule)
{
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();
    PyObject *none;
    struct renderer *r;

    r = begin_call(module, capsule);
    if (!r)
        return NULL;
    none = end_call(module, r, refocus_get_depth_edges(r->renderer, &report));
    if (!none)
        return NULL;
    Py_DECREF(none);
    return rf_struct_make("depth_edges_report", &report);
}

static PyObject *get_info(PyObject *module, PyObject *capsule)
{
    struct refocus_renderer_info info = refocus_renderer_info_default();
    struct renderer *r;

    r = begin_call(module, capsule);
    if (!r)
        return NULL;
    refocus_renderer_get_info(r->renderer, &info);
    r->calls--;
    return rf_struct_make("renderer_info", &info);
}

static PyObject *renderer_memory(PyObject *module, PyObject *dictionary)
{
    struct refocus_renderer_params params;
    uint64_t bytes;

    if (rf_struct_get(NULL, dictionary, "renderer_params", &params) != 0)
        return NULL;
    params.papers = refocus_papers();
    bytes = refocus_renderer_memory(&params);
    return bytes ? PyLong_FromUnsignedLongLong(bytes)
                 : rf_raise(module, REFOCUS_ERR_ARGUMENT, NULL);
}

PyMethodDef rf_renderer_methods[] = {{"aperture_create", aperture_create, METH_VARARGS, NULL},
                                     {"renderer_create", renderer_create, METH_O, NULL},
                                     {"renderer_destroy", renderer_destroy, METH_O, NULL},
                                     {"renderer_memory", renderer_memory, METH_O, NULL},
                                     {"prepare_scene", prepare_scene, METH_VARARGS, NULL},
                                     {"render", render, METH_VARARGS, NULL},
                                     {"cancel", cancel, METH_O, NULL},
                                     {"get_view", get_view, METH_VARARGS, NULL},
                                     {"get_depth_edges", get_depth_edges, METH_O, NULL},
                                     {"get_info", get_info, METH_O, NULL},
                                     {NULL, NULL, 0, NULL}};
