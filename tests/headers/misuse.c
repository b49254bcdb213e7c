/* misuse.c: every public function with every kind of argument that it must not take: an error
 * or, where there is no status, nothing; never a crash. Headers are searched for functions that
 * no call names, so that a new one needs its lines here. Those of capture have a
 * test of their own, whose text has to call them. */
#include "misuse.h"

#include <dirent.h>

static struct {
    const char *function, *arguments, *spoilt;
    const char *covered[256];
    size_t count;
    int groups, done; /* groups of calls that have begun, and that have come to their end */
} now;

void misuse_calling(const char *function, const char *arguments)
{
    now.function = function;
    now.arguments = arguments;
    for (size_t i = 0; i < now.count; i++)
        if (strcmp(now.covered[i], function) == 0)
            return;
    assert_true(now.count < COUNT(now.covered));
    now.covered[now.count++] = function;
}

static const char *spoilt(void)
{
    return now.spoilt ? now.spoilt : "";
}

void misuse_status(int status, int expected)
{
    if (status != expected)
        fail_msg("%s(%s) %s: %d (%s), not %d (%s)", now.function, now.arguments, spoilt(), status,
                 refocus_strerror(status), expected, refocus_strerror(expected));
    now.function = NULL;
}

void misuse_number(double value, double expected)
{
    if (isnan(expected) ? !isnan(value) : !(value == expected))
        fail_msg("%s(%s) %s: %g, not %g", now.function, now.arguments, spoilt(), value, expected);
    now.function = NULL;
}

void misuse_pointer(const void *pointer, int expected)
{
    if (!pointer != !expected)
        fail_msg("%s(%s) %s: %p", now.function, now.arguments, spoilt(), pointer);
    now.function = NULL;
}

void misuse_done(void)
{
    now.function = NULL;
    now.done++;
}

void misuse_spoil(void *params, const struct misuse *bad)
{
    now.spoilt = bad ? bad->what : NULL;
    if (bad)
        memcpy((char *)params + bad->offset, bad->value, bad->size);
}

struct refocus_image misuse_photo(void)
{
    static uint8_t pixels[4 * W * H];

    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(37 * i % 251);
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
}

struct refocus_disparity misuse_map(void)
{
    static uint16_t samples[W * H];

    for (size_t i = 0; i < W * H; i++)
        samples[i] = (uint16_t)(i % W < W / 2 ? 60000 : 9000);
    return refocus_disparity16(samples, W, H, 2 * W);
}

/* Neither a side nor a count of anything. */
#define SIDES(type, field)                                                                         \
    BAD(type, field, 0), BAD(type, field, -1), BAD(type, field, INT32_MIN),                        \
        BAD(type, field, INT32_MAX), BAD(type, field, REFOCUS_MAX_SIDE + 1)
/* Even, but for 3 and 4 bytes a pixel too little or, times the rows, too much. */
#define STRIDES(type, field)                                                                       \
    BAD(type, field, 0), BAD(type, field, 2), BAD(type, field, -2), BAD(type, field, PTRDIFF_MIN), \
        BAD(type, field, PTRDIFF_MIN + 2), BAD(type, field, PTRDIFF_MIN / 2),                      \
        BAD(type, field, PTRDIFF_MAX - 1), BAD(type, field, PTRDIFF_MAX / 2 - 1),                  \
        BAD(type, field, PTRDIFF_MAX / H / 2 * 2 + 2),                                             \
        BAD(type, field, -(PTRDIFF_MAX / H / 2 * 2 + 2))

void misuse_images(void (*use)(const struct refocus_image *image))
{
    const struct misuse bad[] = {
        BAD(refocus_image, struct_size, 0),
        BAD(refocus_image, struct_size, REFOCUS_SIZE_TO(struct refocus_image, range) - 4),
        BAD(refocus_image, struct_size, REFOCUS_MAX_STRUCT_SIZE + 1),
        BAD(refocus_image, format, REFOCUS_FORMAT_NONE),
        BAD(refocus_image, format, 99),
        BAD(refocus_image, format, UINT32_MAX),
        SIDES(refocus_image, width),
        SIDES(refocus_image, height),
        BAD(refocus_image, plane[0], NULL),
        STRIDES(refocus_image, stride[0]),
        BAD(refocus_image, stride[0], 3 * W - 1),
        BAD(refocus_image, stride[0], 1 - 3 * W),
        BAD(refocus_image, stride[0], PTRDIFF_MAX)};

    use(NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_image image = misuse_photo();

        misuse_spoil(&image, &bad[i]);
        use(&image);
    }
    misuse_spoil(NULL, NULL);
}

void misuse_maps(void (*use)(const struct refocus_disparity *map))
{
    const struct misuse bad[] = {
        BAD(refocus_disparity, struct_size, 0),
        BAD(refocus_disparity, struct_size, sizeof(struct refocus_disparity) - 4),
        BAD(refocus_disparity, struct_size, UINT32_MAX),
        BAD(refocus_disparity, bits, 0),
        BAD(refocus_disparity, bits, 32),
        BAD(refocus_disparity, bits, UINT32_MAX),
        SIDES(refocus_disparity, width),
        SIDES(refocus_disparity, height),
        BAD(refocus_disparity, samples, NULL),
        STRIDES(refocus_disparity, stride),
        BAD(refocus_disparity, stride, 2 * W - 2),
        BAD(refocus_disparity, stride, 2 - 2 * W)};

    use(NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_disparity map = misuse_map();

        misuse_spoil(&map, &bad[i]);
        use(&map);
    }
    misuse_spoil(NULL, NULL);
}

void misuse_strides(void (*use)(ptrdiff_t stride), ptrdiff_t bytes)
{
    struct whole {
        ptrdiff_t stride;
    } whole;
    const struct misuse bad[] = {STRIDES(whole, stride), BAD(whole, stride, bytes - 2),
                                 BAD(whole, stride, 2 - bytes)};

    for (size_t i = 0; i < COUNT(bad); i++) {
        misuse_spoil(&whole, &bad[i]);
        use(whole.stride);
    }
    misuse_spoil(NULL, NULL);
}

/* Says where it was when a call does not come back. */
static int tear_down(void **state)
{
    (void)state;
    if (now.function)
        print_error("in %s(%s) %s\n", now.function, now.arguments, spoilt());
    misuse_spoil(NULL, NULL);
    now.function = NULL;
    now.groups++;
    return 0;
}

static char *read_text(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = calloc(1, 1 << 20);
    size_t size;

    assert_non_null(text);
    if (!file)
        fail_msg("cannot open %s", path);
    size = fread(text, 1, (1 << 20) - 1, file);
    assert_true(size > 0 && feof(file));
    fclose(file);
    return text;
}

static char *read_below(const char *folder, const char *name)
{
    char path[8192];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    return read_text(path);
}

static int is_covered(const char *name)
{
    for (size_t i = 0; i < now.count; i++)
        if (strcmp(now.covered[i], name) == 0)
            return 1;
    return 0;
}

/* Whether the text of a test calls a function. */
static int is_called(const char *text, const char *name)
{
    for (const char *at = text; (at = strstr(at, name)); at++)
        if (at[strlen(name)] == '(')
            return 1;
    return 0;
}

/* The names before the first ( after each `opening`: functions that are declared there. */
static int count_missing(const char *path, const char *text, const char *opening, const char *test,
                         int *functions)
{
    int missing = 0;

    for (const char *at = text; (at = strstr(at, opening)); at++) {
        const char *const end = strchr(at, '('), *name = end;
        char word[128];

        while (name && name > at &&
               (name[-1] == '_' || (name[-1] >= 'a' && name[-1] <= 'z') ||
                (name[-1] >= '0' && name[-1] <= '9')))
            name--;
        if (!name || strncmp(name, "refocus_", 8) != 0)
            continue; /* the macro's own definition */
        *functions += !test;
        snprintf(word, sizeof word, "%.*s", (int)(end - name), name);
        if (test ? !is_called(test, word) : !is_covered(word)) {
            print_error("%s: %s() has no bad arguments in its test\n", path, word);
            missing++;
        }
    }
    return missing;
}

static int is_of_capture(const char *name)
{
    return strcmp(name, "convert.h") == 0 || strcmp(name, "sink.h") == 0 ||
           strcmp(name, "source.h") == 0;
}

static int is_built(const char *name)
{
#ifndef RF_HAVE_OPENCV
    if (strcmp(name, "opencv.h") == 0)
        return 0;
#endif
    (void)name;
    return 1;
}

static void every_function_is_here(void **state)
{
    static const char *const folders[] = {"include/refocus", "include/refocus/platform"};
    const char *const root = getenv("REFOCUS_SOURCE_ROOT");
    int functions = 0, missing = 0;
    char *capture;

    (void)state;
    assert_non_null(root);
    capture = read_below(root, "tests/platform/capture/test_misuse.c");
    assert_int_equal(now.done, now.groups); /* else what they left out would be named, too */
    for (size_t i = 0; i < COUNT(folders); i++) {
        char path[4096];
        const struct dirent *entry;
        DIR *folder;

        snprintf(path, sizeof path, "%s/%s", root, folders[i]);
        folder = opendir(path);
        assert_non_null(folder);
        while ((entry = readdir(folder))) {
            const char *const dot = strrchr(entry->d_name, '.');
            const char *const test = is_of_capture(entry->d_name) ? capture : NULL;
            char *text;

            if (!dot || strcmp(dot, ".h") != 0 || !is_built(entry->d_name))
                continue;
            text = read_below(path, entry->d_name);
            missing += count_missing(entry->d_name, text, "REFOCUS_API ", test, &functions);
            missing += count_missing(entry->d_name, text, "static inline ", test, &functions);
            free(text);
        }
        closedir(folder);
    }
    free(capture);
    print_message("%d public functions\n", functions);
    assert_int_equal(missing, 0);
    assert_int_equal(functions, now.count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(misuse_core, tear_down),
        cmocka_unit_test_teardown(misuse_depth, tear_down),
        cmocka_unit_test_teardown(misuse_render, tear_down),
        cmocka_unit_test_teardown(misuse_files, tear_down),
        cmocka_unit_test_teardown(misuse_strokes, tear_down),
#ifdef RF_HAVE_OPENCV
        cmocka_unit_test_teardown(misuse_opencv, tear_down),
#endif
        cmocka_unit_test(every_function_is_here),
    };

    return cmocka_run_group_tests_name("misuse", tests, NULL, NULL);
}
