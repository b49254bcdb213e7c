/* Runs a fuzz target over the files of folders, for builds without libFuzzer. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    uint8_t *data = NULL;
    size_t size = 0;
    int done = 0;

    if (!file)
        return 0;
    for (size_t room = 0;;) {
        if (size == room) {
            uint8_t *more = realloc(data, room = 2 * room + 4096);
            if (!more)
                goto end;
            data = more;
        }
        const size_t got = fread(data + size, 1, room - size, file);
        size += got;
        if (got == 0)
            break;
    }
    /* A copy of just that size, so that a sanitizer sees a read beyond it. */
    uint8_t *exact = malloc(size ? size : 1);
    if (!exact)
        goto end;
    for (size_t i = 0; i < size; i++)
        exact[i] = data[i];
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
    done = 1;
end:
    free(data);
    fclose(file);
    return done;
}

int main(int argc, char **argv)
{
    char path[4096];
    int count = 0;

    for (int i = 1; i < argc; i++) {
        DIR *folder = opendir(argv[i]);

        if (!folder) {
            perror(argv[i]);
            return 1;
        }
        for (struct dirent *entry; (entry = readdir(folder));) {
            if (entry->d_name[0] == '.')
                continue;
            snprintf(path, sizeof path, "%s/%s", argv[i], entry->d_name);
            printf("%s\n", entry->d_name);
            fflush(stdout);
            count += replay(path);
        }
        closedir(folder);
    }
    printf("%d inputs\n", count);
    return count > 0 ? 0 : 1;
}
