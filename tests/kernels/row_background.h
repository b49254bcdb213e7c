/* row_background.h: the rows of row_kernels[] for the kernels of the hidden background. */
#ifndef KERNELS_ROW_BACKGROUND_H
#define KERNELS_ROW_BACKGROUND_H

#include "check.h"

/* Each pair is `run` and `expect` of struct row_kernel. */
void run_spread_row(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
void expect_spread_row(void *const *row, int parameter, int n);
void run_dilate_from(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
void expect_dilate_from(void *const *row, int parameter, int n);
void run_mark_foreground(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
void expect_mark_foreground(void *const *row, int parameter, int n);
void run_push(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
void expect_push(void *const *row, int parameter, int n);
void run_pull(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
void expect_pull(void *const *row, int parameter, int n);
void run_pull_blur(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
void expect_pull_blur(void *const *row, int parameter, int n);
void run_push1(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
void expect_push1(void *const *row, int parameter, int n);

#endif
