/* test_npz.c: NumPy's archives, as numpy.savez() and numpy.savez_compressed() write them. */
#include "check.h"

/* A seed of the fuzz target. */
static struct bytes archive(const char *name)
{
    char path[1024];
    struct refocus_blob blob;
    struct bytes file;

    snprintf(path, sizeof path, "%s/tests/fuzz/file/corpus/npz/%s", REFOCUS_SOURCE, name);
    assert_int_equal(refocus_file_read(path, 1 << 20, &blob, NULL), REFOCUS_OK);
    file = bytes_copy(blob.data, blob.size);
    free(blob.data);
    return file;
}

static bool notes(const struct refocus_photo *photo, const char *line)
{
    for (int i = 0; i < photo->info->evidence_count; i++)
        if (strcmp(photo->info->evidence[i], line) == 0)
            return true;
    return false;
}

/* An archive may hold several: the one called depth is taken, else the first. */
TEST(an_array_is_chosen)
{
    static const char *const names[][2] = {
        {"stored", "NPZ: the array 'arr_0'"},
        {"deflated", "NPZ: the array 'disparity'"},
        {"several", "NPZ: the array 'Depth'"},
        {"unnamed", "NPZ: the array 'a', the first one; 2 more, none is called depth"}};

    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct refocus_photo *photo = read_depth(archive(names[i][0]), NULL, REFOCUS_OK);

        assert_string_equal(photo->info->container, "NPZ");
        assert_true(notes(photo, names[i][1]));
        assert_int_equal(photo->depth->width, 3);
        assert_int_equal(photo->depth->height, 2);
        for (int k = 0; k < 6; k++)
            assert_true(float_at(photo->depth, k % 3, k / 3) == k + 1);
        refocus_photo_free(&photo);
        read_photo(archive(names[i][0]), REFOCUS_ERR_UNSUPPORTED);
    }
}

static size_t find(const struct bytes *file, const char *text)
{
    const size_t length = strlen(text);

    for (size_t i = 0; i + length <= file->size; i++)
        if (memcmp(file->data + i, text, length) == 0)
            return i;
    fail_msg("no %s in it", text);
    return 0;
}

/* A checksum tells the damage that an array alone does not. */
TEST(damage_is_told)
{
    struct bytes file = archive("stored");
    const size_t samples = find(&file, "}") + 60;

    file.data[samples] ^= 1;
    read_depth(file, NULL, REFOCUS_ERR_FORMAT);
    file = archive("deflated");
    for (size_t size = 4; size < file.size; size += 3)
        read_depth(bytes_copy(file.data, size), NULL, REFOCUS_ERR_FORMAT);
    bytes_free(&file);
}

TEST(others_are_refused)
{
    static const uint8_t empty[22] = "PK\5\6";
    struct bytes file = archive("stored");

    read_depth(bytes_copy(empty, sizeof empty), NULL, REFOCUS_ERR_UNSUPPORTED);
    for (int i = 0; i < 2; i++) /* here and in the directory */
        memcpy(file.data + find(&file, "arr_0.npy"), "arr_0.txt", 9);
    read_depth(file, NULL, REFOCUS_ERR_UNSUPPORTED);
    file = archive("stored");
    memcpy(file.data + find(&file, "NUMPY"), "numpy", 5);
    read_depth(file, NULL, REFOCUS_ERR_FORMAT);
}
