/* live_calibration.c: the positions of two cameras are read from JSON:
 *
 *     {"depth":  {"width": 640, "height": 480, "fx": 570, "fy": 570, "cx": 320, "cy": 240},
 *      "colour": {"width": 1280, ...},
 *      "rotation": [1, 0, 0,  0, 1, 0,  0, 0, 1],
 *      "translation_m": [0.025, 0, 0]}
 */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include "line/report.h"
#include "live/live_calibration.h"

static bool read_camera(const json_t *root, const char *name, struct refocus_pinhole *camera)
{
    int width, height;

    if (json_unpack(json_object_get(root, name), "{s:i, s:i, s:F, s:F, s:F, s:F}", "width", &width,
                    "height", &height, "fx", &camera->fx, "fy", &camera->fy, "cx", &camera->cx,
                    "cy", &camera->cy) != 0)
        return false;
    camera->width = width;
    camera->height = height;
    return width > 0 && height > 0 && width <= REFOCUS_MAX_SIDE && height <= REFOCUS_MAX_SIDE &&
           camera->fx > 0 && camera->fy > 0;
}

static bool read_numbers(const json_t *root, const char *name, int count, double *values)
{
    const json_t *array = json_object_get(root, name);

    if (json_array_size(array) != (size_t)count)
        return false;
    for (int i = 0; i < count; i++) {
        const json_t *number = json_array_get(array, (size_t)i);

        if (!json_is_number(number))
            return false;
        values[i] = json_number_value(number);
    }
    return true;
}

/* Rows of unit length at right angles to each other. */
static bool is_rotation(const double r[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            double product = 0;

            for (int k = 0; k < 3; k++)
                product += r[3 * i + k] * r[3 * j + k];
            if (fabs(product - (i == j)) > 1e-3)
                return false;
        }
    return true;
}

/* The words for what is wrong with it, or NULL. */
static const char *parse(const json_t *root, struct refocus_calibration *c)
{
    if (!read_camera(root, "depth", &c->depth))
        return "\"depth\" with width, height, fx, fy, cx and cy";
    if (!read_camera(root, "colour", &c->colour))
        return "\"colour\" with width, height, fx, fy, cx and cy";
    if (!read_numbers(root, "rotation", 9, c->rotation) || !is_rotation(c->rotation))
        return "\"rotation\", the nine numbers of a rotation row by row";
    if (!read_numbers(root, "translation_m", 3, c->translation_m))
        return "\"translation_m\", three numbers in metres";
    return NULL;
}

int live_read_calibration(struct refocus_calibration **result, const char *file)
{
    struct refocus_calibration *c = calloc(1, sizeof *c);
    json_error_t error;
    json_t *root = json_load_file(file, 0, &error);
    const char *wrong = c && root ? parse(root, c) : NULL;
    int status = EXIT_DONE;

    if (!c)
        status = report_failure(EXIT_FAILED, file, "not enough memory");
    else if (!root)
        status = report_failure(EXIT_FAILED, file, "%s (line %d)", error.text, error.line);
    else if (wrong)
        status = report_failure(EXIT_FAILED, file, "it lacks a sound %s", wrong);
    json_decref(root);
    if (status != EXIT_DONE)
        free(c);
    else
        *result = c;
    return status;
}
