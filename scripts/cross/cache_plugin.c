/* A plugin for qemu-user that passes a program's loads and stores through a model of two caches and
 * counts the lines that each must fetch.
 *
 *   qemu-aarch64 -plugin libcache.so,output=FILE PROGRAM
 *
 * writes "LOADS_AND_STORES LINES_INTO_L1 LINES_INTO_L2" at exit. The caches are those of a
 * Cortex-A53 as phones have them: 32 KB, 4 ways, and 512 KB, 16 ways; lines of 64 bytes, of a set
 * the least recently used goes. No prefetching, no instruction fetches. The declarations are those
 * of version 1 of qemu's plugin interface (docs/devel/tcg-plugins of qemu), whose header Debian
 * does not package. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* tb);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* tb, size_t index);
unsigned qemu_plugin_mem_size_shift(uint32_t info);
typedef void (*MemCallback)(unsigned cpu, uint32_t info, uint64_t address, void* data);
void qemu_plugin_register_vcpu_mem_cb(struct qemu_plugin_insn* insn, MemCallback callback,
                                      int flags, int read_write, void* data);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*callback)(qemu_plugin_id_t,
                                                            struct qemu_plugin_tb*));
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void*),
                                    void* data);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

enum { kLineShift = 6, kMaxWays = 16, kMaxSets = 512, kNoRegisters = 0, kReadOrWrite = 3 };

struct Cache {
  unsigned sets, ways;
  uint64_t fetched;
  uint64_t lines[kMaxSets][kMaxWays]; /* of each set, the most recently used first; 0: empty */
};

static struct Cache l1 = {.sets = 128, .ways = 4}, l2 = {.sets = 512, .ways = 16};
static uint64_t accesses;
static char output[4096];

/* Returns whether the line was present. */
static int touch(struct Cache* cache, uint64_t line) {
  uint64_t* set = cache->lines[line % cache->sets];
  unsigned way = 0;
  while (way + 1 < cache->ways && set[way] != line) {
    ++way;
  }
  const int hit = set[way] == line;
  memmove(set + 1, set, way * sizeof *set);
  set[0] = line;
  cache->fetched += !hit;
  return hit;
}

static void accessed(unsigned cpu, uint32_t info, uint64_t address, void* data) {
  (void)cpu;
  (void)data;
  ++accesses;
  const uint64_t last = address + (1u << qemu_plugin_mem_size_shift(info)) - 1;
  for (uint64_t line = address >> kLineShift; line <= last >> kLineShift; ++line) {
    if (!touch(&l1, line)) {
      touch(&l2, line);
    }
  }
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb* tb) {
  (void)id;
  for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); ++i) {
    qemu_plugin_register_vcpu_mem_cb(qemu_plugin_tb_get_insn(tb, i), accessed, kNoRegisters,
                                     kReadOrWrite, NULL);
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
  fprintf(file, "%llu %llu %llu\n", (unsigned long long)accesses, (unsigned long long)l1.fetched,
          (unsigned long long)l2.fetched);
  fclose(file);
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id,
                                                               const void* info, int argc,
                                                               char** argv) {
  (void)info;
  if (argc != 1 || strncmp(argv[0], "output=", 7) != 0) {
    fprintf(stderr, "cache_plugin: wants output=FILE\n");
    return -1;
  }
  snprintf(output, sizeof output, "%s", argv[0] + 7);
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, finished, NULL);
  return 0;
}
