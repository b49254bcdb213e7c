/* upload.h: a photo that a client sends goes into a file without a name. */
#ifndef RF_WEB_UPLOAD_H
#define RF_WEB_UPLOAD_H

#include "server.h"

/* On an error the answer is settled. */
void upload_begin(struct server *server, struct request *request);
void upload_take(struct server *server, struct request *request, const char *data, size_t size);
/* The file, to be closed, or -1. */
int upload_end(struct server *server, struct request *request);
/* Whatever came before. */
void upload_drop(struct server *server, struct request *request);

#endif
