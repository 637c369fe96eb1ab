/*
 * semihosting.h - calls to the debugger that runs an image, here QEMU: an operation's number, a parameter and a trap
 * that the debugger knows. Arm's "Semihosting for AArch32 and AArch64" defines the operations; RISC-V's are these.
 */
#ifndef BOARD_SEMIHOSTING_H
#define BOARD_SEMIHOSTING_H

#include <stdint.h>

#define SEMIHOSTING_WRITE0 0x04        /* parameter: a string, ending in 0 */
#define SEMIHOSTING_EXIT_EXTENDED 0x20 /* parameter: two words, the reason and the exit status */
#define SEMIHOSTING_EXITED 0x20026u    /* the reason: the program ended by itself */

static inline void semihosting(int operation, const void *parameter)
{
#if defined(__arm__)
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = parameter;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
#elif defined(__riscv)
    register int a0 __asm__("a0") = operation;
    register const void *a1 __asm__("a1") = parameter;
    /* The three instructions are recognised when none is compressed and all lie in one page. */
    __asm__ volatile(".option push\n"
                     ".option norvc\n"
                     ".balign 16\n"
                     "slli zero, zero, 0x1f\n"
                     "ebreak\n"
                     "srai zero, zero, 7\n"
                     ".option pop"
                     : "+r"(a0)
                     : "r"(a1)
                     : "memory");
#else
#error "Semihosting is known for Arm and RISC-V."
#endif
}

#endif
