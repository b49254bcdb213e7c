/* live_report.h: the report at the end. */
#ifndef RF_CLI_LIVE_REPORT_H
#define RF_CLI_LIVE_REPORT_H

#include "live/live_state.h"

/* Print it, when all threads have ended; an exit code. */
int live_report(struct live *live);

#endif
