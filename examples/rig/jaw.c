/*
 * jaw.c - one servo: the whole rig is one line. Prints the pulse of every period of 20 ms in microseconds, from the
 * first frame on until the servo is at rest.
 *
 *     labial-rig-jaw
 */
#include <stdio.h>

#include "labial/face.h"
#include "script.h"

static const labial_rig_output_t jaw = LABIAL_RIG_JAW(1400, 1900); /* microseconds: lips closed, mouth wide open */
static const labial_rig_t rig = { &jaw, 1 };

int main(void)
{
    static script_t script;
    static labial_face_t face;
    static int32_t room[LABIAL_FACE_SIZE(1, 0) / 4];
    int32_t pulse;
    int moves = labial_face_init(&face, &rig, 50, 0, room, sizeof room);
    int result = script_begin(&script, labial_face_frame, &face);
    for (unsigned period = 0; result >= 0 && moves >= 0 && (result != LABIAL_DONE || moves != LABIAL_DONE);) {
        if (result != LABIAL_DONE)
            result = script_tick(&script); /* and waits for the next 20 ms */
        if (result == LABIAL_WAITING)
            continue; /* a program with sound begins that here */
        moves = labial_face_tick(&face, &pulse);
        printf("%u,%d\n", period++, (int)pulse); /* here a program sets its PWM */
    }
    return result < 0 || moves < 0;
}
