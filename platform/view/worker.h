/* worker.h: the thread of a viewer's session. */
#ifndef RF_VIEW_WORKER_H
#define RF_VIEW_WORKER_H

/* The thread's function; it ends when the session, a struct rf_session, is told to quit. */
void *rf_worker_run(void *session);

#endif
