/* compare_report.c: the scores of `refocus compare` are printed, as a table or as JSON. */
#include <stdio.h>
#include <string.h>
#include "compare/compare_report.h"

static json_t *item_json(const struct compared *item)
{
    const struct quality_scores *s = &item->scores;
    const int length = (int)strcspn(item->name, ":");
    json_t *json =
        json_pack("{s:s#, s:o, s:o, s:o, s:o, s:o}", "method", item->name, length, "label",
                  report_text_json(item->name), "psnr", report_number_json(s->psnr), "ssim",
                  report_number_json(s->ssim), "edge_psnr", report_number_json(s->edge_psnr),
                  "rmse", report_number_json(s->rmse));

    if (json && item->memory)
        json_object_set_new(json, "render_ms", report_spread_json(item->ms));
    if (json && item->memory)
        json_object_set_new(json, "cpu_ms", report_spread_json(item->cpu_ms));
    if (json && item->memory)
        json_object_set_new(json, "renderer_bytes", json_integer((json_int_t)item->memory));
    return json;
}

int compare_report(const struct comparison *c, const struct engine *engine, const char *photo,
                   const char *reference, int border, bool as_json)
{
    int widest = 13;

    if (as_json) {
        json_t *rows = json_array();
        json_t *run = engine_json(engine);
        json_t *json = json_pack("{s:o, s:o, s:i, s:i, s:i}", "photo", report_text_json(photo),
                                 "reference", report_text_json(reference), "width", c->width,
                                 "height", c->height, "border", border);

        for (int i = 1; i < c->count; i++)
            json_array_append_new(rows, item_json(&c->item[i]));
        if (json && run) {
            static const char *const of_one[] = {"method", "render_ms", "cpu_ms", "renderer_bytes"};

            for (int i = 0; i < 4; i++)
                json_object_del(run, of_one[i]);
            json_object_update(json, run);
        }
        json_decref(run);
        if (json)
            json_object_set_new(json, "methods", rows);
        else
            json_decref(rows);
        return report_print_json(json);
    }
    for (int i = 1; i < c->count; i++)
        if ((int)strlen(c->item[i].name) > widest)
            widest = (int)strlen(c->item[i].name);
    printf("%-*s %7s %7s %9s %7s %10s %8s\n", widest, "method", "PSNR", "SSIM", "edge PSNR", "RMSE",
           "ms", "MiB");
    for (int i = 1; i < c->count; i++) {
        const struct compared *item = &c->item[i];
        const struct quality_scores *s = &item->scores;

        printf("%-*s %7.2f %7.4f %9.2f %7.2f", widest, item->name, s->psnr, s->ssim, s->edge_psnr,
               s->rmse);
        if (item->memory)
            printf(" %10.2f %8.1f", item->ms.median, (double)item->memory / (1 << 20));
        putchar('\n');
    }
    return report_end_output();
}
