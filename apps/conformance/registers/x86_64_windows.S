// Windows x64 calling convention: the callee must preserve rbx, rbp, rdi, rsi, r12 to r15, xmm6 to
// xmm15, the direction flag and the control bits of mxcsr and of the x87.
#include "apps/conformance/registers_abi.h"
#ifdef MIEN_REGISTERS_WIN64

#define CANARY 0x6d69656e00000000

    .text
    .globl mien_call_checked
// uint32_t mien_call_checked(void (*kernel)(), const void* args)
mien_call_checked:
    push %rbx
    push %rbp
    push %rdi
    push %rsi
    push %r12
    push %r13
    push %r14
    push %r15
    sub $216, %rsp               // 32 for the callee, 16 for modes, 160 for xmm6-15, 8 to align
    .macro save number, offset
    movups %xmm\number, \offset(%rsp)
    .endm
    save 6, 48
    save 7, 64
    save 8, 80
    save 9, 96
    save 10, 112
    save 11, 128
    save 12, 144
    save 13, 160
    save 14, 176
    save 15, 192
    stmxcsr 32(%rsp)
    fnstcw 36(%rsp)
    mov %rcx, %rax
    mov %rdx, %rcx
    .macro canary number, value
    movabs $(CANARY + \value), %rbx
    movq %rbx, %xmm\number
    punpcklqdq %xmm\number, %xmm\number
    .endm
    canary 6, 9
    canary 7, 10
    canary 8, 11
    canary 9, 12
    canary 10, 13
    canary 11, 14
    canary 12, 15
    canary 13, 16
    canary 14, 17
    canary 15, 18
    movabs $(CANARY + 1), %rbx
    movabs $(CANARY + 2), %rbp
    movabs $(CANARY + 3), %rdi
    movabs $(CANARY + 4), %rsi
    movabs $(CANARY + 5), %r12
    movabs $(CANARY + 6), %r13
    movabs $(CANARY + 7), %r14
    movabs $(CANARY + 8), %r15
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
    check rdi, 3, 2
    check rsi, 4, 3
    check r12, 5, 4
    check r13, 6, 5
    check r14, 7, 6
    check r15, 8, 7
    .macro check_vector number, canary, bit
    movq %xmm\number, %r8
    movhlps %xmm\number, %xmm0
    movq %xmm0, %r9
    movabs $(CANARY + \canary), %rcx
    xor %rcx, %r8
    xor %rcx, %r9
    xor %edx, %edx
    or %r8, %r9
    setne %dl
    shl $\bit, %edx
    or %edx, %eax
    .endm
    check_vector 6, 9, 8
    check_vector 7, 10, 9
    check_vector 8, 11, 10
    check_vector 9, 12, 11
    check_vector 10, 13, 12
    check_vector 11, 14, 13
    check_vector 12, 15, 14
    check_vector 13, 16, 15
    check_vector 14, 17, 16
    check_vector 15, 18, 17

    pushfq
    pop %rcx
    shr $10, %ecx                // the direction flag
    and $1, %ecx
    shl $18, %ecx
    or %ecx, %eax
    cld

    stmxcsr 40(%rsp)
    mov 40(%rsp), %ecx
    xor 32(%rsp), %ecx
    and $0xffffffc0, %ecx        // all but the sticky flags
    xor %edx, %edx
    cmp $0, %ecx
    setne %dl
    shl $19, %edx
    or %edx, %eax
    ldmxcsr 32(%rsp)

    fnstcw 40(%rsp)
    movzwl 40(%rsp), %ecx
    xor %edx, %edx
    cmp 36(%rsp), %cx
    setne %dl
    shl $20, %edx
    or %edx, %eax
    fldcw 36(%rsp)

    .macro restore number, offset
    movups \offset(%rsp), %xmm\number
    .endm
    restore 6, 48
    restore 7, 64
    restore 8, 80
    restore 9, 96
    restore 10, 112
    restore 11, 128
    restore 12, 144
    restore 13, 160
    restore 14, 176
    restore 15, 192
    add $216, %rsp
    pop %r15
    pop %r14
    pop %r13
    pop %r12
    pop %rsi
    pop %rdi
    pop %rbp
    pop %rbx
    ret

// Kernels for the self-test: correct, except that they change a callee-saved register.
    .globl mien_loses_general_register
mien_loses_general_register:
    mov $1, %r12d
    jmp mien_correct_kernel

    .globl mien_loses_vector_register
mien_loses_vector_register:
    pxor %xmm6, %xmm6
    jmp mien_correct_kernel

#endif
#ifdef __ELF__
    .section .note.GNU-stack, "", %progbits
#endif
