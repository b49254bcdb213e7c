/* scene.h: a folder with a reference scene: allfocus.png, disparity.png, scene.json and the
 * pictures gt_*.png that a lens would have taken. */
#ifndef QUALITY_SCENE_H
#define QUALITY_SCENE_H

#include <stdint.h>

struct quality_view {
    char file[64]; /* the reference picture */
    double focus;  /* df */
    double blur;   /* K in pixels */
    int blades;    /* 0 = a disc */
    double corner; /* degrees: one corner of the polygon */
};

enum { QUALITY_MAX_VIEWS = 64 };

struct quality_scene {
    char folder[1024];
    const char *name; /* last part of folder */
    int width, height;
    double near_m, far_m; /* z0 and z1; 0 when not given */
    uint8_t *photo;       /* R G B */
    uint16_t *disparity;
    int views; /* ordered by K, blades, df */
    struct quality_view view[QUALITY_MAX_VIEWS];
};

/* Returns 0, or -1 after a line on standard error; then nothing is to be freed. */
int quality_scene_read(struct quality_scene *scene, const char *folder);
void quality_scene_free(struct quality_scene *scene);

/* The reference picture of a view, to be freed; NULL after a line on standard error. */
uint8_t *quality_scene_reference(const struct quality_scene *scene,
                                 const struct quality_view *view);

#endif
