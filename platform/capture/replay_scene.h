/* replay_scene.h: a made-up scene for the replay source. */
#ifndef RF_CAPTURE_REPLAY_SCENE_H
#define RF_CAPTURE_REPLAY_SCENE_H

#include <stdint.h>

/* Draw discs before a wall, or how far they are for GREY, Y16 and Z16 (mm), into such a frame. */
void rf_scene_draw(uint8_t *memory, uint32_t format, int64_t stride, int width, int height);

#endif
