/* live_inputs.c: an output that would be written over an input is refused before either is opened.
 */
#include <refocus/platform/sink.h>
#include "line/report.h"
#include "live/live_inputs.h"

int live_check_inputs(const struct live_settings *settings)
{
    const char *const inputs[] = {settings->camera,
                                  settings->depth.file,
                                  settings->estimate.model,
                                  settings->calibration,
                                  settings->engine.aperture,
                                  settings->engine.papers.field_map,
                                  settings->engine.controls.focus_map,
                                  settings->engine.controls.sharp_mask};

    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        const int answer = refocus_sink_overwrites(settings->out, inputs[i]);

        if (answer < 0)
            return report_failure(EXIT_FAILED, settings->out, "%s", refocus_strerror(answer));
        if (answer)
            return report_failure(EXIT_WRONG, settings->out,
                                  "it is an input too and would be lost; give another name");
    }
    return EXIT_DONE;
}
