/*
 * test_hear.c - sound in, frames out (labial/hear.h): the frames of the exporter's integers for sounds of every rate, in
 * blocks of any length; their times; the end, a cancel and a restart; wrong calls.
 */
#include "suite.h"
#include "drawn.h"
#include "hear_fixture.h"
#include "hear_parts.h"
#include "hears.h"
#include "labial/hear.h"

#define HEARS COUNT_OF(hears)
#define LONGEST 60000u
#define FRAMES 1100u

static labial_hear_t hear;
static uint32_t workspace[HEAR_FIXTURE_WORKSPACE_SIZE / 4];
static int16_t samples[2 * LONGEST];

static const uint32_t rates[] = { 8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000 };

/* What the callbacks received since begin(). */
static int16_t told[FRAMES][LABIAL_CHANNELS];
static uint32_t stretches[FRAMES][3];
static unsigned frame_count, stretch_count;
static uint32_t first_frame;
static int user;

/* Visemes of the fixture's classes: one that neighbours decide, one that is none and so silence. */
static const uint8_t visemes[HEAR_FIXTURE_CLASSES] = { LABIAL_VISEME_PP, LABIAL_VISEME_AA, LABIAL_VISEME_NONE, 99,
                                                       LABIAL_VISEME_SS };
static uint8_t sounds[FRAMES][LABIAL_VISEMES]; /* of each frame */

static void on_frame(void *given, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    assert_true(given == &user);
    assert_true(frame_count < FRAMES);
    assert_int_equal(frame, first_frame + frame_count);
    (void)labial_hear_visemes(&hear, visemes, sounds[frame_count]); /* where a copy is heard, `hear` may be empty */
    memcpy(told[frame_count++], faps, sizeof told[0]);
}

static void on_class(void *given, unsigned shown, uint32_t frame, uint32_t frames)
{
    assert_true(given == &user);
    assert_true(stretch_count < FRAMES);
    stretches[stretch_count][0] = shown;
    stretches[stretch_count][1] = frame;
    stretches[stretch_count++][2] = frames;
}

static void begin(uint32_t rate, unsigned channels)
{
    frame_count = stretch_count = 0;
    first_frame = 0;
    assert_ok(labial_hear_init(&hear, &hear_fixture, rate, channels, workspace, sizeof workspace, on_frame, &user));
    assert_ok(labial_hear_classes(&hear, on_class));
}

/* A sound of hears.py, in the second channel upside down and half as loud. */
static void make_sound(uint32_t number, uint32_t count, unsigned channels)
{
    uint32_t state = 1;
    for (uint32_t i = 0; i < count; i++) {
        const int32_t value = hear_sound(number, i, &state);
        samples[i * channels] = (int16_t)value;
        if (channels == 2u)
            samples[2u * i + 1u] = (int16_t) - (value >> 1);
    }
}

/* Of the frames and of the stretches, as bytes of which the least comes first, on every machine. */
static uint32_t faps_crc(void)
{
    uint32_t crc = CHECKSUM_BEGIN;
    for (unsigned i = 0; i < frame_count * LABIAL_CHANNELS; i++) {
        const uint16_t value = (uint16_t)told[i / LABIAL_CHANNELS][i % LABIAL_CHANNELS];
        crc = checksum_add(checksum_add(crc, value), value >> 8);
    }
    return ~crc;
}

static uint32_t classes_crc(void)
{
    uint32_t crc = CHECKSUM_BEGIN;
    for (unsigned i = 0; i < stretch_count * 3u; i++)
        for (unsigned shift = 0; shift < 32u; shift += 8u)
            crc = checksum_add(crc, stretches[i / 3u][i % 3u] >> shift);
    return ~crc;
}

static void push_in_blocks(uint32_t count, unsigned channels, uint32_t block)
{
    const int16_t *at = samples;
    while (count > 0) {
        const uint32_t part = count < block ? count : block;
        assert_ok(labial_hear_push(&hear, at, part));
        at += part * channels;
        count -= part;
    }
}

/* The frames of a sound of hears.py, from its begin to its end. */
static void hear_all(uint32_t rate, unsigned channels, uint32_t number, uint32_t count, uint32_t block)
{
    begin(rate, channels);
    make_sound(number, count, channels);
    push_in_blocks(count, channels, block);
    assert_ok(labial_hear_end(&hear));
}

/* How many values of these frames are not those of the neutral face. */
static unsigned moved(unsigned from, unsigned to)
{
    unsigned sum = 0;
    for (; from < to; from++)
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
            sum += told[from][k] != 0;
    return sum;
}

/* The end of what was told of classes. */
static uint32_t told_until(void)
{
    return stretches[stretch_count - 1u][1] + stretches[stretch_count - 1u][2];
}

/* ---- Frames -------------------------------------------------------------------------------------------------------- */

TEST(frames_and_classes_are_the_exporters)
{
    for (unsigned i = 0; i < HEARS; i++) {
        hear_all(hears[i].rate, hears[i].channels, hears[i].sound, hears[i].samples, LONGEST);
        assert_int_equal(frame_count, hears[i].frames);
        assert_int_equal(faps_crc(), hears[i].faps_crc);
        assert_int_equal(stretch_count, hears[i].stretches);
        assert_int_equal(classes_crc(), hears[i].classes_crc);
    }
    assert_string_equal(hear_fixture_classes[HEAR_FIXTURE_M], "M");
}

/* Would catch shares of another frame's classes, a class of a neighbour's that is left out, shares that do not pass to
 * silence with the face, and sounds that outlast it. */
TEST(sounds_are_those_of_the_classes_that_lead)
{
    static uint8_t leaders[FRAMES];
    unsigned moving = 0;
    hear_all(16000, 1, 3, 32000, LONGEST);
    assert_true(frame_count >= 100);
    for (unsigned i = 0; i < stretch_count; i++)
        memset(leaders + stretches[i][1], (int)stretches[i][0], stretches[i][2]);
    for (unsigned i = 1; i + 1 < 100; i++) { /* the last frame's neighbour is not told */
        unsigned parts[LABIAL_VISEMES] = { 0 }, all = 0, whole = 0;
        for (unsigned k = 0; k < 3; k++) {
            const uint8_t viseme = visemes[leaders[i + k - 1]];
            if (viseme != LABIAL_VISEME_NONE) {
                parts[viseme < LABIAL_VISEMES ? viseme : LABIAL_VISEME_SIL] += k == 1 ? 2 : 1;
                all += k == 1 ? 2 : 1;
            }
        }
        for (unsigned k = 1; k < LABIAL_VISEMES; k++)
            whole += sounds[i][k];
        assert_in_range(whole + sounds[i][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE - 2, LABIAL_VISEME_ONE + 2);
        if (all == 0 || all == parts[LABIAL_VISEME_SIL]) {
            assert_int_equal(whole, 0);
            continue;
        }
        whole = whole * all / (all - parts[LABIAL_VISEME_SIL]); /* of the sound */
        moving += whole > 120;
        for (unsigned k = 1; k < LABIAL_VISEMES; k++)
            assert_in_range(all * sounds[i][k] + 8, parts[k] * whole, parts[k] * whole + 16);
    }
    assert_true(moving > 20);
    assert_int_equal(sounds[frame_count - 1][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    for (unsigned i = 100; i < frame_count; i++)
        assert_true(sounds[i][LABIAL_VISEME_SIL] >= sounds[i - 1][LABIAL_VISEME_SIL]);
    assert_ok(labial_hear_restart(&hear));
    assert_ok(labial_hear_visemes(&hear, visemes, sounds[0]));
    assert_int_equal(sounds[0][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    assert_ok(labial_hear_cancel(&hear, 200)); /* before there was a frame */
    assert_int_equal(sounds[frame_count - 1][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    assert_ok(labial_hear_restart(&hear));
    push_in_blocks(16000, 1, LONGEST);
    assert_ok(labial_hear_cancel(&hear, 200));
    assert_ok(labial_hear_visemes(&hear, visemes, sounds[0]));
    assert_int_equal(sounds[0][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    assert_int_equal(labial_hear_visemes(&hear, NULL, sounds[0]), LABIAL_ERROR_NULL);
    assert_int_equal(labial_hear_visemes(&hear, visemes, NULL), LABIAL_ERROR_NULL);
}

TEST(blocks_of_any_length_give_the_same_frames)
{
    static const uint32_t blocks[] = { 1, 2, 7, 159, 160, 161, 320, 1024, 4801 };
    for (unsigned i = 5; i < HEARS; i += 7)
        for (unsigned b = 0; b < COUNT_OF(blocks); b += FIXTURE_ROUNDS(3) == 3 ? 1 : 4) {
            hear_all(hears[i].rate, hears[i].channels, hears[i].sound, hears[i].samples, blocks[b]);
            assert_int_equal(faps_crc(), hears[i].faps_crc);
            assert_int_equal(classes_crc(), hears[i].classes_crc);
        }
}

TEST(a_frame_is_known_when_latency_says)
{
    for (unsigned i = 0; i < COUNT_OF(rates); i++) {
        const uint32_t frame = rates[i] / LABIAL_HEAR_FPS;
        uint32_t pushed, delay;
        begin(rates[i], 1);
        /* Three frames ahead, the frame itself, the next one; and the filter, less than a millisecond of which is
         * ahead. */
        assert_int_equal(labial_hear_latency(&hear).delay, 5);
        delay = labial_hear_latency(&hear).delay_milliseconds;
        assert_int_equal(delay, rates[i] == 16000u ? 100 : 101);
        for (pushed = 1; pushed < 8u * frame; pushed++) {
            const uint32_t heard = 1u + (pushed - 1u) / frame; /* but for the filter */
            labial_latency_t latency;
            assert_ok(labial_hear_push(&hear, samples, 1));
            latency = labial_hear_latency(&hear);
            assert_true(frame_count == 0 || pushed * 1000u >= (delay - 1u + 20u * (frame_count - 1u)) * rates[i]);
            assert_true(frame_count > 2 || pushed * 1000u < (delay + 20u * frame_count) * rates[i]);
            assert_true(latency.frames + frame_count == heard || latency.frames + frame_count + 1u == heard);
            assert_true(latency.milliseconds == 20u * latency.frames && latency.phonemes == 0);
        }
        assert_true(frame_count >= 3);
        labial_hear_end(&hear);
        assert_int_equal(labial_hear_latency(&hear).frames, 0);
    }
}

/* Would catch a pointer into the structure itself. */
TEST(a_stream_may_be_moved)
{
    labial_hear_t other;
    assert_int_equal(hears[54].rate, 48000);
    assert_int_equal(hears[54].sound, 5);
    begin(48000, 2);
    make_sound(5, hears[54].samples, 2);
    assert_ok(labial_hear_push(&hear, samples, 1000));
    memcpy(&other, &hear, sizeof other);
    memset(&hear, 0xa5, sizeof hear);
    assert_ok(labial_hear_push(&other, samples + 2000, hears[54].samples - 1000u));
    assert_ok(labial_hear_end(&other));
    assert_int_equal(faps_crc(), hears[54].faps_crc);
}

/* ---- The end, a cancel, a restart ----------------------------------------------------------------------------------- */

/* Would catch frames without sound, and a stream that takes sound after its end. */
TEST(nothing_follows_the_end)
{
    begin(16000, 1);
    assert_ok(labial_hear_end(&hear));
    assert_int_equal(frame_count, 0);
    assert_int_equal(stretch_count, 0);
    begin(16000, 1);
    assert_ok(labial_hear_push(&hear, samples, 0));
    assert_ok(labial_hear_exact(&hear, 1));
    make_sound(3, 321, 1);
    assert_ok(labial_hear_push(&hear, samples, 321));
    assert_ok(labial_hear_end(&hear));
    assert_int_equal(frame_count, 2);
    assert_ok(labial_hear_end(&hear));
    assert_int_equal(frame_count, 2);
    assert_int_equal(labial_hear_push(&hear, samples, 1), LABIAL_ERROR_STATE);
}

/* Would catch an end that stays open, a way to rest that counts as sound, and one that an exact stream goes. */
TEST(the_face_comes_to_rest_after_the_end)
{
    unsigned count;
    make_sound(3, 8000, 1);
    for (int exact = 1; exact >= 0; exact--) {
        begin(16000, 1);
        assert_ok(labial_hear_exact(&hear, exact));
        push_in_blocks(8000, 1, 333);
        assert_ok(labial_hear_end(&hear));
        count = 25;
        assert_int_equal(frame_count, exact ? count : count + LABIAL_EASE_FRAMES);
        assert_int_equal(told_until(), count);
    }
    for (unsigned f = 0; f < LABIAL_EASE_FRAMES; f++)
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
            const double way = (f + 1.0) / LABIAL_EASE_FRAMES, share = way * way * (3 - 2 * way);
            assert_near(told[count + f][k], told[count - 1u][k] * (1 - share), 1.1);
        }
    assert_ok(labial_hear_restart(&hear));
}

/* Would catch a face that opens in silence, at any level of it, and one that rests where there is sound. */
TEST(silence_is_rest)
{
    for (unsigned span = 32; span <= 33; span++) {
        begin(16000, 1);
        make_sound(3, 1600, 1); /* a voice */
        for (unsigned i = 1600; i < 16000u; i++)
            samples[i] = (int16_t)(i % 7u == 0 ? span : i % 3u);
        push_in_blocks(16000, 1, 1000);
        labial_hear_end(&hear);
        assert_true(span == 32 ? moved(15, 50) == 0 && frame_count == 50u : moved(15, 50) > 100u);
    }
}

/* Moves the samples by a constant. */
static void add_offset(uint32_t count, int offset)
{
    for (uint32_t i = 0; i < count; i++)
        samples[i] = (int16_t)(samples[i] + offset);
}

/* Would catch an offset, such as a microphone's, that is heard where a sound begins or ends: after labial_hear_init(),
 * the end, a cancel and a restart, at any rate and wherever a hop ends. */
TEST(an_offset_is_silence_at_either_end)
{
    static const int offsets[] = { 1000, -3300, 9830 };
    for (unsigned i = 0; i < COUNT_OF(rates); i++)
        for (unsigned o = 0; o < COUNT_OF(offsets); o++) {
            const uint32_t silence = rates[i] * 2u / 5u + 37u * o, voice = rates[i] / 10u;
            begin(rates[i], 1);
            for (unsigned round = 0; round < 4u; round++) {
                unsigned before = frame_count;
                memset(samples, 0, silence * sizeof *samples);
                add_offset(silence, offsets[o]);
                push_in_blocks(silence, 1, 1000);
                if (round == 1u)
                    assert_ok(labial_hear_cancel(&hear, 100));
                else
                    assert_ok(labial_hear_end(&hear));
                assert_int_equal(moved(before, frame_count), 0);
                assert_true(frame_count >= before + 20u);
                assert_ok(labial_hear_restart(&hear));
                before = frame_count; /* and behind a voice, which is noise */
                make_sound(3, voice, 1);
                for (unsigned f = 0; f < voice; f++)
                    samples[f] = (int16_t)(samples[f] / 4);
                memset(samples + voice, 0, silence * sizeof *samples);
                add_offset(voice + silence, offsets[o]);
                push_in_blocks(voice + silence, 1, 777);
                assert_ok(labial_hear_end(&hear));
                assert_true(moved(before, before + 6u) > 10u);
                assert_int_equal(moved(before + 16u, frame_count), 0);
                assert_true(frame_count > before + 20u && frame_count < before + 28u); /* at rest: no way there */
                assert_ok(labial_hear_restart(&hear));
            }
        }
}

/* Would catch a jump of the lips, or frames after the neutral one. */
TEST(a_cancel_eases_to_the_neutral_face)
{
    static const struct {
        uint32_t milliseconds;
        unsigned frames;
    } eases[] = { { 0, 1 },    { 1, 1 },     { 20, 1 },       { 21, 2 },
                  { 200, 10 }, { 1000, 50 }, { 20000, 1000 }, { UINT32_MAX, 1000 } };
    make_sound(3, 8000, 1);
    for (unsigned i = 0; i < COUNT_OF(eases); i++) {
        unsigned before;
        begin(16000, 1);
        push_in_blocks(8000, 1, 333);
        before = frame_count;
        assert_true(before > 10u);
        assert_ok(labial_hear_cancel(&hear, eases[i].milliseconds));
        assert_int_equal(frame_count, before + eases[i].frames);
        for (unsigned f = before; f < frame_count; f++)
            for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
                const int from = told[f - 1u][k], to = told[f][k];
                assert_true(from < 0 ? to >= from && to <= 0 : to <= from && to >= 0);
            }
        assert_int_equal(moved(frame_count - 1u, frame_count), 0);
        assert_int_equal(told_until(), before);
        assert_int_equal(labial_hear_push(&hear, samples, 1), LABIAL_ERROR_STATE);
        assert_ok(labial_hear_end(&hear));
        assert_int_equal(frame_count, before + eases[i].frames);
        assert_int_equal(labial_hear_latency(&hear).frames, 0);
        assert_ok(labial_hear_restart(&hear));
        assert_ok(labial_hear_end(&hear)); /* of no sound: nothing was left behind */
        assert_int_equal(frame_count, before + eases[i].frames);
    }
}

/* Would catch a level that a restart forgets, one that is not set, and one that is set while a sound is heard. */
TEST(a_restart_keeps_the_level)
{
    for (unsigned i = 0; i < COUNT_OF(hears_again); i++) {
        begin(16000, 1);
        assert_int_equal(labial_hear_level(&hear), LABIAL_HEAR_LEVEL_BEGIN);
        if (hears_again[i].set > 0) {
            assert_ok(labial_hear_set_level(&hear, hears_again[i].set));
            assert_int_equal(labial_hear_level(&hear), hears_again[i].set);
        }
        make_sound(hears_again[i].sound, hears_again[i].samples, 1);
        push_in_blocks(hears_again[i].samples, 1, 333);
        assert_int_equal(labial_hear_set_level(&hear, LABIAL_HEAR_LEVEL_BEGIN), LABIAL_ERROR_STATE);
        labial_hear_end(&hear);
        assert_int_equal(frame_count, hears_again[i].frames);
        assert_int_equal(labial_hear_level(&hear), hears_again[i].level);
        assert_ok(labial_hear_restart(&hear));
        assert_int_equal(labial_hear_level(&hear), hears_again[i].level);
        first_frame += frame_count;
        frame_count = 0;
        make_sound(hears_again[i].next, hears_again[i].next_samples, 1);
        push_in_blocks(hears_again[i].next_samples, 1, 777);
        labial_hear_end(&hear);
        assert_int_equal(frame_count, hears_again[i].next_frames);
        assert_int_equal(faps_crc(), hears_again[i].next_crc);
        assert_int_equal(labial_hear_level(&hear), hears_again[i].next_level);
    }
    assert_ok(labial_hear_set_level(&hear, LABIAL_HEAR_LEVEL_MIN));
    assert_ok(labial_hear_set_level(&hear, LABIAL_HEAR_LEVEL_MAX));
    assert_int_equal(labial_hear_set_level(&hear, LABIAL_HEAR_LEVEL_MIN - 1), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_hear_set_level(&hear, LABIAL_HEAR_LEVEL_MAX + 1), LABIAL_ERROR_RANGE);
}

/* Would catch sound from before the restart that is still heard, and a jump from the last frame. */
TEST(a_restart_fades_and_then_hears_afresh)
{
    int16_t fresh[FRAMES][LABIAL_CHANNELS];
    unsigned count, before;
    make_sound(5, 9000, 1);
    begin(44100, 1);
    labial_hear_exact(&hear, 1);
    push_in_blocks(9000, 1, 500);
    labial_hear_end(&hear);
    memcpy(fresh, told, sizeof fresh);
    count = frame_count;
    assert_true(count > 9u);
    begin(44100, 1);
    labial_hear_exact(&hear, 1);
    assert_int_equal(labial_hear_restart(&hear), LABIAL_ERROR_STATE);
    make_sound(3, 9001, 1);
    push_in_blocks(9001, 1, 500);
    assert_int_equal(labial_hear_restart(&hear), LABIAL_ERROR_STATE);
    labial_hear_end(&hear);
    before = frame_count;
    assert_ok(labial_hear_restart(&hear));
    assert_ok(labial_hear_set_level(&hear, LABIAL_HEAR_LEVEL_BEGIN));
    make_sound(5, 9000, 1);
    push_in_blocks(9000, 1, 500);
    labial_hear_end(&hear);
    assert_int_equal(frame_count, before + count);
    for (unsigned f = 0; f < count; f++)
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
            const double step = f < 8u ? (f + 1.0) / 9.0 : 1.0, share = step * step * (3 - 2 * step);
            const double last = told[before - 1u][k], wanted = last * (1 - share) + fresh[f][k]; /* which fades, too */
            assert_near(told[before + f][k], wanted, 1.6);
        }
    assert_int_equal(told_until(), before + count);
}

/* ---- Articulation -------------------------------------------------------------------------------------------------- */

/* Frames of a sound at an articulation that is set before it, or after `after` samples of it. */
static unsigned articulate(unsigned percent, uint32_t after, int16_t frames[FRAMES][LABIAL_CHANNELS])
{
    static labial_hear_model_t model;
    static int16_t scale[LABIAL_CHANNELS]; /* so small that no pose is cut */
    model = hear_fixture;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        scale[k] = (int16_t)(hear_fixture.scale[k] % 200);
    model.scale = scale;
    begin(16000, 1);
    assert_ok(labial_hear_init(&hear, &model, 16000, 1, workspace, sizeof workspace, on_frame, &user));
    labial_hear_exact(&hear, 1);
    make_sound(3, 16000, 1);
    assert_ok(labial_hear_push(&hear, samples, after));
    assert_ok(labial_hear_articulation(&hear, percent));
    assert_ok(labial_hear_push(&hear, samples + after, 16000 - after));
    labial_hear_end(&hear);
    memcpy(frames, told, sizeof told);
    return frame_count;
}

/* Would catch an articulation that is not a factor. That 100 percent change nothing, the exporter's frames show. */
TEST(articulation_is_a_factor)
{
    static int16_t plain[FRAMES][LABIAL_CHANNELS], half[FRAMES][LABIAL_CHANNELS], most[FRAMES][LABIAL_CHANNELS],
        beyond[FRAMES][LABIAL_CHANNELS];
    const unsigned count = articulate(100, 0, plain);
    unsigned wider = 0;
    assert_int_equal(articulate(50, 0, half), count);
    assert_int_equal(articulate(LABIAL_ARTICULATION_MAX, 0, most), count);
    assert_int_equal(articulate(UINT32_MAX, 0, beyond), count);
    assert_memory_equal(most, beyond, count * sizeof most[0]);
    assert_int_equal(articulate(0, 0, beyond), count);
    assert_int_equal(moved(0, count), 0);
    for (unsigned t = 0; t < count; t++)
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
            const int far = abs(plain[t][k]);
            assert_true(abs(2 * half[t][k] - plain[t][k]) <= 2);
            wider += abs(most[t][k]) > far + far / 2; /* but where lips are closed */
        }
    assert_true(wider > count);
}

/* Would catch closed lips that are pressed together, or apart, by a shout, and a channel that follows them too far. */
TEST(closed_lips_stay_closed)
{
    static const int16_t zero[LABIAL_CHANNELS],
        ones[LABIAL_CHANNELS] = { 160, 160, 160, 160, 160, 160, 160, 160, 160, 160, 160, 160, 160 },
        all[LABIAL_CHANNELS] = { 256, 128, 0, 256, 256, 256, 256, 256, 256, 256, 256, 256, 256 };
    static const int32_t gains[] = { 0, 128, 256, 300, 512 };
    labial_hear_model_t model = hear_fixture;
    int16_t heads[HEAR_FIXTURE_CLASSES + 1 + LABIAL_CHANNELS] = { 0 }, pose[LABIAL_CHANNELS];
    model.mean = zero;
    model.scale = zero;
    model.closed = ones;
    model.closing = all;
    for (unsigned i = 0; i < COUNT_OF(gains); i++) {
        heads[HEAR_FIXTURE_CLASSES] = 32767; /* the score of closed lips */
        model.mean = zero;
        labial_hear_pose(&model, heads, gains[i], pose);
        assert_int_equal(pose[4], gains[i] < 256 ? 160 * gains[i] / 256 : 160);
        assert_int_equal(pose[1], pose[4] / 2);
        assert_int_equal(pose[2], 0);
        heads[HEAR_FIXTURE_CLASSES] = -32767;
        model.mean = ones;
        labial_hear_pose(&model, heads, gains[i], pose);
        assert_int_equal(pose[4], (160 * gains[i] + 128) / 256);
    }
}

/* Would catch a jolt, and an articulation that a cancel or a restart forgets. */
TEST(articulation_comes_nearer_by_ten)
{
    static int16_t plain[FRAMES][LABIAL_CHANNELS], less[FRAMES][LABIAL_CHANNELS];
    const unsigned count = articulate(100, 0, plain);
    unsigned before;
    assert_int_equal(articulate(0, 8000, less), count);
    for (before = 0; memcmp(plain[before], less[before], sizeof plain[0]) == 0; before++)
        assert_true(before < count);
    assert_true(before >= 18u && before <= 22u); /* 25 frames, of which five were not delivered */
    for (unsigned t = before; t < count; t++)
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
            const double share = t - before < 10u ? 1 - (t - before) / 10.0 : 0;
            assert_near(less[t][k], plain[t][k] * share, abs(plain[t][k]) * 0.12 + 12);
        }
    assert_ok(labial_hear_restart(&hear));
    frame_count = 0;
    first_frame = count;
    push_in_blocks(16000, 1, 16000);
    labial_hear_cancel(&hear, 40);
    assert_true(frame_count > 30u);
    assert_int_equal(moved(0, frame_count), 0);
}

/* ---- Memory and wrong calls ----------------------------------------------------------------------------------------- */

TEST(wrong_arguments_are_refused)
{
    static const uint32_t wrong[] = { 0, 1, 7999, 11025, 15999, 44000, 96000, UINT32_MAX };
    static labial_hear_model_t large, other;
    uint8_t *odd = (uint8_t *)workspace + 2;
    const size_t size = sizeof workspace;
    const struct {
        labial_hear_t *hear;
        const labial_hear_model_t *model;
        unsigned channels;
        void *workspace;
        size_t size;
        labial_frame_fn callback;
        int error;
    } cases[] = {
        { NULL, &hear_fixture, 1, workspace, size, on_frame, LABIAL_ERROR_NULL },
        { &hear, NULL, 1, workspace, size, on_frame, LABIAL_ERROR_NULL },
        { &hear, &hear_fixture, 1, NULL, size, on_frame, LABIAL_ERROR_NULL },
        { &hear, &hear_fixture, 1, workspace, size, NULL, LABIAL_ERROR_NULL },
        { &hear, &hear_fixture, 0, workspace, size, on_frame, LABIAL_ERROR_RANGE },
        { &hear, &hear_fixture, 3, workspace, size, on_frame, LABIAL_ERROR_RANGE },
        { &hear, &hear_fixture, 1, workspace, size - 1u, on_frame, LABIAL_ERROR_WORKSPACE },
        { &hear, &hear_fixture, 1, odd, size, on_frame, LABIAL_ERROR_WORKSPACE },
        { &hear, &large, 1, workspace, SIZE_MAX, on_frame, LABIAL_ERROR_RANGE },
        { &hear, &other, 1, workspace, size, on_frame, LABIAL_ERROR_VERSION },
    };
    large = other = hear_fixture;
    large.units = LABIAL_HEAR_UNITS_MAX + 1;
    other.format++;
    assert_int_equal(labial_hear_workspace_size(&hear_fixture), HEAR_FIXTURE_WORKSPACE_SIZE);
    assert_int_equal(labial_hear_workspace_size(NULL), 0);
    for (unsigned i = 0; i < COUNT_OF(wrong); i++)
        assert_int_equal(labial_hear_init(&hear, &hear_fixture, wrong[i], 1, workspace, size, on_frame, NULL),
                         LABIAL_ERROR_SAMPLE_RATE);
    for (unsigned i = 0; i < COUNT_OF(cases); i++)
        assert_int_equal(labial_hear_init(cases[i].hear, cases[i].model, 16000, cases[i].channels, cases[i].workspace,
                                          cases[i].size, cases[i].callback, NULL),
                         cases[i].error);
    for (unsigned i = 0; i < 2; i++) { /* after an error the stream is unusable */
        labial_hear_t *const bad = i ? &hear : NULL;
        const int error = i ? LABIAL_ERROR_STATE : LABIAL_ERROR_NULL;
        assert_int_equal(labial_hear_push(bad, samples, 1), error);
        assert_int_equal(labial_hear_end(bad), error);
        assert_int_equal(labial_hear_cancel(bad, 0), error);
        assert_int_equal(labial_hear_restart(bad), error);
        assert_int_equal(labial_hear_classes(bad, NULL), error);
        assert_int_equal(labial_hear_articulation(bad, 100), error);
        assert_int_equal(labial_hear_exact(bad, 1), error);
        assert_int_equal(labial_hear_set_level(bad, LABIAL_HEAR_LEVEL_MIN), error);
        assert_int_equal(labial_hear_visemes(bad, visemes, sounds[0]), error);
        assert_int_equal(labial_hear_latency(bad).delay, 0);
        assert_int_equal(labial_hear_level(bad), 0);
    }
    begin(16000, 1);
    assert_int_equal(labial_hear_push(&hear, NULL, 1), LABIAL_ERROR_NULL);
}

static void (*act)(void); /* what the callbacks do */

static void at_frame(void *given, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)given;
    (void)frame;
    (void)faps;
    act();
}

static void at_class(void *given, unsigned shown, uint32_t frame, uint32_t frames)
{
    (void)shown;
    (void)frames;
    at_frame(given, frame, NULL);
}

static unsigned refused;

/* Calls all that a callback must not call. */
static void call_again(void)
{
    refused += labial_hear_push(&hear, samples, 1) == LABIAL_ERROR_STATE;
    refused += labial_hear_end(&hear) == LABIAL_ERROR_STATE;
    refused += labial_hear_cancel(&hear, 0) == LABIAL_ERROR_STATE;
    refused += labial_hear_restart(&hear) == LABIAL_ERROR_STATE;
    refused += labial_hear_classes(&hear, NULL) == LABIAL_ERROR_STATE;
    refused += labial_hear_articulation(&hear, 50) == LABIAL_ERROR_STATE && labial_hear_latency(&hear).delay == 5;
}

TEST(callbacks_cannot_change_their_stream)
{
    refused = 0;
    act = call_again;
    assert_ok(labial_hear_init(&hear, &hear_fixture, 16000, 1, workspace, sizeof workspace, at_frame, NULL));
    assert_ok(labial_hear_classes(&hear, at_class));
    make_sound(0, 960, 1);
    push_in_blocks(960, 1, 960);
    assert_ok(labial_hear_end(&hear));
    assert_true(refused >= 6u * 4u);
    assert_int_equal(refused % 6u, 0);
}

/* A callback that initialises its stream anew, when `anew` frames or stretches were told, and pushes to it at once. */
static unsigned anew, again;
static int with;

static void begin_anew(void)
{
    if (--anew > 0)
        return;
    frame_count = 0;
    assert_int_equal(
        labial_hear_init(&hear, with ? &hear_fixture : NULL, 24000, 1, workspace, sizeof workspace, on_frame, &user),
        with ? LABIAL_OK : LABIAL_ERROR_NULL);
    again++;
    if (with > 1)
        assert_ok(labial_hear_push(&hear, samples, 9600));
}

/* Pushes samples to a stream that begins anew in one of its callbacks: in this push, in the end or in a cancel. */
static void push_and_begin_anew(uint32_t rate, unsigned channels, int by_class, unsigned call, uint32_t count)
{
    const unsigned before = again;
    frame_count = first_frame = 0;
    act = begin_anew;
    assert_ok(labial_hear_init(&hear, &hear_fixture, rate, channels, workspace, sizeof workspace,
                               by_class ? on_frame : at_frame, &user));
    assert_ok(labial_hear_classes(&hear, by_class ? at_class : NULL));
    anew = call > 0 ? UINT32_MAX : 2;
    assert_ok(labial_hear_push(&hear, samples, count));
    if (call > 0) {
        anew = 1;
        assert_ok(call == 1 ? labial_hear_end(&hear) : labial_hear_cancel(&hear, 100));
    }
    assert_int_equal(again, before + 1u);
}

/* Would catch a call that goes on with a stream that is another one by now: in a push, an end and a cancel, in both
 * callbacks, with a stream that is good, used at once, or that could not be initialised. */
TEST(a_callback_may_begin_anew)
{
    make_sound(3, 16000, 1);
    for (unsigned call = 0; call < 3; call++)
        for (int by_class = 0; by_class < 2; by_class++)
            for (with = 0; with < 3; with++) {
                push_and_begin_anew(16000, 1, by_class, call, 8000);
                assert_int_equal(frame_count,
                                 with > 1 ? 15 : 0); /* 20 frames of 480, of which five are still to come */
                assert_int_equal(labial_hear_push(&hear, samples, 9600), with ? LABIAL_OK : LABIAL_ERROR_STATE);
                assert_int_equal(labial_hear_end(&hear), with ? LABIAL_OK : LABIAL_ERROR_STATE);
                assert_true(with == 0 ? frame_count == 0 : frame_count >= 20u * (unsigned)with);
            }
}

/* The same with sound of another rate, of one or two channels, and wherever in a frame the sound ends. */
TEST(a_callback_may_begin_anew_at_any_rate)
{
    make_sound(3, 16000, 1);
    with = 1;
    for (unsigned length = 4800; length < 5280; length += 5) {
        push_and_begin_anew(24000, 1 + length / 10 % 2, 0, length % 2, length);
        assert_int_equal(frame_count, 0);
        assert_ok(labial_hear_push(&hear, samples, 9600));
        assert_ok(labial_hear_end(&hear));
        assert_true(frame_count >= 20);
    }
}

SUITE(NULL, NULL)
