/*
 * main.c - a jaw that moves to a recording, on an Arduino Uno (ATmega328P, 16 MHz) without Arduino's software.
 *
 * talk.h has the jaw's motion (labial bake), a DFPlayer Mini the sound. Both begin at reset, and again whenever the
 * button is pressed.
 *
 *     pin 9   servo's signal
 *     pin 1   (TX) through 1 kilohm to the DFPlayer's RX
 *     pin 2   button to ground
 *
 * Timer 1 makes the pulses by itself, in steps of half a microsecond, 50 a second: one for each frame. The program
 * waits for the end of each period and puts the next pulse's length into the compare register, from which the timer
 * takes it when the next period begins. There are no interrupts.
 */
#ifndef F_CPU
#define F_CPU 16000000ul
#endif

#include <avr/io.h>

#include "dfplayer.h"
#include "talk.h"

#define PERIOD_MS 20u
#define COUNTS_PER_US (F_CPU / 8u / 1000000u) /* of timer 1 */
#define COMMAND_MS (DFPLAYER_COMMAND_SIZE * 10ul * 1000u / DFPLAYER_BAUD + 1u)

/* The number of periods for at least so many milliseconds. */
#define PERIODS(ms) (uint16_t)(((ms) + PERIOD_MS - 1u) / PERIOD_MS)

#ifdef TALK_PARTS /* of labial bake --parts: one after the other they are the whole motion */
#define TALK_INIT(part) talk_init(&player, part)
#else
#define TALK_PARTS 1u
#define TALK_INIT(part) talk_init(&player)
#endif

static labial_player_t player;

/* The pulse of the next period, in microseconds. In fast PWM the pin is high for a count more than the register
 * says. */
static void servo_show(int32_t pulse)
{
    OCR1A = (uint16_t)((uint16_t)pulse * COUNTS_PER_US - 1u);
}

static void servo_begin(int32_t pulse)
{
    ICR1 = (uint16_t)(PERIOD_MS * 1000u * COUNTS_PER_US - 1u);
    servo_show(pulse);
    DDRB |= _BV(DDB1); /* OC1A, pin 9 */
    TCCR1A = _BV(COM1A1) | _BV(WGM11);
    TCCR1B = _BV(WGM13) | _BV(WGM12) | _BV(CS11); /* fast PWM up to ICR1, a count in 8 clocks */
}

/* Waits until a period begins, and one more for each of `more`. */
static void wait_for_period(uint16_t more)
{
    do {
        while (!(TIFR1 & _BV(TOV1))) {
        }
        TIFR1 = _BV(TOV1);
    } while (more--);
}

static void serial_begin(void)
{
    UBRR0 = (uint16_t)((F_CPU / 8u / DFPLAYER_BAUD + 1u) / 2u - 1u);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(TXEN0);
}

static void serial_write(uint8_t byte)
{
    while (!(UCSR0A & _BV(UDRE0))) {
    }
    UDR0 = byte;
}

/* Starts the sound and, when it is heard, the motion. */
static void talk(void)
{
    uint8_t command[DFPLAYER_COMMAND_SIZE], i;
    const uint8_t *frame;
    uint16_t part;
    dfplayer_play(command, 1, 1);
    wait_for_period(0);
    for (i = 0; i < sizeof command; i++)
        serial_write(command[i]);
    /* In the last of these periods the timer loads frame 0. */
    wait_for_period((uint16_t)(PERIODS(COMMAND_MS + DFPLAYER_DELAY_MS) - 2u));
    for (part = 0; part < TALK_PARTS; part++) {
        TALK_INIT(part);
        while ((frame = talk_next(&player)) != NULL) {
            servo_show(talk_jaw(frame));
            wait_for_period(0);
        }
    }
}

int main(void)
{
    TALK_INIT(0);
    servo_begin(talk_jaw(talk_next(&player)));
    PORTD |= _BV(PORTD2); /* holds pin 2 high while the button is open */
    serial_begin();
    wait_for_period(PERIODS(DFPLAYER_READY_MS));
    for (;;) {
        talk();
        while (PIND & _BV(PIND2))
            wait_for_period(0);
    }
}
