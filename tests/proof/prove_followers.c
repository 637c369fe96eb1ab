/* Any table, corners of any size, and any motion of models with a table and without, with any spacing. */
#include "any_model.h"
#include "followers.h"

static labial_model_t model;

int main(void)
{
    static int16_t motion[LABIAL_CHANNELS * LABIAL_SEARCH_STRIDE_MAX];
    int16_t frame[LABIAL_CHANNELS];
    const unsigned spacing = (unsigned)Frama_C_interval(1, LABIAL_SEARCH_STRIDE_MAX);
    any_model(&model, 1);
    FILL(motion);
    labial_followers_complete(&model, motion + Frama_C_interval(0, (int)spacing - 1), spacing, frame);
    return labial_protrusion(&protrusion, Frama_C_interval(2 * INT16_MIN, 2 * INT16_MAX)) + frame[0];
}
