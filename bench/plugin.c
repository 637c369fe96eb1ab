/*
 * plugin.c - a plugin for QEMU that counts how often the instruction at each address is executed, and how often the
 * next one is not the one behind it:
 *
 *     cc -shared -fPIC plugin.c -o plugin.so
 *     qemu-system-arm -plugin file=plugin.so,out=HISTOGRAM ...
 *
 * writes lines of an address, hexadecimal, and the two counts.
 *
 * QEMU's header qemu-plugin.h is not in every package of QEMU; what is used of version 1 of its interface is declared
 * here.
 */
#include <inttypes.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
typedef struct qemu_info_t qemu_info_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum qemu_plugin_op { QEMU_PLUGIN_INLINE_ADD_U64 };

extern void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                                  void (*callback)(qemu_plugin_id_t, struct qemu_plugin_tb *));
extern void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *tb, void (*callback)(unsigned, void *),
                                                 int flags, void *user);
extern void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void *), void *user);
extern void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn *insn, enum qemu_plugin_op op, void *at,
                                                       uint64_t value);
extern size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *tb);
extern struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *tb, size_t index);
extern uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *insn);
extern size_t qemu_plugin_insn_size(const struct qemu_plugin_insn *insn);

extern int qemu_plugin_version;
int qemu_plugin_version = 1;
extern int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv);

#define SLOTS (1u << 20) /* a power of two, far more than an image has instructions */

/* A hash table, open addressing; empty slots have no address + 1. */
typedef struct {
    uint64_t address; /* + 1 */
    uint64_t count;
    uint64_t left; /* times that execution went on elsewhere than behind it */
} slot_t;

static slot_t slots[SLOTS];

/* A block of instructions as QEMU translates them; only its last one can branch. */
typedef struct {
    uint64_t begin, end;
    slot_t *last;
} block_t;

static char *output;
static const block_t *block_before;

static slot_t *slot_of(uint64_t address)
{
    uint32_t slot = (uint32_t)(address >> 1) * 2654435761u >> 12;
    while (slots[slot].address && slots[slot].address != address + 1)
        slot = (slot + 1) % SLOTS;
    slots[slot].address = address + 1;
    return &slots[slot];
}

static void executed(unsigned cpu, void *user)
{
    const block_t *block = (const block_t *)user;
    (void)cpu;
    if (block_before && block_before->end != block->begin)
        block_before->last->left++;
    block_before = block;
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb *tb)
{
    const size_t count = qemu_plugin_tb_n_insns(tb);
    block_t *block = malloc(sizeof *block); /* for as long as QEMU may execute it, which it does not tell */
    (void)id;
    if (!block)
        abort();
    for (size_t i = 0; i < count; i++) {
        struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(tb, i);
        const uint64_t address = qemu_plugin_insn_vaddr(insn);
        slot_t *slot = slot_of(address);
        qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &slot->count, 1);
        if (i == 0)
            block->begin = address;
        block->end = address + qemu_plugin_insn_size(insn);
        block->last = slot;
    }
    qemu_plugin_register_vcpu_tb_exec_cb(tb, executed, 0, block);
}

static void finish(qemu_plugin_id_t id, void *user)
{
    FILE *out = fopen(output, "w");
    (void)id;
    (void)user;
    if (!out) {
        perror(output);
        return;
    }
    for (uint32_t slot = 0; slot < SLOTS; slot++)
        if (slots[slot].count)
            fprintf(out, "%" PRIx64 " %" PRIu64 " %" PRIu64 "\n", slots[slot].address - 1, slots[slot].count,
                    slots[slot].left);
    if (fclose(out) != 0)
        perror(output);
}

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv)
{
    const char *name = argc == 1 && strncmp(argv[0], "out=", 4) == 0 ? argv[0] + 4 : NULL;
    (void)info;
    output = name ? malloc(strlen(name) + 1) : NULL;
    if (!output) {
        fputs("usage: -plugin file=plugin.so,out=HISTOGRAM\n", stderr);
        return 1;
    }
    strcpy(output, name);
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, finish, NULL);
    return 0;
}
