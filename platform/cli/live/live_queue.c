/* live_queue.c: a bounded queue of pictures between two threads. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "live/live_lock.h"
#include "live/live_queue.h"

bool live_queue_init(struct live_queue *queue, bool newest_wins)
{
    memset(queue, 0, sizeof *queue);
    queue->made = live_lock_make(&queue->lock, &queue->changed);
    queue->newest_wins = newest_wins;
    queue->most = queue->newest_wins ? 1 : 2;
    for (int i = 0; i < LIVE_SLOTS; i++)
        queue->free[queue->free_count++] = i;
    return queue->made;
}

void live_queue_free(struct live_queue *queue)
{
    for (int i = 0; i < LIVE_SLOTS; i++)
        free(queue->slot[i].image.plane[0]);
    if (queue->made)
        live_lock_end(&queue->lock, &queue->changed);
    queue->made = false;
}

void live_queue_close(struct live_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->closed = true;
    pthread_cond_broadcast(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
}

static bool reserve(struct live_picture *picture, uint32_t format, int width, int height)
{
    const uint64_t bytes = refocus_image_bytes(format, width, height);
    uint8_t *memory = picture->image.plane[0];

    if (bytes > picture->capacity) {
        free(memory);
        memory = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
        picture->capacity = memory ? (size_t)bytes : 0;
    }
    if (memory)
        picture->image = refocus_image_planar(format, memory, width, height);
    else
        picture->image.plane[0] = NULL;
    return memory != NULL;
}

struct live_picture *live_queue_fill(struct live_queue *queue, uint32_t format, int width,
                                     int height, bool *memory)
{
    struct live_picture *picture = NULL;

    pthread_mutex_lock(&queue->lock);
    while (!queue->closed &&
           (queue->free_count == 0 || (!queue->newest_wins && queue->full_count >= queue->most)))
        pthread_cond_wait(&queue->changed, &queue->lock);
    if (!queue->closed)
        picture = &queue->slot[queue->free[--queue->free_count]];
    pthread_mutex_unlock(&queue->lock);
    *memory = !picture || reserve(picture, format, width, height);
    return picture;
}

void live_queue_put(struct live_queue *queue, struct live_picture *picture)
{
    pthread_mutex_lock(&queue->lock);
    while (queue->newest_wins && queue->full_count >= queue->most) {
        queue->free[queue->free_count++] = queue->full[0];
        memmove(queue->full, queue->full + 1, sizeof *queue->full * (LIVE_SLOTS - 1));
        queue->full_count--;
        queue->dropped++;
    }
    queue->full[queue->full_count++] = (int)(picture - queue->slot);
    pthread_cond_broadcast(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
}

struct live_picture *live_queue_take(struct live_queue *queue, bool *ended)
{
    struct live_picture *picture = NULL;
    struct timespec until;
    int error = 0;

    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += 100000000;
    if (until.tv_nsec >= 1000000000) {
        until.tv_nsec -= 1000000000;
        until.tv_sec++;
    }
    pthread_mutex_lock(&queue->lock);
    while (queue->full_count == 0 && !queue->closed && error != ETIMEDOUT)
        error = pthread_cond_timedwait(&queue->changed, &queue->lock, &until);
    if (queue->full_count > 0) {
        picture = &queue->slot[queue->full[0]];
        memmove(queue->full, queue->full + 1, sizeof *queue->full * (LIVE_SLOTS - 1));
        queue->full_count--;
        pthread_cond_broadcast(&queue->changed);
    }
    *ended = !picture && queue->closed;
    pthread_mutex_unlock(&queue->lock);
    return picture;
}

void live_queue_return(struct live_queue *queue, struct live_picture *picture)
{
    pthread_mutex_lock(&queue->lock);
    queue->free[queue->free_count++] = (int)(picture - queue->slot);
    pthread_cond_broadcast(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
}

uint64_t live_queue_dropped(struct live_queue *queue)
{
    uint64_t dropped;

    pthread_mutex_lock(&queue->lock);
    dropped = queue->dropped;
    pthread_mutex_unlock(&queue->lock);
    return dropped;
}
