/* A preloaded malloc. Allocation number MIEN_FAIL_AT, counted from 1, fails. The number of
 * allocations is written to the file MIEN_COUNT_TO. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t count, size_t bytes);
void* __libc_realloc(void* memory, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);

static long count;
static long fail_at = -1;

static int fails(void) {
  if (fail_at < 0) {
    const char* text = getenv("MIEN_FAIL_AT");
    fail_at = text != NULL ? strtol(text, NULL, 10) : 0;
  }
  if (__atomic_add_fetch(&count, 1, __ATOMIC_RELAXED) == fail_at) {
    errno = ENOMEM;
    return 1;
  }
  return 0;
}

void* malloc(size_t bytes) { return fails() ? NULL : __libc_malloc(bytes); }
void* calloc(size_t number, size_t bytes) { return fails() ? NULL : __libc_calloc(number, bytes); }
void* realloc(void* memory, size_t bytes) { return fails() ? NULL : __libc_realloc(memory, bytes); }
void* aligned_alloc(size_t alignment, size_t bytes) {
  return fails() ? NULL : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  *memory = fails() ? NULL : __libc_memalign(alignment, bytes);
  return *memory == NULL ? ENOMEM : 0;
}

__attribute__((destructor)) static void tell(void) {
  const char* path = getenv("MIEN_COUNT_TO");
  if (path != NULL) {
    char text[32];
    const int length = snprintf(text, sizeof text, "%ld", count);
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0 || write(file, text, (size_t)length) != length || close(file) != 0) {
      abort();
    }
  }
}
