/* test_damage.c: every sample cut at every byte and with every byte changed: an error or a whole
 * photo, never a crash. The copies end where the memory ends, for the sanitizers to see. */
#include "check.h"
#include "samples.h"

static int read_exact(const uint8_t *bytes, size_t size, bool depth, struct refocus_reason *reason)
{
    uint8_t *const copy = malloc(size ? size : 1);
    struct refocus_photo *photo = (struct refocus_photo *)1;
    int status;

    memcpy(copy, bytes, size);
    status = depth ? refocus_depth_read_memory(&photo, copy, size, NULL, 0, 0, NULL, reason)
                   : refocus_photo_read_memory(&photo, copy, size, NULL, reason);
    free(copy);
    if ((status == REFOCUS_OK) != (photo != NULL) ||
        (status != REFOCUS_OK && reason->text[0] == '\0'))
        fail_msg("status %d does not go with the photo or its words", status);
    refocus_photo_free(&photo);
    return status;
}

TEST(whole_samples_are_read)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);
    struct refocus_reason reason;

    assert_true(count >= 7);
    for (int i = 0; i < count; i++) {
        const struct bytes *const b = &samples[i].bytes;
        const int photo = read_exact(b->data, b->size, false, &reason);
        const int depth = read_exact(b->data, b->size, true, &reason);
        if ((photo == REFOCUS_OK) != samples[i].photo || (depth == REFOCUS_OK) != samples[i].depth)
            fail_msg("%s: %d %d %s", samples[i].name, photo, depth, reason.text);
    }
    free_samples(samples, count);
}

TEST(cut_at_every_byte)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);
    struct refocus_reason reason;

    for (int i = 0; i < count; i++) {
        const struct sample *const s = &samples[i];
        for (size_t size = 0; size < s->bytes.size; size++) {
            for (int depth = 0; depth < 2; depth++) {
                const int status = read_exact(s->bytes.data, size, depth, &reason);
                if (status == REFOCUS_OK && size != s->whole_at && !s->loose_end)
                    fail_msg("%s cut at %zu is read as if whole", s->name, size);
            }
        }
    }
    free_samples(samples, count);
}

TEST(every_byte_changed)
{
    static const uint8_t changes[] = {0x01, 0x80, 0xff};
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);
    struct refocus_reason reason;

    for (int i = 0; i < count; i++) {
        struct bytes *const b = &samples[i].bytes;
        for (size_t at = 0; at < b->size; at++) {
            for (size_t k = 0; k < sizeof changes; k++) {
                b->data[at] ^= changes[k];
                read_exact(b->data, b->size, at % 2, &reason);
                b->data[at] ^= changes[k];
            }
        }
    }
    free_samples(samples, count);
}

TEST(limits_of_parts)
{
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);
    const struct refocus_read_limits limits = {.struct_size = sizeof(struct refocus_read_limits),
                                               .max_pixels = 1};

    for (int i = 0; i < count; i++) {
        struct refocus_reason reason;
        struct refocus_photo *photo;
        const int status = refocus_photo_read_memory(&photo, samples[i].bytes.data,
                                                     samples[i].bytes.size, &limits, &reason);
        const int small = strcmp(samples[i].name, "p3.ppm") == 0;

        if (samples[i].photo)
            assert_int_equal(status, small ? REFOCUS_OK : REFOCUS_ERR_SIZE);
        refocus_photo_free(&photo);
    }
    free_samples(samples, count);
}

#ifdef RF_HAVE_JPEG
/* The size in a JPEG's frame header. */
static struct bytes jpeg_of_size(unsigned width, unsigned height)
{
    struct bytes jpeg = make_jpeg(16, 16, false, false);

    for (size_t i = 0; i + 9 < jpeg.size; i++) {
        if (jpeg.data[i] == 0xff && jpeg.data[i + 1] == 0xc0) {
            jpeg.data[i + 5] = (uint8_t)(height >> 8);
            jpeg.data[i + 6] = (uint8_t)height;
            jpeg.data[i + 7] = (uint8_t)(width >> 8);
            jpeg.data[i + 8] = (uint8_t)width;
        }
    }
    return jpeg;
}

TEST(jpeg_absurd)
{
    read_photo(jpeg_of_size(65500, 65500), REFOCUS_ERR_SIZE);
    read_photo(jpeg_of_size(32000, 4000), REFOCUS_ERR_FORMAT);
    read_photo(jpeg_of_size(0, 16), REFOCUS_ERR_FORMAT);
    read_photo(jpeg_of_size(16, 17), REFOCUS_ERR_FORMAT);
}
#endif
