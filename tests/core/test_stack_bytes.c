/* test_stack_bytes.c: depth and the photo of focus stacks are the same to the bit everywhere, by
 * any number of threads. Frames are drawn by whole numbers alone, as no library of mathematics is.
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include "unit_test.h"
#include "stack_scene.h"

/* Two textured surfaces, one on the left and one on the right, and what is drawn over them. */
struct drawn {
    int frames, left, right; /* twice the frames that are focused on the surfaces */
    int noise;               /* codes, either way */
    int shift;               /* pixels, from a frame to the next, to the right */
    int brighter;            /* parts of 64 that the last frame has more light */
    bool walks, lamp, faint; /* a square that walks, a clipped one, faint texture on the right */
    uint32_t hash;
};

static int16_t texture[H + 64][W + 64];

static void make_texture(void)
{
    uint32_t seed = 5;

    for (int y = 0; y < H + 64; y++)
        for (int x = 0; x < W + 64; x++)
            texture[y][x] = (int16_t)(next(&seed) % 161 - 80);
}

/* The texture spread over a square of this radius. */
static int spread(int x, int y, int radius)
{
    int sum = 0;

    for (int v = y - radius; v <= y + radius; v++)
        for (int u = x - radius; u <= x + radius; u++)
            sum += texture[v + 32][u + 32];
    return sum / ((2 * radius + 1) * (2 * radius + 1));
}

static int code_of(const struct drawn *d, int k, int x, int y)
{
    const bool right = x >= W / 2;
    const int away = abs(2 * k - (right ? d->right : d->left));

    if (d->walks && abs(x - 20 - 8 * k) < 7 && abs(y - 30) < 7)
        return 225;
    if (d->lamp && abs(x - 40) < 3 + away && abs(y - 70) < 3 + away)
        return 255;
    return 110 + spread(x, y, away / 2) / (right && d->faint ? 16 : 1);
}

static void draw_frames(const struct drawn *d)
{
    uint32_t seed = 11;

    frames = d->frames;
    for (int k = 0; k < frames; k++)
        for (int i = 0; i < PIXELS; i++) {
            const int at = i % W - d->shift * k, x = at < 0 ? 0 : at;
            const int light = k == frames - 1 ? 64 + d->brighter : 64;
            int code = code_of(d, k, x, i / W) * light / 64;

            if (d->noise)
                code += (int)(next(&seed) % (uint32_t)(2 * d->noise + 1)) - d->noise;
            code = code < 0 ? 0 : code > 255 ? 255 : code;
            for (int c = 0; c < 3; c++)
                frame[k][3 * i + c] = (uint8_t)(code - c * code / 8);
        }
}

static uint32_t hash_of_result(void)
{
    uint32_t hash = 2166136261u;

    for (int i = 0; i < 3 * PIXELS; i++)
        hash = (hash ^ photo[i]) * 16777619u;
    for (int i = 0; i < PIXELS; i++)
        hash = (hash ^ disparity[i]) * 16777619u;
    for (int i = 0; i < PIXELS; i++)
        hash = (hash ^ confidence[i]) * 16777619u;
    return hash;
}

TEST(stacks_have_the_same_bytes_everywhere)
{
    static const struct drawn stacks[] = {
        {.frames = 9, .left = 2, .right = 13, .noise = 2, .hash = 0xdb57891f},
        {.frames = 9, .left = 14, .right = 5, .walks = true, .brighter = 9, .hash = 0xf8546d10},
        {.frames = 8, .left = 3, .right = 11, .lamp = true, .noise = 6, .hash = 0xb66f43ab},
        {.frames = 7, .left = 1, .right = 9, .faint = true, .shift = 1, .hash = 0x21e5b9c6},
        {.frames = 6, .left = 3, .right = 8, .walks = true, .lamp = true, .hash = 0xf8a75e5e},
        {.frames = 4, .left = 0, .right = 5, .noise = 1, .hash = 0xea3aecfe},
        {.frames = 3, .left = 0, .right = 3, .lamp = true, .hash = 0xe8297361},
        {.frames = 2, .left = 0, .right = 1, .hash = 0x1b097a8b},
    };

    make_texture();
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++) {
        draw_frames(&stacks[i]);
        for (threads = 1; threads <= 3; threads += 2) {
            run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
            assert_int_equal(hash_of_result(), stacks[i].hash);
        }
    }
    threads = 0;
    frames = FRAMES;
}

int main(void)
{
    make_waves();
    return unit_test_run(NULL, NULL);
}
