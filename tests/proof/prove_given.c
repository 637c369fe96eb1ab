/*
 * prove_given.c - what a program is given: prove_NAME() is the driver of lib/NAME.c.
 */
#include <string.h>

#include "labial/beside.h"
#include "labial/blob.h"
#include "labial/rig.h"
#include "labial/visemes.h"

#include "prove.h"
#include "rig_parts.h"

/* ---- Packets ----------------------------------------------------------------------------------------------------- */

/* Any packets, sample numbers and cancels, in any order, in players of several sizes. A packet is in memory as long
 * as the longest of its outputs, since the prover does not relate its size to the count in its head. */

static uint8_t player_memory[LABIAL_BESIDE_SIZE(6u, 20u)], shown[6];
static uint8_t packet[LABIAL_BESIDE_HEAD + 6u * 256u];

static void play_packets(unsigned outputs, uint32_t size)
{
    labial_beside_t player;
    if (labial_beside_init(OR_NULL(labial_beside_t *, &player), outputs, any_uint32, OR_NULL(void *, player_memory),
                           size) != LABIAL_OK)
        return;
    while (any_int) {
        if (any_int) {
            FILL(packet);
            labial_beside_push(OR_NULL(labial_beside_t *, &player), OR_NULL(const void *, packet), any_size);
        }
        if (any_int)
            labial_beside_tick(OR_NULL(labial_beside_t *, &player), any_uint32, OR_NULL(uint8_t *, shown));
        if (any_int)
            labial_beside_limit(OR_NULL(labial_beside_t *, &player), any_unsigned, any_unsigned);
        if (any_int)
            labial_beside_restart(OR_NULL(labial_beside_t *, &player), any_uint32);
        if (any_int)
            labial_beside_cancel(OR_NULL(labial_beside_t *, &player), any_uint32);
    }
}

int prove_beside(void)
{
    static const labial_beside_t unprepared;
    labial_beside_t player = unprepared;
    labial_beside_push(&player, packet, any_size);
    labial_beside_tick(&player, any_uint32, shown);
    labial_beside_cancel(&player, any_uint32);
    labial_beside_limit(&player, any_unsigned, any_unsigned);
    labial_beside_restart(&player, any_uint32);
    labial_beside_init(&player, any_unsigned, any_uint32, player_memory, 4);
    play_packets(0, sizeof player_memory);
    play_packets(1, 6);
    play_packets(1, LABIAL_BESIDE_SIZE(1, 64));
    play_packets(3, LABIAL_BESIDE_SIZE(3, 17));
    play_packets(6, sizeof player_memory);
    labial_beside_value(any_uint8, any_int16, any_int16);
    return 0;
}

/* ---- Blobs ------------------------------------------------------------------------------------------------------- */

/* Any bytes, of any size up to more than the largest counts ask for, and of some sizes in an array that ends with
 * them. labial_model_check() is proven on its own, for tables as long as its counts ask for, as those of a blob are;
 * its stand-in here reads whatever a model is made of. */

#define ROOM 0x1000000 /* more than a model of the largest counts takes */

static uint8_t bytes[ROOM];

static int is_there(const void *table)
{
    return table != 0;
}

int labial_model_check(const labial_model_t *model)
{
    int sum = model->format + model->frames_per_second + model->component_count + model->phoneme_count +
              model->class_count + model->state_count + model->predecessor_fours + model->search_stride +
              model->silence + model->mixture_mean + model->kernel_taps + model->kernel_stride + model->kernel_behind +
              model->floor_count + model->pair_knots + model->pair_count + model->channel_count;
    sum += is_there(model->phonemes) + is_there(model->components) + is_there(model->contexts) +
           is_there(model->shapes) + is_there(model->slopes) + is_there(model->kernels) + is_there(model->pair_keys) +
           is_there(model->pairs) + is_there(model->floors) + is_there(model->contacts) + is_there(model->protrusion);
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        sum += model->sources[k];
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        const labial_channel_t *channel = &model->channels[k];
        sum += channel->centre + channel->shape_scale + channel->slope_scale + channel->kernel_scale +
               channel->pair_scale + channel->motion_scale[0] + channel->motion_scale[1] + channel->contact_weight;
        sum += is_there(channel->emissions) + is_there(channel->states) + is_there(channel->transitions) +
               is_there(channel->initials);
    }
    return any_int ? sum : any_int;
}

static void load_blob(const uint8_t *data, size_t size)
{
    labial_blob_t blob;
    memset(blob.channels, 0, sizeof blob.channels); /* EVA cannot tell that what is not damaged was written */
    labial_model_load(&blob, data, size);
}

int prove_blob(void)
{
    static const size_t sizes[] = { 0, 11, 12, 31, 32, 33, 35, 36, 600, 4096, 65536, ROOM };
    labial_blob_t blob;
    FILL(bytes);
    labial_model_load(0, bytes, sizeof bytes);
    labial_model_load(&blob, 0, sizeof bytes);
    load_blob(bytes, Frama_C_size_t_interval(0, ROOM));
    for (unsigned i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        load_blob(bytes + ROOM - sizes[i], sizes[i]);
    return 0;
}

/* ---- Rigs -------------------------------------------------------------------------------------------------------- */

/* Any table, checked or not, of several outputs; any FAPs and values. A pointer among the numbers of 65,535 outputs
 * would be one of them to the prover, so they are few, and filled without their pointers. */

#define OUTPUTS 3
#define FRAMES 65535

static labial_rig_output_t outputs[OUTPUTS];
static labial_rig_curve_t curve;
static int32_t values[OUTPUTS], changes[OUTPUTS];
static int16_t wanted_visemes[LABIAL_VISEMES];
static int16_t frames[FRAMES * LABIAL_CHANNELS];
static uint8_t sounds[FRAMES * LABIAL_VISEMES];

int prove_rig(void)
{
    labial_rig_t rig;
    labial_sight_t sight;
    int16_t faps[LABIAL_CHANNELS];
    uint8_t shares[LABIAL_VISEMES];
    FILL(curve);
    FILL(wanted_visemes);
    FILL(shares);
    for (unsigned i = 0; i < OUTPUTS; i++) {
        Frama_C_make_unknown((char *)&outputs[i], offsetof(labial_rig_output_t, curve));
        outputs[i].curve = OR_NULL(const labial_rig_curve_t *, &curve);
        outputs[i].visemes = OR_NULL(const int16_t *, wanted_visemes);
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
    return 0;
}

/* ---- Visemes ----------------------------------------------------------------------------------------------------- */

/* Any stream whose input is as units.c and channels.c keep it, which prove_units() shows: no more frames in the
 * queue than are pending; any labels, and any shares for the tongue. */

static labial_t stream;
static labial_model_t model;
static uint8_t visemes[LABIAL_PHONEMES_MAX];

int prove_visemes(void)
{
    uint8_t shares[LABIAL_VISEMES];
    int16_t tongue[LABIAL_TONGUE_FAPS];
    Frama_C_make_unknown((char *)&stream, sizeof stream);
    Frama_C_make_unknown((char *)&model, sizeof model);
    FILL(visemes);
    for (unsigned i = 0; i < LABIAL_MODELS; i++)
        stream.models[i] = OR_NULL(const labial_model_t *, &model);
    for (unsigned i = 0; i < sizeof stream.channels.slots; i++)
        stream.channels.slots[i] = (uint8_t)(any_uint8 % LABIAL_MODELS);
    model.frames_per_second = (uint16_t)(1u + any_uint16 % 250u);
    model.phoneme_count = (uint8_t)(1u + any_uint8 % LABIAL_PHONEMES_MAX);
    labial_visemes(OR_NULL(const labial_t *, &stream), OR_NULL(const labial_model_t *, &model),
                   OR_NULL(const uint8_t *, visemes), OR_NULL(uint8_t *, shares));
    FILL(shares);
    labial_tongue(OR_NULL(const uint8_t *, shares), OR_NULL(int16_t *, tongue));
    return 0;
}
