/* module.h: parts that bring many libraries with them are loaded when they are first asked for. */
#ifndef RF_CLI_MODULE_H
#define RF_CLI_MODULE_H

#include <stdbool.h>

enum { MODULE_WHY = 256 };

/* Load a part, from where it lies beside the command as that is built, else from `installed` in the
 * folder of libraries; it stays loaded. NULL: it cannot be had, and `why` says why. */
void *module_open(const char *built, const char *installed, char why[MODULE_WHY]);

/* The address of a symbol, or NULL. Where it is a function's, it is copied to a pointer to it: ISO
 * C has no conversion between the two. */
void *module_symbol(void *module, const char *name);

/* A function of a part that is a module of this command. */
struct module_function {
    const char *built, *installed; /* as module_open() has them */
    const char *name;
    const char *part, *library; /* for people: its name, and the library that it is built with */
};

/* Load the part, and set `function`, the address of a pointer to a function, to it; false: it
 * cannot be had, and `why` says why. */
bool module_load(const struct module_function *wanted, void *function, char why[MODULE_WHY]);

#endif
