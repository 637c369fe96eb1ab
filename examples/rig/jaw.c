/*
 * jaw.c - one servo: the whole rig is one line. Prints the pulse of every frame in microseconds.
 *
 *     labial-rig-jaw
 */
#include <stdio.h>

#include "labial/rig.h"
#include "script.h"

static const labial_rig_output_t jaw = LABIAL_RIG_JAW(1400, 1900); /* microseconds: lips closed, mouth wide open */
static const labial_rig_t rig = { &jaw, 1 };

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    int32_t *pulse = (int32_t *)user;
    labial_rig_apply(&rig, faps, pulse);
    printf("%u,%d\n", (unsigned)frame, (int)*pulse); /* here a program sets its PWM */
}

int main(void)
{
    static script_t script;
    int32_t pulse;
    labial_rig_rest(&rig, &pulse);
    int result = script_begin(&script, on_frame, &pulse);
    while (result >= 0 && result != LABIAL_DONE)
        result = script_tick(&script); /* and waits for the next 20 ms */
    return result < 0;
}
