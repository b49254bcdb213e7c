/* test_threads.c: "Thread-safe" says the header: readers and writers in many threads at once,
 * for the thread sanitizer to watch, each with the result of one alone. */
#include "check.h"
#include "samples.h"

#include <pthread.h>
#include <unistd.h>

enum { THREADS = 4, ROUNDS = 3 };

struct work {
    const struct sample *samples;
    int count, number, wrong;
};

/* A sum over what the caller sees; 1 when there is no photo. */
static unsigned digest(const struct refocus_photo *photo)
{
    unsigned sum = 1;

    for (int y = 0; photo && photo->image->plane[0] && y < photo->image->height; y++)
        for (int x = 0; x < photo->image->width * 3; x++)
            sum = sum * 31 + photo->image->plane[0][y * photo->image->stride[0] + x];
    for (int i = 0; photo && i < photo->info->evidence_count; i++)
        sum = sum * 31 + (unsigned)strlen(photo->info->evidence[i]);
    return sum;
}

static unsigned read_sample(const struct sample *sample)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    unsigned sum;

    refocus_photo_read_memory(&photo, sample->bytes.data, sample->bytes.size, NULL, &reason);
    sum = digest(photo);
    refocus_photo_free(&photo);
    return sum;
}

/* All threads write the same name: each time it holds one of the pictures, whole. */
static int write_shared(int number, const char *ending)
{
    uint8_t pixels[16 * 16 * 3];
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 16, 16, 48);
    struct refocus_photo *photo = NULL;
    char path[64];
    int wrong;

    memset(pixels, number * 50 + 20, sizeof pixels);
    snprintf(path, sizeof path, "/tmp/refocus-threads-%ld%s", (long)getpid(), ending);
    wrong = refocus_image_write(path, &image, NULL, NULL) != REFOCUS_OK;
    wrong += refocus_photo_read(&photo, path, NULL, NULL) != REFOCUS_OK;
    for (int i = 1; !wrong && i < 16 * 16 * 3; i++)
        wrong += abs(photo->image->plane[0][i] - photo->image->plane[0][0]) > 2;
    refocus_photo_free(&photo);
    return wrong;
}

static void *run(void *argument)
{
    struct work *const work = argument;

    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < work->count; i++) {
            const struct sample *const sample = &work->samples[(i + work->number) % work->count];
            work->wrong += read_sample(sample) != (unsigned)sample->whole_at;
        }
        work->wrong += write_shared(work->number, ".ppm");
#ifdef RF_HAVE_PNG
        work->wrong += write_shared(work->number, ".png");
#endif
#ifdef RF_HAVE_JPEG
        work->wrong += write_shared(work->number, ".jpg");
#endif
    }
    return NULL;
}

TEST(many_threads)
{
    static const char *const endings[] = {".ppm", ".png", ".jpg"};
    struct sample samples[SAMPLES_MAX];
    const int count = make_samples(samples);
    struct work work[THREADS];
    pthread_t threads[THREADS];

    for (int i = 0; i < count; i++)
        samples[i].whole_at = read_sample(&samples[i]); /* the sum expected */
    for (int i = 0; i < THREADS; i++) {
        work[i] = (struct work){samples, count, i, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, run, &work[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_int_equal(work[i].wrong, 0);
    }
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char path[64];
        snprintf(path, sizeof path, "/tmp/refocus-threads-%ld%s", (long)getpid(), endings[i]);
        unlink(path);
    }
    free_samples(samples, count);
}
