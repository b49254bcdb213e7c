/* settings.c: parses a way to render, as it is named on the command line. */
#include "settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum kind { INT32, FLOAT, NAMED, METHOD, CPU, TEXT };

struct name {
    const char *name;
    double value;
};

static const struct name ray_names[] = {{"full", REFOCUS_RAYS_FULL}, {0}};
static const struct name sigma_names[] = {{"off", INFINITY}, {0}};
static const struct name blend_names[] = {{"linear", REFOCUS_BLEND_LINEAR},
                                          {"stored", REFOCUS_BLEND_STORED},
                                          {"gamma", REFOCUS_BLEND_GAMMA},
                                          {0}};
static const struct name format_names[] = {{"rgb", 0},
                                           {"nv12", REFOCUS_FORMAT_NV12},
                                           {"nv21", REFOCUS_FORMAT_NV21},
                                           {"i420", REFOCUS_FORMAT_I420},
                                           {"yuyv", REFOCUS_FORMAT_YUYV},
                                           {0}};

#define RENDER(field) offsetof(struct quality_settings, render.field)

/* A new setting of the renderer is one line here. */
static const struct key {
    const char *name;
    enum kind kind;
    size_t offset;
    const struct name *names;
} keys[] = {
    {"method", METHOD, RENDER(render.method), NULL},
    {"rays", INT32, RENDER(render.rays), ray_names},
    {"iterations", INT32, RENDER(search.iterations), NULL},
    {"blend", NAMED, RENDER(render.blend), blend_names},
    {"sigma", FLOAT, RENDER(render.sigma), sigma_names},
    {"mirror", INT32, RENDER(search.mirror), NULL},
    {"background", INT32, RENDER(search.background), NULL},
    {"prefilter", INT32, RENDER(render.prefilter), NULL},
    {"inpaint", INT32, RENDER(render.inpaint), NULL},
    {"thin", INT32, RENDER(thin.enabled), NULL},
    {"highlight", FLOAT, RENDER(highlights.gain), NULL},
    {"estimate", FLOAT, RENDER(highlights.estimate), NULL},
    {"cell", INT32, RENDER(jittered.cell), NULL},
    {"seed", INT32, RENDER(jittered.seed), NULL},
    {"spread", INT32, RENDER(scatter.spread), NULL},
    {"attention_angle", FLOAT, RENDER(foveated.angle), NULL},
    {"layers", INT32, RENDER(diffusion.layers), NULL},
    {"solver", INT32, RENDER(diffusion.solver), NULL},
    {"conductivity", FLOAT, RENDER(diffusion.conductivity), NULL},
    {"threads", INT32, offsetof(struct quality_settings, threads), NULL},
    {"cpu", CPU, offsetof(struct quality_settings, cpu), NULL},
    {"format", NAMED, offsetof(struct quality_settings, format), format_names},
    {"through", NAMED, offsetof(struct quality_settings, through), format_names},
    {"against", TEXT, offsetof(struct quality_settings, against), NULL},
};

static int parse_value(const struct key *key, const char *text, double *value)
{
    char *end;

    for (uint32_t i = 0; key->kind == METHOD && refocus_method_name(i); i++) {
        if (!strcmp(refocus_method_name(i), text)) {
            *value = i;
            return 0;
        }
    }
    if (key->kind == METHOD) {
        *value = -1;
        return strcmp(text, "input") ? -1 : 0;
    }
    for (uint32_t i = 0; key->kind == CPU && refocus_cpu_name(i); i++) {
        if (!strcmp(refocus_cpu_name(i), text)) {
            *value = i;
            return 0;
        }
    }
    for (const struct name *n = key->names; n && n->name; n++) {
        if (!strcmp(n->name, text)) {
            *value = n->value;
            return 0;
        }
    }
    *value = strtod(text, &end);
    return key->kind == NAMED || key->kind == CPU || end == text || *end ? -1 : 0;
}

static int set(struct quality_settings *settings, const struct key *key, const char *text)
{
    void *field = (char *)settings + key->offset;
    double value;

    if (key->kind == TEXT) {
        snprintf(field, sizeof settings->against, "%s", text);
        return 0;
    }
    if (parse_value(key, text, &value) || fabs(value) > INT32_MAX) {
        if (key->kind != FLOAT || !isinf(value))
            return -1;
    }
    if (key->kind == METHOD && value < 0)
        settings->input = 1;
    else if (key->kind == FLOAT)
        *(float *)field = (float)value;
    else
        *(int32_t *)field = (int32_t)value;
    return 0;
}

static int set_pair(struct quality_settings *settings, char *pair)
{
    char *value = strchr(pair, '=');

    if (value)
        *value++ = 0;
    for (size_t i = 0; value && i < sizeof keys / sizeof keys[0]; i++) {
        if (!strcmp(keys[i].name, pair)) {
            if (!set(settings, &keys[i], value))
                return 0;
            fprintf(stderr, "refocus-quality: %s: bad value '%s'\n", pair, value);
            return -1;
        }
    }
    fprintf(stderr, "refocus-quality: no setting '%s': one of these:\n", pair);
    quality_settings_help(stderr);
    return -1;
}

int quality_settings_parse(struct quality_settings *settings, const char *text)
{
    char copy[512];
    char *colon, *save, *pair;

    memset(settings, 0, sizeof *settings);
    settings->render = refocus_settings_default(0, 0);
    if (strlen(text) >= sizeof copy || !(colon = strchr(strcpy(copy, text), ':')) ||
        (size_t)(colon - copy) >= sizeof settings->label) {
        fprintf(stderr, "refocus-quality: '%s' is not LABEL:key=value,...\n", text);
        return -1;
    }
    *colon = 0;
    strcpy(settings->label, copy);
    for (pair = strtok_r(colon + 1, ",", &save); pair; pair = strtok_r(NULL, ",", &save)) {
        if (set_pair(settings, pair))
            return -1;
    }
    return 0;
}

void quality_settings_help(FILE *file)
{
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        fprintf(file, "  %-11s", keys[i].name);
        if (keys[i].kind == TEXT)
            fprintf(file, " label of an earlier run");
        else if (keys[i].kind == METHOD)
            for (uint32_t m = 0; refocus_method_name(m); m++)
                fprintf(file, "%s %s", m ? "" : " input", refocus_method_name(m));
        else if (keys[i].kind == CPU)
            for (uint32_t cpu = 0; refocus_cpu_name(cpu); cpu++)
                fprintf(file, " %s", refocus_cpu_name(cpu));
        else if (keys[i].kind != NAMED)
            fprintf(file, " number");
        for (const struct name *n = keys[i].names; n && n->name; n++)
            fprintf(file, " %s", n->name);
        fputc('\n', file);
    }
}
