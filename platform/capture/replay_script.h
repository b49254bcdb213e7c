/* replay_script.h: the script of a replay source: frames and faults. */
#ifndef RF_CAPTURE_REPLAY_SCRIPT_H
#define RF_CAPTURE_REPLAY_SCRIPT_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/platform/file.h>

enum rf_fault {
    RF_FAULT_NONE,
    RF_FAULT_DROP,        /* frames that do not come */
    RF_FAULT_CORRUPT,     /* flagged */
    RF_FAULT_LATE,        /* comes so many ms after its time */
    RF_FAULT_TIMESTAMP,   /* shifted by so many ms */
    RF_FAULT_STALL,       /* nothing comes for so many ms */
    RF_FAULT_FAIL,        /* the stream fails; a restart helps */
    RF_FAULT_VANISH,      /* the device is gone for so many ms */
    RF_FAULT_QUEUE_ERROR, /* the buffer is lost when it is given back */
    RF_FAULT_STRIDE,      /* so many bytes a row from here on */
    RF_FAULT_FORMAT,      /* another format and size from here on */
    RF_FAULT_MEMORY,      /* the frame finds no memory */
};

struct rf_event {
    int64_t frame;
    enum rf_fault fault;
    int64_t value; /* frames, ms, bytes */
    uint32_t format;
    int width, height;
};

enum { RF_MOST_EVENTS = 256 };

struct rf_script {
    uint32_t format;
    int width, height;
    double fps;
    int64_t frames, stride; /* 0: endless; packed */
    uint32_t sequence;      /* number of the first frame */
    int64_t seed;
    double random_percent; /* so many frames in a hundred suffer a fault */
    int start_errors;      /* number of starts that fail first */
    char *from, *jpeg;     /* another source, a JPEG file; owned, or NULL */
    char *stack;           /* names of the frames of a focus stack, the farthest first; owned */
    double pictures;       /* number of pictures of the stack, which begin with number 0 */
    double lens[2];        /* the farthest and the nearest position of the lens; equal: none */
    double lens_speed;     /* dioptres a frame */
    double lens_stop;      /* the lens gets no nearer than this */
    double lens_error;     /* the lens reports its place plus this */
    struct rf_event event[RF_MOST_EVENTS];
    int events;
    bool lacks_memory; /* a text could not be copied */
};

/* Fill a script from a text of lines, or of parts with semicolons. On an error the
 * reason names the line; rf_script_free() in any case. */
int rf_script_parse(struct rf_script *script, char *text, struct refocus_reason *reason);
void rf_script_free(struct rf_script *script);

#endif
