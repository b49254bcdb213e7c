/* consumer.c: a program of somebody else's: renders a flat photo, with the core and two other
 * libraries. */
#include <stdio.h>
#include <string.h>
#include <refocus/platform/file.h>
#include <refocus/refocus.h>

int main(void)
{
    static uint8_t pixels[16][16][3];
    static uint16_t depth[16][16];
    struct refocus_renderer_params params = refocus_renderer_params_default(16, 16, 4);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 16, 16, sizeof pixels[0]);
    const struct refocus_disparity map = refocus_disparity16(depth[0], 16, 16, sizeof depth[0]);
    const struct refocus_settings settings = refocus_settings_default(1, 4);
    struct refocus_renderer *renderer = NULL;
    int status;

    memset(pixels, 99, sizeof pixels);
    params.papers = refocus_papers();
    status = refocus_renderer_create(&renderer, &params);
    if (status == REFOCUS_OK)
        status = refocus_prepare(renderer, &photo, &map);
    if (status == REFOCUS_OK)
        status = refocus_render_settings(renderer, &settings, &photo);
    refocus_renderer_destroy(&renderer);
    printf("%s, %s, %d\n", refocus_strerror(status), refocus_file_formats(), pixels[7][7][0]);
    return status != REFOCUS_OK || pixels[7][7][0] != 99;
}
