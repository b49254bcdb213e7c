/* words.h: words in place of a subcommand that tell about the command itself. */
#ifndef RF_CLI_WORDS_H
#define RF_CLI_WORDS_H

struct word {
    const char *name, *usage, *summary;
    int (*run)(int argc, char **argv); /* argv[0] is the word; returns an exit code */
};

/* help, version, man and completion; a row without a name ends them. */
extern const struct word words[];
const struct word *words_find(const char *name);

/* The name of a subcommand or word; NULL behind the last. For options_nearest(). */
const char *words_name(const void *unused, int i);

#endif
