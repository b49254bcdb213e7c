/* dynamic_write.c: depth is written as Dynamic Depth 1.0, in the form that Android takes:
 * https://developer.android.com/static/training/camera2/Dynamic-depth-v1.0.pdf
 * Its validator wants JPEGs, a confidence and metres, and counts items without padding. A JPEG has
 * 8 bits and is not exact; GDepth beside it, which readers here take first, is. Examples of the
 * document give attributes and elements to one property, which RDF forbids and Adobe's XMP Toolkit
 * refuses with all else in the packet; a structure (rdf:parseType) says the same, and Android's
 * reader looks for both. */
#include "dynamic_write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "jpeg_encode.h"
#include "reason.h"
#include "xmp.h"

#define DD RF_NS_DYNAMIC

enum { QUALITY = 100 };
static const char semantics[2][16] = {"Depth", "Confidence"};
static const char uris[2][24] = {"android/depthmap", "android/confidencemap"};

static void fill(uint8_t *out, const struct refocus_depth_write *depth, bool is_confidence)
{
    for (int32_t y = 0; y < depth->height; y++) {
        const uint16_t *const in =
            (const uint16_t *)((const char *)depth->disparity + y * depth->stride);

        for (int32_t x = 0; x < depth->width; x++) {
            *out++ = !is_confidence      ? (uint8_t)((65535 - in[x] + 128) / 257)
                     : depth->confidence ? depth->confidence[y * depth->confidence_stride + x]
                                         : 255;
        }
    }
}

static int add(struct rf_behind *behind, const struct refocus_depth_write *depth,
               bool is_confidence, struct refocus_reason *reason)
{
    struct rf_rows rows = {.width = depth->width,
                           .height = depth->height,
                           .stride = depth->width,
                           .format = RF_FORMAT_GRAY8};
    uint8_t *const samples = malloc((size_t)depth->width * (size_t)depth->height);
    struct refocus_blob jpeg = {NULL, 0};
    struct rf_jpeg_encoded encoded;
    int status;

    if (!samples)
        return rf_fail_memory(reason);
    fill(samples, depth, is_confidence);
    rows.top = samples;
    status = rf_jpeg_encode(&encoded, &rows, QUALITY, reason);
    free(samples);
    if (status == REFOCUS_OK) {
        jpeg.data = malloc(encoded.size);
        status = jpeg.data ? REFOCUS_OK : rf_fail_memory(reason);
    }
    if (status == REFOCUS_OK) {
        memcpy(jpeg.data, encoded.bytes, encoded.size);
        jpeg.size = encoded.size;
        rf_behind_add(behind, semantics[is_confidence], uris[is_confidence], jpeg);
    }
    rf_jpeg_encoded_free(&encoded);
    return status;
}

int rf_dynamic_add(struct rf_behind *behind, const struct refocus_depth_write *depth,
                   struct refocus_reason *reason)
{
    int status = add(behind, depth, false, reason);

    if (status == REFOCUS_OK)
        status = add(behind, depth, true, reason);
    return status;
}

void rf_dynamic_put(struct rf_text *text, const struct rf_behind *behind,
                    const struct refocus_depth_write *depth)
{
    if (!rf_behind_has(behind, semantics[0]))
        return;
    rf_text_words(text, "<rdf:Description xmlns:rdf=\"" RF_NS_RDF "\" rdf:about=\"\" xmlns:Device="
                        "\"" DD "device/\" xmlns:Profile=\"" DD "profile/\" xmlns:Container=\"" DD
                        "container/\" xmlns:Item=\"" DD "item/\" xmlns:Camera=\"" DD
                        "camera/\" xmlns:Image=\"" DD "image/\" xmlns:DepthMap=\"" DD
                        "depthmap/\"><Device:Profiles><rdf:Seq><rdf:li rdf:parseType=\"Resource\">"
                        "<Device:Profile rdf:parseType=\"Resource\"><Profile:Type>DepthPhoto"
                        "</Profile:Type><Profile:CameraIndices>"
                        "<rdf:Seq><rdf:li>0</rdf:li></rdf:Seq></Profile:CameraIndices>"
                        "</Device:Profile></rdf:li></rdf:Seq></Device:Profiles>"
                        "<Device:Container rdf:parseType=\"Resource\">");
    rf_behind_put_items(text, behind, false);
    rf_text_words(text, "</Device:Container><Device:Cameras><rdf:Seq><rdf:li rdf:parseType="
                        "\"Resource\"><Device:Camera rdf:parseType=\"Resource\">"
                        "<Camera:Trait>Physical</Camera:Trait><Camera:Image "
                        "Image:ItemSemantic=\"Primary\" Image:ItemURI=\"primary_image\"/>"
                        "<Camera:DepthMap DepthMap:Format=\"RangeInverse\" "
                        "DepthMap:ItemSemantic=\"Depth\" DepthMap:MeasureType=\"OpticalAxis\"");
    if (depth->near_m > 0 && depth->far_m > depth->near_m) {
        rf_text_number(text, " DepthMap:Near", depth->near_m);
        rf_text_number(text, " DepthMap:Far", isfinite(depth->far_m) ? depth->far_m : 1e9);
        rf_text_words(text, " DepthMap:Units=\"Meters\"");
    }
    rf_text_words(text, " DepthMap:DepthURI=\"");
    rf_text_words(text, uris[0]);
    rf_text_words(text, "\" DepthMap:ConfidenceURI=\"");
    rf_text_words(text, uris[1]);
    rf_text_words(text, "\"/></Device:Camera></rdf:li></rdf:Seq></Device:Cameras>"
                        "</rdf:Description>");
}
