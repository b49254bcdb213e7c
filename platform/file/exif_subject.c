/* exif_subject.c: the middle of the subject that EXIF says becomes the focus point. EXIF counts it
 * in pixels of the picture as the camera stored it. Programs that turn a picture, cut or shrink it
 * may leave it as it was. */
#include "exif_subject.h"

#include <math.h>

#include "orient.h"
#include "reason.h"

/* Two to four numbers, of which the first two are the middle of the subject in pixels. */
static bool is_area(const struct rf_tiff_entry *entry)
{
    return entry->type == RF_TIFF_SHORT && entry->count >= 2 && entry->count <= 4;
}

void rf_subject_read(const struct rf_tiff *tiff, const struct rf_tiff_entry *area,
                     const struct rf_tiff_entry *width, const struct rf_tiff_entry *height,
                     struct rf_subject *subject)
{
    uint32_t x, y;

    if (width->count != 1 || height->count != 1)
        return;
    subject->width = rf_tiff_integer(tiff, width, 0);
    subject->height = rf_tiff_integer(tiff, height, 0);
    if (!is_area(area))
        return;
    x = rf_tiff_integer(tiff, area, 0);
    y = rf_tiff_integer(tiff, area, 1);
    if (x < subject->width && y < subject->height) {
        subject->x = (x + 0.5) / subject->width;
        subject->y = (y + 0.5) / subject->height;
    }
}

/* False where the entry cannot be turned. */
static bool turn_entry(struct rf_tiff *tiff, const struct rf_tiff_entry *entry,
                       const struct rf_subject *subject)
{
    const bool on_side = subject->orientation >= 5;
    const uint32_t width = on_side ? subject->height : subject->width;
    const uint32_t height = on_side ? subject->width : subject->height;
    double x, y;

    if (!is_area(entry) || rf_tiff_integer(tiff, entry, 0) >= subject->width ||
        rf_tiff_integer(tiff, entry, 1) >= subject->height || width > UINT16_MAX ||
        height > UINT16_MAX)
        return false;
    x = (rf_tiff_integer(tiff, entry, 0) + 0.5) / subject->width;
    y = (rf_tiff_integer(tiff, entry, 1) + 0.5) / subject->height;
    rf_orient_point(&x, &y, subject->orientation);
    rf_tiff_put16(tiff, entry->value, (uint32_t)(x * width));
    rf_tiff_put16(tiff, entry->value + 2, (uint32_t)(y * height));
    if (on_side && entry->count == 4) { /* the sides of a rectangle */
        const uint32_t wide = rf_tiff_integer(tiff, entry, 2);

        rf_tiff_put16(tiff, entry->value + 4, rf_tiff_integer(tiff, entry, 3));
        rf_tiff_put16(tiff, entry->value + 6, wide);
    }
    return true;
}

void rf_subject_turn(struct rf_tiff *tiff, size_t directory, const struct rf_subject *subject)
{
    static const uint32_t tags[] = {RF_EXIF_SUBJECT_AREA, RF_EXIF_SUBJECT_LOCATION};

    for (int t = 0; t < 2; t++) {
        const int count = rf_tiff_count(tiff, directory);
        bool good = true;

        for (int i = 0; i < count; i++) {
            struct rf_tiff_entry entry;
            const bool whole = rf_tiff_entry(tiff, directory, i, &entry);

            if (entry.tag == tags[t])
                good = good && whole && turn_entry(tiff, &entry, subject);
        }
        if (!good)
            rf_tiff_drop(tiff, directory, tags[t]);
    }
}

/* Whether two pairs of sides are of one shape, but for the rounding of pictures that were scaled:
 * 2 %. */
static bool alike(double width, double height, double other_width, double other_height)
{
    const double one = width * other_height, other = height * other_width;

    return fabs(one - other) <= 0.02 * fmax(one, other);
}

/* The turn from the sides of the point to the upright picture; 0: not known. Phones and programs
 * that turn the pixels may leave sides and point as the sensor has them: 4032 x 3024 and
 * 2398,1575 in a picture of 3024 x 4032 that was held upright is 1448,2398. */
static int turn_of(const struct rf_read *read)
{
    const struct refocus_photo_info *const info = read->info;
    const struct rf_subject *const subject = &read->subject;

    if (alike(subject->width, subject->height, info->stored_width, info->stored_height))
        return info->orientation;
    if (info->orientation != 1 ||
        !alike(subject->width, subject->height, info->stored_height, info->stored_width))
        return 0;
    return subject->orientation >= 5 ? subject->orientation : subject->held;
}

void rf_subject_settle(struct rf_read *read)
{
    struct refocus_photo_info *const info = read->info;
    const struct rf_subject *const subject = &read->subject;
    int turn;

    if (subject->width == 0 || subject->x < 0.0 || info->focus_x >= 0.0)
        return;
    turn = turn_of(read);
    if (turn == 0) {
        rf_note(info,
                "EXIF: a subject area of %u x %u pixels, passed over: the picture was turned "
                "or cut",
                (unsigned)subject->width, (unsigned)subject->height);
        return;
    }
    info->focus_x = subject->x;
    info->focus_y = subject->y;
    rf_orient_point(&info->focus_x, &info->focus_y, turn);
    rf_note(info, "EXIF: the middle of the subject area, %staken for the focus point",
            turn != info->orientation ? "turned as the pixels were, " : "");
}
