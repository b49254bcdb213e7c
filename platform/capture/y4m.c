/* y4m.c: the header of a YUV4MPEG2 stream is parsed, and written. */
#include "y4m.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/platform/source.h>

#define MAGIC "YUV4MPEG2"

/* Words for 4:2:0 by the place of U and V. */
static const char *const yuv420[REFOCUS_CHROMA_PLACE_COUNT] = {"420", "420jpeg", "420mpeg2",
                                                               "420paldv"};

static void parse_colours(struct rf_y4m *y4m, const char *name)
{
    y4m->tall = strcmp(name, "422") == 0;
    y4m->format = y4m->tall                     ? REFOCUS_FRAME_YUYV
                  : strcmp(name, "mono") == 0   ? REFOCUS_FRAME_GREY
                  : strcmp(name, "mono16") == 0 ? REFOCUS_FRAME_Y16
                                                : REFOCUS_FRAME_ANY;
    for (uint32_t i = 0; i < REFOCUS_CHROMA_PLACE_COUNT; i++)
        if (strcmp(name, yuv420[i]) == 0) {
            y4m->format = REFOCUS_FRAME_YUV420;
            y4m->chroma_place = i;
        }
}

static void parse_aspect(int32_t aspect[2], const char *text)
{
    int width = 0, height = 0;

    if (sscanf(text, "%9d:%9d", &width, &height) != 2 || width < 1 || height < 1)
        width = height = 0;
    aspect[0] = width;
    aspect[1] = height;
}

/* A side of the picture; 0, which is out of the range, where the text is no such number. */
static int parse_side(const char *text)
{
    char *end;
    const long side = strtol(text, &end, 10);

    return *end == '\0' && side > 0 && side <= REFOCUS_MAX_SIDE ? (int)side : 0;
}

static double parse_rate(const char *text)
{
    long numerator = 0, denominator = 1;

    sscanf(text, "%9ld:%9ld", &numerator, &denominator);
    return numerator > 0 && denominator > 0 ? (double)numerator / (double)denominator : 0;
}

static void parse_word(struct rf_y4m *y4m, const char *word, char *fields)
{
    const char *const value = word + 1;

    if (*word == 'W')
        y4m->width = parse_side(value);
    else if (*word == 'H')
        y4m->height = parse_side(value);
    else if (*word == 'F')
        y4m->fps = parse_rate(value);
    else if (*word == 'I')
        *fields = *value;
    else if (*word == 'A')
        parse_aspect(y4m->aspect, value);
    else if (*word == 'C')
        parse_colours(y4m, value);
    else if (strcmp(word, "XCOLORRANGE=FULL") == 0)
        y4m->full_range = true;
}

int rf_y4m_parse(struct rf_y4m *y4m, char *header, const char *path, struct refocus_reason *reason)
{
    const size_t begin = strlen(MAGIC);
    char *word, *rest = NULL, fields = 'p';

    *y4m = (struct rf_y4m){.format = REFOCUS_FRAME_YUV420};
    if (strncmp(header, MAGIC, begin) != 0 || (header[begin] && header[begin] != ' '))
        return rf_capture_fail(reason, REFOCUS_ERR_FORMAT, "%.160s: it is not a YUV4MPEG2 stream",
                               path);
    for (word = strtok_r(header + begin, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        parse_word(y4m, word, &fields);
    if (fields == 't' || fields == 'b' || fields == 'm')
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%.160s: it is interlaced (I%c); deinterlace it first", path,
                               fields);
    if (y4m->format == REFOCUS_FRAME_ANY)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%.160s: give 4:2:0 or 4:2:2 of 8 bits, mono or mono16", path);
    return REFOCUS_OK;
}

/* The simplest fraction that is a rate to 13 digits, by its continued fraction: 29.97002997 is
 * 29 + 1/(1 + 1/(32 + 1/(2 + 1/1.2))) and so on to 30000/1001. */
static void find_fraction(double rate, long *numerator, long *denominator)
{
    long n[2] = {1, 0}, d[2] = {0, 1};
    double rest = rate;

    for (int i = 0; i < 20; i++) {
        const double whole = floor(rest);
        const double next_n = whole * (double)n[0] + (double)n[1];
        const double next_d = whole * (double)d[0] + (double)d[1];

        if (next_n > 999999999 || next_d > 999999999)
            break;
        n[1] = n[0];
        d[1] = d[0];
        n[0] = (long)next_n;
        d[0] = (long)next_d;
        if (n[0] > 0 && fabs((double)n[0] / (double)d[0] - rate) <= 1e-13 * rate)
            break;
        rest = 1 / (rest - whole);
    }
    *numerator = n[0] > 0 && d[0] > 0 ? n[0] : 1;
    *denominator = d[0] > 0 ? d[0] : 999999999;
}

size_t rf_y4m_write(char header[RF_Y4M_HEADER], const struct rf_y4m *y4m)
{
    const uint32_t place =
        y4m->chroma_place ? y4m->chroma_place : (uint32_t)REFOCUS_CHROMA_PLACE_CENTRE;
    const bool known = y4m->aspect[0] > 0;
    long numerator, denominator;

    find_fraction(y4m->fps, &numerator, &denominator);
    return (size_t)snprintf(header, RF_Y4M_HEADER,
                            MAGIC " W%d H%d F%ld:%ld Ip A%d:%d C%s XCOLORRANGE=%s\n", y4m->width,
                            y4m->height, numerator, denominator, known ? (int)y4m->aspect[0] : 1,
                            known ? (int)y4m->aspect[1] : 1, y4m->tall ? "422" : yuv420[place],
                            y4m->full_range ? "FULL" : "LIMITED");
}
