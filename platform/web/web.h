/* web.h: the HTTP server of `refocus serve` as the command calls it. It checks requests, and hands
 * those that need a photo to processes of their own, which the command's functions run in. */
#ifndef RF_WEB_WEB_H
#define RF_WEB_WEB_H

#include <stdbool.h>
#include <stdint.h>

enum {
    RF_WEB_SESSION = 32,        /* hexadecimal digits of a session, and of the token */
    RF_WEB_MOST_BODY = 1 << 18, /* bytes of JSON */
    RF_WEB_MOST_SIDE = 65535,
};

/* The requests that a process answers. */
enum rf_web_what {
    RF_WEB_NOTHING,
    RF_WEB_OPEN, /* the first one of a session */
    RF_WEB_THUMBNAIL,
    RF_WEB_FOCUS,
    RF_WEB_PICTURE,
    RF_WEB_OVERLAY,
    RF_WEB_DRAFT, /* a stroke that is not finished */
    RF_WEB_STROKE,
    RF_WEB_UNDO,
    RF_WEB_REDO,
    RF_WEB_STROKES,
    RF_WEB_SAVE,
    RF_WEB_PULL,
    RF_WEB_FRAME, /* a frame of the cameras */
};

/* Sent to the process; the body follows. */
struct rf_web_ask {
    uint32_t what;   /* enum rf_web_what */
    uint32_t number; /* rises with each; sent by `control`, it cancels the picture of it */
    int32_t size;    /* fits into that many pixels each way; 0: as large as it is */
    uint32_t quick;  /* 1: of the reduced photo */
    uint32_t bytes;  /* size of the body */
    uint32_t after;  /* a newer frame than this is wanted */
    char word[16];   /* the kind of a view, or the format of a file */
};

/* Sent back; the body follows. */
struct rf_web_reply {
    int32_t status; /* status of HTTP; the body of 400 and above is one sentence, not JSON yet */
    int32_t depth;  /* 1: the photo has depth; 0: not; -1: it is not told */
    uint32_t frame; /* number of the frame that is seen; 0: it is none of a camera */
    uint64_t bytes;
    char type[32];   /* media type */
    char ending[24]; /* end of the name of a file that is saved; "": none is */
};

/* The life of a process that answers the requests of one photo. */
struct rf_web_work {
    int socket;          /* asks are read from it, replies written to it */
    int control;         /* numbers, uint32_t, of asks to cancel; its end is the server's end */
    const char *photo;   /* a path that opens the photo's file; NULL: frames of the cameras */
    const char *name;    /* the photo's name, without a path */
    const char *session; /* RF_WEB_SESSION digits */
};

struct rf_web_setup {
    const char *address;               /* numbers of IPv4 or IPv6 */
    int port;                          /* 0: any that is free */
    const char *path;                  /* a photo or a folder, or NULL */
    const char *origin;                /* "https://NAME" of a server before this one, or NULL */
    bool live;                         /* there are cameras */
    uint64_t most_upload, most_memory; /* bytes: of a photo; of all sessions together */
    int signals;                       /* a file that can be read once the server is to end */
    void (*ready)(void *of, const char *link);
    /* Called in a new process, which ends when it returns. */
    void (*work)(void *of, const struct rf_web_work *work);
    void *of;
};

#if defined(__GNUC__)
#define RF_WEB_CALL __attribute__((visibility("default")))
#else
#define RF_WEB_CALL
#endif

/* Serve until signals can be read. 0, or -1 with words in reason (256 bytes). The process may have
 * no other threads. */
RF_WEB_CALL int rf_web_run(const struct rf_web_setup *setup, char *reason);

#endif
