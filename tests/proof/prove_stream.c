/*
 * prove_stream.c - drivers of stream.c, of one frame in and of one frame out. channels.c is proven on its own; its
 * stand-in gives any motion, and any place for a frame.
 */
#include "any_fade.h"
#include "any_model.h"
#include "channels.h"
#include "stream.c"

labial_frame_t *labial_channels_enter(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                                      unsigned slot)
{
    static labial_frame_t frame;
    /*@ assert slot < LABIAL_MODELS; */
    (void)models;
    FILL(frame);
    channels->entered = any_uint8;
    return &frame;
}

void labial_channels_run_out(labial_channels_t *channels)
{
    channels->entered = any_uint8;
    channels->beyond = any_uint8;
}

int labial_channels_due(const labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                        int16_t frame[LABIAL_CHANNELS])
{
    unsigned k;
    (void)models;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        frame[k] = any_int16;
    return channels->entered && any_int;
}

/* ---- One frame in ------------------------------------------------------------------------------------------------ */

/* stream.c, one frame in: any stride, phase, marks and number of frames that entered, with phonemes, frames and
 * ends in any order. units.c, shape.c and channels.c are proven on their own; their stand-ins here give any of their
 * results, and read and write what those do. */

static labial_model_t spoken_model;

uint32_t labial_units_left(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS])
{
    return units->count > 0 && models[any_int ? 0 : LABIAL_MODELS - 1]->phonemes ? any_uint32 : 0u;
}

int labial_units_next(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_spoken_t *spoken)
{
    if (units->count == 0)
        return 0;
    spoken->slot = (uint8_t)Frama_C_interval(0, LABIAL_MODELS - 1);
    spoken->phoneme = (uint8_t)Frama_C_interval(0, models[spoken->slot]->phoneme_count - 1);
    spoken->previous = (uint8_t)Frama_C_interval(0, models[spoken->slot]->phoneme_count - 1);
    spoken->next = (uint8_t)Frama_C_interval(0, models[spoken->slot]->phoneme_count - 1);
    spoken->ms = any_uint16;
    return ended || any_int;
}

int labial_units_take(labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_taken_t *taken)
{
    if (units->count == 0)
        return ended ? LABIAL_DONE : LABIAL_STARVED;
    if (!ended && any_int)
        return LABIAL_STARVED;
    units->count = any_uint8;
    FILL(units->labels);
    taken->labels = units->labels + LABIAL_REACH;
    taken->slot = (uint8_t)Frama_C_interval(0, LABIAL_MODELS - 1);
    taken->share = (uint16_t)Frama_C_interval(0, 16384);
    taken->is_first = (uint8_t)Frama_C_interval(0, 1);
    taken->is_open = (uint8_t)Frama_C_interval(0, 1);
    taken->rest = (uint8_t)Frama_C_interval(0, LABIAL_REST_FRAMES);
    taken->marks = models[taken->slot]->phonemes ? (uint8_t)Frama_C_interval(0, 7) : (uint8_t)0;
    return LABIAL_OK;
}

void labial_shape_select(const labial_model_t *spoken_model, const labial_spoken_t *spoken,
                         labial_selection_t *selection)
{
    labial_shape_t *shape = selection->shape;
    unsigned k;
    selection->halves++;
    /*@ assert selection->halves <= 2; */
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        shape[k].knots[0] = any_position();
        shape[k].knots[1] = any_position();
    }
    shape[0].knots[0] = spoken_model->phonemes[spoken->phoneme].floor + spoken->ms + spoken->previous + spoken->next > 0
                            ? any_position()
                            : 0;
}

unsigned labial_shape_target(const labial_model_t *spoken_model, const labial_shape_t *shape,
                             const labial_taken_t *taken, int16_t target[LABIAL_CHANNELS])
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        target[k] = shape[k].knots[0] + shape[k].knots[1] + taken->labels[0] + taken->share > 0 ? any_position() : 0;
    return spoken_model->floor_count ? any_uint16 : 0u;
}

static void advance(int stride)
{
    static labial_t stream; /* zero but for these, as labial_init() makes it */
    static labial_shape_t shapes[2][LABIAL_CHANNELS];
    unsigned i;
    stream.shape = shapes[0];
    stream.next.shape = shapes[1];
    for (i = 0; i < LABIAL_MODELS; i++)
        stream.models[i] = &spoken_model;
    stream.channels.stride = (uint8_t)stride;
    while (any_int) {
        stream.ended = (uint8_t)Frama_C_interval(0, 1);
        stream.pending = any_uint32;
        stream.units.count = any_uint8;
        stream.articulation.wanted = (uint8_t)Frama_C_interval(0, LABIAL_ARTICULATION_MAX);
        stream.articulation.present = (uint8_t)Frama_C_interval(0, LABIAL_ARTICULATION_MAX);
        if (any_int)
            select_more(&stream, Frama_C_interval(0, 1));
        stream.channels.phase = (uint8_t)Frama_C_interval(0, stride - 1);
        select_ahead(&stream);
        take_frame(&stream);
        if (any_int) { /* as when it begins anew */
            stream.channels.entered = 0;
            stream.next.halves = 0;
        }
    }
}

int prove_input(void)
{
    int stride;
    any_model(&spoken_model, 1);
    for (stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++)
        advance(stride);
    return 0;
}

/* ---- One frame out ----------------------------------------------------------------------------------------------- */

/* stream.c, one frame out: any motion due or none, at any step of a way to it or to rest, with every stride.
 * fade.c is proven on its own; its stand-in here leads anywhere. */

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    int16_t *sum = (int16_t *)user;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        *sum = (int16_t)(*sum ^ faps[k] ^ (int16_t)frame);
}

static void any_stream(labial_t *stream, int16_t *user)
{
    FILL(stream->fade.pose);
    stream->fade.step = any_uint16;
    stream->fade.length = any_uint16;
    stream->begun = (uint8_t)Frama_C_interval(0, 1);
    stream->exact = (uint8_t)Frama_C_interval(0, 1);
    stream->resting = (uint8_t)Frama_C_interval(0, 1);
    stream->held = (uint8_t)Frama_C_interval(0, LABIAL_HOLD_TICKS);
    FILL(stream->begins);
    FILL(stream->touches);
    stream->frame = any_uint32;
    stream->pending = any_uint32;
    stream->callback = on_frame;
    stream->user = user;
}

static void deliver_one(int stride)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    stream.channels.stride = (uint8_t)stride;
    stream.channels.entered = any_uint8;
    deliver(&stream);
}

static void call_back_one(void)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    call_back(&stream, (unsigned)Frama_C_interval(0, 1));
}

static void rest_one(void)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    rest(&stream);
    any_stream(&stream, &user);
    hold_or_rest(&stream);
}

int prove_output(void)
{
    for (int stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++)
        deliver_one(stride);
    rest_one();
    call_back_one();
    return 0;
}
