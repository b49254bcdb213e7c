/* xmp_parse.c: XMP is read by expat: the few properties that say what is depth, which may be
 * attributes or elements. */
#include "xmp_parse.h"

#include <errno.h>
#include <expat.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "reason.h"

/* expat puts it between namespace and name; it is in no URI. */
#define SEPARATOR   "|"
#define DEPTH       "http://ns.google.com/photos/1.0/depthmap/" SEPARATOR
#define IMAGE       "http://ns.google.com/photos/1.0/image/" SEPARATOR
#define FOCUS       "http://ns.google.com/photos/1.0/focus/" SEPARATOR
#define APPLE       "http://ns.apple.com/pixeldatainfo/1.0/" SEPARATOR
#define APPLE_DEPTH "http://ns.apple.com/depthData/1.0/" SEPARATOR
#define APPLE_BLUR  "http://ns.apple.com/depthBlurEffect/1.0/" SEPARATOR

static const char *const names[RF_XMP_KEYS] = {
    [RF_XMP_EXTENDED] = "http://ns.adobe.com/xmp/note/" SEPARATOR "HasExtendedXMP",
    [RF_XMP_DEPTH_FORMAT] = DEPTH "Format",
    [RF_XMP_DEPTH_NEAR] = DEPTH "Near",
    [RF_XMP_DEPTH_FAR] = DEPTH "Far",
    [RF_XMP_DEPTH_UNITS] = DEPTH "Units",
    [RF_XMP_DEPTH_MIME] = DEPTH "Mime",
    [RF_XMP_DEPTH_DATA] = DEPTH "Data",
    [RF_XMP_IMAGE_MIME] = IMAGE "Mime",
    [RF_XMP_IMAGE_DATA] = IMAGE "Data",
    [RF_XMP_FOCUS_X] = FOCUS "FocalPointX",
    [RF_XMP_FOCUS_Y] = FOCUS "FocalPointY",
    [RF_XMP_FOCUS_DISTANCE] = FOCUS "FocalDistance",
    [RF_XMP_FOCUS_BLUR] = FOCUS "BlurAtInfinity",
    [RF_XMP_APPLE_TYPE] = APPLE "AuxiliaryImageType",
    [RF_XMP_APPLE_FLOAT_MIN] = APPLE "FloatMinValue",
    [RF_XMP_APPLE_FLOAT_MAX] = APPLE "FloatMaxValue",
    [RF_XMP_APPLE_INT_MIN] = APPLE "IntMinValue",
    [RF_XMP_APPLE_INT_MAX] = APPLE "IntMaxValue",
    [RF_XMP_APPLE_ACCURACY] = APPLE_DEPTH "Accuracy",
    [RF_XMP_APPLE_APERTURE] = APPLE_BLUR "SimulatedAperture",
    [RF_XMP_GAIN_MAP] = "http://ns.adobe.com/hdr-gain-map/1.0/" SEPARATOR "Version",
};

struct parsing {
    const struct rf_read *read;
    XML_Parser parser;
    struct rf_xmp *xmp;
    int key;     /* property whose text is collected; RF_XMP_KEYS: none */
    int depth;   /* elements open inside that property */
    size_t room; /* bytes reserved for its text */
    int status;
};

static int find_key(const char *name)
{
    for (int key = 0; key < RF_XMP_KEYS; key++) {
        if (strcmp(name, names[key]) == 0) {
            return key;
        }
    }
    return RF_XMP_KEYS;
}

static void stop(struct parsing *parsing, int status)
{
    if (parsing->status == REFOCUS_OK) {
        parsing->status = status;
    }
    XML_StopParser(parsing->parser, XML_FALSE);
}

/* Append text to the value of parsing->key and keep it terminated. */
static void append(struct parsing *parsing, const char *text, size_t size)
{
    struct rf_xmp *const xmp = parsing->xmp;
    const size_t length = xmp->length[parsing->key];
    char *value = xmp->value[parsing->key];

    if (length + size + 1 > parsing->room) {
        /* The text lies in memory already, so that length + size cannot overflow. */
        const size_t room = length + size + 1 + length / 2;
        int status = rf_check_bytes(parsing->read, room, "its XMP");

        if (status == REFOCUS_OK) {
            value = realloc(value, room);
            status = value ? REFOCUS_OK : rf_fail_memory(parsing->read->reason);
        }
        if (status != REFOCUS_OK) {
            stop(parsing, status);
            return;
        }
        xmp->value[parsing->key] = value;
        parsing->room = room;
    }
    memcpy(value + length, text, size);
    value[length + size] = '\0';
    xmp->length[parsing->key] = length + size;
}

static void begin_value(struct parsing *parsing, int key)
{
    parsing->key = key;
    parsing->depth = 0;
    parsing->room = 0;
}

static void XMLCALL on_start(void *user, const XML_Char *name, const XML_Char **attributes)
{
    struct parsing *const parsing = user;
    int key;

    if (parsing->key != RF_XMP_KEYS) {
        parsing->depth++;
        return;
    }
    for (; *attributes && parsing->status == REFOCUS_OK; attributes += 2) {
        key = find_key(attributes[0]);
        if (key != RF_XMP_KEYS && !parsing->xmp->value[key]) {
            begin_value(parsing, key);
            append(parsing, attributes[1], strlen(attributes[1]));
        }
    }
    parsing->key = RF_XMP_KEYS;
    key = find_key(name);
    if (key != RF_XMP_KEYS && !parsing->xmp->value[key] && parsing->status == REFOCUS_OK) {
        begin_value(parsing, key);
        append(parsing, "", 0);
    }
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    struct parsing *const parsing = user;

    (void)name;
    if (parsing->key != RF_XMP_KEYS && parsing->depth-- == 0) {
        parsing->key = RF_XMP_KEYS;
    }
}

static void XMLCALL on_text(void *user, const XML_Char *text, int size)
{
    struct parsing *const parsing = user;

    if (parsing->key != RF_XMP_KEYS && parsing->depth == 0 && parsing->status == REFOCUS_OK) {
        append(parsing, text, (size_t)size);
    }
}

/* XMP has no document type. Entities live there, and their expansion is an old trap. */
static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system,
                               const XML_Char *public, int internal)
{
    struct parsing *const parsing = user;

    (void)name;
    (void)system;
    (void)public;
    (void)internal;
    stop(parsing, rf_fail(parsing->read->reason, REFOCUS_ERR_FORMAT,
                          "damaged: its XMP has a document type, which XMP never has"));
}

static int run(struct parsing *parsing, struct rf_bytes packet)
{
    enum XML_Error error;

    errno = 0;
    /* Writers pad packets with blanks, some with zeros that XML does not allow. */
    while (packet.size > 0 && packet.data[packet.size - 1] == 0) {
        packet.size--;
    }
    while (packet.size > 0 && parsing->status == REFOCUS_OK) {
        /* Steps are small: expat takes an int, and doubles its buffer up to the needs of one. */
        const size_t step = packet.size < INT_MAX / 2 ? packet.size : INT_MAX / 2;
        if (XML_Parse(parsing->parser, (const char *)packet.data, (int)step, step == packet.size) ==
            XML_STATUS_ERROR) {
            break;
        }
        packet.data += step;
        packet.size -= step;
    }
    if (parsing->status != REFOCUS_OK) {
        return parsing->status;
    }
    /* expat takes some failed allocations for an unbound prefix, or goes on without the text that
     * found no room; malloc() itself says so in errno. */
    error = XML_GetErrorCode(parsing->parser);
    if (error == XML_ERROR_NO_MEMORY || errno == ENOMEM) {
        return rf_fail_memory(parsing->read->reason);
    }
    if (packet.size == 0) {
        return REFOCUS_OK;
    }
    return rf_fail(parsing->read->reason, REFOCUS_ERR_FORMAT, "damaged: its XMP: %s",
                   XML_ErrorString(error));
}

int rf_xmp_parse(const struct rf_read *read, struct rf_bytes packet, struct rf_xmp *xmp)
{
    static const XML_Memory_Handling_Suite memory = {malloc, realloc, free};
    struct parsing parsing = {.read = read, .xmp = xmp, .key = RF_XMP_KEYS};
    int status;

    parsing.parser = XML_ParserCreate_MM(NULL, &memory, SEPARATOR);
    if (!parsing.parser) {
        return rf_fail_memory(read->reason);
    }
    XML_SetUserData(parsing.parser, &parsing);
    XML_SetElementHandler(parsing.parser, on_start, on_end);
    XML_SetCharacterDataHandler(parsing.parser, on_text);
    XML_SetStartDoctypeDeclHandler(parsing.parser, on_doctype);
    status = run(&parsing, packet);
    XML_ParserFree(parsing.parser);
    return status;
}
