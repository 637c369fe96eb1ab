/*
 * The frames of a voice in any state: at any frame, with any segments noted, after any changes. The stream and the other
 * files of voices are not part of it; their stand-ins give any of their results, and touch the ends of what those read and
 * write.
 */
#include "voice_parts.h"

#include "prove.h"

#define WORKSPACE 64u

static labial_voice_t voice;
static labial_model_t model;
static uint32_t memory[WORKSPACE / 4u];

int labial_init(labial_t *stream, const labial_model_t *any, void *workspace, size_t size, labial_frame_fn callback,
                void *user)
{
    ((char *)workspace)[size - 1u] = (char)any->channel_count;
    stream->callback = callback;
    stream->user = user;
    return any_int;
}

int labial_exact(labial_t *stream, int exact)
{
    stream->exact = (uint8_t)exact;
    return any_int;
}

int labial_tick(labial_t *stream)
{
    int16_t faps[LABIAL_CHANNELS];
    FILL(faps);
    if (stream->callback && any_int)
        stream->callback(stream->user, any_uint32, faps);
    return any_int;
}

unsigned labial_fade_closing(const labial_t *stream, unsigned age, unsigned length, int opening)
{
    /*@ assert age < LABIAL_DELAY(LABIAL_SEARCH_STRIDE_MAX) && opening >= -65536; */
    return stream->held ? length : (unsigned)Frama_C_interval(1, (int)length);
}

int labial_push(labial_t *stream, unsigned phoneme, uint32_t milliseconds)
{
    /*@ assert milliseconds <= 3600000; */
    stream->held = (uint8_t)phoneme;
    return any_int;
}

const uint8_t labial_arpabet_visemes[LABIAL_ARPABET_PHONEMES] = { 0 };

int labial_visemes(const labial_t *stream, const labial_model_t *any, const uint8_t *visemes,
                   uint8_t shares[LABIAL_VISEMES])
{
    shares[0] = (uint8_t)(stream->held + any->channel_count + visemes[LABIAL_ARPABET_PHONEMES - 1]);
    shares[LABIAL_VISEMES - 1] = any_uint8;
    return any_int;
}

static int64_t any_moment(void)
{
    return any_int ? INT64_MAX : (int64_t)any_uint32 * 8;
}

void labial_voice_plan_start(labial_voice_t *any, int64_t moment)
{
    any->plan.moment = moment;
    any->stale = 0;
}

void labial_voice_plan_next(labial_voice_t *any, labial_voice_segment_t *segment)
{
    segment->start = (int64_t)any_uint32 * 8;
    segment->end = any_moment();
    segment->phoneme = any_uint8;
    any->plan.moment = segment->end;
}

int labial_voice_plan_sounds(labial_voice_t *any)
{
    any->stale = 0;
    return any_int;
}

int64_t labial_voice_latest(labial_voice_t *any)
{
    return any->begun ? (int64_t)any_uint32 * 8 : -1;
}

unsigned labial_fade_frames(uint32_t milliseconds, uint32_t frames_per_second)
{
    return milliseconds < frames_per_second ? 1u : (unsigned)Frama_C_interval(1, LABIAL_CANCEL_MAX);
}

void labial_voice_forget(labial_voice_t *any, int64_t moment)
{
    any->stale = moment > 0 || any_int;
}

static void any_state(void)
{
    unsigned k;
    model.frames_per_second = (uint16_t)Frama_C_interval(1, 250);
    model.search_stride = (uint8_t)Frama_C_interval(1, LABIAL_SEARCH_STRIDE_MAX);
    model.channel_count = any_uint8;
    voice.model = &model;
    voice.workspace = memory;
    voice.workspace_size = WORKSPACE;
    voice.next = any_uint32;
    voice.step = (uint32_t)Frama_C_interval(0, LABIAL_CANCEL_MAX);
    voice.steps = (uint32_t)Frama_C_interval(0, LABIAL_CANCEL_MAX);
    voice.closing = (uint32_t)Frama_C_interval(0, LABIAL_CANCEL_MAX);
    voice.left = (uint64_t)any_uint32 << 32 | any_uint32;
    voice.tail = any_moment();
    voice.from = (int64_t)any_uint32 * 8;
    FILL(voice.given);
    FILL(voice.phonemes);
    voice.given_first = (uint8_t)Frama_C_interval(0, LABIAL_VOICE_GIVEN_ - 1);
    voice.given_count = (uint8_t)Frama_C_interval(0, LABIAL_VOICE_GIVEN_);
    voice.changed = any_uint8;
    voice.stale = any_uint8;
    voice.streaming = any_uint8;
    voice.begun = any_uint8;
    voice.finished = any_uint8;
    voice.still = any_uint8;
    voice.eased = any_uint8;
    voice.offset = any_int32;
    FILL(voice.shown);
    FILL(voice.made);
    for (k = 0; k < LABIAL_CHANNELS; k++)
        voice.fade[k] = (int32_t)Frama_C_interval(-65535, 65535);
}

int main(void)
{
    int16_t faps[LABIAL_CHANNELS];
    uint8_t shares[LABIAL_VISEMES];
    uint32_t frame;
    static labial_voice_t unprepared;
    labial_voice_next(&unprepared, any_uint32, &frame, faps);
    any_state();
    labial_voice_next(OR_NULL(labial_voice_t *, &voice), (uint64_t)any_uint32 << 32 | any_uint32,
                      OR_NULL(uint32_t *, &frame), OR_NULL(int16_t *, faps));
    labial_voice_ease(&unprepared, faps);
    any_state();
    labial_voice_ease(OR_NULL(labial_voice_t *, &voice), OR_NULL(int16_t *, faps));
    any_state();
    labial_voice_begin_fade(&voice, any_uint32);
    any_state();
    model.phoneme_count = any_uint8;
    FILL(shares);
    labial_voice_visemes(&unprepared, shares);
    labial_voice_visemes(OR_NULL(labial_voice_t *, &voice), OR_NULL(uint8_t *, shares));
    return 0;
}
