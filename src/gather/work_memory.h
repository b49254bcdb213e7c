/* work_memory.h: the memory that methods of whole frames share. */
#ifndef RF_WORK_MEMORY_H
#define RF_WORK_MEMORY_H

#include <stdint.h>

/* The largest picture and lens that memory must suffice for. */
struct rf_limits {
    int width, height, pad, threads;
    float max_blur_radius; /* largest blur of these methods, at most RF_PLAIN_RADIUS */
};

/* Memory of the methods that work on whole frames, one at a time. */
struct rf_work_memory {
    uint8_t *at;
    uint32_t owner; /* enum refocus_method whose tables are still in it, or RF_NO_METHOD */
};
#define RF_NO_METHOD UINT32_MAX

#endif
