/* Command lines by tables: one row of a table is one option, with its parsing, its range and
 * its help. */
#ifndef RF_CLI_OPTIONS_H
#define RF_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum option_kind {
    OPTION_HEADING, /* a line of the help */
    OPTION_FLAG,    /* bool */
    OPTION_NUMBER,  /* double */
    OPTION_INTEGER, /* double that holds a whole number */
    OPTION_NUMBERS, /* double[count], written with commas or as WxH */
    OPTION_TEXT,    /* const char * into argv, not empty */
    OPTION_CHOICE,  /* int, the index of a word */
};

struct option {
    enum option_kind kind;
    char letter;          /* short form, or 0 */
    const char *name;     /* with its dashes */
    const char *argument; /* what the help calls the value */
    size_t offset;        /* of the value in the settings; doubles that are NAN beforehand
                             and still afterwards were not given */
    double least, greatest; /* of numbers; least is not allowed itself when above is set */
    bool above;
    int count;                              /* of OPTION_NUMBERS */
    const char *word;                       /* one word that stands for a number, or NULL */
    double word_value;                      /* and that number */
    const char *(*choice)(uint32_t index);  /* words of OPTION_CHOICE; NULL ends them */
    const char *(*summary)(uint32_t index); /* a line on each word, or NULL */
    const char *help;
    bool elsewhere; /* of this run, not of the picture: not in files of settings */
};

struct command {
    const char *name;
    const char *usage;   /* what follows the name */
    const char *summary; /* one line */
    const char *notes;   /* paragraphs after the options, or NULL */
    const struct option *options; /* ended by a row whose help is NULL */
    int files_least, files_most;  /* how many names go with it */
    int (*run)(int argc, char **argv);
};

/* What options_parse() returns beside exit codes: go on. */
enum { OPTIONS_PARSED = -1 };

/*
 * Parse argv[1] and on into settings; names of files are moved to files[], which ends with
 * NULL. Returns OPTIONS_PARSED, or the exit code after --help or an error, which it printed.
 */
int options_parse(const struct command *command, int argc, char **argv, void *settings,
                  const char **files);

/* Give an option its value as the command line does; `name` is what errors call it. For flags
 * `text` is not used. Returns OPTIONS_PARSED or EXIT_WRONG. */
int options_set(const struct option *option, const char *name, const char *text,
                void *settings);

/* The row of a name with its dashes, or NULL. */
const struct option *options_find(const struct command *command, const char *name);

/* The name of a row that is most like `name`, or NULL. */
const char *options_nearest_name(const struct command *command, const char *name);

void options_print_help(const struct command *command);

/* The one of the words that is most like text, or NULL when none is. */
const char *options_nearest(const char *text, const char *(*word)(const void *list, int i),
                            const void *list);

#endif
