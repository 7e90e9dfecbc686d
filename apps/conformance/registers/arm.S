// Procedure call standard for the Arm architecture, 6.1: the callee must preserve r4 to r11, d8 to
// d15 and the modes in fpscr.
#include "apps/conformance/registers_abi.h"
#ifdef MIEN_REGISTERS_ARM

    .syntax unified
    .arm
    .fpu vfp
    .text
    .p2align 2
    .globl mien_call_checked
    .hidden mien_call_checked
    .hidden mien_correct_kernel
    .type mien_call_checked, %function
// uint32_t mien_call_checked(void (*kernel)(), const void* args)
mien_call_checked:
    push {r4-r11, lr}
    vpush {d8-d15}
    sub sp, sp, #12              // 8-byte aligned again
    vmrs r2, fpscr
    str r2, [sp]
    mov r3, r0
    mov r0, r1
    .macro canary number, value
    movw r12, #\value
    vmov d\number, r12, r12
    .endm
    canary 8, 0x6e08
    canary 9, 0x6e09
    canary 10, 0x6e10
    canary 11, 0x6e11
    canary 12, 0x6e12
    canary 13, 0x6e13
    canary 14, 0x6e14
    canary 15, 0x6e15
    movw r4, #0x6e24
    movw r5, #0x6e25
    movw r6, #0x6e26
    movw r7, #0x6e27
    movw r8, #0x6e28
    movw r9, #0x6e29
    movw r10, #0x6e30
    movw r11, #0x6e31
    blx r3

    mov r0, #0
    .macro check register, canary, bit
    movw r12, #\canary
    cmp \register, r12
    orrne r0, r0, #(1 << \bit)
    .endm
    check r4, 0x6e24, 0
    check r5, 0x6e25, 1
    check r6, 0x6e26, 2
    check r7, 0x6e27, 3
    check r8, 0x6e28, 4
    check r9, 0x6e29, 5
    check r10, 0x6e30, 6
    check r11, 0x6e31, 7
    .macro check_vector number, canary, bit
    vmov r2, r3, d\number
    check r2, \canary, \bit
    check r3, \canary, \bit
    .endm
    check_vector 8, 0x6e08, 8
    check_vector 9, 0x6e09, 9
    check_vector 10, 0x6e10, 10
    check_vector 11, 0x6e11, 11
    check_vector 12, 0x6e12, 12
    check_vector 13, 0x6e13, 13
    check_vector 14, 0x6e14, 14
    check_vector 15, 0x6e15, 15
    ldr r2, [sp]
    vmrs r3, fpscr
    eor r3, r3, r2
    ldr r12, =0x07f70000         // half precision, NaNs, flush to zero, rounding, vectors
    tst r3, r12
    orrne r0, r0, #(1 << 16)
    vmsr fpscr, r2

    add sp, sp, #12
    vpop {d8-d15}
    pop {r4-r11, pc}
    .ltorg

// Kernels for the self-test: correct, except that they change a callee-saved register.
    .globl mien_loses_general_register
    .hidden mien_loses_general_register
    .type mien_loses_general_register, %function
mien_loses_general_register:
    mov r6, #1
    b mien_correct_kernel

    .globl mien_loses_vector_register
    .hidden mien_loses_vector_register
    .type mien_loses_vector_register, %function
mien_loses_vector_register:
    mov r1, #1
    vmov d9, r1, r1
    b mien_correct_kernel

#endif
#ifdef __ELF__
    .section .note.GNU-stack, "", %progbits
#endif
