/* y4m.c: the header of a YUV4MPEG2 stream is parsed. */
#include "y4m.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/platform/source.h>

#define MAGIC "YUV4MPEG2"

static uint32_t colour_space(const char *name)
{
    static const char *const yuv420[] = {"420", "420jpeg", "420mpeg2", "420paldv"};

    for (int i = 0; i < 4; i++)
        if (strcmp(name, yuv420[i]) == 0)
            return REFOCUS_FRAME_YUV420;
    if (strcmp(name, "422") == 0)
        return REFOCUS_FRAME_YUYV;
    if (strcmp(name, "mono") == 0)
        return REFOCUS_FRAME_GREY;
    return strcmp(name, "mono16") == 0 ? REFOCUS_FRAME_Y16 : REFOCUS_FRAME_ANY;
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
    return numerator > 0 && denominator > 0 ? (double)numerator / (double)denominator : 30;
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
    else if (*word == 'C') {
        y4m->tall = strcmp(value, "422") == 0;
        y4m->format = colour_space(value);
    } else if (strcmp(word, "XCOLORRANGE=FULL") == 0)
        y4m->full_range = true;
}

int rf_y4m_parse(struct rf_y4m *y4m, char *header, const char *path, struct refocus_reason *reason)
{
    const size_t begin = strlen(MAGIC);
    char *word, *rest = NULL, fields = 'p';

    *y4m = (struct rf_y4m){.format = REFOCUS_FRAME_YUV420, .fps = 30};
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
