/* The clock of the WebAssembly module for mien_tracker_config.clock_ns, from WASI. */
#include <stdint.h>
#include <time.h>

static uint64_t clock_ns(void* user) {
  (void)user;
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

typedef uint64_t (*mien_clock)(void* user);

/* For the configuration of a tracker. */
mien_clock mien_module_clock(void);
mien_clock mien_module_clock(void) { return clock_ns; }
