/* Any table, checked or not, of as many outputs as there can be; any FAPs and values. */
#include "labial/rig.h"

#include "prove.h"

#define OUTPUTS 65535
#define FRAMES 65535

static labial_rig_output_t outputs[OUTPUTS];
static int32_t values[OUTPUTS], changes[OUTPUTS];
static int16_t frames[FRAMES * LABIAL_CHANNELS];

int main(void)
{
    labial_rig_t rig;
    int16_t faps[LABIAL_CHANNELS];
    FILL(outputs);
    FILL(values);
    FILL(changes);
    FILL(faps);
    FILL(frames);
    rig.outputs = OR_NULL(const labial_rig_output_t *, outputs);
    rig.count = any_uint16;
    labial_rig_check(OR_NULL(const labial_rig_t *, &rig));
    labial_rig_rest(OR_NULL(const labial_rig_t *, &rig), OR_NULL(int32_t *, values));
    labial_rig_apply(OR_NULL(const labial_rig_t *, &rig), OR_NULL(const int16_t *, faps), OR_NULL(int32_t *, values));
    labial_rig_apply_ahead(OR_NULL(const labial_rig_t *, &rig), OR_NULL(const int16_t *, frames), any_uint16,
                           OR_NULL(int32_t *, values), OR_NULL(int32_t *, changes));
    return 0;
}
