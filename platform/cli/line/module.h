/* module.h: parts that bring many libraries with them are loaded when they are first asked for. */
#ifndef RF_CLI_MODULE_H
#define RF_CLI_MODULE_H

enum { MODULE_WHY = 256 };

/* Load a part, from where it lies beside the command as that is built, else from `installed` in the
 * folder of libraries; it stays loaded. NULL: it cannot be had, and `why` says why. */
void *module_open(const char *built, const char *installed, char why[MODULE_WHY]);

/* The address of a symbol, or NULL. Where it is a function's, it is copied to a pointer to it: ISO
 * C has no conversion between the two. */
void *module_symbol(void *module, const char *name);

#endif
