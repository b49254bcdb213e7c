/* stack_lens.c: the lens of a camera is moved to the positions of a focus stack.
 *
 * Time is that of the frames' own stamps, so a scripted camera takes none. The lens has arrived
 * when the position that it reports is the one asked for, or when it has not changed for a second;
 * a lens that reports nothing has arrived after the time to settle.
 */
#include "commands/stack_lens.h"
#include <math.h>
#include "inputs/read_input.h"
#include "line/report.h"

enum {
    WAIT_MS = 3000,     /* for a frame */
    RESTING_MS = 1000,  /* a lens that has not moved for so long has stopped */
    LONGEST_MS = 20000, /* for one position */
    MOST_BROKEN = 100,  /* frames in a row */
};

int shots_fail(const struct shots *shots, int status, const struct refocus_reason *reason)
{
    if (status == REFOCUS_ERR_CANCELLED && shots->ends_quietly)
        return EXIT_FAILED;
    if (status == REFOCUS_ERR_CANCELLED)
        return report_failure(EXIT_FAILED, shots->settings->camera, REPORT_INTERRUPTED);
    return report_failure(input_exit_code(status), shots->settings->camera, "%s",
                          reason->text[0] ? reason->text : refocus_strerror(status));
}

int shots_next_frame(struct shots *shots, const struct refocus_frame **frame)
{
    struct refocus_reason reason = {""};

    for (int i = 0; i < MOST_BROKEN; i++) {
        const int status = refocus_source_wait(shots->source, WAIT_MS, frame, &reason);

        if (status != REFOCUS_OK)
            return shots_fail(shots, status, &reason);
        if (!((*frame)->flags & REFOCUS_FRAME_CORRUPT))
            return EXIT_DONE;
        refocus_source_release(shots->source, *frame);
    }
    return report_failure(EXIT_FAILED, shots->settings->camera, "all of its frames are damaged");
}

/* The time of the next frame in milliseconds; the frame itself is not wanted. */
static int pass_frame(struct shots *shots, double *ms)
{
    const struct refocus_frame *frame;
    const int status = shots_next_frame(shots, &frame);

    if (status == EXIT_DONE) {
        *ms = (double)frame->timestamp_ns * 1e-6;
        refocus_source_release(shots->source, frame);
    }
    return status;
}

int shots_pass_time(struct shots *shots, double ms)
{
    double first, now;
    int status = pass_frame(shots, &first);

    for (now = first; status == EXIT_DONE && now >= first && now < first + ms;)
        status = pass_frame(shots, &now);
    return status;
}

int shots_focus(struct shots *shots, double position)
{
    struct refocus_reason reason = {""};
    const int status =
        refocus_source_set_focus(shots->source, REFOCUS_SOURCE_FOCUS_FIXED, position, &reason);

    return status == REFOCUS_OK ? EXIT_DONE : shots_fail(shots, status, &reason);
}

/* Frames pass until the lens is there, or stays elsewhere; *position receives what it reports. */
static int arrive(struct shots *shots, double asked, double near_by, double *position)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    struct refocus_reason reason = {""};
    double began, now, mark = NAN, marked;
    int status = pass_frame(shots, &began);

    for (now = marked = began; status == EXIT_DONE; status = pass_frame(shots, &now)) {
        const int got = refocus_source_get_lens(shots->source, &lens, &reason);

        if (got != REFOCUS_OK)
            return shots_fail(shots, got, &reason);
        *position = lens.position;
        if (isnan(lens.position) || fabs(lens.position - asked) <= near_by)
            return EXIT_DONE;
        if (!(fabs(lens.position - mark) <= 0.2 * near_by)) {
            mark = lens.position;
            marked = now;
        }
        if (now - marked >= RESTING_MS || now < began)
            return EXIT_DONE;
        if (now - began >= LONGEST_MS)
            return report_failure(EXIT_FAILED, shots->settings->camera,
                                  "its lens has not come to rest within %d s", LONGEST_MS / 1000);
    }
    return status;
}

double shots_step(const struct shots *shots)
{
    return (shots->asked[shots->count - 1] - shots->asked[0]) / (shots->count - 1);
}

int shots_move_lens(struct shots *shots, int k)
{
    const double step = shots_step(shots);
    double position = NAN;
    int status = shots_focus(shots, shots->asked[k]);

    if (status == EXIT_DONE)
        status = arrive(shots, shots->asked[k], 0.1 * step, &position);
    if (status == EXIT_DONE)
        status = shots_pass_time(shots, shots->settings->settle);
    if (status != EXIT_DONE)
        return status;
    shots->reported[k] = isnan(position) ? shots->asked[k] : position;
    if (k > 0 && shots->reported[k] < shots->reported[k - 1] + 0.25 * step)
        return report_failure(EXIT_FAILED, shots->settings->camera,
                              "its lens stays at %g where %g was asked for; give a --range that it "
                              "can reach",
                              shots->reported[k], shots->asked[k]);
    return EXIT_DONE;
}

int shots_rest(struct shots *shots, int k)
{
    double position;
    int status = shots_focus(shots, shots->asked[k]);

    if (status == EXIT_DONE)
        status = arrive(shots, shots->asked[k], 0.1 * shots_step(shots), &position);
    return status == EXIT_DONE ? shots_pass_time(shots, shots->settings->settle) : status;
}
