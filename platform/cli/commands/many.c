/* many.c: the names of what is read and written for each of several photos. */
#define _XOPEN_SOURCE 700 /* realpath */
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <refocus/platform/file.h>
#include "commands/many.h"
#include "inputs/standard_input.h"
#include "line/report.h"
#include "outputs/outputs.h"
#include "outputs/pattern.h"

/* "-" is standard input or output, even where a folder has that name. */
static bool is_folder(const char *path)
{
    struct stat about;

    return !standard_is(path) && stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

static bool ends_as_folder(const char *path)
{
    const size_t length = strlen(path);

    return length > 0 && path[length - 1] == '/';
}

/* The pattern that "-o FOLDER" stands for. */
static char *pattern_in(const char *folder)
{
    static const char name[] = "/{name}.{ext}";
    size_t size = sizeof name;
    char *pattern, *end;

    for (const char *c = folder; *c; c++)
        size += *c == '{' ? 2 : 1;
    pattern = malloc(size);
    if (!pattern)
        return NULL;
    end = pattern;
    for (const char *c = folder; *c; c++) {
        if (*c == '{')
            *end++ = '{';
        *end++ = *c;
    }
    memcpy(end, name, sizeof name);
    return pattern;
}

/* The photo's own ending where pictures are written so, else jpg. */
static const char *ending_of(const char *photo)
{
    return output_is_picture(photo) ? strrchr(photo, '.') + 1 : "jpg";
}

static int expand(const char *option, const char *pattern, const struct pattern_values *values,
                  char **name)
{
    return pattern ? pattern_expand(option, pattern, values, name) : EXIT_DONE;
}

static int name_photo(struct many_photo *photo, const struct pattern_values *values,
                      const char *output, const char *depth, const char *matte)
{
    int status;

    photo->photo = values->photo;
    status = expand("-o", output, values, &photo->output);
    if (status == EXIT_DONE)
        status = expand("--depth", depth, values, &photo->depth);
    if (status == EXIT_DONE)
        status = expand("--matte", matte, values, &photo->matte);
    return status;
}

int many_name(struct many *many, const struct command *command, const void *settings,
              const char *const *files, const char *output, const char *ext, const char *depth,
              const char *matte)
{
    struct pattern_values values = {.command = command, .settings = settings};
    char *folder = NULL;
    int status = EXIT_DONE;

    for (; files[values.count]; values.count++)
        if (is_folder(files[values.count]))
            return report_failure(EXIT_FAILED, files[values.count],
                                  "it is a folder; give the names of the photos in it");
    if (output && is_folder(output)) {
        folder = pattern_in(output);
        if (!folder)
            return report_failure(EXIT_FAILED, output, "not enough memory");
    } else if (output && ends_as_folder(output) && !pattern_is(output)) {
        return report_failure(EXIT_WRONG, "-o", "there is no folder %s; make it", output);
    } else if (output && values.count > 1 && !pattern_is(output)) {
        return report_failure(EXIT_WRONG, "-o",
                              "there is no folder %s for %d photos; make it, or give a name with "
                              "{name}",
                              output, values.count);
    }
    many->photos = calloc((size_t)values.count, sizeof *many->photos);
    if (!many->photos)
        status = report_failure(EXIT_FAILED, command->name, "not enough memory");
    for (int i = 0; i < values.count && status == EXIT_DONE; i++) {
        values.photo = files[i];
        values.ext = ext ? ext : ending_of(files[i]);
        values.number = i + 1;
        many->count = i + 1;
        status = name_photo(&many->photos[i], &values, folder ? folder : output, depth, matte);
    }
    free(folder);
    return status;
}

/* A file, by the one name that it has without links: there or not. To be freed, or NULL. */
static char *place_of(const char *path)
{
    char *file = refocus_file_place(path), *folder = NULL, *place = NULL;
    char *slash = file ? strrchr(file, '/') : NULL;
    const char *base = slash ? slash + 1 : file;

    if (slash)
        *slash = '\0';
    if (file)
        folder = realpath(!slash ? "." : slash == file ? "/" : file, NULL);
    if (folder && (place = malloc(strlen(folder) + strlen(base) + 2)) != NULL)
        strcat(strcat(strcpy(place, folder), "/"), base);
    free(folder);
    free(file);
    return place;
}

struct place {
    char *path;
    int index;
};

static int compare(const void *a, const void *b)
{
    const struct place *one = a, *other = b;
    const int order = strcmp(one->path, other->path);

    return order ? order : one->index - other->index;
}

static int compare_paths(const void *path, const void *place)
{
    return strcmp(path, ((const struct place *)place)->path);
}

static int check_input(const struct place *places, const struct many *many, const char *input)
{
    char *path = input ? realpath(input, NULL) : NULL;
    const struct place *found =
        path ? bsearch(path, places, (size_t)many->count, sizeof *places, compare_paths) : NULL;

    free(path);
    if (!found)
        return EXIT_DONE;
    return report_failure(EXIT_WRONG, many->photos[found->index].output,
                          "it is an input too and would be lost; give another name");
}

static int check_places(struct place *places, const struct many *many)
{
    int status = EXIT_DONE;

    qsort(places, (size_t)many->count, sizeof *places, compare);
    for (int i = 1; i < many->count; i++)
        if (strcmp(places[i - 1].path, places[i].path) == 0)
            return report_failure(EXIT_WRONG, many->photos[places[i].index].output,
                                  "%s and %s would both be written there; give a name with {n}",
                                  many->photos[places[i - 1].index].photo,
                                  many->photos[places[i].index].photo);
    for (int i = 0; i < many->count && status == EXIT_DONE; i++) {
        status = check_input(places, many, many->photos[i].photo);
        if (status == EXIT_DONE)
            status = check_input(places, many, many->photos[i].depth);
        if (status == EXIT_DONE)
            status = check_input(places, many, many->photos[i].matte);
    }
    return status;
}

int many_check(const struct many *many)
{
    struct place *places;
    int status = EXIT_DONE, count;

    if (many->count < 2)
        return EXIT_DONE; /* output_check() has looked at it */
    places = calloc((size_t)many->count, sizeof *places);
    for (count = 0; places && count < many->count; count++) {
        places[count].index = count;
        places[count].path = place_of(many->photos[count].output);
        if (!places[count].path)
            break;
    }
    if (!places || count < many->count)
        status = report_failure(EXIT_FAILED, "-o", "not enough memory");
    else
        status = check_places(places, many);
    for (int i = 0; places && i < count; i++)
        free(places[i].path);
    free(places);
    return status;
}

void many_free(struct many *many)
{
    for (int i = 0; many->photos && i < many->count; i++) {
        free(many->photos[i].output);
        free(many->photos[i].depth);
        free(many->photos[i].matte);
    }
    free(many->photos);
}
