/* replay.c: runs a fuzz target on the files of folders: the seeds and what was ever found, in
 * every run of the tests and with any compiler. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

extern const char fuzz_replays; /* with_failures.c looks for it */
const char fuzz_replays = 1;

/* The copy ends where the memory ends, so that sanitizers see every byte too far. */
static int run_file(const char *path)
{
    struct stat facts;
    FILE *const file = fopen(path, "rb");
    uint8_t *data;
    size_t size;

    if (!file || fstat(fileno(file), &facts) != 0) {
        perror(path);
        return 1;
    }
    size = (size_t)facts.st_size;
    data = malloc(size ? size : 1);
    if (!data || fread(data, 1, size, file) != size) {
        perror(path);
        return 1;
    }
    fclose(file);
    LLVMFuzzerTestOneInput(data, size);
    free(data);
    return 0;
}

int main(int count, char **folders)
{
    int failed = 0, files = 0;

    for (int i = 1; i < count; i++) {
        DIR *const folder = opendir(folders[i]);
        struct dirent *entry;

        while (folder && (entry = readdir(folder))) {
            char path[4096];
            if (entry->d_name[0] != '.') {
                snprintf(path, sizeof path, "%s/%s", folders[i], entry->d_name);
                failed |= run_file(path);
                files++;
            }
        }
        if (folder)
            closedir(folder);
    }
    printf("%d files\n", files);
    return failed || files == 0;
}
