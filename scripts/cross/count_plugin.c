/* A plugin for qemu-user that counts the instructions a program executes, per symbol.
 *
 *   qemu-aarch64 -plugin libcount.so,output=FILE PROGRAM
 *
 * writes lines "COUNT SYMBOL" at exit; "?" is code without a symbol. The declarations are those of
 * version 1 of qemu's plugin interface (docs/devel/tcg-plugins of qemu), whose header Debian does
 * not package. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* tb);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* tb, size_t index);
const char* qemu_plugin_insn_symbol(const struct qemu_plugin_insn* insn);
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn* insn, int operation,
                                                void* counter, uint64_t operand);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*callback)(qemu_plugin_id_t,
                                                            struct qemu_plugin_tb*));
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void*),
                                    void* data);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

enum { kInlineAdd = 0, kMaxSymbols = 1 << 16 };

static struct {
  char* name;
  uint64_t count;
} symbols[kMaxSymbols]; /* open addressing; the addresses of counts must not move */
static char output[4096];

static uint64_t* counter_of(const char* name) {
  uint32_t hash = 2166136261u; /* FNV-1a */
  for (const char* c = name; *c != '\0'; ++c) {
    hash = (hash ^ (unsigned char)*c) * 16777619u;
  }
  for (uint32_t i = hash % kMaxSymbols;; i = (i + 1) % kMaxSymbols) {
    if (symbols[i].name == NULL) {
      symbols[i].name = strdup(name);
    }
    if (strcmp(symbols[i].name, name) == 0) {
      return &symbols[i].count;
    }
  }
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb* tb) {
  (void)id;
  for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); ++i) {
    struct qemu_plugin_insn* insn = qemu_plugin_tb_get_insn(tb, i);
    const char* symbol = qemu_plugin_insn_symbol(insn);
    const char* name = symbol != NULL && *symbol != '\0' ? symbol : "?";
    qemu_plugin_register_vcpu_insn_exec_inline(insn, kInlineAdd, counter_of(name), 1);
  }
}

static void finished(qemu_plugin_id_t id, void* data) {
  (void)id;
  (void)data;
  FILE* file = fopen(output, "w");
  if (file == NULL) {
    perror(output);
    exit(1);
  }
  for (int i = 0; i < kMaxSymbols; ++i) {
    if (symbols[i].name != NULL) {
      fprintf(file, "%llu %s\n", (unsigned long long)symbols[i].count, symbols[i].name);
    }
  }
  fclose(file);
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id,
                                                               const void* info, int argc,
                                                               char** argv) {
  (void)info;
  if (argc != 1 || strncmp(argv[0], "output=", 7) != 0) {
    fprintf(stderr, "count_plugin: wants output=FILE\n");
    return -1;
  }
  snprintf(output, sizeof output, "%s", argv[0] + 7);
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, finished, NULL);
  return 0;
}
