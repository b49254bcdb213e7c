/* keys.c: key frames are read from JSON, and values between them are interpolated. */
#include "settings/keys.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>
#include <refocus/platform/file.h>
#include "line/options.h"
#include "line/report.h"
#include "settings/settings.h"

enum { MOST_KEYS = 1024, MOST_BYTES = 1 << 20, VERSION = 1 };
#define MOST_SECONDS 3600.0

/* The parameters that can move: floats, with the ranges of their options. */
static const struct parameter {
    const char *name;
    size_t offset;
    double least, greatest;
} parameters[] = {
    {"focus", offsetof(struct refocus_settings, render.focus_disparity), 0, 1},
    {"blur", offsetof(struct refocus_settings, render.max_blur_radius), 0, REFOCUS_MAX_BLUR_RADIUS},
    {"highlights", offsetof(struct refocus_settings, highlights.gain), 1, 16},
    {"focus-width", offsetof(struct refocus_settings, focus.half_width), 0, 1},
    {"focus-transition", offsetof(struct refocus_settings, focus.transition), 0, 1},
    {"cat-eye", offsetof(struct refocus_settings, look.cat_eye), 0, 0.9f},
    {"field-x", offsetof(struct refocus_settings, field.x), 0, 1},
    {"field-y", offsetof(struct refocus_settings, field.y), 0, 1},
    {"field-disparity", offsetof(struct refocus_settings, field.disparity), 0, 1},
    {"field-radius", offsetof(struct refocus_settings, field.radius), 0, 4},
    {"field-falloff", offsetof(struct refocus_settings, field.falloff), 0.001, 4},
    {"field-angle", offsetof(struct refocus_settings, field.angle), -360, 360},
};
enum { PARAMETERS = sizeof parameters / sizeof *parameters };

struct key {
    double time;
    enum ease ease;
    double value[PARAMETERS]; /* NAN: not named */
};

struct keys {
    int count;
    struct key key[];
};

const struct option_word ease_words[] = {
    {"smooth", NULL}, {"linear", NULL}, {"in", NULL}, {"out", NULL}, {0}};

double ease_at(enum ease ease, double part)
{
    switch (ease) {
    case EASE_LINEAR:
        return part;
    case EASE_IN:
        return part * part;
    case EASE_OUT:
        return part * (2 - part);
    case EASE_SMOOTH:
        break;
    }
    return part * part * (3 - 2 * part);
}

static const char *parameter_word(const void *list, int i)
{
    (void)list;
    return i < PARAMETERS ? parameters[i].name : NULL;
}

static int find_parameter(const char *name)
{
    for (int i = 0; i < PARAMETERS; i++)
        if (strcmp(parameters[i].name, name) == 0)
            return i;
    return -1;
}

/* Append a key; NULL without memory. */
static struct key *append(struct keys **keys, double time, enum ease ease)
{
    const int count = *keys ? (*keys)->count : 0;
    struct keys *more = realloc(*keys, sizeof **keys + (size_t)(count + 1) * sizeof(struct key));
    struct key *key;

    if (!more)
        return NULL;
    *keys = more;
    more->count = count + 1;
    key = &more->key[count];
    key->time = time;
    key->ease = ease;
    for (int i = 0; i < PARAMETERS; i++)
        key->value[i] = NAN;
    return key;
}

int keys_add(struct keys **keys, double time, const char *name, double value, enum ease ease)
{
    struct key *key = *keys && (*keys)->key[(*keys)->count - 1].time == time
                          ? &(*keys)->key[(*keys)->count - 1]
                          : append(keys, time, ease);

    if (!key)
        return report_failure(EXIT_FAILED, name, "not enough memory");
    key->value[find_parameter(name)] = value;
    return EXIT_DONE;
}

static int damaged(const char *file, int i, const char *name, const char *why)
{
    char clean[64], what[128];

    report_clean(clean, sizeof clean, name);
    snprintf(what, sizeof what, "keys[%d]: %s", i, clean);
    return report_failure(EXIT_FAILED, file, "%s %s", what, why);
}

static int read_ease(const char *file, int i, const json_t *value, struct key *key)
{
    for (uint32_t e = 0; ease_words[e].name; e++) {
        if (json_is_string(value) && strcmp(json_string_value(value), ease_words[e].name) == 0) {
            key->ease = (enum ease)e;
            return EXIT_DONE;
        }
    }
    return damaged(file, i, "ease", "has to be one of smooth, linear, in, out");
}

static int read_parameter(const char *file, int i, const char *name, const json_t *value,
                          struct key *key)
{
    const int p = find_parameter(name);
    char why[160];

    if (p < 0) {
        const char *nearest = options_nearest(name, parameter_word, NULL);

        snprintf(why, sizeof why, "is no parameter%s%s%s", nearest ? "; did you mean '" : "",
                 nearest ? nearest : "", nearest ? "'?" : "");
        return damaged(file, i, name, why);
    }
    if (!json_is_number(value) || !(json_number_value(value) >= parameters[p].least &&
                                    json_number_value(value) <= parameters[p].greatest)) {
        snprintf(why, sizeof why, "has to be a number from %g to %g", parameters[p].least,
                 parameters[p].greatest);
        return damaged(file, i, name, why);
    }
    key->value[p] = json_number_value(value);
    return EXIT_DONE;
}

static int read_key(struct keys **keys, const char *file, int i, json_t *object)
{
    const json_t *time = json_object_get(object, "time");
    const double before = *keys ? (*keys)->key[(*keys)->count - 1].time : -1;
    int status = EXIT_DONE;
    struct key *key;
    const char *name;
    json_t *value;

    if (!json_is_object(object))
        return damaged(file, i, "", "has to be an object");
    if (!json_is_number(time) ||
        !(json_number_value(time) > before && json_number_value(time) >= 0 &&
          json_number_value(time) <= MOST_SECONDS))
        return damaged(file, i, "time",
                       "has to be seconds, later than those of the key before, at most 3600");
    key = append(keys, json_number_value(time), EASE_SMOOTH);
    if (!key)
        return report_failure(EXIT_FAILED, file, "not enough memory");
    json_object_foreach(object, name, value)
    {
        if (strcmp(name, "time") == 0)
            continue;
        status = strcmp(name, "ease") == 0 ? read_ease(file, i, value, key)
                                           : read_parameter(file, i, name, value, key);
        if (status != EXIT_DONE)
            break;
    }
    return status;
}

static int read_all(struct keys **keys, const char *file, json_t *root)
{
    const json_t *version = json_object_get(root, "refocus-pull");
    json_t *list = json_object_get(root, "keys"), *value;
    const char *name;
    int status = EXIT_DONE;
    size_t i;

    if (!json_is_integer(version) || json_integer_value(version) != VERSION)
        return report_failure(EXIT_FAILED, file,
                              "holds no keys: its member \"refocus-pull\" should be %d", VERSION);
    json_object_foreach(root, name,
                        value) if (strcmp(name, "keys") != 0 && strcmp(name, "refocus-pull") != 0)
    {
        char clean[64];

        report_clean(clean, sizeof clean, name);
        return report_failure(EXIT_FAILED, file, "'%s' is no member; did you mean 'keys'?", clean);
    }
    if (json_array_size(list) < 2 || json_array_size(list) > MOST_KEYS)
        return report_failure(EXIT_FAILED, file, "'keys' has to be a list of 2 to %d keys",
                              MOST_KEYS);
    json_array_foreach(list, i, value)
    {
        status = read_key(keys, file, (int)i, value);
        if (status != EXIT_DONE)
            break;
    }
    return status;
}

int keys_read(struct keys **keys, const char *file, const char *bytes, size_t size)
{
    json_t *const root = settings_parse(file, bytes, size);
    int status;

    *keys = NULL;
    if (!root)
        return EXIT_FAILED;
    status = read_all(keys, file, root);
    json_decref(root);
    if (status != EXIT_DONE) {
        keys_free(*keys);
        *keys = NULL;
    }
    return status;
}

int keys_load(struct keys **keys, const char *file)
{
    struct refocus_reason reason = {{0}};
    struct refocus_blob blob;
    int status;

    *keys = NULL;
    if (refocus_file_read(file, MOST_BYTES, &blob, &reason) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, file, "%s", reason.text);
    status = keys_read(keys, file, (const char *)blob.data, blob.size);
    free(blob.data);
    return status;
}

void keys_free(struct keys *keys)
{
    free(keys);
}

double keys_seconds(const struct keys *keys)
{
    return keys->key[keys->count - 1].time;
}

double keys_most(const struct keys *keys, const char *name, double otherwise)
{
    const int p = find_parameter(name);
    double most = NAN;

    for (int i = 0; i < keys->count; i++)
        most = fmax(most, keys->key[i].value[p]);
    return isnan(most) ? otherwise : most;
}

/* A parameter at a time; NAN: no key names it. */
static double value_at(const struct keys *keys, int p, double time)
{
    const struct key *before = NULL;

    for (int i = 0; i < keys->count; i++) {
        const struct key *key = &keys->key[i];

        if (isnan(key->value[p]))
            continue;
        if (key->time > time) {
            double part;

            if (!before)
                return key->value[p];
            part = ease_at(key->ease, (time - before->time) / (key->time - before->time));
            return before->value[p] + (key->value[p] - before->value[p]) * part;
        }
        before = key;
    }
    return before ? before->value[p] : NAN;
}

void keys_apply(const struct keys *keys, double time, struct refocus_settings *params)
{
    for (int p = 0; p < PARAMETERS; p++) {
        const double value = value_at(keys, p, time);

        if (!isnan(value))
            *(float *)((char *)params + parameters[p].offset) = (float)value;
        if (!isnan(value) &&
            parameters[p].offset == offsetof(struct refocus_settings, highlights.gain))
            params->highlights.estimate = 0;
    }
}
