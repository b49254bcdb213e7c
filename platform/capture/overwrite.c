/* overwrite.c: whether a sink would write over a file that is read. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <refocus/platform/sink.h>
#include "pattern.h"
#include "replay.h"

/* Files that are there, whatever the names that led to them. */
struct files {
    struct rf_place {
        dev_t device;
        ino_t number;
    } * place;
    size_t count, room;
    bool lacks_memory;
};

static void add(struct files *files, const char *path)
{
    struct stat found;

    if (stat(path, &found) != 0 || !S_ISREG(found.st_mode))
        return;
    if (files->count == files->room) {
        const size_t room = 2 * files->room + 8;
        struct rf_place *const place = realloc(files->place, room * sizeof *place);

        if (!place) {
            files->lacks_memory = true;
            return;
        }
        files->place = place;
        files->room = room;
    }
    files->place[files->count++] = (struct rf_place){found.st_dev, found.st_ino};
}

static void add_numbered(void *files, const char *path, int n)
{
    (void)n;
    add(files, path);
}

static void add_pattern(struct files *files, const char *pattern)
{
    files->lacks_memory |= !rf_pattern_each(pattern, add_numbered, files);
}

static void add_pictures(struct files *files, const char *name)
{
    if (rf_pattern_check(name) == 1)
        add_pattern(files, name);
    else
        add(files, name);
}

/* A name with up to so many words behind commas, any of which may be part of the name instead. */
static void add_raw(struct files *files, const char *name, int most_words)
{
    char *const path = strdup(name);

    files->lacks_memory |= !path;
    for (char *comma = path; comma && most_words >= 0; most_words--) {
        add(files, path);
        comma = strrchr(path, ',');
        if (comma)
            *comma = '\0';
    }
    free(path);
}

static bool is_of_kind(const char **name, const char *kind)
{
    const size_t length = strlen(kind);
    const bool is = strncmp(*name, kind, length) == 0;

    *name += is ? length : 0;
    return is;
}

/* The files that any source but a script reads, or the file of that name. */
static void add_plain(struct files *files, const char *name)
{
    if (is_of_kind(&name, "raw:"))
        add_raw(files, name, 3);
    else if (is_of_kind(&name, "file:"))
        add_pictures(files, name);
    else {
        is_of_kind(&name, "y4m:");
        add(files, name);
    }
}

static void add_script(struct files *files, const char *rest)
{
    const size_t before = files->count;
    struct refocus_reason unheard;
    struct rf_script script = {0};

    if (*rest != ':')
        add(files, rest);
    if (*rest != ':' && files->count == before)
        return; /* The source would miss what is read from a pipe here. */
    files->lacks_memory |= rf_replay_read_script(&script, rest, &unheard) == REFOCUS_ERR_MEMORY;
    if (script.from)
        add_plain(files, script.from);
    if (script.jpeg)
        add(files, script.jpeg);
    if (script.stack)
        add_pictures(files, script.stack);
    rf_script_free(&script);
}

static void add_source(struct files *files, const char *name)
{
    if (is_of_kind(&name, "replay:"))
        add_script(files, name);
    else
        add_plain(files, name);
}

static void add_sink(struct files *files, const char *name)
{
    if (is_of_kind(&name, "raw:"))
        add_raw(files, name, 1);
    else if (is_of_kind(&name, "y4m:"))
        add(files, name);
    else if (rf_pattern_check(name) == 1 && !is_of_kind(&name, "v4l2:") &&
             !is_of_kind(&name, "pipewire:"))
        add_pattern(files, name);
}

static int compare(const void *a, const void *b)
{
    const struct rf_place *const p = a, *const q = b;

    if (p->device != q->device)
        return p->device < q->device ? -1 : 1;
    return p->number == q->number ? 0 : p->number < q->number ? -1 : 1;
}

int refocus_sink_overwrites(const char *sink, const char *input)
{
    struct files in = {0}, out = {0};
    int answer = 0;

    if (sink && input) {
        add_sink(&out, sink);
        add_source(&in, input);
    }
    if (in.count > 0)
        qsort(in.place, in.count, sizeof *in.place, compare);
    for (size_t i = 0; i < out.count && in.count > 0 && !answer; i++)
        answer = bsearch(&out.place[i], in.place, in.count, sizeof *in.place, compare) != NULL;
    if (!answer && (in.lacks_memory || out.lacks_memory))
        answer = REFOCUS_ERR_MEMORY;
    free(in.place);
    free(out.place);
    return answer;
}
