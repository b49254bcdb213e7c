/* refocus_ppm.c: the whole life of a picture: create a renderer once, prepare a photo once, render
 * as often as the lens changes.
 *
 * The "photo" is drawn here: a checkered wall far away, a ball, and a bar close to the
 * lens. It is rendered with the focus on each of the three.
 *
 *     refocus_ppm [FOLDER]    writes focus_far.ppm, focus_middle.ppm, focus_near.ppm
 */
#include <stdio.h>
#include <stdlib.h>
#include <refocus/refocus.h>

enum { WIDTH = 640, HEIGHT = 480 };

static uint8_t photo[HEIGHT][WIDTH][3];
static uint16_t disparity[HEIGHT][WIDTH]; /* 65535 nearest, 0 farthest */
static uint8_t result[HEIGHT][WIDTH][3];

static void draw(void)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const int dx = x - 320, dy = y - 260;
            const int checker = (x / 16 + y / 16) & 1;
            uint8_t *rgb = photo[y][x];

            rgb[0] = rgb[1] = rgb[2] = checker ? 220 : 60;
            if (dx * dx + dy * dy < 120 * 120) {
                disparity[y][x] = 32768;
                rgb[0] = (uint8_t)(200 - dy / 2 + 20 * checker);
                rgb[1] = rgb[2] = (uint8_t)(80 - dy / 2);
            }
            if (x + y / 4 > 150 && x + y / 4 < 190) {
                disparity[y][x] = 65535;
                rgb[0] = 40, rgb[1] = 90, rgb[2] = (uint8_t)(150 + 60 * checker);
            }
        }
    }
}

static int write_ppm(const char *folder, const char *name)
{
    char path[1024];
    FILE *file;
    int ok;

    snprintf(path, sizeof path, "%s/%s.ppm", folder, name);
    if (!(file = fopen(path, "wb"))) {
        perror(path);
        return 0;
    }
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    ok = fwrite(result, sizeof result, 1, file) == 1;
    return fclose(file) == 0 && ok;
}

int main(int argc, char **argv)
{
    const struct {
        const char *name;
        float focus;
    } views[] = {{"focus_far", 0}, {"focus_middle", 0.5f}, {"focus_near", 1}};
    const float blur =
        16; /* pixels: K, the blur radius of the nearest when the farthest is sharp */
    const struct refocus_image in =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, photo, WIDTH, HEIGHT, sizeof photo[0]);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, result, WIDTH, HEIGHT, sizeof result[0]);
    const struct refocus_disparity depth =
        refocus_disparity16(disparity[0], WIDTH, HEIGHT, sizeof disparity[0]);
    const struct refocus_renderer_params limits =
        refocus_renderer_params_default(WIDTH, HEIGHT, blur);
    struct refocus_renderer *renderer;
    int status;

    draw();
    if ((status = refocus_renderer_create(&renderer, &limits)) == REFOCUS_OK)
        status = refocus_prepare(renderer, &in, &depth);
    for (int i = 0; i < 3 && status == REFOCUS_OK; i++) {
        const struct refocus_render_params params =
            refocus_render_params_default(views[i].focus, blur);

        status = refocus_render(renderer, &params, &out);
        if (status == REFOCUS_OK && !write_ppm(argc > 1 ? argv[1] : ".", views[i].name))
            status = REFOCUS_ERR_IO;
    }
    refocus_renderer_destroy(&renderer);
    if (status != REFOCUS_OK)
        fprintf(stderr, "refocus_ppm: %s\n", refocus_strerror(status));
    return status == REFOCUS_OK ? 0 : 1;
}
