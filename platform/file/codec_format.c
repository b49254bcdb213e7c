/* codec_format.c: the module of a picture library is loaded, and what it says of a file is taken
 * over. */
#define _GNU_SOURCE
#include "codec_format.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exif.h"
#include "exif_copy.h"
#include "icc.h"
#include "kept.h"
#include "reason.h"

static const int here;

static const struct rf_codec *codec_of(void *module, const char *name)
{
    char symbol[64];
    const struct rf_codec *codec;

    snprintf(symbol, sizeof symbol, "rf_codec_%s", name);
    codec = dlsym(module, symbol);
    return codec && strcmp(codec->version, RF_CODEC_VERSION) == 0 ? codec : NULL;
}

/* The codec in the module of that folder, and why it is not there. */
static const struct rf_codec *try(const char *folder, int length, const char *between,
                                  const char *name, char *why, size_t size)
{
    char path[4096];
    void *module;

    if (snprintf(path, sizeof path, "%.*s%srefocus-%s.so", length, folder, between, name) >=
        (int)sizeof path)
        return NULL;
    module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!module) {
        const char *const error = dlerror();
        const char *const words = error ? error : "";

        /* A module that is there and cannot be loaded says more than one that is not there. */
        if (!why[0] || !strstr(words, path))
            snprintf(why, size, "%s", words);
        return NULL;
    }
    return codec_of(module, name);
}

/* The module lies beside this library, where both are installed and where both are built. */
static const struct rf_codec *find(const char *name, char *why, size_t size)
{
    const struct rf_codec *found = NULL;
    Dl_info self;

    if (dladdr((const void *)&here, &self) && self.dli_fname) {
        const char *const slash = strrchr(self.dli_fname, '/');
        const int length = slash ? (int)(slash + 1 - self.dli_fname) : 0;

        found = try(self.dli_fname, length, "refocus/", name, why, size);
        if (!found)
            found = try(self.dli_fname, length, "", name, why, size);
    }
    return found ? found : try(RF_MODULES, (int)strlen(RF_MODULES), "", name, why, size);
}

/* A module that was found stays loaded; one that was not is looked for again. */
static const struct rf_codec *load(struct rf_codec_slot *slot, char *why, size_t size)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    const struct rf_codec *codec;

    pthread_mutex_lock(&lock);
    if (!slot->codec)
        slot->codec = find(slot->name, why, size);
    codec = slot->codec;
    pthread_mutex_unlock(&lock);
    return codec;
}

static const struct rf_codec *get(const struct rf_format *format, struct rf_codec_slot *slot,
                                  struct refocus_reason *reason, int *status)
{
    char why[160] = "";
    const struct rf_codec *const codec = load(slot, why, sizeof why);

    if (!codec) {
        *status = rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                          "%s needs %s, which cannot be loaded: %s", format->name, format->library,
                          why[0] ? why : "its module is of another release");
    }
    return codec;
}

static void free_extras(struct rf_extras *extras)
{
    free(extras->exif.data);
    free(extras->icc.data);
    free(extras->xmp.data);
}

static struct rf_bytes bytes_of(const struct refocus_blob *blob)
{
    return (struct rf_bytes){blob->data, blob->size};
}

/* TIFF and the raws that are one have the blocks of EXIF strewn over the file. */
static int exif_of_tiff(const struct rf_read *read, struct rf_bytes file, struct refocus_blob *exif)
{
    if (file.size < 8 || (memcmp(file.data, "II*\0", 4) != 0 && memcmp(file.data, "MM\0*", 4) != 0))
        return REFOCUS_OK;
    exif->data = malloc(RF_EXIF_COPY_ROOM);
    if (!exif->data)
        return rf_fail_memory(read->reason);
    exif->size = rf_exif_of_tiff(file, exif->data);
    return REFOCUS_OK;
}

int rf_codec_read(const struct rf_format *format, struct rf_codec_slot *slot, struct rf_read *read,
                  struct rf_bytes file)
{
    struct rf_extras extras = {.upright = false};
    int status = REFOCUS_OK;
    const struct rf_codec *const codec = get(format, slot, read->reason, &status);

    if (!codec)
        return status;
    if (strlen(format->name) < sizeof read->info->container)
        memcpy(read->info->container, format->name, strlen(format->name) + 1);
    status = codec->read(read, file, &extras);
    if (status == REFOCUS_OK && !extras.exif.data)
        status = exif_of_tiff(read, file, &extras.exif);
    if (status == REFOCUS_OK)
        status = rf_check_metadata(read, extras.exif.size, "its EXIF");
    if (status == REFOCUS_OK)
        status = rf_exif_take(read, bytes_of(&extras.exif), !extras.upright);
    if (status == REFOCUS_OK)
        status = rf_check_metadata(read, extras.icc.size, "its ICC profile");
    if (status == REFOCUS_OK)
        status = rf_icc_take(read, &extras.icc);
    if (status == REFOCUS_OK)
        status = rf_keep(read, RF_KEPT_XMP, bytes_of(&extras.xmp));
    free_extras(&extras);
    return status;
}

/* The first packet of XMP that a picture made from the photo keeps. */
static int take_xmp(struct rf_xmp_keep *keep, const struct refocus_photo *photo,
                    const struct rf_rows *rows, struct rf_bytes *packet,
                    struct refocus_reason *reason)
{
    const int status = rf_keep_xmp(photo, keep, rows->width, rows->height, reason);

    for (int i = 0; status == REFOCUS_OK && i < keep->count && packet->size == 0; i++)
        *packet = rf_xmp_kept(&keep->packet[i]);
    /* The light of a gain map is in floats as it is. */
    if (status == REFOCUS_OK && rows->format != REFOCUS_FORMAT_RGB_HALF &&
        rows->format != REFOCUS_FORMAT_RGB_FLOAT)
        rf_keep_warn(photo, keep, reason);
    return status;
}

/* A copy that says the sides of the picture. */
static int take_exif(const struct refocus_blob *exif, const struct rf_rows *rows,
                     struct refocus_blob *copy, struct refocus_reason *reason)
{
    if (!exif || !exif->data || exif->size == 0)
        return REFOCUS_OK;
    copy->data = malloc(exif->size);
    if (!copy->data)
        return rf_fail_memory(reason);
    memcpy(copy->data, exif->data, exif->size);
    copy->size = exif->size;
    rf_exif_set_size(copy->data, copy->size, (uint32_t)rows->width, (uint32_t)rows->height);
    return REFOCUS_OK;
}

int rf_codec_write(const struct rf_format *format, struct rf_codec_slot *slot,
                   struct rf_store *store, const struct rf_rows *rows,
                   const struct refocus_write_options *options, struct refocus_reason *reason)
{
    struct rf_xmp_keep keep = {.cut = RF_XMP_CUT_EDITABLE | RF_XMP_CUT_EXTENDED};
    struct rf_extras extras = {.upright = true};
    struct refocus_blob file = {NULL, 0};
    struct rf_bytes xmp = {NULL, 0};
    int status = REFOCUS_OK;
    const struct rf_codec *const codec = get(format, slot, reason, &status);

    if (!codec)
        return status;
    if (options->keep) {
        status = take_xmp(&keep, options->keep, rows, &xmp, reason);
        rf_keep_warn_kind(options->keep, RF_KEPT_XMP, reason);
    }
    if (status == REFOCUS_OK) {
        extras.xmp = (struct refocus_blob){(uint8_t *)(uintptr_t)xmp.data, xmp.size};
        if (options->icc)
            extras.icc = *options->icc;
        status = take_exif(options->exif, rows, &extras.exif, reason);
    }
    if (status == REFOCUS_OK)
        status = codec->write(&file, rows, &extras, reason);
    if (status == REFOCUS_OK)
        rf_store_write(store, file.data, file.size);
    free(file.data);
    free(extras.exif.data);
    rf_xmp_keep_free(&keep);
    return status;
}
