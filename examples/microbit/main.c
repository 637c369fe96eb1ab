/*
 * main.c - a face on a micro:bit: says a sentence and laughs, again whenever button A is pressed.
 *
 * All computing is done here, in the main program, ahead of time: faces go into a queue, from which the timer's
 * interrupt shows one every 20 ms (servos.c).
 */
#include "face.h"
#include "labial/labial.h"
#include "nrf51.h"
#include "script.h"
#include "servos.h"
#include "trace.h"

typedef char one_servo_per_output[FACE_OUTPUTS == SERVOS_COUNT ? 1 : -1];

static script_t script;
static int32_t pulses[FACE_OUTPUTS];

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    labial_rig_apply(&face, faps, pulses);
    servos_push(pulses); /* a tick has one frame at most, and there was room before it */
}

/* Takes shown faces out of the queue. */
static void tidy(void)
{
    servos_face_t shown;
    while (servos_shown(&shown))
        trace_face(&shown);
}

static int speak(void)
{
    int result = script_begin(&script, on_frame, 0);
    while (result >= 0 && result != LABIAL_DONE) {
        const uint32_t begin = servos_clock();
        result = script_tick(&script);
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
    return result < 0;
}

int main(void)
{
    int failed;
    labial_rig_rest(&face, pulses);
    servos_start(pulses);
    failed = speak();
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
