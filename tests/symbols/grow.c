/* grow.c: a program that sets structs of the library, compiled by grow.sh against older and newer
 * headers than those that the library it runs with was compiled from.
 *
 *     grow          fields that the library may not know are 0: all works
 *     grow refused  compiled with -DNEWER: each that is not 0 is refused, and the log says so
 *     grow taken    the same with a library that knows them
 */
#include <refocus/refocus.h>

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { W = 48, H = 32 };

static char said[256];
static uint8_t pixels[3 * W * H], out[3 * W * H];
static uint16_t disparities[W * H];

static void hear(void *user, const char *text)
{
    (void)user;
    snprintf(said, sizeof said, "%s", text);
}

static void draw(void)
{
    for (int i = 0; i < W * H; i++) {
        disparities[i] = i % W < W / 2 ? 60000 : 5000;
        for (int c = 0; c < 3; c++)
            pixels[3 * i + c] = (uint8_t)(i * (7 + c) % 251);
    }
}

/* A struct that only newer headers have the field of. */
#ifdef NEWER
#define ADD(object) (object).added_later = 1
#else
#define ADD(object) (void)(object)
#endif

enum which { NOTHING, LIMITS, PHOTO, MAP, RENDER, LOOK, OUT, ALL };

/* The whole life of a picture, with the field of one struct set; the first status that is none. */
static int life(enum which set)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 9);
    struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
    struct refocus_image result = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_disparity map = refocus_disparity16(disparities, W, H, 2 * W);
    struct refocus_render_params params = refocus_render_params_default(0.9f, 8);
    struct refocus_look_params look = refocus_look_params_default();
    struct refocus_renderer_info info = refocus_renderer_info_default();
    struct refocus_renderer *renderer = NULL;
    int status;

    limits.log.message = hear;
    limits.threads = 1;
    look.cat_eye = 0.4f;
    params.look = &look;
    if (set == LIMITS)
        ADD(limits);
    if (set == PHOTO)
        ADD(photo);
    if (set == MAP)
        ADD(map);
    if (set == RENDER)
        ADD(params);
    if (set == LOOK)
        ADD(look);
    if (set == OUT)
        ADD(result);
    ADD(info); /* the library sets it back */
    status = refocus_renderer_create(&renderer, &limits);
    if (status == REFOCUS_OK)
        status = refocus_prepare(renderer, &photo, &map);
    if (status == REFOCUS_OK)
        status = refocus_render(renderer, &params, &result);
    refocus_renderer_get_info(renderer, &info);
    if (status == REFOCUS_OK && (info.threads != 1 || info.memory == 0))
        status = REFOCUS_ERR_STATE;
#ifdef NEWER
    if (status == REFOCUS_OK && info.added_later != 0)
        status = REFOCUS_ERR_STATE;
#endif
    refocus_renderer_destroy(&renderer);
    return status;
}

int main(int argc, char **argv)
{
    const int refused = argc > 1 && strcmp(argv[1], "refused") == 0;
    uint32_t sum = 0;
    int status;

    draw();
    status = life(NOTHING);
    if (status != REFOCUS_OK || said[0]) {
        printf("nothing is set: %s, %s\n", refocus_strerror(status), said);
        return 1;
    }
    for (size_t i = 0; i < sizeof out; i++)
        sum = sum * 31 + out[i];
    for (int set = LIMITS; set < ALL && argc > 1; set++) {
        said[0] = 0;
        status = life((enum which)set);
        if (status != (refused ? REFOCUS_ERR_UNSUPPORTED : REFOCUS_OK) ||
            !strstr(said, refused ? "does not know" : "")) {
            printf("struct %d: %s, %s\n", set, refocus_strerror(status), said);
            return 1;
        }
    }
    printf("%08x\n", (unsigned)sum);
    return 0;
}
