/*
 * target.h - the interface of target.c and the processor-specific part.
 */
#ifndef BOARD_TARGET_H
#define BOARD_TARGET_H

#include "board.h"

/* Called by reset, with only a stack: initialises variables, calls main() and exits. Does not return. */
void board_start(void);

/* Called on any processor fault. Does not return. */
void board_fault(void);

void board_count_calibrate(void);

static inline uint32_t *board_stack_pointer(void)
{
    uint32_t *pointer;
#if defined(__arm__)
    __asm__ volatile("mov %0, sp" : "=r"(pointer));
#else
    __asm__ volatile("mv %0, sp" : "=r"(pointer));
#endif
    return pointer;
}

#endif
