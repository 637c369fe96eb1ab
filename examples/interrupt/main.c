/*
 * main.c - a stream that two contexts share: the main program pushes phonemes whenever they come, and the timer's
 * interrupt shows a frame every 20 ms, whatever the main program is doing.
 *
 * The build has LABIAL_LOCKS=1 (labial/config.h): a call of the main program that reads or writes the stream holds the
 * interrupt off for as long as it takes, some hundred instructions. The interrupt needs no lock, since the main program
 * cannot interrupt it.
 *
 * At the end it compares the frames with those of the same phonemes without an interrupt: they are the same, since
 * frames do not depend on when their phonemes were pushed.
 */
#include "board.h"
#include "labial/labial.h"
#include "speech_en.h"

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
#define SYST_CSR REGISTER(0xe000e010u) /* bit 0 enables, bit 1 interrupts, bit 2 takes the processor's clock */
#define SYST_RVR REGISTER(0xe000e014u)
#define SYST_CVR REGISTER(0xe000e018u)

#ifndef PERIOD
#define PERIOD 320000u /* clock ticks: 20 ms at 16 MHz */
#endif
#ifndef PHONEMES
#define PHONEMES 60u
#endif

/* How long a stream may take, in ticks for each phoneme: it starves while the main program has no phoneme for it. */
#define PATIENCE 8u

static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static uint32_t frames, sum; /* of the frames that were delivered */

/* The interrupt's, which the main program reads. */
static volatile int result;
static volatile uint32_t ticks;

#if LABIAL_LOCKS > 0

static uint32_t was_masked;

void labial_lock(const labial_t *locked)
{
    uint32_t primask;
    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(primask) : : "memory");
    was_masked = primask;
    (void)locked;
}

void labial_unlock(const labial_t *locked)
{
    __asm__ volatile("msr primask, %0" : : "r"(was_masked) : "memory");
    (void)locked;
}

#endif

/* Shows a frame: here its numbers are summed up, each with a weight of its own. */
static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    unsigned k;
    (void)user;
    (void)frame;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        sum = sum * 31u + (uint16_t)faps[k];
    frames++;
}

static void start_timer(void)
{
    SYST_CSR = 0;
    SYST_RVR = PERIOD - 1u;
    SYST_CVR = 0;
    SYST_CSR = 7u;
}

/* SysTick_Handler() with other start-up code. */
void board_interrupt(unsigned number)
{
    (void)number; /* no other one is enabled */
    ticks++;
    result = labial_tick(&stream);
    if (result == LABIAL_DONE || result < 0 || ticks > PHONEMES * PATIENCE)
        SYST_CSR = 0;
}

/* Phoneme `i` of what is said, which lasts a frame, and how long after the one before it comes: each time differently,
 * and so long that the queue is rarely full. Otherwise pushes would follow right after ticks, and no interrupt would
 * ever fall into one. */
static unsigned phoneme_at(uint32_t i)
{
    return (unsigned)(i * 7u % speech_en.phoneme_count);
}

static void wait_for_phoneme(uint32_t i)
{
    volatile uint32_t turns = (i * 2654435761u >> 16) % (PERIOD / 4u);
    while (turns > 0)
        turns = turns - 1u;
}

static int begin(void)
{
    int initialised;
    frames = sum = 0;
    initialised = labial_init(&stream, &speech_en, workspace, sizeof workspace, on_frame, 0);
    return initialised == LABIAL_OK ? labial_exact(&stream, 1) : initialised; /* whether it starves is chance */
}

/* Says everything without an interrupt. */
static int say_alone(void)
{
    uint32_t i = 0;
    int done = begin();
    while (done >= 0 && done != LABIAL_DONE) {
        for (; i < PHONEMES && labial_room(&stream) > 0; i++)
            labial_push(&stream, phoneme_at(i), 1000u / SPEECH_EN_FPS);
        if (i == PHONEMES)
            labial_end(&stream);
        done = labial_tick(&stream);
    }
    return done;
}

/* Says everything while the interrupt ticks. */
static int say(void)
{
    uint32_t i;
    result = begin();
    if (result < 0)
        return result;
    start_timer();
    for (i = 0; i < PHONEMES; i++) {
        wait_for_phoneme(i);
        while (labial_room(&stream) == 0 && (SYST_CSR & 1u)) { /* a program with more to do would do it here */
        }
        labial_push(&stream, phoneme_at(i), 1000u / SPEECH_EN_FPS);
    }
    labial_end(&stream);
    while (SYST_CSR & 1u) {
    }
    return result;
}

int main(void)
{
    uint32_t frames_alone, sum_alone;
    if (say_alone() != LABIAL_DONE)
        return 1;
    frames_alone = frames;
    sum_alone = sum;
    if (say() != LABIAL_DONE || frames < frames_alone) {
        board_print("The calls ran into each other: frames are missing.\n");
        return 1;
    }
    if (frames > frames_alone || sum != sum_alone) {
        board_print("The calls ran into each other: frames ");
        board_print(frames > frames_alone ? "are too many.\n" : "differ.\n");
        return 1;
    }
    board_print_unsigned(frames);
    board_print(" frames, the same as without an interrupt.\n");
    return 0;
}
