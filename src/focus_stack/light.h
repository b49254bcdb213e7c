/* light.h: the cells by which light.c finds light above white. */
#ifndef RF_STACK_LIGHT_H
#define RF_STACK_LIGHT_H

#include "focus_stack/focus_stack.h"

enum {
    RF_LIGHT_MOST = 12, /* cells of the largest radius */
    RF_LIGHT_FINE = 4,  /* radii are quarters of a cell */
    RF_LIGHT_SIDE = 2 * (RF_LIGHT_MOST + 1) + 1,
    RF_LIGHT_RADII = RF_LIGHT_FINE * RF_LIGHT_MOST + 1,
    RF_LIGHT_LANES = 4, /* R, G, B and one that fills vectors */
    RF_LIGHT_BAND = 16, /* rows of cells that a worker takes at a time */
};

/* Marks of cells. Half of a mark is set while rf_light_mark_around() has looked along rows alone.
 */
enum {
    RF_LIGHT_WHITE = 1,   /* The cell is clipped, in part at the least. */
    RF_LIGHT_NEAR = 4,    /* A white cell may be spread over it: frames are looked at there. */
    RF_LIGHT_SOURCE = 16, /* It may be spread over one that is near. */
};

/* A disc: weights from -reach to reach, which add up to 1. */
struct rf_light_disc {
    int reach;
    float square; /* the square of its area */
    float weight[RF_LIGHT_SIDE][RF_LIGHT_SIDE];
};

struct rf_lights {
    const struct refocus_stack *stack;
    const struct rf_stack_photo *photo;
    struct rf_deep *out;
    int by;                     /* pixels of a cell, across and down */
    int columns, rows;          /* cells */
    int frame;                  /* the frame that is looked at */
    int focus;                  /* the disparity that is in focus there */
    int sources;                /* cells with these marks are spread */
    float kept;                 /* this share is handed on to the next cell */
    double radius;              /* K, in parts of a cell */
    struct rf_light_disc *disc; /* RF_LIGHT_RADII of them */
    float *light;               /* L, RF_LIGHT_LANES a cell, as are all of these */
    float *clipped;             /* c */
    float *excess;              /* x */
    float *norm;                /* n */
    float *spread; /* A_k of L or of c x, and what frame k has more; `change`, smooth along rows */
    float *ones;   /* A_k of c; `norm`, smooth along rows */
    float *change; /* the sum beside it */
    const float *from[2]; /* rf_light_spread() spreads this at present: one plane or two */
    float *to[2];         /* rf_light_spread() adds that up here */
    int16_t *residual;    /* F_k - A_k L, RF_LIGHT_LANES a cell, frame by frame */
    uint16_t *disparity;  /* the middle of a cell has it */
    uint8_t *near;        /* marks of a cell */
};

static inline size_t rf_light_cell(const struct rf_lights *l, int x, int y)
{
    return (size_t)y * (size_t)l->columns + (size_t)x;
}

/* Makes the discs of all radii. */
void rf_light_make_discs(struct rf_lights *l);
/* Cells get `mark` where one that has `of` is within the largest circle of confusion. */
void rf_light_mark_around(const struct rf_lights *l, int of, int mark);
/* Spreads what is `from` as the frame does, from cells with these marks: A_k. */
void rf_light_spread(struct rf_lights *l, int sources, const float *from, float *to);
/* Likewise of c x, from white cells, to `spread`, and at the same time of `clipped` to `ones`. */
void rf_light_spread_excess(struct rf_lights *l, const float *excess);
/* Adds what is spread back of `spread` and `ones` to `change` and `norm`: B_k. */
void rf_light_gather(struct rf_lights *l);

#endif
