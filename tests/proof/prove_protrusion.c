/* Any table, corners of any size, and any motion of models with a table and without. */
#include "any_model.h"
#include "protrusion.h"

static labial_model_t model;

int main(void)
{
    int16_t motion[LABIAL_CHANNELS];
    any_model(&model, 1);
    FILL(motion);
    labial_protrusion_complete(&model, motion);
    return labial_protrusion(&protrusion, Frama_C_interval(2 * INT16_MIN, 2 * INT16_MAX));
}
