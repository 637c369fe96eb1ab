/*
 * start.c - Cortex-M: vectors, reset, and SysTick as the instruction counter.
 */
#include "target.h"

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
#define SYST_CSR REGISTER(0xe000e010u) /* bit 0 enables, bit 2 takes the processor's clock, bit 16: has wrapped */
#define SYST_RVR REGISTER(0xe000e014u)
#define SYST_CVR REGISTER(0xe000e018u) /* counts down, 24 bits */
#define CPACR REGISTER(0xe000ed88u)    /* bits 20 to 23: access to floating point */

#define SYST_ENABLE 5u
#define SYST_WRAPPED 0x10000u
#define SYST_MAX 0xffffffu

/* Instructions per clock tick. An instruction takes 64 ns (-icount shift=6); the micro:bit's clock ticks every 62.5 ns,
 * that of the MPS2 boards every 40 ns. */
#if defined(__ARM_ARCH_6M__)
#define COUNT_FACTOR 125u
#define COUNT_DIVISOR 128u
#else
#define COUNT_FACTOR 5u
#define COUNT_DIVISOR 8u
#endif

extern uint32_t board_stack_end[];

static uint32_t calibration;

void board_reset(void);

void board_reset(void)
{
#if defined(__ARM_FP)
    CPACR |= 0xfu << 20;
    __asm__ volatile("dsb\n\tisb");
#endif
    board_start();
}

/* An interrupt that an image enables without defining board_interrupt() is a fault. */
__attribute__((weak)) void board_interrupt(unsigned number)
{
    (void)number;
    board_fault();
}

static void interrupt(void)
{
    uint32_t exception;
    __asm__ volatile("mrs %0, ipsr" : "=r"(exception));
    board_interrupt((unsigned)exception - 16u);
}

#define FOUR_INTERRUPTS interrupt, interrupt, interrupt, interrupt

/* What the processor reads at address 0: where the stack ends, then one handler per exception and interrupt. */
typedef struct {
    uint32_t *stack;
    void (*handlers[15 + BOARD_INTERRUPTS])(void);
} vectors_t;

/* clang-format off */
__attribute__((section(".vectors"), used)) static const vectors_t vectors = {
    board_stack_end,
    { board_reset, board_fault, board_fault, board_fault, board_fault, board_fault, 0, 0, 0, 0, board_fault,
      board_fault, 0, board_fault, interrupt, FOUR_INTERRUPTS, FOUR_INTERRUPTS, FOUR_INTERRUPTS, FOUR_INTERRUPTS,
      FOUR_INTERRUPTS, FOUR_INTERRUPTS, FOUR_INTERRUPTS, FOUR_INTERRUPTS }
};
/* clang-format on */

__attribute__((noinline)) void board_count_start(void)
{
    SYST_CSR = 0;
    SYST_RVR = SYST_MAX;
    SYST_CVR = 0; /* any value: it begins anew, and has not wrapped */
    SYST_CSR = SYST_ENABLE;
}

__attribute__((noinline)) uint32_t board_count(void)
{
    const uint32_t ticks = (0u - SYST_CVR) & SYST_MAX;
    if (SYST_CSR & SYST_WRAPPED)
        return BOARD_COUNT_OVERFLOW;
    return (ticks * COUNT_FACTOR + COUNT_DIVISOR / 2u) / COUNT_DIVISOR - calibration;
}

void board_count_calibrate(void)
{
    calibration = 0;
    board_count_start();
    calibration = board_count();
}
