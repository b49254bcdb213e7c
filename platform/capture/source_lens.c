/* source_lens.c: the lens and the exposure of a source: checks that are the same for every kind. */
#include "backend.h"

static const size_t lens_first = REFOCUS_SIZE_TO(struct refocus_source_lens, position);

int refocus_source_get_lens(struct refocus_source *source, struct refocus_source_lens *lens,
                            struct refocus_reason *reason)
{
    struct refocus_source_lens own = refocus_source_lens_default();
    struct refocus_reason unheard;
    int status = REFOCUS_OK;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!source || refocus_struct_write(lens, lens_first, &own, sizeof own))
        return REFOCUS_ERR_ARGUMENT;
    if (source->ops->get_lens)
        status = source->ops->get_lens(source, &own, reason);
    if (status == REFOCUS_OK)
        refocus_struct_write(lens, lens_first, &own, sizeof own);
    return status;
}

int refocus_source_set_focus(struct refocus_source *source, uint32_t mode, double position,
                             struct refocus_reason *reason)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    struct refocus_reason unheard;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!source || mode >= REFOCUS_SOURCE_FOCUS_COUNT)
        return REFOCUS_ERR_ARGUMENT;
    status = refocus_source_get_lens(source, &lens, reason);
    if (status != REFOCUS_OK)
        return status;
    if (!(lens.modes >> mode & 1) || !source->ops->set_focus)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               lens.modes ? "its lens cannot be focused in that way"
                                          : "its lens does not move");
    if (mode == REFOCUS_SOURCE_FOCUS_FIXED &&
        !(position >= lens.least && position <= lens.greatest))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "%g is no position of its lens; give %g to %g", position, lens.least,
                               lens.greatest);
    status = source->ops->set_focus(source, mode, position, reason);
    if (status == REFOCUS_OK) {
        source->focused = true;
        source->focus_mode = mode;
        source->focus_position = position;
    }
    return status;
}

int refocus_source_lock_exposure(struct refocus_source *source, int lock,
                                 struct refocus_reason *reason)
{
    struct refocus_reason unheard;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!source)
        return REFOCUS_ERR_ARGUMENT;
    if (!source->ops->lock_exposure)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "sources of the kind '%s' have no exposure", source->ops->scheme);
    return source->ops->lock_exposure(source, lock != 0, reason);
}
