/* module.c: the module refocus._core, which the package in Python stands on. */
#include "module.h"

/* The module keeps {status: class of exception}, from refocus._errors. */
struct state {
    PyObject *classes;
};

PyObject *rf_raise(PyObject *module, int status, const char *words)
{
    const struct state *const state = PyModule_GetState(module);
    PyObject *const number = PyLong_FromLong(status);
    PyObject *const class = number ? PyDict_GetItem(state->classes, number) : NULL;
    /* Names of files are bytes of any kind. */
    PyObject *const text =
        PyUnicode_DecodeFSDefault(words && *words ? words : refocus_strerror(status));

    Py_XDECREF(number);
    if (text)
        PyErr_SetObject(class ? class : PyExc_RuntimeError, text);
    Py_XDECREF(text);
    return NULL;
}

static PyObject *struct_default(PyObject *module, PyObject *args)
{
    static _Thread_local union {
        double align;
        char bytes[RF_MOST_STRUCT];
    } made;
    const char *name;

    (void)module;
    if (!PyArg_ParseTuple(args, "s", &name) || rf_struct_get(NULL, Py_None, name, &made) != 0)
        return NULL;
    return rf_struct_make(name, &made);
}

static PyObject *version(PyObject *module, PyObject *args)
{
    (void)module, (void)args;
    return PyUnicode_FromString(refocus_version());
}

static PyObject *method_name(PyObject *module, PyObject *args)
{
    unsigned int method;

    if (!PyArg_ParseTuple(args, "I", &method))
        return NULL;
    return refocus_method_name(method) ? PyUnicode_FromString(refocus_method_name(method))
                                       : rf_raise(module, REFOCUS_ERR_ARGUMENT, "no such method");
}

static PyObject *method_traits(PyObject *module, PyObject *args)
{
    unsigned int method;

    (void)module;
    if (!PyArg_ParseTuple(args, "I", &method))
        return NULL;
    return PyLong_FromUnsignedLong(refocus_method_traits(method));
}

static PyMethodDef methods[] = {{"struct_default", struct_default, METH_VARARGS, NULL},
                                {"version", version, METH_NOARGS, NULL},
                                {"method_name", method_name, METH_VARARGS, NULL},
                                {"method_traits", method_traits, METH_VARARGS, NULL},
                                {NULL, NULL, 0, NULL}};

static int begin(PyObject *module)
{
    struct state *const state = PyModule_GetState(module);
    PyObject *const errors = PyImport_ImportModule("refocus._errors");

    if (!errors)
        return -1;
    state->classes = PyObject_GetAttrString(errors, "BY_STATUS");
    Py_DECREF(errors);
    if (!state->classes || PyModule_AddFunctions(module, rf_renderer_methods) != 0 ||
        PyModule_AddFunctions(module, rf_depth_methods) != 0 ||
        PyModule_AddFunctions(module, rf_optics_methods) != 0 ||
        PyModule_AddFunctions(module, rf_files_methods) != 0)
        return -1;
    return 0;
}

static int visit_state(PyObject *module, visitproc visit, void *arg)
{
    Py_VISIT(((struct state *)PyModule_GetState(module))->classes);
    return 0;
}

static int clear_state(PyObject *module)
{
    Py_CLEAR(((struct state *)PyModule_GetState(module))->classes);
    return 0;
}

static void free_state(void *module)
{
    clear_state(module);
}

PyMODINIT_FUNC PyInit__core(void);

PyMODINIT_FUNC PyInit__core(void)
{
    static PyModuleDef_Slot slots[] = {{Py_mod_exec, begin}, {0, NULL}};
    static PyModuleDef definition = {.m_base = PyModuleDef_HEAD_INIT,
                                     .m_name = "refocus._core",
                                     .m_doc = "The C functions behind the package refocus.",
                                     .m_size = sizeof(struct state),
                                     .m_methods = methods,
                                     .m_slots = slots,
                                     .m_traverse = visit_state,
                                     .m_clear = clear_state,
                                     .m_free = free_state};

    return PyModuleDef_Init(&definition);
}
