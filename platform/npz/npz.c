/* npz.c: of a NumPy archive (.npz, a ZIP of arrays, stored or deflated) one array is read as depth:
 * the first whose name begins with "depth" or "disp", else the first. */
#include <stdio.h>
#include <string.h>
#include <zip.h>

#include "codec.h"
#include "letters.h"
#include "npy.h"
#include "reason.h"

static bool is_array(const char *name)
{
    const size_t length = name ? strlen(name) : 0;

    return length > 4 && strcmp(name + length - 4, ".npy") == 0;
}

static bool is_depth(const char *name)
{
    return rf_begins_with(name, "depth") || rf_begins_with(name, "disp");
}

/* The number of the array in the archive; -1: there is none. *others: how many more there are, if
 * nothing but its place makes it the one. */
static zip_int64_t choose(zip_t *archive, int *others)
{
    const zip_int64_t count = zip_get_num_entries(archive, 0);
    zip_int64_t first = -1;

    *others = 0;

    for (zip_int64_t i = 0; i < count; i++) {
        const char *const name = zip_get_name(archive, (zip_uint64_t)i, 0);

        if (is_array(name) && is_depth(name)) {
            *others = 0;
            return i;
        }
        if (is_array(name) && first < 0)
            first = i;
        else if (is_array(name))
            ++*others;
    }
    return first;
}

static bool pull_entry(void *from, uint8_t *bytes, size_t count)
{
    return zip_fread(from, bytes, count) == (zip_int64_t)count;
}

static int read_entry(struct rf_read *read, zip_t *archive, zip_int64_t index, int others)
{
    zip_file_t *entry;
    zip_stat_t facts;
    char name[48], behind;
    int status;

    if (zip_stat_index(archive, (zip_uint64_t)index, 0, &facts) != 0 ||
        !(facts.valid & ZIP_STAT_SIZE) || !(facts.valid & ZIP_STAT_NAME))
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its arrays have no sizes");
    entry = zip_fopen_index(archive, (zip_uint64_t)index, 0);
    if (!entry) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED, "its array cannot be read: %s",
                       zip_strerror(archive));
    }
    snprintf(name, sizeof name, "%.*s", (int)(strlen(facts.name) - 4), facts.name);
    rf_clean_text(name);
    status = rf_npy_read(read, pull_entry, entry, facts.size);
    /* The checksum is compared where the array ends. */
    if (status == REFOCUS_OK && zip_fread(entry, &behind, 1) < 0) {
        status = rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: %s; copy it again",
                         zip_file_strerror(entry));
    }
    zip_fclose(entry);
    if (status == REFOCUS_OK && others > 0) {
        rf_note(read->info, "NPZ: the array '%s', the first one; %d more, none is called depth",
                name, others);
    } else if (status == REFOCUS_OK) {
        rf_note(read->info, "NPZ: the array '%s'", name);
    }
    return status;
}

static int read_archive(struct rf_read *read, zip_t *archive)
{
    int others;
    const zip_int64_t index = choose(archive, &others);

    return index >= 0 ? read_entry(read, archive, index, others)
                      : rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                                "it is a ZIP archive without an array of NumPy (.npy) in it");
}

static int read_npz(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras)
{
    zip_error_t error;
    zip_source_t *source;
    zip_t *archive;
    int status;

    (void)extras;
    zip_error_init(&error);
    source = zip_source_buffer_create(file.data, file.size, 0, &error);
    archive = source ? zip_open_from_source(source, ZIP_RDONLY, &error) : NULL;
    if (archive) {
        status = read_archive(read, archive);
        zip_discard(archive);
    } else {
        status = zip_error_code_zip(&error) == ZIP_ER_MEMORY
                     ? rf_fail_memory(read->reason)
                     : rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged ZIP archive: %s",
                               zip_error_strerror(&error));
        zip_source_free(source);
    }
    zip_error_fini(&error);
    return status;
}

__attribute__((visibility("default"))) extern const struct rf_codec rf_codec_npz;
const struct rf_codec rf_codec_npz = {.version = RF_CODEC_VERSION, .read = read_npz};
