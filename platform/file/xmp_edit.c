/* xmp_edit.c: an XMP packet is edited in its own bytes. expat says which elements and attributes
 * are properties to be cut and where their tags lie; attributes are then found within their tag. */
#include "xmp_edit.h"

#include <stdlib.h>
#include <string.h>

#include "reason.h"
#include "xmp_parse.h"

#define SEPARATOR RF_XMP_SEPARATOR
#define RDF       RF_NS_RDF SEPARATOR

/* Names begin with one of these; the first that fits decides. */
static const struct {
    const char *begin;
    unsigned cut; /* 0: stays */
} properties[] = {
    {RF_NS_DEPTH SEPARATOR, RF_XMP_CUT_DEPTH},
    {RF_NS_IMAGE SEPARATOR, RF_XMP_CUT_ORIGINAL},
    {RF_NS_FOCUS SEPARATOR "FocalPoint", RF_XMP_CUT_POINT},
    {RF_NS_FOCUS SEPARATOR, RF_XMP_CUT_BLUR},
    {RF_NS_REFOCUS SEPARATOR, RF_XMP_CUT_NOTE},
    {RF_NS_NOTE SEPARATOR "HasExtendedXMP", RF_XMP_CUT_EXTENDED},
    {RF_NS_GAIN_MAP, RF_XMP_CUT_GAIN_MAP},
    {RF_NS_CONTAINER, RF_XMP_CUT_STALE},
    {RF_NS_DYNAMIC, RF_XMP_CUT_STALE},
    {"http://ns.google.com/photos/1.0/camera/" SEPARATOR "MicroVideo", RF_XMP_CUT_STALE},
    {"http://ns.google.com/photos/1.0/camera/" SEPARATOR "MotionPhoto", RF_XMP_CUT_STALE},
    {"http://ns.apple.com/HDRGainMap/1.0/", RF_XMP_CUT_GAIN_MAP},
    {"http://ns.apple.com/pixeldatainfo/1.0/", RF_XMP_CUT_STALE},
    {"http://ns.apple.com/depthData/1.0/", RF_XMP_CUT_STALE},
    {"http://ns.apple.com/depthBlurEffect/1.0/", RF_XMP_CUT_STALE},
    {"http://ns.adobe.com/xap/1.0/" SEPARATOR "Thumbnails", RF_XMP_CUT_STALE},
    {"http://ns.adobe.com/tiff/1.0/" SEPARATOR "Orientation", RF_XMP_CUT_ORIENTATION},
    {"http://ns.adobe.com/tiff/1.0/" SEPARATOR "ImageWidth", RF_XMP_CUT_SIZE},
    {"http://ns.adobe.com/tiff/1.0/" SEPARATOR "ImageLength", RF_XMP_CUT_SIZE},
    {"http://ns.adobe.com/exif/1.0/" SEPARATOR "PixelXDimension", RF_XMP_CUT_SIZE},
    {"http://ns.adobe.com/exif/1.0/" SEPARATOR "PixelYDimension", RF_XMP_CUT_SIZE},
};

struct stretch {
    size_t begin, end;
};

struct editing {
    const struct rf_read *read;
    XML_Parser parser;
    struct rf_bytes packet;
    struct rf_xmp_edit *edit;
    struct stretch *cuts; /* in ascending order */
    size_t count, room;
    uint32_t open;     /* elements open at all */
    uint32_t frame;    /* elements open inside of rdf:RDF, itself counted; 0: not in it */
    uint32_t cut_open; /* elements open inside of one that is cut, itself counted */
    size_t cut_begin;
    /* The node (mostly an rdf:Description) that is open: */
    size_t node_begin, node_cuts; /* offset; cuts before it */
    bool node_has, node_lost;     /* properties that stay, and that are cut */
    bool has;                     /* a node stays */
    size_t place;                 /* offset of the end tag of rdf:RDF; 0: none */
    int status;
};

static void stop(struct editing *editing, int status)
{
    if (editing->status == REFOCUS_OK)
        editing->status = status;
    XML_StopParser(editing->parser, XML_FALSE);
}

static void cut(struct editing *editing, size_t begin, size_t end)
{
    if (editing->count == editing->room) {
        const size_t room = 2 * editing->room + 16;
        struct stretch *const cuts = realloc(editing->cuts, room * sizeof *cuts);

        if (!cuts) {
            stop(editing, rf_fail_memory(editing->read->reason));
            return;
        }
        editing->cuts = cuts;
        editing->room = room;
    }
    editing->cuts[editing->count++] = (struct stretch){begin, end};
}

/* Whether a property is to be cut. */
static bool is_cut(struct editing *editing, const char *name)
{
    for (size_t i = 0; i < sizeof properties / sizeof *properties; i++) {
        if (strncmp(name, properties[i].begin, strlen(properties[i].begin)) == 0) {
            editing->edit->found |= properties[i].cut & editing->edit->cut;
            return properties[i].cut & editing->edit->cut;
        }
    }
    return false;
}

static bool is_blank(uint8_t c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Step over the next attribute of a well-formed tag; `attribute` gets its place with the blanks
 * before it. False at the end of the tag. */
static bool next_attribute(const uint8_t *data, size_t *at, size_t end, struct stretch *attribute)
{
    size_t i = *at;
    uint8_t quote;

    attribute->begin = i;
    while (i < end && is_blank(data[i]))
        i++;
    while (i < end && data[i] != '"' && data[i] != '\'')
        i++;
    if (i == end)
        return false;
    quote = data[i++];
    while (i < end && data[i] != quote)
        i++;
    attribute->end = *at = i < end ? i + 1 : end;
    return i < end;
}

static bool declares_namespace(const uint8_t *data, struct stretch attribute)
{
    while (is_blank(data[attribute.begin]))
        attribute.begin++;
    return attribute.end - attribute.begin > 6 && memcmp(data + attribute.begin, "xmlns", 5) == 0 &&
           (data[attribute.begin + 5] == ':' || data[attribute.begin + 5] == '=' ||
            is_blank(data[attribute.begin + 5]));
}

/* expat gives the attributes in their order, without declarations of namespaces. */
static void cut_attributes(struct editing *editing, size_t begin, size_t end,
                           const XML_Char **attributes)
{
    const uint8_t *const data = editing->packet.data;
    struct stretch attribute;
    size_t at = begin;

    while (at < end && !is_blank(data[at]))
        at++;
    while (*attributes && next_attribute(data, &at, end, &attribute)) {
        if (declares_namespace(data, attribute))
            continue;
        if (is_cut(editing, *attributes)) {
            cut(editing, attribute.begin, attribute.end);
            editing->node_lost = true;
        } else if (editing->frame == 2 && strncmp(*attributes, RDF, sizeof RDF - 1) != 0) {
            editing->node_has = true;
        }
        attributes += 2;
    }
}

static void XMLCALL on_start(void *user, const XML_Char *name, const XML_Char **attributes)
{
    struct editing *const editing = user;
    const size_t begin = (size_t)XML_GetCurrentByteIndex(editing->parser);
    const size_t end = begin + (size_t)XML_GetCurrentByteCount(editing->parser);

    if (++editing->open > editing->read->limits.max_depth) {
        stop(editing, REFOCUS_ERR_SIZE);
        return;
    }
    if (editing->cut_open > 0) {
        editing->cut_open++;
        return;
    }
    if (editing->frame > 0 || strcmp(name, RDF "RDF") == 0)
        editing->frame++;
    if (editing->frame >= 3 && is_cut(editing, name)) {
        editing->cut_begin = begin;
        editing->cut_open = 1;
        editing->frame--;
        editing->node_lost = true;
        return;
    }
    if (editing->frame == 2) {
        editing->node_begin = begin;
        editing->node_cuts = editing->count;
        editing->node_has = editing->node_lost = false;
    } else if (editing->frame == 3) {
        editing->node_has = true;
    }
    cut_attributes(editing, begin, end, attributes);
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    struct editing *const editing = user;
    const size_t begin = (size_t)XML_GetCurrentByteIndex(editing->parser);
    const size_t end = begin + (size_t)XML_GetCurrentByteCount(editing->parser);

    (void)name;
    editing->open--;
    if (editing->cut_open > 0) {
        if (--editing->cut_open == 0)
            cut(editing, editing->cut_begin, end);
        return;
    }
    if (editing->frame == 2) {
        if (editing->node_lost && !editing->node_has) {
            editing->count = editing->node_cuts;
            cut(editing, editing->node_begin, end);
        } else {
            editing->has = true;
        }
    } else if (editing->frame == 1 && end > begin) {
        editing->place = begin;
    }
    editing->frame -= editing->frame > 0;
}

static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system,
                               const XML_Char *public, int internal)
{
    (void)name;
    (void)system;
    (void)public;
    (void)internal;
    stop(user, REFOCUS_ERR_FORMAT);
}

static void put(struct rf_text *text, struct rf_bytes bytes)
{
    rf_text_put(text, bytes.data, bytes.size);
}

static void put_new(struct rf_xmp_edit *edit)
{
    rf_text_words(&edit->packet,
                  "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"" RF_NS_RDF "\">");
    put(&edit->packet, edit->insert);
    rf_text_words(&edit->packet, "</rdf:RDF></x:xmpmeta>");
}

static void put_between(struct editing *editing, size_t begin, size_t end)
{
    struct rf_text *const text = &editing->edit->packet;
    const uint8_t *const data = editing->packet.data;

    if (editing->place > 0 && begin <= editing->place && editing->place < end) {
        rf_text_put(text, data + begin, editing->place - begin);
        put(text, editing->edit->insert);
        begin = editing->place;
    }
    rf_text_put(text, data + begin, end - begin);
}

static void put_edited(struct editing *editing)
{
    size_t at = 0;

    for (size_t i = 0; i < editing->count; i++) {
        put_between(editing, at, editing->cuts[i].begin);
        at = editing->cuts[i].end;
    }
    put_between(editing, at, editing->packet.size);
}

static int finish(struct editing *editing)
{
    struct rf_xmp_edit *const edit = editing->edit;

    if (editing->count == 0 && edit->insert.size == 0) {
        edit->outcome = RF_XMP_SAME;
        return REFOCUS_OK;
    }
    edit->outcome = RF_XMP_CHANGED;
    if (editing->has && (editing->place > 0 || edit->insert.size == 0))
        put_edited(editing);
    else if (edit->insert.size > 0)
        put_new(edit);
    else
        edit->outcome = RF_XMP_EMPTY;
    return edit->packet.failed ? rf_fail_memory(editing->read->reason) : REFOCUS_OK;
}

/* Offsets are those of the bytes, which UTF-16 and UTF-32 would make others in the tags. */
static bool has_wide_letters(struct rf_bytes packet)
{
    return packet.size >= 2 && (packet.data[0] == 0 || packet.data[1] == 0 ||
                                packet.data[0] >= 0xfe || packet.data[1] >= 0xfe);
}

int rf_xmp_edit(const struct rf_read *read, struct rf_bytes packet, struct rf_xmp_edit *edit)
{
    struct editing editing = {.read = read, .packet = packet, .edit = edit};
    int status = rf_xmp_check(read, packet);

    edit->found = 0;
    edit->packet = (struct rf_text){NULL, 0, 0, false};
    if (packet.size == 0)
        return finish(&editing);
    if (status == REFOCUS_OK && has_wide_letters(packet))
        status = REFOCUS_ERR_FORMAT;
    if (status == REFOCUS_OK) {
        editing.parser = rf_xmp_parser(&editing, on_start, on_end, on_doctype);
        status = editing.parser ? REFOCUS_OK : rf_fail_memory(read->reason);
    }
    if (status == REFOCUS_OK)
        status = rf_xmp_run(read, editing.parser, packet, &editing.status);
    if (editing.parser)
        XML_ParserFree(editing.parser);
    if (status == REFOCUS_OK)
        status = finish(&editing);
    free(editing.cuts);
    return status;
}
