/*
 * board_works.c - what board.h promises: variables as C starts them, text, exact counts, stack depth, a status.
 *
 * Would catch a linker script that loses .data, start-up that leaves .bss as it was, a counter that counts something
 * else than instructions, and a stack that is not painted.
 */
#include "board.h"
#include "speech_en.h"

static volatile uint32_t initialised[3] = { 1, 0xfeedbeefu, 3 };
static volatile uint32_t zeroed[64];
static volatile uint32_t sink;

static int failures;

static void expect(int holds, const char *what)
{
    if (!holds) {
        board_print("FAILED: ");
        board_print(what);
        board_put('\n');
        failures++;
    }
}

__attribute__((noinline)) static uint32_t count_loop(uint32_t rounds)
{
    board_count_start();
    while (rounds-- > 0)
        sink = rounds;
    return board_count();
}

/* Touches `size` bytes of stack, at most 512. */
__attribute__((noinline)) static void use_stack(unsigned size)
{
    volatile uint8_t bytes[512];
    for (unsigned i = 0; i < size; i++)
        bytes[sizeof bytes - 1u - i] = (uint8_t)i;
    sink = bytes[sizeof bytes - 1u];
}

static void check_counter(void)
{
    const uint32_t one = count_loop(1), round = count_loop(2) - one, many = count_loop(100001);
    if (many == 0) /* the host has no counter */
        return;
    board_print_within("one round of a loop: ", round, " instructions\n");
    expect(round >= 2 && round <= 6, "a round of the loop takes two to six instructions");
    expect(many == one + 100000u * round, "100,000 more rounds take exactly as many times what one takes");
    expect(count_loop(100001) == many, "the same loop counts the same again");
    expect(count_loop(BOARD_COUNT_MAX / round) / round >= BOARD_COUNT_MAX / round,
           "the longest stretch can be counted");
    const uint32_t long_stretch = count_loop(8000001);
    expect(long_stretch == BOARD_COUNT_OVERFLOW || long_stretch == one + 8000000u * round,
           "a longer stretch is counted or said to be too long");
    expect(count_loop(0) <= 8, "counting itself is not counted");
}

static void check_stack(void)
{
    board_stack_paint();
    use_stack(16);
    const uint32_t shallow = board_stack_depth();
    use_stack(512);
    const uint32_t deep = board_stack_depth();
    if (board_stack_left() == UINT32_MAX) /* the host cannot tell */
        return;
    expect(shallow >= 16 && shallow < 128, "a call that touches 16 bytes is seen as such");
    expect(deep >= 512 && deep < 640, "a call that touches 512 bytes is seen as such");
    board_print_within("stack never used: ", board_stack_left(), " bytes\n");
}

int main(void)
{
    uint32_t any = 0;
    board_print("board: ");
    board_print(board_name);
    board_put('\n');
    board_print_signed(-2147483647 - 1);
    board_put(' ');
    board_print_hex(0x0badf00du);
    board_put('\n');
    expect(initialised[0] == 1 && initialised[1] == 0xfeedbeefu && initialised[2] == 3, "variables are initialised");
    for (unsigned i = 0; i < sizeof zeroed / sizeof zeroed[0]; i++)
        any |= zeroed[i];
    expect(any == 0, "other variables are zero");
    expect(labial_model_check(&speech_en) == LABIAL_OK, "the model's tables are readable");
    check_counter();
    check_stack();
    return failures ? 1 : 0;
}
