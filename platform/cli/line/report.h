/* report.h: everything that the command prints: errors, progress, times and JSON. */
#ifndef RF_CLI_REPORT_H
#define RF_CLI_REPORT_H

#include <stdbool.h>
#include <stdint.h>
#include <jansson.h>
#include <refocus/depth.h>
#include <refocus/platform/file.h>

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_WRONG = 2 };

/* Print "refocus: WHAT: WHY" on one line of standard error; returns exit_code. A name in WHY that
 * stands in WHAT already is left out. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int report_failure(int exit_code, const char *what, const char *why, ...);

/* The words for work that a signal has ended. Between report_cut() of what it is for and of NULL
 * the process may end with them at any time: see interrupt_cut(). One thread of the process calls
 * it. */
#define REPORT_INTERRUPTED "interrupted; nothing was written"
void report_cut(const char *what);

/* Report work that is done, but not quite as it was asked for. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void report_warning(const char *what, const char *why, ...);

/* Called after the last output on standard output: EXIT_DONE, or EXIT_FAILED when it was lost. */
int report_end_output(void);

/* A bar on standard error, when that is a terminal: what is being done, and how much of
 * the whole, 0 to 1, is behind. report_failure() and report_progress_end() wipe it. */
void report_progress(const char *doing, double done);
void report_progress_end(void);
bool report_is_watched(void); /* whether there is such a terminal */

/* Called in a process that works on one photo of several: lines on standard error begin with its
 * name, and the bar, which another process shows, is wiped before each. */
void report_about(const char *name);

/* Called in a process that answers others: the words of the last failure, WHAT: WHY, are kept there
 * instead, and nothing else is printed. */
void report_keep(char *text, size_t size);

/* Milliseconds of a clock that only moves forwards. */
double report_clock_ms(void);

/* Milliseconds of processor time that this process has taken, all threads together. */
double report_cpu_ms(void);

/* Processors that may be used. */
int report_processors(void);

/* The most memory this process has held. */
int64_t report_peak_rss_kib(void);

/* Least, median and greatest of count >= 1 values, which are sorted by it. */
struct spread {
    double min, median, max;
};
struct spread report_spread(double *values, int count);
json_t *report_spread_json(struct spread spread);

/* JSON of values that JSON has no words for: NAN and 0 metres are null, infinity is the
 * text "infinity"; bytes that are not printable ASCII or UTF-8 become '?'. */
json_t *report_number_json(double value);
json_t *report_metres_json(double metres);
json_t *report_text_json(const char *text);

/* WHY without WHAT and a colon before it, or without the name that follows on the kind of a source
 * or sink in WHAT: "cut.y4m: it ends" of "y4m:cut.y4m" is "it ends". */
const char *report_without_name(const char *what, const char *why);

/* Text with control characters replaced, cut to the size. */
void report_clean(char *clean, size_t size, const char *text);

/* The words of --json for what a depth map is. */
json_t *report_depth_json(const struct refocus_photo *from,
                          const struct refocus_depth_report *report);
const char *report_depth_source(uint32_t source);

/* Print an object, or say that there was no memory for it; frees it. Returns an exit
 * code. */
int report_print_json(json_t *object);

#endif
