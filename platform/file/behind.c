/* behind.c: a list of pictures that lie behind the main one, and its container directory. */
#include "behind.h"

#include <stdlib.h>
#include <string.h>

const char rf_gain_map_semantic[8] = "GainMap";

void rf_behind_add(struct rf_behind *behind, const char *semantic, const char *uri,
                   struct refocus_blob jpeg)
{
    behind->item[behind->count++] = (struct rf_behind_item){semantic, uri, jpeg};
}

bool rf_behind_has(const struct rf_behind *behind, const char *semantic)
{
    for (int i = 0; i < behind->count; i++)
        if (strcmp(behind->item[i].semantic, semantic) == 0)
            return true;
    return false;
}

bool rf_behind_has_gain_map(const struct rf_behind *behind)
{
    return rf_behind_has(behind, rf_gain_map_semantic);
}

void rf_behind_drop_depth(struct rf_behind *behind)
{
    while (behind->count > rf_behind_has_gain_map(behind))
        free(behind->item[--behind->count].bytes.data);
}

static void put_item(struct rf_text *text, const char *key, const char *name, double length)
{
    rf_text_words(text,
                  "<rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Mime=\"image/jpeg\"");
    rf_text_words(text, key);
    rf_text_words(text, name);
    rf_text_words(text, "\"");
    rf_text_number(text, " Item:Length", length);
    rf_text_words(text, "/></rdf:li>");
}

void rf_behind_put_items(struct rf_text *text, const struct rf_behind *behind, bool by_semantic)
{
    const char *const key = by_semantic ? " Item:Semantic=\"" : " Item:DataURI=\"";

    rf_text_words(text, "<Container:Directory><rdf:Seq>");
    put_item(text, key, by_semantic ? "Primary" : "primary_image", 0);
    for (int i = 0; i < behind->count; i++) {
        const struct rf_behind_item *const item = &behind->item[i];

        put_item(text, key, by_semantic ? item->semantic : item->uri, (double)item->bytes.size);
    }
    rf_text_words(text, "</rdf:Seq></Container:Directory>");
}

void rf_behind_free(struct rf_behind *behind)
{
    for (int i = 0; i < behind->count; i++)
        free(behind->item[i].bytes.data);
    behind->count = 0;
}
