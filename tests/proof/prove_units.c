/* Any pushes of any models' phonemes, and frames taken, asked for or forgotten between them, in any order. */
#include "any_model.h"
#include "units.h"

int main(void)
{
    static labial_model_t model;
    static labial_units_t units; /* zero, as labial_init() makes it */
    const labial_model_t *models[LABIAL_MODELS];
    labial_taken_t taken;
    labial_spoken_t spoken;
    unsigned i;
    any_model(&model, 1);
    model.kernel_behind = 0; /* with every distance that a model may look ahead */
    model.kernel_stride = 1;
    model.kernel_taps = (uint8_t)Frama_C_interval(0, LABIAL_REACH + 1);
    for (i = 0; i < LABIAL_MODELS; i++)
        models[i] = &model;
    labial_units_reset(&units);
    while (any_int) {
        if (any_int && units.count < LABIAL_QUEUE)
            labial_units_push(&units, (unsigned)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1),
                              (unsigned)Frama_C_interval(0, LABIAL_MODELS - 1),
                              (uint32_t)Frama_C_interval(0, LABIAL_DURATION_MAX), (uint32_t)Frama_C_interval(1, 250));
        labial_units_take(&units, models, any_int, &taken);
        labial_units_left(&units, models);
        labial_units_uses(&units, (unsigned)Frama_C_interval(0, LABIAL_MODELS - 1));
        labial_units_next(&units, models, any_int, &spoken);
        if (any_int)
            labial_units_reset(&units);
    }
    return 0;
}
