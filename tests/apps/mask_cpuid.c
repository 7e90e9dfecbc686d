/* For LD_PRELOAD on x86-64 Linux: CPUID reports a CPU of class MIEN_CPU_CLASS to the program, so
 * that all engines can be compared as they run on CPUs with fewer instruction sets:
 *
 *   avx2       without AVX-512, AMX and AVX-VNNI
 *   avx2+vnni  without AVX-512 and AMX
 *   avx512     without AMX
 *
 * The kernel traps CPUID (arch_prctl(2), ARCH_CPUID) where the CPU supports it. Elsewhere the
 * program ends with exit status 69, unless the CPU itself is of that class. Bits: Intel 64 and
 * IA-32 Architectures Software Developer's Manual, volume 2, CPUID.
 */
#define _GNU_SOURCE
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

enum { kArchCpuid = 0x1012, kUnavailable = 69 };

#define BIT(n) (UINT32_C(1) << (n))

struct registers {
  uint32_t eax, ebx, ecx, edx;
};

/* Bits to clear of leaf 7, subleaves 0 and 1. */
static const struct registers kAvx512[2] = {
    {.ebx = BIT(16) | BIT(17) | BIT(21) | BIT(26) | BIT(27) | BIT(28) | BIT(30) | BIT(31),
     .ecx = BIT(1) | BIT(6) | BIT(11) | BIT(12) | BIT(14),
     .edx = BIT(2) | BIT(3) | BIT(8) | BIT(23)},
    {.eax = BIT(5), .edx = BIT(19)}};
static const struct registers kAmx[2] = {{.edx = BIT(22) | BIT(24) | BIT(25)},
                                         {.eax = BIT(21), .edx = BIT(8)}};
static const struct registers kAvxVnni[2] = {
    {0}, {.eax = BIT(4) | BIT(23), .edx = BIT(4) | BIT(5) | BIT(10)}};

static struct registers hidden[2];

static void hide(const struct registers what[2]) {
  for (int i = 0; i < 2; ++i) {
    hidden[i].eax |= what[i].eax;
    hidden[i].ebx |= what[i].ebx;
    hidden[i].ecx |= what[i].ecx;
    hidden[i].edx |= what[i].edx;
  }
}

static struct registers cpuid(uint32_t leaf, uint32_t subleaf) {
  struct registers r = {leaf, 0, subleaf, 0};
  __asm__ volatile("cpuid" : "+a"(r.eax), "=b"(r.ebx), "+c"(r.ecx), "=d"(r.edx));
  return r;
}

static struct registers masked_cpuid(uint32_t leaf, uint32_t subleaf) {
  struct registers r = cpuid(leaf, subleaf);
  if (leaf == 7 && subleaf < 2) {
    r.eax &= ~hidden[subleaf].eax;
    r.ebx &= ~hidden[subleaf].ebx;
    r.ecx &= ~hidden[subleaf].ecx;
    r.edx &= ~hidden[subleaf].edx;
  }
  const int of_amx = leaf == 0x1d || leaf == 0x1e, of_avx10 = leaf == 0x24;
  if (of_amx || (of_avx10 && (hidden[1].edx & BIT(19)))) {
    memset(&r, 0, sizeof r);
  }
  return r;
}

static long trap_cpuid(int on) { return syscall(SYS_arch_prctl, kArchCpuid, !on); }

static void on_trap(int signal_number, siginfo_t* info, void* context) {
  (void)info;
  greg_t* const registers = ((ucontext_t*)context)->uc_mcontext.gregs;
  const unsigned char* const code = (const unsigned char*)registers[REG_RIP];
  if (code[0] != 0x0f || code[1] != 0xa2) { /* not CPUID: a real fault */
    signal(signal_number, SIG_DFL);
    return;
  }
  trap_cpuid(0);
  const struct registers r =
      masked_cpuid((uint32_t)registers[REG_RAX], (uint32_t)registers[REG_RCX]);
  trap_cpuid(1);
  registers[REG_RAX] = r.eax;
  registers[REG_RBX] = r.ebx;
  registers[REG_RCX] = r.ecx;
  registers[REG_RDX] = r.edx;
  registers[REG_RIP] += 2;
}

static void fail(const char* what) {
  fprintf(stderr, "mask_cpuid: %s\n", what);
  _exit(kUnavailable);
}

/* Whether the CPU has none of the instruction sets to hide, so that nothing needs a trap. */
static int hides_nothing(void) {
  for (uint32_t i = 0; i < 2; ++i) {
    const struct registers all = cpuid(7, i), kept = masked_cpuid(7, i);
    if (memcmp(&all, &kept, sizeof all) != 0) {
      return 0;
    }
  }
  return 1;
}

/* Sets `hidden`. */
static void choose(const char* class) {
  hide(kAmx);
  if (strcmp(class, "avx2") == 0) {
    hide(kAvx512);
    hide(kAvxVnni);
  } else if (strcmp(class, "avx2+vnni") == 0) {
    hide(kAvx512);
  } else if (strcmp(class, "avx512") != 0) {
    fail("MIEN_CPU_CLASS: expected avx2, avx2+vnni or avx512");
  }
}

/* A CPU below a class would give it the times of another. */
static int lacks_the_class(const char* class) {
  if (strcmp(class, "avx512") == 0) {
    return (cpuid(7, 0).ebx & BIT(16)) == 0;
  }
  return strcmp(class, "avx2+vnni") == 0 && (cpuid(7, 1).eax & BIT(4)) == 0;
}

__attribute__((constructor)) static void start(void) {
  const char* const class = getenv("MIEN_CPU_CLASS");
  choose(class == NULL ? "" : class);
  if (lacks_the_class(class)) {
    fail("this CPU lacks the instruction sets of MIEN_CPU_CLASS");
  }
  if (hides_nothing()) {
    return;
  }
  struct sigaction action = {.sa_flags = SA_SIGINFO | SA_NODEFER};
  action.sa_sigaction = on_trap;
  sigaction(SIGSEGV, &action, NULL);
  if (trap_cpuid(1) != 0) {
    fail("this CPU or kernel cannot trap CPUID");
  }
}
