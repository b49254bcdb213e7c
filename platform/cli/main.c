/* main.c: the command `refocus` finds its subcommand and runs it. */
#include <fcntl.h>
#include <stddef.h>
#include <unistd.h>
#include "commands/commands.h"
#include "commands/words.h"
#include "line/interrupt.h"
#include "line/report.h"

static int unknown(const char *argument)
{
    const char *nearest;

    if (argument[0] == '-')
        return report_failure(EXIT_WRONG, argument,
                              "unknown option; give a subcommand first, or --help");
    nearest = options_nearest(argument, words_name, NULL);
    if (nearest)
        return report_failure(EXIT_WRONG, argument, "unknown subcommand; did you mean '%s'?",
                              nearest);
    return report_failure(EXIT_WRONG, argument, "unknown subcommand; 'refocus --help' lists them");
}

/* The stack grows page by page, and where memory is short that is no failed allocation but a
 * signal. So it grows before anything else takes memory. Not inlined: within main() it would lie
 * below everything that comes after. */
__attribute__((noinline)) static void grow_stack(void)
{
    enum { NEEDED = 1 << 20, PAGE = 4096 };
    char stack[NEEDED];
    volatile char *byte = stack;

    for (size_t i = 0; i < NEEDED; i += PAGE)
        byte[NEEDED - 1 - i] = 0;
}

/* A parent may leave standard files closed. The next file that is opened would take their place,
 * and messages would be written into it. What is opened here can only be used the other way round,
 * so that what needs the real one is still told EBADF. */
static void fill_standard_files(void)
{
    for (int file = STDIN_FILENO; file <= STDERR_FILENO; file++)
        if (fcntl(file, F_GETFD) < 0)
            (void)!open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int main(int argc, char **argv)
{
    const struct command *command;
    const struct word *word;
    int status;

    grow_stack();
    fill_standard_files();
    if (argc < 2)
        return report_failure(EXIT_WRONG, "subcommand",
                              "none is given; 'refocus --help' lists them");
    command = commands_find(argv[1]);
    word = words_find(argv[1]);
    if (word)
        return word->run(argc - 1, argv + 1);
    if (!command)
        return unknown(argv[1]);
    interrupt_start();
    status = command->run(argc - 1, argv + 1);
    interrupt_stop();
    return status;
}
