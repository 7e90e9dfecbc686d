// System V ABI for x86-64, 3.2.1: the callee must preserve rbx, rbp, r12 to r15, the direction flag
// and the control bits of mxcsr and of the x87.
#include "apps/conformance/registers_abi.h"
#ifdef MIEN_REGISTERS_SYSV

#define CANARY 0x6d69656e00000000

    .text
    .globl MIEN_SYMBOL(mien_call_checked)
#ifdef __ELF__
    .hidden mien_call_checked
    .hidden mien_correct_kernel
    .type mien_call_checked, @function
#endif
// uint32_t mien_call_checked(void (*kernel)(), const void* args)
MIEN_SYMBOL(mien_call_checked):
    push %rbx
    push %rbp
    push %r12
    push %r13
    push %r14
    push %r15
    sub $24, %rsp                // 16-byte aligned again
    stmxcsr (%rsp)
    fnstcw 4(%rsp)
    mov %rdi, %rax
    mov %rsi, %rdi
    movabs $(CANARY + 1), %rbx
    movabs $(CANARY + 2), %rbp
    movabs $(CANARY + 3), %r12
    movabs $(CANARY + 4), %r13
    movabs $(CANARY + 5), %r14
    movabs $(CANARY + 6), %r15
    call *%rax

    xor %eax, %eax
    .macro check register, canary, bit
    movabs $(CANARY + \canary), %rcx
    xor %edx, %edx
    cmp %rcx, %\register
    setne %dl
    shl $\bit, %edx
    or %edx, %eax
    .endm
    check rbx, 1, 0
    check rbp, 2, 1
    check r12, 3, 2
    check r13, 4, 3
    check r14, 5, 4
    check r15, 6, 5

    pushfq
    pop %rcx
    shr $10, %ecx                // the direction flag
    and $1, %ecx
    shl $6, %ecx
    or %ecx, %eax
    cld

    stmxcsr 8(%rsp)
    mov 8(%rsp), %ecx
    xor (%rsp), %ecx
    and $0xffffffc0, %ecx        // all but the sticky flags
    xor %edx, %edx
    cmp $0, %ecx
    setne %dl
    shl $7, %edx
    or %edx, %eax
    ldmxcsr (%rsp)

    fnstcw 8(%rsp)
    movzwl 8(%rsp), %ecx
    xor %edx, %edx
    cmp 4(%rsp), %cx
    setne %dl
    shl $8, %edx
    or %edx, %eax
    fldcw 4(%rsp)

    add $24, %rsp
    pop %r15
    pop %r14
    pop %r13
    pop %r12
    pop %rbp
    pop %rbx
    ret

// A kernel for the self-test: correct, except that it changes a callee-saved register.
    .globl MIEN_SYMBOL(mien_loses_general_register)
#ifdef __ELF__
    .hidden mien_loses_general_register
    .type mien_loses_general_register, @function
#endif
MIEN_SYMBOL(mien_loses_general_register):
    mov $1, %r12d
    jmp MIEN_SYMBOL(mien_correct_kernel)

#endif
#ifdef __ELF__
    .section .note.GNU-stack, "", %progbits
#endif
