/* scene.c: reads a folder with a reference scene. */
#include "scene.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "png_io.h"

static int by_blur_blades_focus(const void *left, const void *right)
{
    const struct quality_view *a = left, *b = right;

    if (a->blur != b->blur)
        return a->blur < b->blur ? -1 : 1;
    if (a->blades != b->blades)
        return a->blades < b->blades ? -1 : 1;
    return a->focus < b->focus ? -1 : a->focus > b->focus;
}

static int read_views(struct quality_scene *scene, const char *path)
{
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error), *list, *item;
    size_t i;
    int result = -1;

    if (!root) {
        fprintf(stderr, "refocus-quality: %s:%d: %s\n", path, error.line, error.text);
        return -1;
    }
    scene->near_m = json_number_value(json_object_get(root, "z0"));
    scene->far_m = json_number_value(json_object_get(root, "z1"));
    list = json_object_get(root, "gt");
    if (json_array_size(list) < 1 || json_array_size(list) > QUALITY_MAX_VIEWS)
        goto done;
    json_array_foreach(list, i, item)
    {
        struct quality_view *view = &scene->view[scene->views];
        const char *file = json_string_value(json_object_get(item, "file"));
        const json_t *focus = json_object_get(item, "df");
        const json_t *blur = json_object_get(item, "K");

        if (!file || strlen(file) >= sizeof view->file || !json_is_number(focus) ||
            !json_is_number(blur))
            goto done;
        strcpy(view->file, file);
        view->focus = json_number_value(focus);
        view->blur = json_number_value(blur);
        view->blades = (int)json_integer_value(json_object_get(item, "blades"));
        view->corner = json_number_value(json_object_get(item, "blade_corner_deg"));
        scene->views++;
    }
    qsort(scene->view, (size_t)scene->views, sizeof scene->view[0], by_blur_blades_focus);
    result = 0;
done:
    if (result)
        fprintf(stderr, "refocus-quality: %s: no list 'gt' of file, df, K\n", path);
    json_decref(root);
    return result;
}

static void *read_in(const struct quality_scene *scene, const char *file, int channels, int *width,
                     int *height)
{
    char path[1200];

    snprintf(path, sizeof path, "%s/%s", scene->folder, file);
    return png_io_read(path, channels, width, height);
}

int quality_scene_read(struct quality_scene *scene, const char *folder)
{
    char path[1200];
    size_t length = strlen(folder);
    int width, height;

    memset(scene, 0, sizeof *scene);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    if (length >= sizeof scene->folder)
        return -1;
    memcpy(scene->folder, folder, length);
    scene->name = strrchr(scene->folder, '/') ? strrchr(scene->folder, '/') + 1 : scene->folder;

    scene->photo = read_in(scene, "allfocus.png", 3, &scene->width, &scene->height);
    scene->disparity = read_in(scene, "disparity.png", 1, &width, &height);
    if (!scene->photo || !scene->disparity)
        goto fail;
    if (width != scene->width || height != scene->height) {
        fprintf(stderr, "refocus-quality: %s: photo and disparity differ in size\n", folder);
        goto fail;
    }
    snprintf(path, sizeof path, "%s/scene.json", scene->folder);
    if (read_views(scene, path))
        goto fail;
    return 0;
fail:
    quality_scene_free(scene);
    return -1;
}

void quality_scene_free(struct quality_scene *scene)
{
    free(scene->photo);
    free(scene->disparity);
    memset(scene, 0, sizeof *scene);
}

uint8_t *quality_scene_reference(const struct quality_scene *scene, const struct quality_view *view)
{
    int width, height;
    uint8_t *picture = read_in(scene, view->file, 3, &width, &height);

    if (picture && (width != scene->width || height != scene->height)) {
        fprintf(stderr, "refocus-quality: %s/%s: not of the photo's size\n", scene->folder,
                view->file);
        free(picture);
        picture = NULL;
    }
    return picture;
}
