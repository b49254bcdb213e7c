/* folder.h: the photos that a server may open: those of one folder, or one photo, or none. */
#ifndef RF_WEB_FOLDER_H
#define RF_WEB_FOLDER_H

#include <stdbool.h>
#include <stdint.h>

enum { FOLDER_MOST = 4096 };

struct folder_photo {
    char *name;
    int64_t changed; /* when, and how large it was then: what is known of it holds for that */
    int64_t bytes;
    int depth; /* 1: it has depth; 0: none; -1: not known */
};

struct folder {
    int fd;   /* the folder; -1: there is none */
    int file; /* the photo, of which there is one then; -1: none */
    struct folder_photo *photos;
    int count;
    int unnamed; /* further photos whose names a link cannot have; hidden ones are none */
};

/* Open it by its path, or with NULL have no photos. False: words in why (256 bytes). */
bool folder_open(struct folder *folder, const char *path, char *why);
void folder_close(struct folder *folder);

/* Read its names again: photos alone, by their endings, no links, in order. */
bool folder_read(struct folder *folder);

/* Open one of its photos for reading, or -1. No link is followed. */
int folder_photo_open(const struct folder *folder, const char *name);

/* Note whether a photo has depth. */
void folder_note_depth(struct folder *folder, const char *name, int depth);

#endif
