/* scene.h: reads the scene that instructions are counted of. A file of it is raw: two 32-bit
 * numbers, width and height; RGB, three bytes a pixel; 16-bit disparities. */
#ifndef SCENE_H
#define SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct scene {
    int width, height;
    uint8_t *rgb, *out;
    uint16_t *disparity;
};

/* Brings it to that size by repeating pixels. */
static bool read_scene(struct scene *s, const char *file, int width, int height)
{
    FILE *in = fopen(file, "rb");
    uint32_t size[2] = {0, 0};
    uint8_t *rgb = NULL;
    uint16_t *disparity = NULL;
    size_t pixels = 0;
    bool good =
        in && fread(size, sizeof size, 1, in) == 1 && size[0] - 1 < 65535 && size[1] - 1 < 65535;

    if (good) {
        pixels = (size_t)size[0] * size[1];
        rgb = malloc(3 * pixels);
        disparity = malloc(2 * pixels);
        good = rgb && disparity && fread(rgb, 3, pixels, in) == pixels &&
               fread(disparity, 2, pixels, in) == pixels;
    }
    *s = (struct scene){width, height, malloc((size_t)width * (size_t)height * 3),
                        malloc((size_t)width * (size_t)height * 3),
                        malloc((size_t)width * (size_t)height * 2)};
    good = good && s->rgb && s->out && s->disparity;
    for (int y = 0; good && y < height; y++) {
        for (int x = 0; x < width; x++) {
            const size_t from = (size_t)y * size[1] / (size_t)height * size[0] +
                                (size_t)x * size[0] / (size_t)width;
            const size_t to = (size_t)y * (size_t)width + (size_t)x;

            memcpy(s->rgb + 3 * to, rgb + 3 * from, 3);
            s->disparity[to] = disparity[from];
        }
    }
    free(rgb);
    free(disparity);
    if (in)
        fclose(in);
    return good;
}

#endif
