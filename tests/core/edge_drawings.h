/* edge_drawings.h: scenes of surfaces with known disparities, drawn, and what makes their maps
 * worse.
 */
#ifndef TEST_EDGE_DRAWINGS_H
#define TEST_EDGE_DRAWINGS_H

#include <stdbool.h>
#include <stdint.h>
#include "unit_test.h"
#include <refocus/refocus.h>

struct picture {
    int width, height;
    uint8_t *rgb;
    uint16_t *exact, *map, *out;
};

/* The disparity at a pixel, 0 to 1, and which of four surfaces has it. */
struct seen {
    double disparity;
    int surface;
};
typedef struct seen scene_fn(double x, double y);

/* Scenes of WIDTH x HEIGHT pixels. */
enum { WIDTH = 240, HEIGHT = 180 };
bool in_disc(double x, double y, double radius);
bool on_wire(double x, double y);
scene_fn disc, disc_and_wire, planes, sphere, paraboloid, stairs;

/* Random numbers, which draw() begins anew. */
extern uint32_t random_state;
uint32_t random_bits(void);

struct picture make(int width, int height);
void end(struct picture *p);

/* Paints a pixel of one of four surfaces, which have different colours and a texture. */
void paint(uint8_t *pixel, int surface, int x, int y);

/* Draws photo and exact map; disparities are multiplied by `contrast`. */
void draw(struct picture *p, scene_fn *scene, double contrast);

/* The map becomes that of the scene moved by (right, down). */
void displace(struct picture *p, scene_fn *scene, double right, double down);

/* Blurs the map; overshoot > 0: and then sharpens it in part, as networks and cameras do. */
void soften(struct picture *p, double sigma, double overshoot);

struct refocus_image photo_of(const struct picture *p);

/* Puts the edges of the map on those of the photo, to p->out; returns the report. */
struct refocus_depth_edges_report place(const struct picture *p);

/* The share of pixels whose disparity is within `off` of the exact one. */
double share_within(const struct picture *p, const uint16_t *map, double off);

void assert_same(const struct picture *p, const uint16_t *should, const char *what, int number);

#endif
