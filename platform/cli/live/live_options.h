/* live_options.h: the options of refocus live, and what is wrong with them together. */
#ifndef RF_CLI_LIVE_OPTIONS_H
#define RF_CLI_LIVE_OPTIONS_H

#include "live/live_settings.h"

extern const struct option live_options[];
/* The settings when nothing is given. */
extern const struct live_settings live_settings_none;
/* Fill in what follows from other options; an exit code, and prints why. */
int live_check_settings(struct live_settings *settings);

#endif
