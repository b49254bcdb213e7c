/* server.h: the state of the server, which is one thread. */
#ifndef RF_WEB_SERVER_H
#define RF_WEB_SERVER_H

#include <microhttpd.h>
#include <sys/types.h>
#include "folder.h"
#include "web.h"

enum {
    MOST_CONNECTIONS = 64,
    MOST_CONNECTIONS_EACH = 24, /* connections of one address */
    MOST_SESSIONS = 16,
    MOST_WAITING = 8,    /* requests of a session that wait */
    MOST_THUMBNAILS = 2, /* processes that make thumbnails */
    MOST_THUMBNAILS_WAITING = 256,
    MOST_UPLOADS = 4,
    UPLOAD_PIECE = 64 << 10, /* bytes */
    MOST_HELD = 512,         /* MiB of answers that clients have not taken yet */
};

/* A connection that has done nothing whole by its deadline is ended, however busy it looks. */
enum {
    SECONDS_HEADERS = 10,
    SECONDS_BODY = 10,
    SECONDS_UPLOAD = 60, /* for each piece of a photo */
    SECONDS_ANSWER = 30, /* one more for each 64 KiB */
    SECONDS_IDLE = 60,
    SECONDS_WORK = 600,
    SECONDS_SESSION = 7200, /* a session that nobody asks */
    SECONDS_LIVE = 10,      /* cameras at which nobody looks */
};

struct line { /* a connection */
    struct line *next;
    int fd;
    double deadline_ms; /* INFINITY while the answer is worked on */
};

struct request {
    struct request *next; /* in the queue of a process */
    struct MHD_Connection *connection;
    struct line *line;
    enum {
        ACTION_PAGE,
        ACTION_PHOTOS,
        ACTION_THUMBNAIL,
        ACTION_OPEN,
        ACTION_LIVE, /* the session of the cameras */
        ACTION_UPLOAD,
        ACTION_ASK, /* a request to a session */
        ACTION_CLOSE,
    } action;
    bool dispatched, suspended;
    struct rf_web_ask ask;
    const struct page_file *file;
    struct process *process;
    char name[256];
    char *body;
    int upload; /* a file without a name, or -1 */
    uint64_t uploaded;
    /* The answer, once status is not 0. */
    int status, depth;
    uint32_t frame;
    char *text;
    size_t size;
    uint64_t held; /* bytes of it that count as the server's */
    char type[40], ending[24];
};

struct process {
    struct process *next;
    pid_t pid;
    int socket, control;
    bool session; /* the process keeps its photo open; false: it makes a thumbnail and ends */
    bool live;    /* the session of the cameras, which all clients share */
    bool open;    /* the photo is open */
    char id[RF_WEB_SESSION + 1], name[256];
    char folder[1024]; /* for its temporary files, which end with it */
    struct request *running, *waiting;
    int waiting_count;
    uint32_t number; /* number of the last ask */
    long newest;     /* number of the newest picture that the page asked for */
    struct rf_web_reply reply;
    size_t have;   /* bytes of the reply that are here */
    char *body;    /* the part behind its head */
    uint64_t held; /* bytes of its reply, which count as the server's */
    double used_ms, until_ms;
    int64_t kib;
};

struct server {
    const struct rf_web_setup *setup;
    struct MHD_Daemon *daemon;
    struct folder folder;
    char token[RF_WEB_SESSION + 1];
    int port, uploads;
    uint64_t held; /* bytes of answers that are not sent yet */
    struct line *lines;
    struct process *processes;
    struct request *thumbnails; /* requests that wait for a process */
    int thumbnail_count;
    double looked_ms; /* when memory was last looked at */
    bool resumed;     /* connections wait to be seen to */
};

double server_now_ms(void);

/* RF_WEB_SESSION random digits. */
bool server_random(char digits[RF_WEB_SESSION + 1]);

/* arguments.c */

/* Takes the arguments of a request that has found its way; answers it where one is wrong. */
void request_take_arguments(struct server *server, struct request *request);

/* Finds the process of the session that a request names; answers it where there is none. */
void request_find_process(struct server *server, struct request *request);

/* request.c: the callbacks of the library. */
enum MHD_Result request_handle(void *of, struct MHD_Connection *connection, const char *url,
                               const char *method, const char *version, const char *data,
                               size_t *size, void **kept);
void request_completed(void *of, struct MHD_Connection *connection, void **kept,
                       enum MHD_RequestTerminationCode code);

/* answer.c */

/* Settle an answer: an error of one sentence, which may be NULL; or a text, which is freed. */
void answer_error(struct request *request, int status, const char *why);
void answer_text(struct request *request, char *text, size_t size, const char *type);
/* Let the library call for an answer that has been settled after it was put off. */
void answer_resume(struct server *server, struct request *request);
/* Give the settled answer to the library. */
enum MHD_Result answer_queue(struct request *request);

/* start.c */

/* A new process for a photo, whose fd is closed, or, -1, for the cameras; NULL: none can be had. */
struct process *process_start(struct server *server, const char *name, bool session, int fd);
void process_remove_folder(const struct process *process);

/* process.c: each of these settles an answer, at once or later. */

/* Start a session; fd is closed. */
void process_open(struct server *server, struct request *request, int fd);
/* Start the session of the cameras, or join it. */
void process_live(struct server *server, struct request *request);
void process_thumbnail(struct server *server, struct request *request);
void process_ask(struct server *server, struct request *request);
struct process *process_find(const struct server *server, const char *id);
/* End a process; its requests are answered. */
void process_end(struct server *server, struct process *process, int status, const char *why);
/* The socket of a process can be read. */
void process_read(struct server *server, struct process *process);
/* End sessions that have had their time, or hold too much memory. */
void process_tick(struct server *server);

#endif
