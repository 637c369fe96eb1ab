/*
 * servos.c - pulses by TIMER1. Its compare register 0 ends the period, register 1 holds the next edge.
 */
#include "servos.h"

#include "board.h"
#include "nrf51.h"

#define FIRST_PULSE 100u
#define SLOT 3000u /* microseconds from one servo's pulse to the next one's */

static const uint8_t pins[SERVOS_COUNT] = { MICROBIT_P0, MICROBIT_P1, MICROBIT_P2 };

/*
 * The queue needs no lock: each counter has one writer and is read and written as a whole. They count all faces that
 * were pushed (by the main program), whose period has begun and has ended (by the handler), and that were passed on (by
 * the main program); each is at most as large as the one before.
 */
static volatile servos_face_t queue[SERVOS_QUEUE];
static volatile uint32_t pushed, begun, ended, passed;
static volatile uint32_t playing, ending, attached;

/* Written only by the handler. */
static volatile uint32_t periods, interrupts, late;
static uint16_t lengths[SERVOS_COUNT]; /* of this period's pulses */
static unsigned edge;                  /* next one: 2 n begins servo n's pulse, 2 n + 1 ends it */
static uint32_t risen;                 /* when the present pulse began */

static uint16_t limited(int32_t length)
{
    return (uint16_t)((uint32_t)length < SERVOS_PULSE_MAX ? (uint32_t)length : SERVOS_PULSE_MAX);
}

/* TIMER0's count; register 0 is the main program's, 1 the handler's. */
static uint32_t clock_by(unsigned channel)
{
    TIMER_CAPTURE(TIMER0, channel) = 1;
    return TIMER_CC(TIMER0, channel);
}

static void begin_period(void)
{
    periods++;
    ended = begun;
    if (playing && begun != pushed) {
        for (unsigned servo = 0; servo < SERVOS_COUNT; servo++)
            lengths[servo] = queue[begun % SERVOS_QUEUE].lengths[servo];
        begun++;
    } else if (ending) {
        playing = 0;
    } else if (playing) {
        late++;
    }
    edge = 0;
    TIMER_CC(TIMER1, 1) = FIRST_PULSE;
}

static void make_edge(void)
{
    const unsigned servo = edge / 2u;
    const uint32_t pin = 1u << pins[servo], begin = FIRST_PULSE + SLOT * servo;
    if (edge % 2u == 0) {
        if (servo < attached)
            GPIO_OUTSET = pin;
        risen = clock_by(1);
        TIMER_CC(TIMER1, 1) = begin + lengths[servo];
    } else {
        const uint32_t was_high = GPIO_OUT & pin;
        GPIO_OUTCLR = pin;
        if (begun != ended)
            queue[ended % SERVOS_QUEUE].measured[servo] = (uint16_t)(was_high ? clock_by(1) - risen : 0u);
        if (servo + 1u < SERVOS_COUNT)
            TIMER_CC(TIMER1, 1) = begin + SLOT;
    }
    edge++;
}

void board_interrupt(unsigned number)
{
    if (number != TIMER1_INTERRUPT)
        return;
    interrupts++;
    if (TIMER_COMPARE(TIMER1, 1)) {
        TIMER_COMPARE(TIMER1, 1) = 0;
        if (edge < 2u * SERVOS_COUNT)
            make_edge();
    }
    if (TIMER_COMPARE(TIMER1, 0)) {
        TIMER_COMPARE(TIMER1, 0) = 0;
        begin_period();
    }
    /* Reads after the writes, so that the events are cleared before the handler returns; else it would be called
     * again. */
    (void)TIMER_COMPARE(TIMER1, 0);
}

void servos_start(const int32_t rest[SERVOS_COUNT])
{
    CLOCK_HFCLKSTART = 1;
    while (!CLOCK_HFCLKSTARTED) {
    }
    for (unsigned servo = 0; servo < SERVOS_COUNT; servo++) {
        lengths[servo] = limited(rest[servo]);
        GPIO_OUTCLR = 1u << pins[servo];
        GPIO_DIRSET = 1u << pins[servo];
    }

    TIMER_BITMODE(TIMER0) = TIMER_BITMODE_32;
    TIMER_PRESCALER(TIMER0) = TIMER_PRESCALER_MICROSECONDS;
    TIMER_CLEAR(TIMER0) = 1;
    TIMER_START(TIMER0) = 1;

    TIMER_BITMODE(TIMER1) = TIMER_BITMODE_16;
    TIMER_PRESCALER(TIMER1) = TIMER_PRESCALER_MICROSECONDS;
    TIMER_CC(TIMER1, 0) = SERVOS_PERIOD;
    TIMER_CC(TIMER1, 1) = FIRST_PULSE;
    TIMER_SHORTS(TIMER1) = 1u;
    TIMER_INTENSET(TIMER1) = 3u << 16;
    TIMER_CLEAR(TIMER1) = 1;
    NVIC_ISER = 1u << TIMER1_INTERRUPT;
    TIMER_START(TIMER1) = 1;
}

void servos_attach(unsigned count)
{
    attached = count;
}

unsigned servos_room(void)
{
    return SERVOS_QUEUE - (pushed - passed);
}

void servos_push(const int32_t face[SERVOS_COUNT])
{
    for (unsigned servo = 0; servo < SERVOS_COUNT; servo++)
        queue[pushed % SERVOS_QUEUE].lengths[servo] = limited(face[servo]);
    pushed++;
}

void servos_play(void)
{
    ending = 0;
    playing = 1;
}

void servos_end(void)
{
    ending = 1;
}

int servos_shown(servos_face_t *face)
{
    if (passed == ended)
        return 0;
    *face = queue[passed % SERVOS_QUEUE];
    passed++;
    return 1;
}

void servos_wait(void)
{
    __asm__ volatile("wfi" ::: "memory");
}

uint32_t servos_clock(void)
{
    return clock_by(0);
}

servos_counts_t servos_counts(void)
{
    return (servos_counts_t){ periods, interrupts, late };
}
