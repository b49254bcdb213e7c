/* fuzz_resize.c: sizes of --resize: those that are taken are sizes, and never enlarge a picture. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "outputs/resize.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const int sides[] = {1, 2, 1000, 65535};
    char *text = malloc(size + 1);
    struct resize asked;

    if (!text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    if (resize_parse(text, &asked)) {
        if (!(asked.part > 0 ? asked.part <= 1 : asked.width > 0))
            abort();
        for (int i = 0; i < 16; i++) {
            int width, height;

            resize_fit(&asked, sides[i / 4], sides[i % 4], &width, &height);
            if (width < 1 || width > sides[i / 4] || height < 1 || height > sides[i % 4])
                abort();
            if (asked.width > 0 && width > asked.width)
                abort();
        }
    }
    free(text);
    return 0;
}
