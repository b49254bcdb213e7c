/* live_queue.h: pictures on their way from one thread to the next. */
#ifndef RF_CLI_LIVE_QUEUE_H
#define RF_CLI_LIVE_QUEUE_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <refocus/image.h>

struct live_picture {
    struct refocus_image image; /* RGB8, or the camera's Y, U, V; the queue owns the memory */
    size_t capacity;
    int64_t timestamp_ns; /* by the camera's clock, for pairing */
    int64_t taken_ns;     /* CLOCK_MONOTONIC: when it was taken, as far as is known */
    float lens_dioptres;
    bool still;
    int64_t key; /* number, from 1 on, of the picture that the network sees for its depth */
};

enum { LIVE_SLOTS = 4 };

struct live_queue {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    struct live_picture slot[LIVE_SLOTS];
    int free[LIVE_SLOTS], free_count;
    int full[LIVE_SLOTS], full_count; /* oldest first */
    int most;                         /* full ones at a time */
    bool made;                        /* the lock and the condition are there */
    bool newest_wins, closed;
    uint64_t dropped;
};

/* When the newest wins, a picture replaces one that waits; else the giver waits. False: there is no
 * lock to be had; live_queue_free() is right even so. */
bool live_queue_init(struct live_queue *queue, bool newest_wins);
void live_queue_free(struct live_queue *queue);
/* No more will come; full slots can still be taken. */
void live_queue_close(struct live_queue *queue);
/* A slot to fill, with memory for such a picture; NULL when the queue is closed. *memory is
 * false when there is none. */
struct live_picture *live_queue_fill(struct live_queue *queue, uint32_t format, int width,
                                     int height, bool *memory);
void live_queue_put(struct live_queue *queue, struct live_picture *picture);
/* The oldest, or NULL after 100 ms without one, or when the queue is closed and empty. */
struct live_picture *live_queue_take(struct live_queue *queue, bool *ended);
/* Give a slot back to the free ones: it was taken, or is not worth to be put. */
void live_queue_return(struct live_queue *queue, struct live_picture *picture);
uint64_t live_queue_dropped(struct live_queue *queue);

#endif
