/* xmp_parse.c: XMP is read by expat: the few properties that say what is depth and what a
 * gain map means, which may be attributes or elements. */
#include "xmp_parse.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reason.h"

#define SEPARATOR   RF_XMP_SEPARATOR
#define DEPTH       "http://ns.google.com/photos/1.0/depthmap/" SEPARATOR
#define IMAGE       "http://ns.google.com/photos/1.0/image/" SEPARATOR
#define FOCUS       "http://ns.google.com/photos/1.0/focus/" SEPARATOR
#define APPLE       "http://ns.apple.com/pixeldatainfo/1.0/" SEPARATOR
#define APPLE_DEPTH "http://ns.apple.com/depthData/1.0/" SEPARATOR
#define REFOCUS     RF_NS_REFOCUS SEPARATOR
#define APPLE_BLUR  "http://ns.apple.com/depthBlurEffect/1.0/" SEPARATOR
#define DYNAMIC     "http://ns.google.com/photos/dd/1.0/"
#define CAMERA      DYNAMIC "camera/" SEPARATOR
#define MAP         DYNAMIC "depthmap/" SEPARATOR
#define PICTURE     DYNAMIC "image/" SEPARATOR
#define ITEM        DYNAMIC "item/" SEPARATOR
#define CONTAINER   "http://ns.google.com/photos/1.0/container/"
#define ITEM_1      CONTAINER "item/" SEPARATOR
#define GAIN        RF_NS_GAIN_MAP SEPARATOR

static const struct {
    int key;
    const char *name;
} names[] = {
    {RF_XMP_EXTENDED, "http://ns.adobe.com/xmp/note/" SEPARATOR "HasExtendedXMP"},
    {RF_XMP_DEPTH_FORMAT, DEPTH "Format"},
    {RF_XMP_DEPTH_NEAR, DEPTH "Near"},
    {RF_XMP_DEPTH_FAR, DEPTH "Far"},
    {RF_XMP_DEPTH_UNITS, DEPTH "Units"},
    {RF_XMP_DEPTH_MIME, DEPTH "Mime"},
    {RF_XMP_DEPTH_DATA, DEPTH "Data"},
    {RF_XMP_DEPTH_CONFIDENCE, DEPTH "Confidence"},
    {RF_XMP_IMAGE_MIME, IMAGE "Mime"},
    {RF_XMP_IMAGE_DATA, IMAGE "Data"},
    {RF_XMP_FOCUS_X, FOCUS "FocalPointX"},
    {RF_XMP_FOCUS_Y, FOCUS "FocalPointY"},
    {RF_XMP_FOCUS_DISTANCE, FOCUS "FocalDistance"},
    {RF_XMP_FOCUS_BLUR, FOCUS "BlurAtInfinity"},
    {RF_XMP_APPLE_TYPE, APPLE "AuxiliaryImageType"},
    {RF_XMP_APPLE_SUBTYPE, APPLE "AuxiliaryImageSubType"},
    {RF_XMP_APPLE_FLOAT_MIN, APPLE "FloatMinValue"},
    {RF_XMP_APPLE_FLOAT_MAX, APPLE "FloatMaxValue"},
    {RF_XMP_APPLE_INT_MIN, APPLE "IntMinValue"},
    {RF_XMP_APPLE_INT_MAX, APPLE "IntMaxValue"},
    {RF_XMP_APPLE_ACCURACY, APPLE_DEPTH "Accuracy"},
    {RF_XMP_APPLE_APERTURE, APPLE_BLUR "SimulatedAperture"},
    {RF_XMP_GAIN_MAP, GAIN "Version"},
    {RF_XMP_NOTE_ORIGINAL, REFOCUS "OriginalOrientation"},
    {RF_XMP_NOTE_DEPTH, REFOCUS "DepthOrientation"},
    {RF_XMP_NOTE_FOCUS, REFOCUS "FocusDisparity"},
    {RF_XMP_NOTE_BLUR, REFOCUS "MaxBlurRadius"},
    {RF_XMP_NOTE_F_NUMBER, REFOCUS "SimulatedFNumber"},
    {RF_XMP_NOTE_MATTE, REFOCUS "Matte"},
    {RF_XMP_MAP_FORMAT, MAP "Format"},
    {RF_XMP_MAP_NEAR, MAP "Near"},
    {RF_XMP_MAP_FAR, MAP "Far"},
    {RF_XMP_MAP_UNITS, MAP "Units"},
    {RF_XMP_MAP_SEMANTIC, MAP "ItemSemantic"},
    {RF_XMP_MAP_URI, MAP "DepthURI"},
    {RF_XMP_MAP_CONFIDENCE_URI, MAP "ConfidenceURI"},
    {RF_XMP_CAMERA_IMAGE_SEMANTIC, PICTURE "ItemSemantic"},
    {RF_XMP_CAMERA_IMAGE_URI, PICTURE "ItemURI"},
    {RF_XMP_ITEM_SEMANTIC, ITEM "Semantic"},
    {RF_XMP_ITEM_SEMANTIC, ITEM_1 "Semantic"},
    {RF_XMP_ITEM_URI, ITEM "DataURI"},
    {RF_XMP_ITEM_URI, ITEM_1 "DataURI"},
    {RF_XMP_ITEM_LENGTH, ITEM "Length"},
    {RF_XMP_ITEM_LENGTH, ITEM_1 "Length"},
    {RF_XMP_ITEM_PADDING, ITEM "Padding"},
    {RF_XMP_ITEM_PADDING, ITEM_1 "Padding"},
    {RF_XMP_APPLE_HEADROOM, "http://ns.apple.com/HDRGainMap/1.0/" SEPARATOR "HDRGainMapHeadroom"},
    {RF_XMP_GAIN_MIN, GAIN "GainMapMin"},
    {RF_XMP_GAIN_MAX, GAIN "GainMapMax"},
    {RF_XMP_GAIN_GAMMA, GAIN "Gamma"},
    {RF_XMP_GAIN_OFFSET_SDR, GAIN "OffsetSDR"},
    {RF_XMP_GAIN_OFFSET_HDR, GAIN "OffsetHDR"},
    {RF_XMP_GAIN_CAPACITY_MIN, GAIN "HDRCapacityMin"},
    {RF_XMP_GAIN_CAPACITY_MAX, GAIN "HDRCapacityMax"},
    {RF_XMP_GAIN_BASE_IS_HDR, GAIN "BaseRenditionIsHDR"},
};

struct parsing {
    const struct rf_read *read;
    XML_Parser parser;
    struct rf_xmp *xmp;
    int key;       /* property whose text is collected; RF_XMP_KEYS: none */
    int depth;     /* elements open inside that property */
    uint32_t open; /* elements open at all */
    size_t room;   /* bytes reserved for its text */
    int status;
};

/* The key of a name whose value is still to be read, else RF_XMP_KEYS. */
static int find_key(const struct rf_xmp *xmp, const char *name)
{
    int key = RF_XMP_KEYS;

    for (size_t i = 0; i < sizeof names / sizeof *names && key == RF_XMP_KEYS; i++)
        if (strcmp(name, names[i].name) == 0)
            key = names[i].key;
    if (key == RF_XMP_KEYS || xmp->value[key] ||
        (key >= RF_XMP_MAP_FORMAT && key <= RF_XMP_MAP_CONFIDENCE_URI && xmp->maps > 1) ||
        (key >= RF_XMP_CAMERA_IMAGE_SEMANTIC && key <= RF_XMP_CAMERA_IMAGE_URI && xmp->images > 1))
        return RF_XMP_KEYS;
    return key;
}

static void stop(struct parsing *parsing, int status)
{
    if (parsing->status == REFOCUS_OK)
        parsing->status = status;
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

/* Cameras of Dynamic Depth and directories repeat their properties: what they belong to is told by
 * the elements around them. */
static void count_element(struct rf_xmp *xmp, const char *name)
{
    xmp->maps += strcmp(name, CAMERA "DepthMap") == 0;
    xmp->images += strcmp(name, CAMERA "Image") == 0;
    xmp->directories += strcmp(name, DYNAMIC "container/" SEPARATOR "Directory") == 0 ||
                        strcmp(name, CONTAINER SEPARATOR "Directory") == 0;
}

static void XMLCALL on_start(void *user, const XML_Char *name, const XML_Char **attributes)
{
    struct parsing *const parsing = user;
    int key;

    if (++parsing->open > parsing->read->limits.max_depth) {
        stop(parsing, rf_fail(parsing->read->reason, REFOCUS_ERR_SIZE,
                              "its XMP has elements within each other beyond the limit of %u",
                              (unsigned)parsing->read->limits.max_depth));
        return;
    }
    if (parsing->key != RF_XMP_KEYS) {
        parsing->depth++;
        return;
    }
    count_element(parsing->xmp, name);
    for (; *attributes && parsing->status == REFOCUS_OK; attributes += 2) {
        key = find_key(parsing->xmp, attributes[0]);
        if (key != RF_XMP_KEYS) {
            begin_value(parsing, key);
            append(parsing, attributes[1], strlen(attributes[1]));
        }
    }
    parsing->key = RF_XMP_KEYS;
    key = find_key(parsing->xmp, name);
    if (key != RF_XMP_KEYS && parsing->status == REFOCUS_OK) {
        begin_value(parsing, key);
        append(parsing, "", 0);
    }
}

static void copy_name(char name[RF_XMP_ITEM_NAME], const char *value)
{
    snprintf(name, RF_XMP_ITEM_NAME, "%s", value ? value : "");
}

/* A count of bytes, 0 when it is not said. */
static int read_bytes(const struct parsing *parsing, enum rf_xmp_key key, const char *name,
                      uint64_t *bytes)
{
    double value;
    bool found;
    const int status = rf_xmp_number(parsing->read, parsing->xmp, key, name, &found, &value);

    if (status != REFOCUS_OK)
        return status;
    if (!(value >= 0.0 && value < 9007199254740992.0)) { /* 2^53: any sum of them fits */
        return rf_fail(parsing->read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its %s is no count of bytes", name);
    }
    *bytes = (uint64_t)value;
    return REFOCUS_OK;
}

/* Writers put the properties of an item into Container:Item or right into the element of the list
 * around it, so that the end of either is the end of the item. */
static bool ends_item(const char *name)
{
    return strcmp(name, DYNAMIC "container/" SEPARATOR "Item") == 0 ||
           strcmp(name, CONTAINER SEPARATOR "Item") == 0 ||
           strcmp(name, "http://www.w3.org/1999/02/22-rdf-syntax-ns#" SEPARATOR "li") == 0;
}

/* Bring the properties of an item from their keys to the list of items. */
static void take_item(struct parsing *parsing)
{
    struct rf_xmp *const xmp = parsing->xmp;
    struct rf_xmp_item *const item = &xmp->item[xmp->items % RF_XMP_ITEMS];
    int status = REFOCUS_OK;

    if (!xmp->value[RF_XMP_ITEM_SEMANTIC] && !xmp->value[RF_XMP_ITEM_URI] &&
        !xmp->value[RF_XMP_ITEM_LENGTH] && !xmp->value[RF_XMP_ITEM_PADDING])
        return;
    if (xmp->items == RF_XMP_ITEMS) {
        stop(parsing, rf_fail(parsing->read->reason, REFOCUS_ERR_SIZE,
                              "its container directory has more than %d items", RF_XMP_ITEMS));
        return;
    }
    xmp->items++;
    item->directory = xmp->directories;
    copy_name(item->semantic, xmp->value[RF_XMP_ITEM_SEMANTIC]);
    copy_name(item->uri, xmp->value[RF_XMP_ITEM_URI]);
    status = read_bytes(parsing, RF_XMP_ITEM_LENGTH, "Item:Length", &item->length);
    if (status == REFOCUS_OK)
        status = read_bytes(parsing, RF_XMP_ITEM_PADDING, "Item:Padding", &item->padding);
    for (int key = RF_XMP_ITEM_SEMANTIC; key <= RF_XMP_ITEM_PADDING; key++) {
        free(xmp->value[key]);
        xmp->value[key] = NULL;
        xmp->length[key] = 0;
    }
    if (status != REFOCUS_OK)
        stop(parsing, status);
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    struct parsing *const parsing = user;

    parsing->open--;
    if (parsing->key == RF_XMP_KEYS) {
        if (ends_item(name))
            take_item(parsing);
    } else if (parsing->depth-- == 0) {
        parsing->key = RF_XMP_KEYS;
    } else if (parsing->key >= RF_XMP_GAIN_MIN && parsing->status == REFOCUS_OK) {
        append(parsing, " ", 1);
    }
}

static void XMLCALL on_text(void *user, const XML_Char *text, int size)
{
    struct parsing *const parsing = user;

    if (parsing->key != RF_XMP_KEYS && parsing->status == REFOCUS_OK &&
        (parsing->depth == 0 || parsing->key >= RF_XMP_GAIN_MIN))
        append(parsing, text, (size_t)size);
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

/* Tags and attributes, with those in text counted, too, which is on the safe side: expat takes up
 * to 100 bytes for each of them before it tells of the first. */
int rf_xmp_check(const struct rf_read *read, struct rf_bytes packet)
{
    uint64_t elements = 0;

    for (size_t i = 0; i < packet.size; i++)
        elements += packet.data[i] == '<' || packet.data[i] == '=';
    if (elements > read->limits.max_elements) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its XMP has %llu tags and attributes, more than the limit of %u",
                       (unsigned long long)elements, (unsigned)read->limits.max_elements);
    }
    return rf_check_metadata(read, packet.size, "its XMP");
}

XML_Parser rf_xmp_parser(void *user, XML_StartElementHandler on_element,
                         XML_EndElementHandler on_element_end,
                         XML_StartDoctypeDeclHandler on_document_type)
{
    static const XML_Memory_Handling_Suite memory = {malloc, realloc, free};
    XML_Parser parser = XML_ParserCreate_MM(NULL, &memory, RF_XMP_SEPARATOR);

    if (parser) {
        XML_SetUserData(parser, user);
        XML_SetElementHandler(parser, on_element, on_element_end);
        XML_SetStartDoctypeDeclHandler(parser, on_document_type);
    }
    return parser;
}

int rf_xmp_run(const struct rf_read *read, XML_Parser parser, struct rf_bytes packet,
               const int *status)
{
    enum XML_Error error;

    errno = 0;
    /* Writers pad packets with blanks, some with zeros that XML does not allow. */
    while (packet.size > 0 && packet.data[packet.size - 1] == 0)
        packet.size--;
    while (packet.size > 0 && *status == REFOCUS_OK) {
        /* Steps are small: expat takes an int, and doubles its buffer up to the needs of one. */
        const size_t step = packet.size < INT_MAX / 2 ? packet.size : INT_MAX / 2;
        if (XML_Parse(parser, (const char *)packet.data, (int)step, step == packet.size) ==
            XML_STATUS_ERROR)
            break;
        packet.data += step;
        packet.size -= step;
    }
    if (*status != REFOCUS_OK)
        return *status;
    /* expat takes some failed allocations for an unbound prefix, or goes on without the text that
     * found no room; malloc() itself says so in errno. */
    error = XML_GetErrorCode(parser);
    if (error == XML_ERROR_NO_MEMORY || errno == ENOMEM)
        return rf_fail_memory(read->reason);
    if (packet.size == 0)
        return REFOCUS_OK;
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its XMP: %s",
                   XML_ErrorString(error));
}

int rf_xmp_parse(const struct rf_read *read, struct rf_bytes packet, struct rf_xmp *xmp)
{
    struct parsing parsing = {.read = read, .xmp = xmp, .key = RF_XMP_KEYS};
    int status = rf_xmp_check(read, packet);

    if (status != REFOCUS_OK)
        return status;
    parsing.parser = rf_xmp_parser(&parsing, on_start, on_end, on_doctype);
    if (!parsing.parser)
        return rf_fail_memory(read->reason);
    XML_SetCharacterDataHandler(parsing.parser, on_text);
    status = rf_xmp_run(read, parsing.parser, packet, &parsing.status);
    XML_ParserFree(parsing.parser);
    return status;
}
