/*
 * trace.c - a line per frame and one at the end, as text through the debugger.
 */
#include "trace.h"

#include "board.h"

static uint32_t faces, work, longest;

static void print_lengths(const uint16_t lengths[SERVOS_COUNT])
{
    for (unsigned i = 0; i < SERVOS_COUNT; i++) {
        board_put(' ');
        board_print_unsigned(lengths[i]);
    }
}

static void print_count(const char *name, uint32_t count)
{
    board_print(name);
    board_print_unsigned(count);
}

void trace_face(const servos_face_t *face)
{
    print_count("face ", faces++);
    print_lengths(face->lengths);
    board_print(" measured");
    print_lengths(face->measured);
    board_put('\n');
}

void trace_work(uint32_t microseconds)
{
    work += microseconds;
    if (microseconds > longest)
        longest = microseconds;
}

void trace_end(void)
{
    const servos_counts_t counts = servos_counts();
    print_count("end faces ", faces);
    print_count(" late ", counts.late);
    print_count(" periods ", counts.periods);
    print_count(" interrupts ", counts.interrupts);
    print_count(" work ", work);
    print_count(" longest ", longest);
    print_count(" stack ", board_stack_left());
    board_put('\n');
}
