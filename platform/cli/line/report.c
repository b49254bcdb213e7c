/* report.c: errors, progress, times and JSON are printed. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>
#include "line/interrupt.h"
#include "line/report.h"

enum { LINE_LENGTH = 1024, BAR_WIDTH = 30 };

static bool bar_shown;
static const char *about; /* the photo of several that this process is for, or NULL */

void report_clean(char *clean, size_t size, const char *text)
{
    size_t i;

    for (i = 0; i + 1 < size && text[i]; i++)
        clean[i] = (unsigned char)text[i] < 32 || text[i] == 127 ? '?' : text[i];
    clean[i] = '\0';
}

const char *report_without_name(const char *what, const char *why)
{
    const char *const end = strstr(why, ": "), *const colon = strchr(what, ':');
    const size_t length = end ? (size_t)(end - why) : 0;
    const char *const names[] = {what, colon ? colon + 1 : what};

    for (int i = 0; i < 2 && length > 0; i++)
        if (strncmp(why, names[i], length) == 0 && (!names[i][length] || names[i][length] == ','))
            return end + 2;
    return why;
}

static char *kept; /* failures go there, or NULL */
static size_t kept_size;

void report_keep(char *text, size_t size)
{
    kept = text;
    kept_size = size;
}

static void keep_line(const char *what, const char *why, va_list list)
{
    char text[LINE_LENGTH], line[2 * LINE_LENGTH];

    vsnprintf(text, sizeof text, why, list);
    snprintf(line, sizeof line, "%s: %s", what, report_without_name(what, text));
    report_clean(kept, kept_size, line);
}

/* Returns the length of the line. */
static int compose(char *line, size_t size, const char *what, const char *text)
{
    const bool other = about && strcmp(about, what) != 0;
    char of[LINE_LENGTH] = "", name[LINE_LENGTH], why[LINE_LENGTH];

    if (other)
        report_clean(of, sizeof of, about);
    report_clean(name, sizeof name, what);
    report_clean(why, sizeof why, report_without_name(what, text));
    return snprintf(line, size, "refocus: %s%s%s: %s\n", of, other ? ": " : "", name, why);
}

static void print_line(const char *what, const char *why, va_list list)
{
    char text[LINE_LENGTH], line[4 * LINE_LENGTH];

    vsnprintf(text, sizeof text, why, list);
    compose(line, sizeof line, what, text);
    report_progress_end();
    fputs(line, stderr);
}

void report_cut(const char *what)
{
    static char line[4 * LINE_LENGTH];
    int begin = 0;

    interrupt_cut(NULL);
    if (!what)
        return;
    if (bar_shown || (about && report_is_watched()))
        begin = snprintf(line, sizeof line, "\r\033[K");
    compose(line + begin, sizeof line - (size_t)begin, what, REPORT_INTERRUPTED);
    interrupt_cut(line);
}

void report_about(const char *name)
{
    about = name;
}

int report_failure(int exit_code, const char *what, const char *why, ...)
{
    va_list list;

    va_start(list, why);
    if (kept)
        keep_line(what, why, list);
    else
        print_line(what, why, list);
    va_end(list);
    return exit_code;
}

void report_warning(const char *what, const char *why, ...)
{
    va_list list;

    if (kept)
        return;
    va_start(list, why);
    print_line(what, why, list);
    va_end(list);
}

int report_end_output(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return EXIT_DONE;
    if (interrupt_ends())
        return EXIT_FAILED;
    return report_failure(EXIT_FAILED, "standard output", "%s; make room for it", strerror(errno));
}

bool report_is_watched(void)
{
    return !kept && isatty(STDERR_FILENO);
}

void report_progress(const char *doing, double done)
{
    const int full = (int)(done * BAR_WIDTH + 0.5);

    if (about || !report_is_watched())
        return;
    fprintf(stderr, "\r[");
    for (int i = 0; i < BAR_WIDTH; i++)
        fputc(i < full ? '#' : '.', stderr);
    fprintf(stderr, "] %3.0f %% %s\033[K", done * 100, doing);
    fflush(stderr);
    bar_shown = true;
}

void report_progress_end(void)
{
    if (bar_shown || (about && report_is_watched()))
        fprintf(stderr, "\r\033[K");
    bar_shown = false;
}

static double read_clock_ms(clockid_t clock)
{
    struct timespec now;

    clock_gettime(clock, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec / 1e6;
}

double report_clock_ms(void)
{
    return read_clock_ms(CLOCK_MONOTONIC);
}

double report_cpu_ms(void)
{
    return read_clock_ms(CLOCK_PROCESS_CPUTIME_ID);
}

int report_processors(void)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);

    return count > 0 && count < 4096 ? (int)count : 1;
}

/* The figure of getrusage() includes the memory of the process that started this one. */
int64_t report_peak_rss_kib(void)
{
    FILE *const facts = fopen("/proc/self/status", "re");
    struct rusage usage;
    char line[256];
    long long peak = 0;

    while (facts && peak == 0 && fgets(line, sizeof line, facts))
        if (strncmp(line, "VmHWM:", 6) == 0)
            peak = strtoll(line + 6, NULL, 10);
    if (facts)
        fclose(facts);
    if (peak > 0)
        return peak;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? usage.ru_maxrss : 0;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct spread report_spread(double *values, int count)
{
    struct spread spread;

    qsort(values, (size_t)count, sizeof *values, compare);
    spread.min = values[0];
    spread.median = (values[(count - 1) / 2] + values[count / 2]) / 2;
    spread.max = values[count - 1];
    return spread;
}

json_t *report_spread_json(struct spread spread)
{
    return json_pack("{s:f, s:f, s:f}", "min", spread.min, "median", spread.median, "max",
                     spread.max);
}

json_t *report_number_json(double value)
{
    if (isnan(value))
        return json_null();
    return isinf(value) ? json_string("infinity") : json_real(value);
}

json_t *report_metres_json(double metres)
{
    return metres > 0 ? report_number_json(metres) : json_null();
}

json_t *report_text_json(const char *text)
{
    char clean[LINE_LENGTH];
    json_t *json;

    report_clean(clean, sizeof clean, text);
    json = json_string(clean);
    if (json)
        return json;
    for (char *c = clean; *c; c++)
        if ((unsigned char)*c >= 128)
            *c = '?';
    return json_string(clean);
}

const char *report_depth_source(uint32_t source)
{
    switch (source) {
    case REFOCUS_DEPTH_SOURCE_GDEPTH:
        return "gdepth";
    case REFOCUS_DEPTH_SOURCE_APPLE_MPF:
        return "apple-mpf";
    case REFOCUS_DEPTH_SOURCE_HEIF:
        return "heif";
    case REFOCUS_DEPTH_SOURCE_FILE:
        return "file";
    case REFOCUS_DEPTH_SOURCE_DYNAMIC:
        return "dynamic-depth";
    case REFOCUS_DEPTH_SOURCE_TRAILER:
        return "trailer";
    }
    return "none";
}

json_t *report_depth_json(const struct refocus_photo *from,
                          const struct refocus_depth_report *report)
{
    const struct refocus_depth_map *map = from->depth;
    const bool disparity = map->meaning == REFOCUS_DEPTH_DISPARITY;
    /* Depth that was made comes from no container, and its way is named there. */
    const char *const source = from->info->depth_source == REFOCUS_DEPTH_SOURCE_NONE
                                   ? from->info->container
                                   : report_depth_source(from->info->depth_source);
    json_t *json =
        json_pack("{s:s, s:i, s:i, s:s, s:o, s:o, s:I, s:I, s:I, s:I}", "source", source, "width",
                  (int)map->width, "height", (int)map->height, "meaning",
                  disparity ? "disparity" : "distance", "near_m",
                  report_metres_json(report->near_m), "far_m", report_metres_json(report->far_m),
                  "unknown", (json_int_t)report->unknown, "clamped", (json_int_t)report->clamped,
                  "specks", (json_int_t)report->specks, "strays", (json_int_t)report->strays);

    if (json && disparity) {
        json_object_set_new(json, "value_near", report_number_json(report->value_near));
        json_object_set_new(json, "value_far", report_number_json(report->value_far));
    }
    return json;
}

int report_print_json(json_t *object)
{
    int status = EXIT_DONE;

    if (!object || json_dumpf(object, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) != 0)
        status = report_failure(EXIT_FAILED, "--json", "the report could not be printed");
    json_decref(object);
    if (status != EXIT_DONE)
        return status;
    putchar('\n');
    return report_end_output();
}
