/* region_and_cancel.c: tap to focus, or what an interactive program does with a renderer.
 *
 * One thread renders: first the region around the tap, which is there at once, then
 * the whole picture. The other takes the taps; a new tap cancels what is being rendered
 * for the last one. Prints what became of each tap.
 */
#include <pthread.h>
#include <stdio.h>
#include <refocus/refocus.h>

enum { WIDTH = 1280, HEIGHT = 720, SIDE = 96, TAPS = 4 };

static uint8_t photo[HEIGHT][WIDTH][3];
static uint8_t disparity[HEIGHT][WIDTH];
static uint8_t result[HEIGHT][WIDTH][3];

/* The newest tap, guarded by the mutex. */
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static int tap_number, tap_x, tap_y, region_done;

static struct refocus_renderer *renderer;

/* Renders the part of the picture at (x, y) in place; zero sizes: all of it. */
static int render(int x, int y, int width, int height, float focus)
{
    struct refocus_render_params params = refocus_render_params_default(focus, 12);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, result[y][x], width ? width : WIDTH,
                             height ? height : HEIGHT, sizeof result[0]);

    params.region_x = x;
    params.region_y = y;
    params.region_width = width;
    params.region_height = height;
    return refocus_render(renderer, &params, &out);
}

static void *render_taps(void *unused)
{
    int number, x, y;

    (void)unused;
    for (int last = 0; last < TAPS; last = number) {
        pthread_mutex_lock(&mutex);
        while (tap_number == last)
            pthread_cond_wait(&changed, &mutex);
        number = tap_number, x = tap_x, y = tap_y;
        pthread_mutex_unlock(&mutex);

        const float focus = (float)disparity[y][x] / 255;
        int status = render(x - SIDE / 2, y - SIDE / 2, SIDE, SIDE, focus);
        pthread_mutex_lock(&mutex);
        region_done = status == REFOCUS_OK ? number : TAPS;
        pthread_cond_broadcast(&changed);
        pthread_mutex_unlock(&mutex);
        if (status == REFOCUS_OK)
            status = render(0, 0, 0, 0, focus);
        printf("tap %d at disparity %.2f: %s\n", number, (double)focus, refocus_strerror(status));
        if (status != REFOCUS_OK && status != REFOCUS_ERR_CANCELLED)
            return "failed";
    }
    return NULL;
}

/* Stripes, nearer to the right. */
static void draw(void)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            disparity[y][x] = (uint8_t)(x * 255 / (WIDTH - 1));
            photo[y][x][0] = (x / 8 & 1) ? 230 : 30;
            photo[y][x][1] = (y / 8 & 1) ? 200 : 60;
            photo[y][x][2] = 90;
        }
    }
}

static void tap_each(void)
{
    for (int i = 1; i <= TAPS; i++) {
        pthread_mutex_lock(&mutex);
        tap_number = i, tap_x = WIDTH * i / (TAPS + 1), tap_y = HEIGHT / 2;
        refocus_cancel(renderer); /* the last tap's picture: this one has not begun yet */
        pthread_cond_broadcast(&changed);
        pthread_mutex_unlock(&mutex);

        /* The finger rests until the region is sharp. */
        pthread_mutex_lock(&mutex);
        while (region_done < i)
            pthread_cond_wait(&changed, &mutex);
        pthread_mutex_unlock(&mutex);
    }
}

int main(void)
{
    const struct refocus_renderer_params limits =
        refocus_renderer_params_default(WIDTH, HEIGHT, 12);
    const struct refocus_image in =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, photo, WIDTH, HEIGHT, sizeof photo[0]);
    const struct refocus_disparity depth =
        refocus_disparity8(disparity[0], WIDTH, HEIGHT, sizeof disparity[0]);
    pthread_t thread;
    void *failed = "failed";
    int status;

    draw();
    if ((status = refocus_renderer_create(&renderer, &limits)) != REFOCUS_OK ||
        (status = refocus_prepare(renderer, &in, &depth)) != REFOCUS_OK) {
        fprintf(stderr, "region_and_cancel: %s\n", refocus_strerror(status));
    } else if (pthread_create(&thread, NULL, render_taps, NULL) == 0) {
        tap_each();
        pthread_join(thread, &failed);
    }
    refocus_renderer_destroy(&renderer);
    return failed ? 1 : 0;
}
