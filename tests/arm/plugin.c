/* plugin.c: a plugin for Debian 12's qemu-user (7.2): how often each block of guest code ran.
 *
 *     qemu-aarch64 -plugin ./plugin.so,out=FILE PROGRAM
 *
 * writes a line "ADDRESS BYTES INSTRUCTIONS RUNS" for each. For one guest thread: counts are
 * added to without a lock. The few functions of the plugin interface that are called are
 * declared here, because Debian has no package with their header. */
#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))

typedef uint64_t plugin_id;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
typedef void translated_fn(plugin_id id, struct qemu_plugin_tb *block);

void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id id, translated_fn *translated);
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb *block, int operation,
                                              void *counter, uint64_t add);
void qemu_plugin_register_atexit_cb(plugin_id id, void (*end)(plugin_id id, void *user),
                                    void *user);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb *block);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *block, size_t i);
size_t qemu_plugin_insn_size(const struct qemu_plugin_insn *instruction);

EXPORT int qemu_plugin_version = 1;
EXPORT int qemu_plugin_install(plugin_id id, const void *info, int argc, char **argv);

struct block {
    struct block *next;
    uint64_t address, runs;
    size_t bytes, instructions;
};

static struct block *blocks;
static const char *out_name;

static void translated(plugin_id id, struct qemu_plugin_tb *tb)
{
    struct block *block = calloc(1, sizeof *block);

    (void)id;
    if (!block) {
        fprintf(stderr, "plugin: no memory\n");
        exit(1);
    }
    block->address = qemu_plugin_tb_vaddr(tb);
    block->instructions = qemu_plugin_tb_n_insns(tb);
    for (size_t i = 0; i < block->instructions; i++)
        block->bytes += qemu_plugin_insn_size(qemu_plugin_tb_get_insn(tb, i));
    block->next = blocks;
    blocks = block;
    qemu_plugin_register_vcpu_tb_exec_inline(tb, 0 /* add */, &block->runs, 1);
}

static void end(plugin_id id, void *user)
{
    FILE *out = fopen(out_name, "w");

    (void)id;
    (void)user;
    if (!out) {
        fprintf(stderr, "plugin: cannot write %s\n", out_name);
        exit(1);
    }
    for (const struct block *b = blocks; b; b = b->next)
        if (b->runs > 0)
            fprintf(out, "%" PRIx64 " %zu %zu %" PRIu64 "\n", b->address, b->bytes, b->instructions,
                    b->runs);
    fclose(out);
}

int qemu_plugin_install(plugin_id id, const void *info, int argc, char **argv)
{
    (void)info;
    for (int i = 0; i < argc; i++)
        if (strncmp(argv[i], "out=", 4) == 0)
            out_name = argv[i] + 4;
    if (!out_name) {
        fprintf(stderr, "plugin: give out=FILE\n");
        return 1;
    }
    out_name = strdup(out_name);
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, end, NULL);
    return 0;
}
