/*
 * target.c - board.h on a board: start-up, text and exit by semihosting, the painted stack. The processor's own part,
 * reset and the counter, is in arm/ and riscv/.
 */
#include "target.h"

#include <stddef.h>
#include <string.h>

#define PAINT 0xa5c3a5c3u
#define STATUS_FAULT 99
#define STATUS_STACK 98

/* Set by the linker script; only their addresses have a meaning. */
extern uint32_t board_data_begin[], board_data_end[], board_data_image[];
extern uint32_t board_bss_begin[], board_bss_end[];
extern uint32_t board_stack_begin[], board_stack_end[];

int main(void);

static char line[81];
static unsigned line_length;
static const uint32_t *painted_to; /* where the stack ended when it was painted */

/* ---- Semihosting ------------------------------------------------------------------------------------------------- */

/* Calls to the debugger that runs an image, here QEMU: an operation's number, a parameter and a trap that the debugger
 * knows. Arm's "Semihosting for AArch32 and AArch64" defines the operations; RISC-V's are these. */
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

/* ---- Text and exit ----------------------------------------------------------------------------------------------- */

static void flush(void)
{
    line[line_length] = '\0';
    if (line_length > 0)
        semihosting(SEMIHOSTING_WRITE0, line);
    line_length = 0;
}

void board_put(char character)
{
    line[line_length++] = character;
    if (character == '\n' || line_length == sizeof line - 1)
        flush();
}

static void leave(int status)
{
    const uint32_t parameter[2] = { SEMIHOSTING_EXITED, (uint32_t)status };
    flush();
    semihosting(SEMIHOSTING_EXIT_EXTENDED, parameter);
    for (;;) {
    }
}

void board_exit(int status)
{
    if (board_stack_begin[0] != PAINT) {
        board_print("\nThe stack overflowed.\n");
        status = STATUS_STACK;
    }
    leave(status);
}

void board_fault(void)
{
    board_print("\nThe processor faulted.\n");
    leave(STATUS_FAULT);
}

/* ---- Stack ------------------------------------------------------------------------------------------------------- */

/* A leaf that keeps everything in registers: its stack pointer is its caller's, and nothing below that is in use. */
__attribute__((noinline)) void board_stack_paint(void)
{
    uint32_t *const end = board_stack_pointer();
    uint32_t *word;
    for (word = board_stack_begin; word < end; word++)
        *(volatile uint32_t *)word = PAINT;
    painted_to = end;
}

static const uint32_t *lowest_used(void)
{
    const uint32_t *word = board_stack_begin;
    while (word < painted_to && *(const volatile uint32_t *)word == PAINT)
        word++;
    return word;
}

uint32_t board_stack_depth(void)
{
    return (uint32_t)(painted_to - lowest_used()) * 4u;
}

uint32_t board_stack_left(void)
{
    return (uint32_t)(lowest_used() - board_stack_begin) * 4u;
}

/* ---- Start ------------------------------------------------------------------------------------------------------- */

void board_start(void)
{
    memcpy(board_data_begin, board_data_image, (size_t)((char *)board_data_end - (char *)board_data_begin));
    memset(board_bss_begin, 0, (size_t)((char *)board_bss_end - (char *)board_bss_begin));
    board_count_calibrate();
    board_stack_paint();
    board_exit(main());
}
