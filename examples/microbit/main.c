/*
 * main.c - a face on a micro:bit: says a sentence and laughs, again whenever button A is pressed.
 *
 * All computing is done here, in the main program, ahead of time: faces go into a queue, from which the timer's
 * interrupt shows one every 20 ms (servos.c). With MICROBIT_TRACE it prints what it does, for a run under QEMU.
 */
#include "board.h"
#include "face.h"
#include "labial/face.h"
#include "nrf51.h"
#include "script.h"
#include "servos.h"

typedef char one_servo_per_output[FACE_OUTPUTS == SERVOS_COUNT ? 1 : -1];

#define ATTACH 25u /* periods from one servo to the next: half a second to get to rest */

static script_t script;
static labial_face_t mouth;
static int32_t room[LABIAL_FACE_SIZE(FACE_OUTPUTS, 0) / 4];
static int32_t pulses[FACE_OUTPUTS];

/* ---- The text of a run under QEMU -------------------------------------------------------------------------------- */

/* A board without a debugger must not print text; so without MICROBIT_TRACE these calls are empty, and the firmware
 * waits for its button instead of ending. */
#if defined(MICROBIT_TRACE)

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

/* Prints a shown face: its number, its pulses, and the pulses at the pins. */
static void trace_face(const servos_face_t *shown)
{
    print_count("face ", faces++);
    print_lengths(shown->lengths);
    board_print(" measured");
    print_lengths(shown->measured);
    board_put('\n');
}

/* The time that one call of the library took, microseconds. */
static void trace_work(uint32_t microseconds)
{
    work += microseconds;
    if (microseconds > longest)
        longest = microseconds;
}

/* Prints the counters. */
static void trace_end(void)
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

#else

static void trace_face(const servos_face_t *shown)
{
    (void)shown;
}

static void trace_work(uint32_t microseconds)
{
    (void)microseconds;
}

static void trace_end(void)
{
}

#endif

/* ---- The face ---------------------------------------------------------------------------------------------------- */

/* Takes shown faces out of the queue. */
static void tidy(void)
{
    servos_face_t shown;
    while (servos_shown(&shown))
        trace_face(&shown);
}

/* Lets the servos begin one after the other, so that the supply need not move all of them at once. */
static void attach(void)
{
    for (unsigned servo = 1; servo <= SERVOS_COUNT; servo++) {
        const uint32_t begin = servos_counts().periods;
        servos_attach(servo);
        while (servos_counts().periods - begin < ATTACH)
            servos_wait();
    }
}

/* Says the script, and goes on until the face is at rest. */
static int speak(void)
{
    int result = script_begin(&script, labial_face_frame, &mouth), shown = LABIAL_OK;
    while (result >= 0 && shown >= 0 && (result != LABIAL_DONE || shown != LABIAL_DONE)) {
        const uint32_t begin = servos_clock();
        if (result != LABIAL_DONE)
            result = script_tick(&script);
        if (result != LABIAL_WAITING) { /* nothing to show before the first frame */
            shown = labial_face_tick(&mouth, pulses);
            servos_push(pulses);
        }
        trace_work(servos_clock() - begin);
        tidy();
        if (servos_room() == 0)
            servos_play(); /* with a full queue in hand; from then on this changes nothing */
        while (servos_room() == 0) {
            servos_wait();
            tidy();
        }
    }
    servos_play();
    servos_end();
    while (servos_room() < SERVOS_QUEUE) {
        servos_wait();
        tidy();
    }
    return result < 0 || shown < 0;
}

int main(void)
{
    int failed = labial_face_init(&mouth, &face, 50, 0, room, sizeof room) < 0;
    failed |= labial_face_tick(&mouth, pulses) < 0; /* at rest, which the servos are told first */
    servos_start(pulses);
    attach();
    failed |= speak();
#if defined(MICROBIT_TRACE)
    failed |= speak(); /* as if the button had been pressed */
#else
    GPIO_PIN_CNF(MICROBIT_BUTTON_A) = 0;
    for (;;) {
        servos_wait();
        if (!(GPIO_IN & 1u << MICROBIT_BUTTON_A))
            failed = speak();
    }
#endif
    trace_end();
    return failed;
}
