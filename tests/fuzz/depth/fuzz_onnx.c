/* fuzz_onnx.c: the shape of a network's input, from any bytes. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "onnx.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int width = -1, height = -1;
    FILE *file;

    if (size == 0)
        return 0;
    file = fmemopen((void *)(uintptr_t)data, size, "rb");
    if (!file)
        abort();
    if (rf_onnx_input_size(file, &width, &height) == 0 &&
        (width < 0 || width > 65535 || height < 0 || height > 65535))
        abort();
    fclose(file);
    return 0;
}
