/*
 * arkit.c - ARKit blendshapes of a sentence and a laugh as CSV, weights from 0 to 1 (examples/faces/arkit.h).
 *
 *     labial-rig-arkit > blendshapes.csv
 */
#include <stdio.h>

#include "arkit.h"
#include "script.h"

static const char *const names[] = ARKIT_OUTPUT_NAMES;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    int32_t *thousandths = (int32_t *)user;
    labial_rig_apply(&arkit, faps, thousandths);
    printf("%u.%02u", (unsigned)frame / 50u, (unsigned)frame % 50u * 2u); /* the models' 50 frames per second */
    for (unsigned i = 0; i < ARKIT_OUTPUTS; i++)
        printf(",%d.%03d", (int)thousandths[i] / 1000, (int)thousandths[i] % 1000);
    putchar('\n');
}

int main(void)
{
    static script_t script;
    int32_t thousandths[ARKIT_OUTPUTS];
    printf("time");
    for (unsigned i = 0; i < ARKIT_OUTPUTS; i++)
        printf(",%s", names[i]);
    putchar('\n');
    labial_rig_rest(&arkit, thousandths);
    int result = script_begin(&script, on_frame, thousandths);
    while (result >= 0 && result != LABIAL_DONE)
        result = script_tick(&script);
    return result < 0;
}
