/* main.c: the command `refocus` finds its subcommand and runs it. */
#include <stdio.h>
#include <string.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include <refocus/platform/source.h>
#include "commands/commands.h"
#include "line/interrupt.h"
#include "line/report.h"

static const struct command *const commands[] = {&render_command, &depth_command, &sheet_command,
                                                 &pull_command,   &info_command,  &compare_command,
                                                 &bench_command,  &live_command,  &view_command};
enum { COMMANDS = sizeof commands / sizeof *commands };

static void print_usage(FILE *out)
{
    fprintf(out, "usage: refocus SUBCOMMAND [options] FILE...\n\n"
                 "Refocus photos by their depth.\n\n");
    for (int i = 0; i < COMMANDS; i++)
        fprintf(out, "  %-10s %s\n", commands[i]->name, commands[i]->summary);
    fprintf(out, "\n"
                 "  refocus SUBCOMMAND --help  says more of one\n"
                 "  refocus --version          version and file formats\n"
                 "\n"
                 "Example: refocus render portrait.jpg --focus-at 1200,900 --blur 40 -o "
                 "out.jpg\n"
                 "\n"
                 "exit status: 0 done, 1 it could not be done, 2 the command line is "
                 "wrong\n");
}

static const char *command_name(const void *list, int i)
{
    (void)list;
    return i < COMMANDS ? commands[i]->name : NULL;
}

static int unknown(const char *argument)
{
    const char *nearest;

    if (argument[0] == '-')
        return report_failure(EXIT_WRONG, argument,
                              "unknown option; give a subcommand first, or --help");
    nearest = options_nearest(argument, command_name, NULL);
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

int main(int argc, char **argv)
{
    grow_stack();
    if (argc < 2)
        return report_failure(EXIT_WRONG, "subcommand",
                              "none is given; 'refocus --help' lists them");
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_usage(stdout);
        return report_end_output();
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("refocus %s\nfiles: %s\n", refocus_version(), refocus_file_formats());
        printf("sources: %s\n", refocus_source_backends());
        return report_end_output();
    }
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(argv[1], commands[i]->name) != 0)
            continue;

        interrupt_start();
        const int status = commands[i]->run(argc - 1, argv + 1);
        interrupt_stop();
        return status;
    }
    return unknown(argv[1]);
}
