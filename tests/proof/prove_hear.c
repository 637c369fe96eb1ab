/*
 * Any calls with any arguments, on a stream in any state that calls leave behind; any workspace, samples in blocks of up to
 * four. fade.c, hear_convert.c, hear_features.c and hear_network.c are not part of it; their stand-ins give any of their results,
 * and touch the ends of what those read and write.
 */
#include "hear_convert.h"
#include "hear_features.h"
#include "hear_network.h"
#include "labial/hear.h"

#include "any_fade.h"

static labial_hear_t hear;
static labial_hear_model_t model;
static uint32_t workspace[8];
static int32_t touched;

int labial_hear_convert_init(labial_hear_convert_t *convert, uint32_t rate)
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
    convert->at = 0;
    FILL(convert->past);
}

unsigned labial_hear_convert(labial_hear_convert_t *convert, int32_t sample, int16_t out[LABIAL_HEAR_CONVERTED_MAX])
{
    /*@ assert -32768 <= sample <= 32767; */
    convert->past[0] = (int16_t)sample;
    convert->past[2 * LABIAL_HEAR_TAPS_ - 1] = (int16_t)sample;
    out[0] = any_int16;
    out[LABIAL_HEAR_CONVERTED_MAX - 1] = any_int16;
    return (unsigned)Frama_C_interval(0, LABIAL_HEAR_CONVERTED_MAX);
}

void labial_hear_features(int16_t window[LABIAL_HEAR_WINDOW_], int32_t *level, int16_t features[LABIAL_HEAR_BANDS])
{
    touched = window[0] + window[LABIAL_HEAR_WINDOW_ - 1];
    Frama_C_make_unknown((char *)window, LABIAL_HEAR_WINDOW_ * sizeof *window);
    Frama_C_make_unknown((char *)features, LABIAL_HEAR_BANDS * sizeof *features);
    *level = any_int ? *level : any_int32;
}

void labial_hear_network_reset(labial_hear_t *stream)
{
    stream->rows[0] = 0;
    stream->taken = 0;
}

const int16_t *labial_hear_network(labial_hear_t *stream)
{
    touched = stream->features[0] + stream->features[LABIAL_HEAR_INPUTS - 1];
    Frama_C_make_unknown((char *)stream->window, LABIAL_HEAR_WINDOW_ * sizeof *stream->window);
    return OR_NULL(const int16_t *, stream->window);
}

unsigned labial_hear_leader(const labial_hear_model_t *any, const int16_t *heads)
{
    touched = heads[0] + heads[any->classes - 1];
    return (unsigned)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
}

void labial_hear_pose(const labial_hear_model_t *any, const int16_t *heads, int16_t pose[LABIAL_CHANNELS])
{
    touched = heads[any->classes + LABIAL_CHANNELS - 1];
    Frama_C_make_unknown((char *)pose, LABIAL_CHANNELS * sizeof *pose);
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
}

static void on_class(void *user, unsigned shown, uint32_t frame, uint32_t frames)
{
    touched = user && frame && frames && shown;
}

/* Whatever calls leave behind. */
static void any_state(void)
{
    hear.channels = (uint8_t)Frama_C_interval(1, 2);
    hear.hop = (uint8_t)Frama_C_interval(0, 1);
    hear.ended = (uint8_t)Frama_C_interval(0, 1);
    hear.busy = (uint8_t)Frama_C_interval(0, 1);
    hear.exact = (uint8_t)Frama_C_interval(0, 1);
    hear.loud = (uint8_t)Frama_C_interval(0, 1);
    hear.silent = any_uint8;
    hear.rest = (uint8_t)Frama_C_interval(0, 5);
    hear.fade.step = any_uint16;
    hear.fade.length = any_uint16;
    hear.shown = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
    hear.leader = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
    hear.held = (uint8_t)Frama_C_interval(0, 1);
    hear.filled = (uint16_t)Frama_C_interval(LABIAL_HEAR_WINDOW_ - LABIAL_HEAR_HOP_, LABIAL_HEAR_WINDOW_ - 1);
    hear.sounding = any_uint32;
    hear.frame = any_uint32;
    hear.first = any_uint32;
    hear.level = any_int32;
    hear.class_callback = OR_NULL(labial_hear_class_fn, on_class);
    FILL(hear.before);
    FILL(hear.now);
    FILL(hear.fade.pose);
    FILL(hear.features);
    FILL(hear.window);
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
    labial_hear_restart(NULL);
    labial_hear_latency(NULL);
}

static int init(void)
{
    return labial_hear_init(&hear, &model, any_uint32, any_unsigned, workspace, any_size, on_frame, &touched);
}

/* Every call, in any state. */
static void use(void)
{
    static int16_t samples[8];
    int frames;
    FILL(samples);
    any_state();
    labial_hear_classes(&hear, OR_NULL(labial_hear_class_fn, on_class));
    labial_hear_latency(&hear);
    labial_hear_push(&hear, OR_NULL(const int16_t *, samples), (size_t)Frama_C_interval(0, 4));
    any_state();
    labial_hear_end(&hear);
    any_state();
    labial_hear_exact(&hear, any_int);
    labial_hear_restart(&hear);
    /*@ loop unroll 51; */
    for (frames = 0; frames <= 50; frames++) {
        any_state();
        labial_hear_cancel(&hear, (uint32_t)Frama_C_interval(frames > 0 ? 20 * frames - 19 : 0, 20 * frames));
    }
    any_state();
    labial_hear_cancel(&hear, (uint32_t)Frama_C_interval(1000, 2000000000));
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
