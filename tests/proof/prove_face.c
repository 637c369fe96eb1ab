/* Any rig of several outputs, any frames, values and times, any calls in any order. The face looks ahead by none, few or
 * most frames: which is known to the prover, as is the size of its memory. The steps of an output (rig.c) have a proof of
 * their own; what stands for them here reads what they may read, and returns anything. */
#include "labial/face.h"

#include "any_fade.h"
#include "rig_parts.h"

#define OUTPUTS 3
#define ROOM (LABIAL_FACE_SIZE(OUTPUTS, LABIAL_FACE_AHEAD_MAX) / 4)

static labial_rig_output_t outputs[OUTPUTS];
static labial_face_t face;
static int32_t values[OUTPUTS], memory[ROOM];
static int16_t faps[LABIAL_CHANNELS];
static uint8_t shares[LABIAL_VISEMES];

static int32_t read_output(const labial_rig_output_t *output)
{
    return output->gain == any_int32 && output->contact ? any_int32 : output->closed;
}

int32_t labial_rig_limited(const labial_rig_output_t *output, int32_t value)
{
    return any_int ? value : read_output(output);
}

int32_t labial_rig_resting(const labial_rig_output_t *output)
{
    return read_output(output);
}

int32_t labial_rig_target(const labial_rig_output_t *output, const int16_t frame[LABIAL_CHANNELS],
                          const uint8_t *shares)
{
    return frame[any_unsigned % LABIAL_CHANNELS] > 0 || (shares && shares[any_unsigned % LABIAL_VISEMES] > 0)
               ? any_int32
               : read_output(output);
}

int32_t labial_rig_step(const labial_rig_output_t *output, labial_sight_t *sight, uint32_t touch, int32_t last,
                        int32_t change)
{
    static char sights[LABIAL_RIG_SIGHT];
    sights[sight->count - 1u] = 1; /* 1 .. LABIAL_RIG_SIGHT */
    if (touch != LABIAL_RIG_NEVER && last == change)
        return sight->wanted[any_unsigned % LABIAL_RIG_SIGHT];
    return any_int ? any_int32 : read_output(output);
}

static void call_anything(void)
{
    labial_face_t *const any = OR_NULL(labial_face_t *, &face);
    FILL(values);
    FILL(faps);
    FILL(shares);
    switch (any_int) {
    case 0:
        labial_face_frame(any, any_uint32, OR_NULL(const int16_t *, faps));
        break;
    case 9:
        labial_face_visemes(any, OR_NULL(const int16_t *, faps), OR_NULL(const uint8_t *, shares));
        break;
    case 1:
        labial_face_values(any, OR_NULL(const int32_t *, values));
        break;
    case 2:
        labial_face_due(any, any_uint32);
        break;
    case 8:
        labial_face_play(any);
        break;
    case 7:
        labial_face_skip(any, any_unsigned);
        break;
    case 3:
        labial_face_cancel(any, any_uint32);
        break;
    case 4:
        labial_face_soft_start(any, any_unsigned);
        break;
    case 5:
        labial_face_attached(any);
        break;
    case 6:
        labial_face_place(any, OR_NULL(const int32_t *, values));
        break;
    default:
        labial_face_tick(any, OR_NULL(int32_t *, values));
    }
}

static void begin(unsigned ahead)
{
    static labial_rig_t rig;
    rig.outputs = outputs;
    rig.count = (uint16_t)(1u + any_uint16 % OUTPUTS);
    labial_face_init(&face, &rig, 1u + any_uint16 % 1000u, ahead, memory, LABIAL_FACE_SIZE(OUTPUTS, ahead));
    /* Frames that wait, and where the first one lies, are bounded by these and by nothing that the prover knows. */
    /*@ loop widen_hints "all", 0, 1, 5, 6, 7, 999, 1000, 1001; */
    while (any_int)
        call_anything();
}

/* What is refused, and calls after that. */
static void refuse(void)
{
    labial_rig_t rig;
    rig.outputs = OR_NULL(const labial_rig_output_t *, outputs);
    rig.count = 0;
    labial_face_init(OR_NULL(labial_face_t *, &face), OR_NULL(const labial_rig_t *, &rig), any_unsigned, any_unsigned,
                     OR_NULL(int32_t *, memory), any_size);
    rig.count = OUTPUTS;
    rig.outputs = outputs;
    labial_face_init(&face, &rig, 0, any_unsigned, memory, any_size);
    labial_face_init(&face, &rig, 50, LABIAL_FACE_AHEAD_MAX + 1u, memory, any_size);
    labial_face_init(&face, &rig, 50, 5, memory, LABIAL_FACE_SIZE(OUTPUTS, 5) - 1u);
    call_anything();
}

int main(void)
{
    for (unsigned i = 0; i < OUTPUTS; i++)
        Frama_C_make_unknown((char *)&outputs[i], offsetof(labial_rig_output_t, curve));
    refuse();
    begin(0);
    begin(5);
    begin(LABIAL_FACE_AHEAD_MAX);
    return 0;
}
