/* replay_scene.c: a made-up scene is drawn in every format: a tilted floor, a wall, and discs
 * before them. */
#include "replay_scene.h"
#include "layout.h"

struct sample {
    int r, g, b;
    int mm;
};

static struct sample scene_at(int x, int y, int width, int height)
{
    const int u = x * 960 / width, v = y * 720 / height;
    const int texture = ((u ^ v) & 8) * 4 + ((u * 7 + v * 13) & 31);
    struct sample sample = {70 + texture, 90 + texture, 120 + texture,
                            v > 440 ? 4000 - (v - 440) * 9 : 4000};

    if (v > 440) {
        sample.r += 50;
        sample.b -= 40;
    }
    for (int i = 0; i < 5; i++) {
        const int dx = u - (100 + i * 190), dy = v - (200 + i * 67 % 190);
        const int mm = 700 + i * 520, radius = 110 - i * 12;

        if (dx * dx + dy * dy < radius * radius && mm < sample.mm) {
            sample.r = 60 + i * 40 + texture;
            sample.g = 200 - i * 30 - texture;
            sample.b = 40 + i * 17 + texture;
            /* the sensor misses the left edge of a disc */
            sample.mm = dx * 8 < -radius * 7 ? 0 : mm;
        }
    }
    return sample;
}

/* BT.601, limited range. */
static uint8_t luma(struct sample s)
{
    return (uint8_t)(16 + (66 * s.r + 129 * s.g + 25 * s.b + 128) / 256);
}

static uint8_t chroma_u(struct sample s)
{
    return (uint8_t)((-38 * s.r - 74 * s.g + 112 * s.b + 128 * 256 + 128) / 256);
}

static uint8_t chroma_v(struct sample s)
{
    return (uint8_t)((112 * s.r - 94 * s.g - 18 * s.b + 128 * 256 + 128) / 256);
}

static void draw_packed(uint8_t *row, uint32_t format, int x, struct sample s)
{
    switch (format) {
    case REFOCUS_FRAME_YUYV:
        row[2 * x] = luma(s);
        row[2 * x + 1] = x & 1 ? chroma_v(s) : chroma_u(s);
        break;
    case REFOCUS_FRAME_UYVY:
        row[2 * x + 1] = luma(s);
        row[2 * x] = x & 1 ? chroma_v(s) : chroma_u(s);
        break;
    case REFOCUS_FRAME_RGB24:
    case REFOCUS_FRAME_BGR24:
    case REFOCUS_FRAME_RGBX:
    case REFOCUS_FRAME_BGRX: {
        const bool blue = format == REFOCUS_FRAME_BGR24 || format == REFOCUS_FRAME_BGRX;
        const int bytes = format >= REFOCUS_FRAME_RGBX ? 4 : 3;

        row[bytes * x] = (uint8_t)(blue ? s.b : s.r);
        row[bytes * x + 1] = (uint8_t)s.g;
        row[bytes * x + 2] = (uint8_t)(blue ? s.r : s.b);
        if (bytes == 4)
            row[4 * x + 3] = 0;
        break;
    }
    case REFOCUS_FRAME_GREY: /* as a disparity: nearer is brighter */
        row[x] = (uint8_t)(s.mm ? 700 * 255 / s.mm : 0);
        break;
    case REFOCUS_FRAME_Y16:
    case REFOCUS_FRAME_Z16:
        row[2 * x] = (uint8_t)(s.mm & 255);
        row[2 * x + 1] = (uint8_t)(s.mm >> 8);
        break;
    default:
        row[x] = luma(s);
        break;
    }
}

void rf_scene_draw(uint8_t *memory, uint32_t format, int64_t stride, int width, int height)
{
    struct refocus_frame frame = refocus_frame_default();
    uint8_t *plane[3] = {memory, memory, memory};

    frame.format = format;
    frame.width = width;
    frame.height = height;
    rf_frame_lay_out(&frame, memory, stride);
    for (int i = 1; i < rf_format_planes(format); i++)
        plane[i] = memory + (frame.plane[i] - frame.plane[0]);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const struct sample s = scene_at(x, y, width, height);

            draw_packed(plane[0] + y * frame.stride[0], format, x, s);
            if (rf_format_planes(format) == 1 || (x | y) & 1)
                continue;
            uint8_t *first = plane[1] + y / 2 * frame.stride[1];
            if (format == REFOCUS_FRAME_YUV420) {
                first[x / 2] = chroma_u(s);
                (plane[2] + y / 2 * frame.stride[2])[x / 2] = chroma_v(s);
            } else {
                first[x] = format == REFOCUS_FRAME_NV12 ? chroma_u(s) : chroma_v(s);
                first[x + 1] = format == REFOCUS_FRAME_NV12 ? chroma_v(s) : chroma_u(s);
            }
        }
}
