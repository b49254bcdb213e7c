/* pull.c: a focus pull of the page's key frames: an animation of the reduced photo. */
#include <stdlib.h>
#include <string.h>
#include "settings/keys.h"
#include "outputs/animation.h"
#include "outputs/encoder.h"
#include "serve/serving.h"

enum { PULL_FPS = 25, PULL_SIDE = 640, PULL_RAYS = 64 };

static const struct {
    const char *word, *type;
} films[] = {
    {"apng", "image/apng"}, {"gif", "image/gif"}, {"mp4", "video/mp4"}, {"webm", "video/webm"}};

json_t *serve_films_json(void)
{
    const int count = encoder_is_there() ? 4 : 1;
    json_t *const list = json_array();

    for (int i = 0; i < count; i++)
        json_array_append_new(list, json_string(films[i].word));
    return list;
}

static int wrong(const char *why)
{
    return report_failure(EXIT_WRONG, "pull", "%s", why);
}

/* The key frames, as the member "keys" of a file for `refocus pull --keys`. */
static int read_keys(json_t *root, struct keys **keys)
{
    json_t *const list = json_object_get(root, "keys");
    json_t *const file = list ? json_pack("{s:i, s:O}", "refocus-pull", 1, "keys", list) : NULL;
    char *const text = file ? json_dumps(file, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    int status = text ? keys_read(keys, "pull", text, strlen(text)) : wrong("give keys");

    free(text);
    json_decref(file);
    if (status == EXIT_DONE && keys_seconds(*keys) > SERVE_PULL_SECONDS)
        status = report_failure(EXIT_WRONG, "pull", "it may take %d seconds at the most",
                                SERVE_PULL_SECONDS);
    if (status == EXIT_DONE && keys_most(*keys, "blur", 0) > REFOCUS_PLAIN_BLUR_RADIUS)
        status = wrong("its blur may be 127 pixels at the most");
    return status;
}

/* The settings beside the keys. */
static int read_settings(const struct serving *s, json_t *root, struct shot_settings *settings)
{
    char *text;
    int status;

    json_object_del(root, "keys");
    text = json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17));
    if (!text)
        return wrong("not enough memory");
    status = serve_settings(s, text, strlen(text), settings);
    free(text);
    return status;
}

static int write_frame(struct serving *s, const struct refocus_settings *lens, int size,
                       struct animation **animation, const char *path, int count)
{
    struct refocus_settings params = *lens;
    struct refocus_image picture = {0};
    int status = serve_render_reduced(s, &params, PULL_RAYS, &picture);

    if (status == EXIT_DONE)
        status = serve_fit(s, size, &picture);
    if (status == EXIT_DONE && !*animation)
        status = animation_open(animation, path, picture.width, picture.height, PULL_FPS, count);
    if (status == EXIT_DONE)
        status = animation_write(*animation, &picture);
    free(picture.plane[0]);
    return status;
}

static int write_frames(struct serving *s, const struct shot_settings *settings,
                        const struct keys *keys, int size, const char *path)
{
    const int count = (int)(keys_seconds(keys) * PULL_FPS + 0.5) + 1;
    struct animation *animation = NULL;
    struct engine engine;
    int status = serve_aim(s, settings, &engine), closed;

    for (int i = 0; i < count && status == EXIT_DONE; i++) {
        struct refocus_settings params = engine.params;

        keys_apply(keys, i / (double)PULL_FPS, &params);
        status = write_frame(s, &params, size, &animation, path, count);
    }
    closed = animation_close(animation, status == EXIT_DONE);
    engine_end(&engine);
    return status == EXIT_DONE ? closed : status;
}

static int make(struct serving *s, const struct shot_settings *settings, const struct keys *keys,
                const struct rf_web_ask *ask, struct refocus_blob *bytes)
{
    const int size = ask->size > 0 ? ask->size : PULL_SIDE;
    char *path = NULL;
    int status = serve_temporary(ask->word, &path);

    if (status != EXIT_DONE)
        return status;
    return serve_take_back(write_frames(s, settings, keys, size, path), path, bytes);
}

void serve_answer_pull(struct serving *s, const struct rf_web_ask *ask, const char *body)
{
    json_t *const root = json_loadb(body, ask->bytes, JSON_REJECT_DUPLICATES, NULL);
    struct refocus_blob bytes = {0};
    struct shot_settings settings;
    struct keys *keys = NULL;
    char ending[24];
    int film = 0;
    int status = json_is_object(root) ? read_keys(root, &keys) : wrong("it is no JSON object");

    while (film < 3 && strcmp(films[film].word, ask->word) != 0)
        film++;
    if (status == EXIT_DONE && film > 0 && !encoder_is_there())
        status = wrong("this server has no ffmpeg program to write it; ask for apng");
    if (status == EXIT_DONE)
        status = read_settings(s, root, &settings);
    json_decref(root);
    if (status != EXIT_DONE) {
        keys_free(keys);
        answer_failure(s, ANSWER_WRONG);
        return;
    }
    status = make(s, &settings, keys, ask, &bytes);
    keys_free(keys);
    snprintf(ending, sizeof ending, "pull.%s", films[film].word);
    if (status == EXIT_DONE)
        answer_bytes(s, films[film].type, ending, bytes.data, bytes.size);
    else
        answer_failure(s, status == EXIT_WRONG ? ANSWER_WRONG : ANSWER_FAILED);
}
