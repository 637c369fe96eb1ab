/* Any table, checked or not, of several outputs; any FAPs and values. A pointer among the numbers of 65,535 outputs would
 * be one of them to the prover, so they are few, and filled without their pointers. */
#include "labial/rig.h"

#include "prove.h"
#include "rig_parts.h"

#define OUTPUTS 3
#define FRAMES 65535

static labial_rig_output_t outputs[OUTPUTS];
static labial_rig_curve_t curve;
static int32_t values[OUTPUTS], changes[OUTPUTS];
static int16_t visemes[LABIAL_VISEMES];
static int16_t frames[FRAMES * LABIAL_CHANNELS];
static uint8_t sounds[FRAMES * LABIAL_VISEMES];

int main(void)
{
    labial_rig_t rig;
    labial_rig_delay_t delay;
    labial_sight_t sight;
    int16_t faps[LABIAL_CHANNELS];
    uint8_t shares[LABIAL_VISEMES];
    FILL(curve);
    FILL(visemes);
    FILL(shares);
    for (unsigned i = 0; i < OUTPUTS; i++) {
        Frama_C_make_unknown((char *)&outputs[i], offsetof(labial_rig_output_t, curve));
        outputs[i].curve = OR_NULL(const labial_rig_curve_t *, &curve);
        outputs[i].visemes = OR_NULL(const int16_t *, visemes);
    }
    FILL(values);
    FILL(changes);
    FILL(faps);
    FILL(frames);
    FILL(sounds);
    rig.outputs = OR_NULL(const labial_rig_output_t *, outputs);
    rig.count = (uint16_t)(any_uint16 % (OUTPUTS + 1u));
    labial_rig_check(OR_NULL(const labial_rig_t *, &rig));
    labial_rig_rest(OR_NULL(const labial_rig_t *, &rig), OR_NULL(int32_t *, values));
    labial_rig_apply(OR_NULL(const labial_rig_t *, &rig), OR_NULL(const int16_t *, faps), OR_NULL(int32_t *, values));
    labial_rig_apply_visemes(OR_NULL(const labial_rig_t *, &rig), OR_NULL(const int16_t *, faps),
                             OR_NULL(const uint8_t *, shares), OR_NULL(int32_t *, values));
    labial_rig_apply_ahead(OR_NULL(const labial_rig_t *, &rig), OR_NULL(const int16_t *, frames), any_uint16,
                           OR_NULL(int32_t *, values), OR_NULL(int32_t *, changes));
    labial_rig_apply_visemes_ahead(OR_NULL(const labial_rig_t *, &rig), OR_NULL(const int16_t *, frames),
                                   OR_NULL(const uint8_t *, sounds), any_uint16, OR_NULL(int32_t *, values),
                                   OR_NULL(int32_t *, changes));
    FILL(sight.wanted);
    sight.count = 1u + any_unsigned % LABIAL_RIG_SIGHT;
    labial_rig_step(&outputs[any_unsigned % OUTPUTS], &sight, any_uint32, any_int32, any_int32);
    delay.frames = OR_NULL(int16_t *, frames);
    delay.ahead = (uint16_t)(any_uint16 & 0x7fffu); /* all that `frames` have room for */
    delay.held = any_uint16;
    labial_rig_delayed(OR_NULL(const labial_rig_t *, &rig), OR_NULL(labial_rig_delay_t *, &delay),
                       OR_NULL(const int16_t *, faps), OR_NULL(int32_t *, values), OR_NULL(int32_t *, changes));
    return 0;
}
