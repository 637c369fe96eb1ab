/*
 * board_fails.c - what an image looks like from outside when it fails: a status, a fault, a stack that overflowed.
 *
 * Would catch a board on which every image passes.
 */
#include "board.h"

#if defined(BOARD_FAILS_BY_overflow)

/* Writes from here down until no word of the stack is as it was painted. */
__attribute__((noinline)) static void overflow(void)
{
    volatile uint32_t bottom = 0;
    volatile uint32_t *word = &bottom;
    uint32_t left;
    while ((left = board_stack_left() / 4u) > 0)
        for (; left > 0; left--)
            *--word = left;
}

#endif

int main(void)
{
#if defined(BOARD_FAILS_BY_fault)
    __builtin_trap(); /* an instruction that no processor knows */
#elif defined(BOARD_FAILS_BY_overflow)
    overflow();
    return 0;
#else
    return 3;
#endif
}
