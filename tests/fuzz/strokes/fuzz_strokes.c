/* fuzz_strokes.c: a file of strokes over a small photo: what is taken is written, read again and
 * the same. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/platform/strokes.h>

enum { W = 40, H = 30, MANY = 1 << 14 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void must(int holds)
{
    if (!holds)
        abort();
}

static int points_of(const struct refocus_strokes *strokes)
{
    int sum = 0, count;

    for (int i = 0; i < refocus_strokes_count(strokes); i++) {
        refocus_strokes_get(strokes, i, NULL, NULL, &count);
        sum += count;
    }
    return sum;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint8_t pixels[3 * W * H];
    static bool is_drawn;
    struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
    struct refocus_strokes *strokes, *again;
    struct refocus_strokes_reason reason;
    char *text;

    if (size > MANY)
        return 0;
    for (int i = 0; !is_drawn && i < 3 * W * H; i++)
        pixels[i] = (uint8_t)(i / 3 % W > 15 ? i * 7 : 200 - i % 5);
    is_drawn = true;
    must(refocus_strokes_create(&strokes, &photo, NULL) == REFOCUS_OK);
    must(refocus_strokes_create(&again, &photo, NULL) == REFOCUS_OK);
    if (refocus_strokes_load(strokes, data, size, &reason) == REFOCUS_OK) {
        must(!reason.text[0]);
        must(refocus_strokes_save(strokes, &text, &size) == REFOCUS_OK);
        must(refocus_strokes_load(again, text, size, &reason) == REFOCUS_OK);
        must(refocus_strokes_count(strokes) == refocus_strokes_count(again));
        must(points_of(strokes) == points_of(again));
        must(!memcmp(refocus_strokes_disparity(strokes), refocus_strokes_disparity(again),
                     2 * W * H));
        free(text);
        while (refocus_strokes_count(strokes) > 0)
            must(refocus_strokes_undo(strokes, NULL) == REFOCUS_OK);
        for (int i = 0; i < W * H; i++)
            must(refocus_strokes_disparity(strokes)[i] == 0);
    } else {
        must(reason.text[0] && refocus_strokes_count(strokes) == 0);
    }
    refocus_strokes_destroy(&strokes);
    refocus_strokes_destroy(&again);
    return 0;
}
