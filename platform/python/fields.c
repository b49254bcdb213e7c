/* fields.c: structs of parameters from dictionaries, and dictionaries from structs. */
#include <string.h>
#include <refocus/platform/file.h>
#include "module.h"

enum rf_field_kind {
    RF_FIELD_I32 = 1,
    RF_FIELD_U32,
    RF_FIELD_U64,
    RF_FIELD_F32,
    RF_FIELD_F64,
    RF_FIELD_TEXT,
    RF_FIELD_MAP,
};

struct rf_field {
    const char *name;
    enum rf_field_kind kind;
    size_t offset;
};

struct rf_struct {
    const char *name;
    const struct rf_field *fields;
    void (*set_default)(void *into);
};

#define RF_FIELD(owner, kind, field)                                                               \
    {                                                                                              \
#field, RF_FIELD_##kind, offsetof(struct refocus_##owner, field)                           \
    }
#include "fields.h"

static const struct rf_struct *find(const char *name)
{
    for (size_t i = 0; i < sizeof rf_structs / sizeof *rf_structs; i++)
        if (strcmp(rf_structs[i].name, name) == 0)
            return &rf_structs[i];
    PyErr_Format(PyExc_KeyError, "no struct %s", name);
    return NULL;
}

static int get_integer(PyObject *value, const struct rf_field *field, char *to)
{
    PyObject *const number = PyNumber_Index(value);
    long long signed_value = 0;
    unsigned long long unsigned_value = 0;

    if (!number)
        return -1;
    if (field->kind == RF_FIELD_I32)
        signed_value = PyLong_AsLongLong(number);
    else
        unsigned_value = PyLong_AsUnsignedLongLong(number);
    Py_DECREF(number);
    if (!PyErr_Occurred() && (signed_value < INT32_MIN || signed_value > INT32_MAX ||
                              (field->kind == RF_FIELD_U32 && unsigned_value > UINT32_MAX)))
        PyErr_SetString(PyExc_OverflowError, "too large");
    if (PyErr_Occurred())
        return -1;
    if (field->kind == RF_FIELD_I32)
        memcpy(to, &(int32_t){(int32_t)signed_value}, sizeof(int32_t));
    else if (field->kind == RF_FIELD_U32)
        memcpy(to, &(uint32_t){(uint32_t)unsigned_value}, sizeof(uint32_t));
    else
        memcpy(to, &(uint64_t){unsigned_value}, sizeof(uint64_t));
    return 0;
}

static int get_number(PyObject *value, const struct rf_field *field, char *to)
{
    const double number = PyFloat_AsDouble(value);

    if (number == -1 && PyErr_Occurred())
        return -1;
    if (field->kind == RF_FIELD_F32)
        memcpy(to, &(float){(float)number}, sizeof(float));
    else
        memcpy(to, &number, sizeof number);
    return 0;
}

static int get_map(struct rf_buffers *buffers, PyObject *value, const char *name, char *to)
{
    const struct refocus_disparity *map = NULL;

    if (value != Py_None) {
        if (!buffers || buffers->map_count == RF_MOST_MAPS) {
            PyErr_Format(PyExc_ValueError, "%s: no map can be here", name);
            return -1;
        }
        if (rf_disparity_get(buffers, value, name, &buffers->map[buffers->map_count]) != 0)
            return -1;
        map = &buffers->map[buffers->map_count++];
    }
    memcpy(to, &map, sizeof map);
    return 0;
}

static int get_bands(PyObject *value, struct refocus_focus_params *focus)
{
    const Py_ssize_t count = PySequence_Size(value);

    if (count < 0)
        return -1;
    if (count >= REFOCUS_MAX_BANDS) {
        PyErr_Format(PyExc_ValueError, "band: at most %d", REFOCUS_MAX_BANDS - 1);
        return -1;
    }
    for (Py_ssize_t i = 0; i < count; i++) {
        struct refocus_band *const band = &focus->band[i];
        PyObject *const item = PySequence_GetItem(value, i);
        PyObject *const triple = item ? PySequence_Tuple(item) : NULL;
        const int good =
            triple &&
            PyArg_ParseTuple(triple, "fff;band: (disparity, half_width, transition) of each",
                             &band->disparity, &band->half_width, &band->transition);
        Py_XDECREF(triple);
        Py_XDECREF(item);
        if (!good)
            return -1;
    }
    focus->bands = (int32_t)count;
    return 0;
}

/* The exception that there is, with the name of the field before its words. */
static void name_error(const char *owner, const char *field)
{
    PyObject *type, *value, *trace;

    PyErr_Fetch(&type, &value, &trace);
    PyErr_Format(type, "%s.%s: %S", owner, field, value ? value : Py_None);
    Py_XDECREF(type);
    Py_XDECREF(value);
    Py_XDECREF(trace);
}

int rf_struct_get(struct rf_buffers *buffers, PyObject *dictionary, const char *name, void *into)
{
    const struct rf_struct *const known = find(name);

    if (!known)
        return -1;
    known->set_default(into);
    if (dictionary == Py_None)
        return 0;
    for (const struct rf_field *field = known->fields; field->name; field++) {
        PyObject *const value = PyDict_GetItemString(dictionary, field->name);
        char *const to = (char *)into + field->offset;
        int status = 0;

        if (!value)
            continue;
        if (field->kind <= RF_FIELD_U64)
            status = get_integer(value, field, to);
        else if (field->kind <= RF_FIELD_F64)
            status = get_number(value, field, to);
        else if (field->kind == RF_FIELD_MAP)
            status = get_map(buffers, value, field->name, to);
        if (status != 0) {
            name_error(name, field->name);
            return -1;
        }
    }
    if (strcmp(name, "focus_params") == 0) {
        PyObject *const bands = PyDict_GetItemString(dictionary, "band");

        return bands ? get_bands(bands, into) : 0;
    }
    return 0;
}

static PyObject *value_of(const struct rf_field *field, const char *from)
{
    int32_t i32;
    uint32_t u32;
    uint64_t u64;
    float f32;
    double f64;

    switch (field->kind) {
    case RF_FIELD_I32:
        memcpy(&i32, from, sizeof i32);
        return PyLong_FromLong(i32);
    case RF_FIELD_U32:
        memcpy(&u32, from, sizeof u32);
        return PyLong_FromUnsignedLong(u32);
    case RF_FIELD_U64:
        memcpy(&u64, from, sizeof u64);
        return PyLong_FromUnsignedLongLong(u64);
    case RF_FIELD_F32:
        memcpy(&f32, from, sizeof f32);
        return PyFloat_FromDouble((double)f32);
    case RF_FIELD_F64:
        memcpy(&f64, from, sizeof f64);
        return PyFloat_FromDouble(f64);
    case RF_FIELD_TEXT:
        return PyUnicode_FromString(from);
    case RF_FIELD_MAP:
        break;
    }
    Py_RETURN_NONE;
}

PyObject *rf_struct_make(const char *name, const void *from)
{
    const struct rf_struct *const known = find(name);
    PyObject *made = known ? PyDict_New() : NULL;

    for (const struct rf_field *field = known ? known->fields : NULL; made && field->name;
         field++) {
        PyObject *const value = value_of(field, (const char *)from + field->offset);

        if (!value || PyDict_SetItemString(made, field->name, value) != 0)
            Py_CLEAR(made);
        Py_XDECREF(value);
    }
    return made;
}
