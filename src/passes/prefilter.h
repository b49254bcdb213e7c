#ifndef RF_PREFILTER_H
#define RF_PREFILTER_H

enum { RF_PREFILTER_STEPS = 3 }; /* see rf_prefilter_rows() */

#endif
