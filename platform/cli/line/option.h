/* option.h: one row of a table is one option, with its parsing, its range and its help. */
#ifndef RF_CLI_OPTION_H
#define RF_CLI_OPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct command;

/* A word of a choice, and a line on it or NULL. One without a name ends a list. */
struct option_word {
    const char *name, *summary;
};

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
    const struct option *rows; /* a group of rows, whose settings lie at `offset`; else NULL */
    enum option_kind kind;
    char letter;            /* short form, or 0 */
    const char *name;       /* with its dashes */
    const char *argument;   /* word for the value in the help */
    size_t offset;          /* where the value lies in the settings; doubles that are NAN
                               beforehand and still afterwards were not given */
    double least, greatest; /* bounds of numbers; least is not allowed itself when above is set */
    bool above;
    int count;              /* number of OPTION_NUMBERS */
    bool fraction;          /* OPTION_NUMBER that may be written as 30000/1001, too */
    bool decimals;          /* OPTION_NUMBERS that need not be whole, as pixels are */
    const char *word;       /* one word that stands for a number, or
                               NULL */
    double word_value;      /* the number it stands for */
    const char *other_word; /* another one, or NULL */
    double other_value;
    const struct option_word *words;        /* words of OPTION_CHOICE, some of OPTION_TEXT, */
    const char *(*choice)(uint32_t index);  /* or a function, whose NULL ends them */
    const char *(*summary)(uint32_t index); /* a line on each word, in place of its own, or NULL */
    const char *brief; /* A line of --help, to which the words of a choice are added; NULL: it is
                          in --help-all alone */
    const char *help;
    bool elsewhere;     /* the option is about this run, not about the picture: not in files of
                           settings */
    bool omits_default; /* OPTION_CHOICE: files of settings leave out its first word, the default,
                           as not every command that takes such files has the option */
    /* OPTION_TEXT that names a file with values of other options, which is read before the rest of
     * the command line, or NULL. Returns OPTIONS_PARSED or an exit code. */
    int (*load)(const struct command *command, const char *file, void *settings);
    const char
        *unless; /* parse() is called with NULL where neither this option nor that one is given */
    const char *group; /* options of one group say the same thing in other words: one of the command
                          line takes those of files away; numbers alone; or NULL */

    /* An option may change nothing without another option that has a value, or without one of some
     * words of a choice; a command line that gives it alone is told so. Where both are named either
     * will do. */
    const char *needs;                      /* name of the option, or several with
                                               commas of which any will do, or NULL */
    const char *of;                         /* name of the choice, or NULL */
    uint32_t of_words;                      /* bit i: word i of the choice, or, where it is not
                                               known before: */
    bool (*of_takes)(uint32_t index);       /* tells whether word i is meant; or NULL */
    const char *(*of_word)(uint32_t index); /* words of the choice */
    size_t of_offset; /* where the choice's value lies, an int; below 0: several */
};

/* The beginning of a row: what it is, its name with its dashes, the word for its value in the help
 * or NULL, and where the value lies in the settings. */
#define OPTION(kind_, name_, argument_, type, field)                                               \
    .kind = kind_, .name = name_, .argument = argument_, .offset = offsetof(type, field)

/* A group: the rows of a struct that is a member of the settings, or of the same settings. */
#define GROUP(rows_, type, field)                                                                  \
    {                                                                                              \
        .rows = rows_, .offset = offsetof(type, field), .help = ""                                 \
    }
#define GROUP_HERE(rows_)                                                                          \
    {                                                                                              \
        .rows = rows_, .help = ""                                                                  \
    }

struct command {
    const char *name;
    const char *usage;           /* words behind the name */
    const char *summary;         /* one line */
    const char *notes;           /* paragraphs after the options, or NULL */
    const struct option *table;  /* ended by a row whose help is NULL; read by options_of() */
    int files_least, files_most; /* number of file names that the command takes */
    const char *too_many;        /* says what to do about more of them; NULL: give its usage */
    int (*run)(int argc, char **argv);
};

/* The rows of a command's table, with those of groups in their places, in the settings of the
 * command; ended by a row whose help is NULL. They live as long as the program. */
const struct option *options_of(const struct command *command);

/* Parsing returns this beside exit codes: go on. */
enum { OPTIONS_PARSED = -1 };

/* Give an option its value as the command line does; `name` is what errors call it. For flags
 * `text` is not used. Returns OPTIONS_PARSED or EXIT_WRONG. */
int options_set(const struct option *option, const char *name, const char *text, void *settings);

/* The row of an argument such as "--blur=3", "--blur" or "-o", or NULL; *value: the text behind
 * the "=" or the letter, or NULL. */
const struct option *options_at(const struct command *command, const char *argument,
                                const char **value);

/* The row of a name with its dashes, or NULL. */
const struct option *options_find(const struct command *command, const char *name);

/* The name of a row that is most like `name`, or NULL. */
const char *options_nearest_name(const struct command *command, const char *name);

/* The one of the words that is most like text, or NULL when none is. */
const char *options_nearest(const char *text, const char *(*word)(const void *list, int i),
                            const void *list);

/* Word `index` of an option, NULL behind the last, and the line on it or NULL. */
const char *options_word(const struct option *option, uint32_t index);
const char *options_summary(const struct option *option, uint32_t index);

/* "a number from 0 to 1", ..., and the word that may stand for a number. */
enum { OPTION_RANGE_LENGTH = 120 };
const char *options_range(const struct option *option, char text[OPTION_RANGE_LENGTH]);

#endif
