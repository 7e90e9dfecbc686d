// Procedure call standard for the Arm 64-bit architecture, 6.1: the callee must preserve x19 to x29,
// the lower halves of v8 to v15 and the modes in fpcr.
#include "apps/conformance/registers_abi.h"
#ifdef MIEN_REGISTERS_AARCH64

    .text
    .p2align 2
    .globl MIEN_SYMBOL(mien_call_checked)
#ifdef __ELF__
    .hidden mien_call_checked
    .hidden mien_correct_kernel
    .type mien_call_checked, %function
#endif
// uint32_t mien_call_checked(void (*kernel)(), const void* args)
MIEN_SYMBOL(mien_call_checked):
    stp x29, x30, [sp, #-176]!
    stp x19, x20, [sp, #16]
    stp x21, x22, [sp, #32]
    stp x23, x24, [sp, #48]
    stp x25, x26, [sp, #64]
    stp x27, x28, [sp, #80]
    stp d8, d9, [sp, #96]
    stp d10, d11, [sp, #112]
    stp d12, d13, [sp, #128]
    stp d14, d15, [sp, #144]
    mrs x9, fpcr
    str x9, [sp, #160]
    mov x29, sp
    mov x9, x0
    mov x0, x1
    mov x19, #0x6e19
    mov x20, #0x6e20
    mov x21, #0x6e21
    mov x22, #0x6e22
    mov x23, #0x6e23
    mov x24, #0x6e24
    mov x25, #0x6e25
    mov x26, #0x6e26
    mov x27, #0x6e27
    mov x28, #0x6e28
    .macro canary number, value
    mov x10, #\value
    fmov d\number, x10
    .endm
    canary 8, 0x6e08
    canary 9, 0x6e09
    canary 10, 0x6e10
    canary 11, 0x6e11
    canary 12, 0x6e12
    canary 13, 0x6e13
    canary 14, 0x6e14
    canary 15, 0x6e15
    blr x9

    mov w0, #0
    .macro check register, canary, bit
    mov x10, #\canary
    cmp \register, x10
    cset w11, ne
    orr w0, w0, w11, lsl #\bit
    .endm
    check x19, 0x6e19, 0
    check x20, 0x6e20, 1
    check x21, 0x6e21, 2
    check x22, 0x6e22, 3
    check x23, 0x6e23, 4
    check x24, 0x6e24, 5
    check x25, 0x6e25, 6
    check x26, 0x6e26, 7
    check x27, 0x6e27, 8
    check x28, 0x6e28, 9
    mov x10, sp
    cmp x29, x10
    cset w11, ne
    orr w0, w0, w11, lsl #10
    .macro check_vector number, canary, bit
    fmov x12, d\number
    check x12, \canary, \bit
    .endm
    check_vector 8, 0x6e08, 11
    check_vector 9, 0x6e09, 12
    check_vector 10, 0x6e10, 13
    check_vector 11, 0x6e11, 14
    check_vector 12, 0x6e12, 15
    check_vector 13, 0x6e13, 16
    check_vector 14, 0x6e14, 17
    check_vector 15, 0x6e15, 18
    ldr x10, [sp, #160]
    mrs x11, fpcr
    cmp x10, x11
    cset w11, ne
    orr w0, w0, w11, lsl #19
    msr fpcr, x10

    ldp d14, d15, [sp, #144]
    ldp d12, d13, [sp, #128]
    ldp d10, d11, [sp, #112]
    ldp d8, d9, [sp, #96]
    ldp x27, x28, [sp, #80]
    ldp x25, x26, [sp, #64]
    ldp x23, x24, [sp, #48]
    ldp x21, x22, [sp, #32]
    ldp x19, x20, [sp, #16]
    ldp x29, x30, [sp], #176
    ret

// Kernels for the self-test: correct, except that they change a callee-saved register.
    .p2align 2
    .globl MIEN_SYMBOL(mien_loses_general_register)
    .globl MIEN_SYMBOL(mien_loses_vector_register)
#ifdef __ELF__
    .hidden mien_loses_general_register
    .hidden mien_loses_vector_register
    .type mien_loses_general_register, %function
    .type mien_loses_vector_register, %function
#endif
MIEN_SYMBOL(mien_loses_general_register):
    mov x21, #1
    b MIEN_SYMBOL(mien_correct_kernel)

MIEN_SYMBOL(mien_loses_vector_register):
    movi d9, #0
    b MIEN_SYMBOL(mien_correct_kernel)

#endif
#ifdef __ELF__
    .section .note.GNU-stack, "", %progbits
#endif
