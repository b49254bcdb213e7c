/* check.h: the texts of a request, all of which may be hostile, are checked. Knows no HTTP library.
 */
#ifndef RF_WEB_CHECK_H
#define RF_WEB_CHECK_H

#include <stdbool.h>
#include <stddef.h>

/* Whether a path is "/TOKEN/NAME"; returns its NAME, which may be empty, else NULL. Takes as long
 * for a token that is almost right. */
const char *rf_check_path(const char *path, const char *token);

/* Whether it is "https://NAME" or "http://NAME", perhaps with ":PORT", and no more. */
bool rf_check_public(const char *origin);

/* Whether the header Host names this machine by number, or as localhost, with this port, or is that
 * of the server before it, whose origin is `public` (NULL: there is none). Another name may be one
 * that somebody else's page has led here. */
bool rf_check_host(const char *host, int port, const char *public);

/* Whether the header Origin, NULL where there is none, is this server's own by its Host, or that of
 * the server before it. */
bool rf_check_origin(const char *origin, const char *host, const char *public);

/* Whether it is the name of a file in a folder: no path, not hidden, UTF-8 without control
 * characters, at most 255 bytes. */
bool rf_check_name(const char *name, size_t length);

/* A whole number of at most nine digits from least to most. */
bool rf_check_number(const char *text, long least, long most, long *value);

/* Whether it is RF_WEB_SESSION hexadecimal digits. */
bool rf_check_session(const char *text);

/* Whether the name ends as that of a photo. */
bool rf_check_photo_ending(const char *name);

#endif
