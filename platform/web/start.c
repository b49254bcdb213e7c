/* start.c: a process for one photo is started: it has that photo's file, two sockets to the server
 * and a folder for temporary files, and nothing else of the server's. */
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include "server.h"

/* Files of a new process. */
enum { FILE_SOCKET = 3, FILE_CONTROL, FILE_PHOTO, FILE_REST };

/* Close what the server has open: a connection ends only when nobody has it open any more. */
static void close_rest(void)
{
    DIR *const files = opendir("/proc/self/fd");
    const struct dirent *entry;
    int most = FILE_REST;

    while (files && (entry = readdir(files)) != NULL) {
        const int fd = atoi(entry->d_name);

        most = fd >= most ? fd + 1 : most;
    }
    if (files)
        closedir(files);
    else
        most = 1024;
    for (int fd = FILE_REST; fd < most; fd++)
        close(fd);
}

/* Make a folder for what a process writes on its way. */
static bool make_folder(struct process *process)
{
    const char *const folder = getenv("TMPDIR");
    const int length = snprintf(process->folder, sizeof process->folder, "%s/refocus-XXXXXX",
                                folder && *folder ? folder : "/tmp");

    if (length > 0 && length < (int)sizeof process->folder && mkdtemp(process->folder))
        return true;
    process->folder[0] = '\0';
    return false;
}

void process_remove_folder(const struct process *process)
{
    DIR *const files = process->folder[0] ? opendir(process->folder) : NULL;
    const struct dirent *entry;

    while (files && (entry = readdir(files)) != NULL)
        unlinkat(dirfd(files), entry->d_name, 0);
    if (files)
        closedir(files);
    if (process->folder[0])
        rmdir(process->folder);
}

/* Where memory runs short, the system is to end this process rather than the server. */
static void go_first(void)
{
    FILE *const file = fopen("/proc/self/oom_score_adj", "w");

    if (file) {
        fputs("500", file);
        fclose(file);
    }
}

static void live(struct server *server, const struct process *process, const int files[3])
{
    char path[32];
    const struct rf_web_work work = {.socket = FILE_SOCKET,
                                     .control = FILE_CONTROL,
                                     .photo = process->live ? NULL : path,
                                     .name = process->name,
                                     .session = process->id};
    int moved[3];

    snprintf(path, sizeof path, "/proc/self/fd/%d", FILE_PHOTO);
    for (int i = 0; i < 3; i++)
        moved[i] = fcntl(files[i], F_DUPFD, FILE_REST);
    for (int i = 0; i < 3; i++)
        if (moved[i] < 0 || dup2(moved[i], FILE_SOCKET + i) < 0)
            _exit(EXIT_FAILURE);
    close_rest();
    go_first();
    setenv("TMPDIR", process->folder, 1);
    server->setup->work(server->setup->of, &work);
    _exit(EXIT_SUCCESS);
}

static bool make_sockets(int sockets[4])
{
    const struct timeval patience = {5, 0};

    sockets[2] = sockets[3] = -1;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0)
        return false;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets + 2) != 0) {
        close(sockets[0]);
        close(sockets[1]);
        return false;
    }
    setsockopt(sockets[0], SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    return true;
}

struct process *process_start(struct server *server, const char *name, bool session, int fd)
{
    struct process *const process = calloc(1, sizeof *process);
    int sockets[4];

    if (process && fd < 0) {
        process->live = true;
        fd = open("/dev/null", O_RDONLY | O_CLOEXEC);
    }
    if (!process || !server_random(process->id) || !make_folder(process) ||
        !make_sockets(sockets)) {
        if (process)
            process_remove_folder(process);
        free(process);
        close(fd);
        return NULL;
    }
    snprintf(process->name, sizeof process->name, "%s", name);
    process->session = session;
    process->used_ms = server_now_ms();
    fflush(NULL);
    process->pid = fork();
    if (process->pid == 0)
        live(server, process, (const int[3]){sockets[1], sockets[3], fd});
    close(sockets[1]);
    close(sockets[3]);
    close(fd);
    process->socket = sockets[0];
    process->control = sockets[2];
    if (process->pid < 0) {
        close(sockets[0]);
        close(sockets[2]);
        process_remove_folder(process);
        free(process);
        return NULL;
    }
    process->next = server->processes;
    server->processes = process;
    return process;
}
