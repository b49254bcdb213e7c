/* onnx.h: what an ONNX file says about the picture that its network takes. */
#ifndef RF_ONNX_H
#define RF_ONNX_H

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Width and height of the first input of four sides, N x 3 x height x width; 0 for a side that
 * is left open. Returns 0, or -1 when there is no such input. Only what leads there is read;
 * weights are skipped.
 */
int rf_onnx_input_size(FILE *file, int *width, int *height);

#ifdef __cplusplus
}
#endif
#endif
