/* spans.c: the pixels that a layer covers, as spans of each row. */
#include <stdlib.h>
#include <string.h>
#include "spans.h"

void rf_spans_free(struct rf_spans *spans)
{
    free(spans->first);
    free(spans->x);
    memset(spans, 0, sizeof *spans);
}

static int take_memory(struct rf_spans *spans, int32_t y, int32_t rows, int64_t numbers)
{
    memset(spans, 0, sizeof *spans);
    spans->y = y;
    spans->rows = rows;
    if ((uint64_t)numbers < SIZE_MAX / sizeof(int32_t)) {
        spans->first = malloc(((size_t)rows + 1) * sizeof *spans->first);
        spans->x = malloc(((size_t)numbers + 1) * sizeof *spans->x);
    }
    if (spans->first && spans->x)
        return REFOCUS_OK;
    rf_spans_free(spans);
    return REFOCUS_ERR_MEMORY;
}

/* The first place from x on where the mask is not value, up to width. */
static int32_t run_end(const uint8_t *row, int32_t x, int32_t width, uint8_t value)
{
    const uint64_t eight = value * UINT64_C(0x0101010101010101);
    uint64_t word;

    for (; x + 8 <= width; x += 8) {
        memcpy(&word, row + x, 8);
        if (word != eight)
            break;
    }
    while (x < width && row[x] == value)
        x++;
    return x;
}

/* The ends of runs of 1 in a row of zeros and ones; out may be NULL to count them. */
static int64_t find_runs(const uint8_t *row, int32_t width, int32_t offset, int32_t *out)
{
    int64_t count = 0;
    int32_t x = 0;

    while ((x = run_end(row, x, width, 0)) < width) {
        const int32_t end = run_end(row, x, width, 1);

        if (out) {
            out[count] = x + offset;
            out[count + 1] = end + offset;
        }
        count += 2;
        x = end;
    }
    return count;
}

int rf_spans_of_mask(struct rf_spans *spans, const uint8_t *mask, struct rf_area area)
{
    int64_t numbers = 0;
    int status;

    for (int32_t y = 0; y < area.height; y++)
        numbers += find_runs(mask + (size_t)y * (size_t)area.width, area.width, 0, NULL);
    status = take_memory(spans, area.y, area.height, numbers);
    if (status != REFOCUS_OK)
        return status;
    spans->first[0] = 0;
    for (int32_t y = 0; y < area.height; y++)
        spans->first[y + 1] =
            spans->first[y] + find_runs(mask + (size_t)y * (size_t)area.width, area.width, area.x,
                                        spans->x + spans->first[y]);
    return REFOCUS_OK;
}

int rf_spans_of_all(struct rf_spans *spans, int32_t width, int32_t height)
{
    const int status = take_memory(spans, 0, height, 2 * (int64_t)height);

    if (status != REFOCUS_OK)
        return status;
    for (int32_t y = 0; y <= height; y++)
        spans->first[y] = 2 * (int64_t)y;
    for (int32_t y = 0; y < height; y++) {
        spans->x[2 * y] = 0;
        spans->x[2 * y + 1] = width;
    }
    return REFOCUS_OK;
}

int rf_spans_copy(struct rf_spans *to, const struct rf_spans *from)
{
    const int64_t numbers = from->first[from->rows];
    const int status = take_memory(to, from->y, from->rows, numbers);

    if (status != REFOCUS_OK)
        return status;
    memcpy(to->first, from->first, ((size_t)from->rows + 1) * sizeof *to->first);
    memcpy(to->x, from->x, (size_t)numbers * sizeof *to->x);
    return REFOCUS_OK;
}

int64_t rf_spans_row(const struct rf_spans *spans, int32_t y, const int32_t **x)
{
    const int32_t row = y - spans->y;

    if (!spans->first || row < 0 || row >= spans->rows)
        return 0;
    *x = spans->x + spans->first[row];
    return spans->first[row + 1] - spans->first[row];
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

bool rf_spans_differ(const struct rf_spans *a, const struct rf_spans *b, int32_t y, int32_t *from,
                     int32_t *to)
{
    const int32_t *p = NULL, *q = NULL;
    const int64_t m = rf_spans_row(a, y, &p), n = rf_spans_row(b, y, &q);
    int64_t same = 0, last = 0;

    if (m == n && (m == 0 || !memcmp(p, q, (size_t)m * sizeof *p)))
        return false;
    if (m == 0 || n == 0) {
        *from = m == 0 ? q[0] : p[0];
        *to = m == 0 ? q[n - 1] : p[m - 1];
        return true;
    }
    while (same < m && same < n && p[same] == q[same])
        same++;
    while (last < m - same && last < n - same && p[m - 1 - last] == q[n - 1 - last])
        last++;
    *from = same == m ? q[same] : same == n ? p[same] : least(p[same], q[same]);
    *to = last == m   ? q[n - 1 - last]
          : last == n ? p[m - 1 - last]
                      : most(p[m - 1 - last], q[n - 1 - last]);
    return true;
}
