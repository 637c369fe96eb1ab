/*
 * Any calls with any arguments, on a stream in any state that calls leave behind; any workspace, samples in blocks of up to
 * four. fade.c and the other files of hearing are not part of it; their stand-ins give any of their results, and touch the
 * ends of what those read and write.
 */
#include "hear_parts.h"
#include "labial/hear.h"

#include "any_fade.h"

static labial_hear_t hear;
static labial_hear_model_t model;
static uint32_t workspace[8];
static int32_t touched;

int labial_hear_convert_init(labial_hear_convert_t *convert, uint32_t samples_per_second)
{
    convert->reach = (uint8_t)(any_int ? Frama_C_interval(6, 16) : 0);
    convert->spacing = (uint8_t)Frama_C_interval(16, 48);
    convert->step = (uint16_t)Frama_C_interval(240, 480);
    labial_hear_convert_reset(convert);
    return any_int ? LABIAL_OK : LABIAL_ERROR_SAMPLE_RATE;
}

void labial_hear_convert_reset(labial_hear_convert_t *convert)
{
    convert->phase = any_uint16;
    convert->at = LABIAL_HEAR_TAPS_;
}

unsigned labial_hear_convert(labial_hear_convert_t *convert, int32_t sample, int16_t out[LABIAL_HEAR_CONVERTED_MAX])
{
    /*@ assert -32768 <= sample <= 32767; */
    convert->past[0] = (int16_t)sample;
    convert->past[2 * LABIAL_HEAR_TAPS_ - 1] = (int16_t)sample;
    convert->at = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_TAPS_ - 1);
    out[0] = any_int16;
    out[LABIAL_HEAR_CONVERTED_MAX - 1] = any_int16;
    return (unsigned)Frama_C_interval(0, LABIAL_HEAR_CONVERTED_MAX);
}

void labial_hear_features_reset(labial_hear_features_t *features)
{
    features->hop = 0;
    features->filled = 0;
}

size_t labial_hear_features_fill(labial_hear_features_t *features, const int16_t *samples, size_t count)
{
    const size_t taken = (size_t)Frama_C_interval(0, LABIAL_HEAR_HOP_);
    features->window[LABIAL_HEAR_WINDOW_ - 2] = *samples;
    features->filled = (uint16_t)Frama_C_interval(LABIAL_HEAR_SHARED, LABIAL_HEAR_WINDOW_ - 1);
    return taken < count ? taken : count;
}

int labial_hear_features_take(labial_hear_features_t *features, int16_t sample)
{
    features->window[0] = features->window[LABIAL_HEAR_WINDOW_ - 1] = sample;
    features->hop = (uint8_t)Frama_C_interval(0, 1);
    features->loud = (uint8_t)Frama_C_interval(0, 1);
    features->filled = (uint16_t)Frama_C_interval(LABIAL_HEAR_SHARED, LABIAL_HEAR_WINDOW_ - 1);
    return any_int;
}

uint32_t labial_hear_workspace_size(const labial_hear_model_t *any)
{
    return any ? LABIAL_HEAR_WORKSPACE_SIZE((uint32_t)any->units, any->rows) : 0;
}

void labial_hear_network_reset(labial_hear_network_t *network)
{
    network->rows[0] = 0;
    network->taken = 0;
}

const int16_t *labial_hear_network(labial_hear_network_t *network, const int16_t features[LABIAL_HEAR_INPUTS],
                                   int16_t scratch[LABIAL_HEAR_SCRATCH])
{
    touched = features[0] + features[LABIAL_HEAR_INPUTS - 1] + network->rows[0];
    Frama_C_make_unknown((char *)scratch, LABIAL_HEAR_SCRATCH * sizeof *scratch);
    return OR_NULL(const int16_t *, scratch);
}

void labial_hear_motion_reset(labial_hear_motion_t *motion)
{
    motion->held = 0;
    motion->articulation.present = motion->articulation.wanted;
}

void labial_hear_motion_hear(labial_hear_motion_t *motion, int loud)
{
    motion->loud = loud ? 1u : any_uint32;
}

int labial_hear_motion_next(labial_hear_motion_t *motion, const labial_hear_model_t *any, const int16_t *heads,
                            int16_t pose[LABIAL_CHANNELS])
{
    touched = heads[0] + heads[any->classes + LABIAL_CHANNELS - 1];
    motion->leader = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
    Frama_C_make_unknown((char *)pose, LABIAL_CHANNELS * sizeof *pose);
    return any_int;
}

int32_t labial_hear_motion_share(const labial_hear_motion_t *motion)
{
    touched = motion->rest;
    return Frama_C_interval(0, 16384);
}

/* fixed.c's, which has its own proof. */
uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    /*@ assert b > 0; */
    return a / b;
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        touched = faps[k];
    touched = user && frame;
    hear.busy = (uint8_t)Frama_C_interval(0, 1); /* it may have begun anew */
}

static void on_class(void *user, unsigned shown, uint32_t frame, uint32_t frames)
{
    touched = user && frame && frames && shown;
    hear.busy = (uint8_t)Frama_C_interval(0, 1);
}

/* Whatever calls leave behind. */
static void any_state(void)
{
    hear.channels = (uint8_t)Frama_C_interval(1, 2);
    hear.features.hop = (uint8_t)Frama_C_interval(0, 1);
    hear.features.loud = (uint8_t)Frama_C_interval(0, 1);
    hear.features.level.level =
        Frama_C_interval(LABIAL_HEAR_LEVEL_MIN / 256 * LABIAL_HEAR_LEVEL_ONE, 46 * LABIAL_HEAR_LEVEL_ONE);
    hear.features.filled = (uint16_t)Frama_C_interval(0, LABIAL_HEAR_WINDOW_ - 1);
    hear.convert.at = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_TAPS_);
    hear.ended = (uint8_t)Frama_C_interval(0, 1);
    hear.busy = (uint8_t)Frama_C_interval(0, 1);
    hear.exact = (uint8_t)Frama_C_interval(0, 1);
    hear.fade.step = any_uint16;
    hear.fade.length = any_uint16;
    hear.shown = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
    hear.earlier = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
    hear.told = (uint8_t)Frama_C_interval(0, 2);
    hear.motion.leader = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
    hear.motion.held = (uint8_t)Frama_C_interval(0, 1);
    hear.motion.articulation.wanted = (uint8_t)Frama_C_interval(0, LABIAL_ARTICULATION_MAX);
    hear.sounding = any_uint32;
    hear.frame = any_uint32;
    hear.first = any_uint32;
    hear.class_callback = OR_NULL(labial_hear_class_fn, on_class);
    FILL(hear.fade.pose);
    FILL(hear.convert.past);
    FILL(hear.features.bands);
    FILL(hear.features.tail);
    FILL(hear.features.window);
}

/* Null pointers, streams without a model. */
static void misuse(void)
{
    labial_hear_latency(&hear);
    labial_hear_workspace_size(OR_NULL(const labial_hear_model_t *, &model));
    labial_hear_init(OR_NULL(labial_hear_t *, &hear), OR_NULL(const labial_hear_model_t *, &model), any_uint32,
                     any_unsigned, OR_NULL(void *, workspace), any_size, OR_NULL(labial_frame_fn, on_frame), &touched);
    labial_hear_classes(NULL, on_class);
    labial_hear_push(NULL, NULL, any_size);
    labial_hear_end(NULL);
    labial_hear_cancel(NULL, any_uint32);
    labial_hear_exact(NULL, any_int);
    labial_hear_articulation(NULL, any_unsigned);
    labial_hear_level(NULL);
    labial_hear_visemes(NULL, NULL, NULL);
    labial_hear_set_level(NULL, any_unsigned);
    labial_hear_restart(NULL);
    labial_hear_latency(NULL);
}

static int init(void)
{
    return labial_hear_init(&hear, &model, any_uint32, any_unsigned, workspace, any_size, on_frame, &touched);
}

static void use(void)
{
    static int16_t samples[8];
    static uint8_t visemes[LABIAL_HEAR_CLASSES_MAX], shares[LABIAL_VISEMES];
    FILL(samples);
    FILL(visemes);
    any_state();
    labial_hear_visemes(&hear, OR_NULL(const uint8_t *, visemes), OR_NULL(uint8_t *, shares));
    labial_hear_classes(&hear, OR_NULL(labial_hear_class_fn, on_class));
    labial_hear_latency(&hear);
    labial_hear_push(&hear, OR_NULL(const int16_t *, samples), (size_t)Frama_C_interval(0, 4));
    any_state();
    labial_hear_end(&hear);
    any_state();
    labial_hear_exact(&hear, any_int);
    labial_hear_articulation(&hear, any_unsigned);
    labial_hear_level(&hear);
    labial_hear_set_level(&hear, any_unsigned);
    labial_hear_restart(&hear);
    any_state();
    labial_hear_cancel(&hear, any_uint32);
}

int main(void)
{
    model.format = any_uint16;
    model.units = any_uint8;
    model.rows = any_uint8;
    model.ahead = any_uint8;
    model.classes = (uint8_t)Frama_C_interval(2, LABIAL_HEAR_CLASSES_MAX);
    misuse();
    if (init() == LABIAL_OK)
        use();
    return 0;
}
