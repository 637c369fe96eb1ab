/*
 * prove_calls.c - drivers of files that need no stand-ins: prove_NAME() is that of lib/NAME.c (fixed.h for `fixed`).
 */
#include "labial/blend.h"
#include "labial/clock.h"
#include "labial/faps.h"
#include "labial/labial.h"
#include "labial/laugh.h"

#include "any_model.h"
#include "channels.h"
#include "fixed.h"
#include "shape.h"
#include "units.h"
#include "viterbi.h"

static volatile int64_t any_int64;

/* Any description, intensity, share of words and frames; the result apart from them or in place of either. */
int prove_blend(void)
{
    labial_blend_t blend;
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    int16_t *to = any_int ? out : any_int ? speech : any_int ? laugh : (int16_t *)0;
    FILL(blend);
    FILL(speech);
    FILL(laugh);
    labial_blend(OR_NULL(const labial_blend_t *, any_int ? &labial_blend_default : &blend), any_unsigned, any_unsigned,
                 OR_NULL(const int16_t *, speech), OR_NULL(const int16_t *, laugh), to);
    return 0;
}

/* Any sounds at any times, on clocks of any rate, and on one that is whatever labial_clock_play() may have left. */
int prove_clock(void)
{
    labial_clock_t clock;
    int64_t sample;
    labial_clock_init(NULL, any_uint32);
    labial_clock_init(&clock, any_uint32);
    while (any_int) {
        if (any_int)
            labial_clock_play(&clock, any_int64, any_uint32, any_int64);
        if (any_int)
            labial_clock_stop(&clock);
        labial_clock_at(&clock, any_int64, &sample);
    }
    return 0;
}

/* Any model, also one that labial_model_check() refuses, whose phonemes are there; and any stream of models that have a
 * frame rate. */
int prove_cost(void)
{
    static labial_phoneme_t some[255];
    static labial_t stream;
    static labial_model_t model;
    unsigned i;
    FILL(some);
    FILL(model);
    model.phonemes = some;
    labial_model_cost(0);
    labial_model_cost(&model);
    labial_workspace_size(OR_NULL(const labial_model_t *, &model));
    Frama_C_make_unknown((char *)&stream, sizeof stream);
    model.frames_per_second = (uint16_t)Frama_C_interval(1, 250);
    for (i = 0; i < LABIAL_MODELS; i++)
        stream.models[i] = &model;
    stream.slot = (uint8_t)Frama_C_interval(0, LABIAL_MODELS - 1);
    labial_uses(OR_NULL(const labial_t *, &stream), OR_NULL(const labial_model_t *, &model));
    return (int)labial_latency(OR_NULL(const labial_t *, &stream)).frames;
}

int prove_faps(void)
{
    int16_t faps[LABIAL_CHANNELS], expanded[LABIAL_FAPS_EXPANDED];
    FILL(faps);
    labial_expand(OR_NULL(const int16_t *, faps), OR_NULL(int16_t *, expanded));
    return labial_fap_numbers[Frama_C_interval(0, LABIAL_CHANNELS - 1)] +
           labial_fap_numbers_expanded[Frama_C_interval(0, LABIAL_FAPS_EXPANDED - 1)];
}

/* The shared arithmetic, with any operands within the ranges that fixed.h names. */
int prove_fixed(void)
{
    const unsigned steps = (unsigned)Frama_C_interval(1, 65535);
    const int32_t limit = Frama_C_interval(0, INT32_MAX);
    labial_add(any_int32, any_int32);
    labial_sub(any_int32, any_int32);
    labial_mulshift(any_int32, any_int32, (unsigned)Frama_C_interval(16, 31));
    labial_part16(any_int32, Frama_C_unsigned_int_interval(0, 65536));
    labial_part24(any_int32, Frama_C_unsigned_int_interval(0, (1u << 24) - 1u));
    labial_part24(any_int32, 1u << 24);
    labial_weight(any_uint8);
    labial_z(Frama_C_unsigned_int_interval(0, 65535), any_uint16, Frama_C_unsigned_int_interval(0, 65535));
    labial_z_cost(Frama_C_unsigned_int_interval(0, 65535));
    labial_ease(Frama_C_unsigned_int_interval(0, 65535), steps);
    labial_position(any_int32);
    return labial_clamp(any_int32, limit);
}

/* Any table, corners of any size, and any motion of models with a table and without, with any spacing. */
int prove_followers(void)
{
    static labial_model_t model;
    static int16_t motion[LABIAL_CHANNELS * LABIAL_SEARCH_STRIDE_MAX];
    int16_t frame[LABIAL_CHANNELS];
    const unsigned spacing = (unsigned)Frama_C_interval(1, LABIAL_SEARCH_STRIDE_MAX);
    any_model(&model, 1);
    FILL(motion);
    labial_followers_complete(&model, motion + Frama_C_interval(0, (int)spacing - 1), spacing, frame);
    return labial_protrusion(&protrusion, Frama_C_interval(2 * INT16_MIN, 2 * INT16_MAX)) + frame[0];
}

/* A laugh of any length, intensity and seed, followed for as long as it lasts. */
static void refuse_laughs(void)
{
    labial_laugh_t laugh;
    unsigned phoneme;
    uint32_t milliseconds;
    labial_laugh_init(0, any_uint32, any_unsigned, any_uint32);
    labial_laugh_next(0, &phoneme, &milliseconds);
    labial_laugh_next(&laugh, 0, &milliseconds);
    labial_laugh_next(&laugh, &phoneme, 0);
}

int prove_laugh(void)
{
    labial_laugh_t laugh;
    unsigned phoneme;
    uint32_t milliseconds;
    refuse_laughs();
    if (labial_laugh_init(&laugh, any_uint32, any_unsigned, any_uint32) == LABIAL_OK)
        while (labial_laugh_next(&laugh, &phoneme, &milliseconds) == LABIAL_OK)
            ;
    return 0;
}

int prove_result(void)
{
    return labial_result_text(any_int)[0];
}

/* Any pushes of any models' phonemes, and frames taken, asked for or forgotten between them, in any order. */
int prove_units(void)
{
    static labial_model_t model;
    static labial_units_t units; /* zero, as labial_init() makes it */
    const labial_model_t *models[LABIAL_MODELS];
    labial_taken_t taken;
    labial_spoken_t spoken;
    unsigned i;
    any_model(&model, 1);
    model.kernel_behind = 0; /* with every distance that a model may look ahead */
    model.kernel_stride = 1;
    model.kernel_taps = (uint8_t)Frama_C_interval(0, LABIAL_REACH + 1);
    for (i = 0; i < LABIAL_MODELS; i++)
        models[i] = &model;
    labial_units_go_back(&units, any_unsigned); /* moves labels, whatever they are, and makes none */
    labial_units_reset(&units);
    while (any_int) {
        if (any_int && units.count < LABIAL_QUEUE)
            labial_units_push(&units, (unsigned)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1),
                              (unsigned)Frama_C_interval(0, LABIAL_MODELS - 1),
                              (uint32_t)Frama_C_interval(0, LABIAL_DURATION_MAX), (uint32_t)Frama_C_interval(1, 250));
        labial_units_take(&units, models, any_int, &taken);
        labial_units_left(&units, models);
        labial_units_uses(&units, (unsigned)Frama_C_interval(0, LABIAL_MODELS - 1), any_uint32);
        labial_units_next(&units, models, any_int, &spoken);
        if (any_int)
            labial_units_reset(&units);
    }
    return 0;
}

/* Any states of any model, any target, and a search that goes on from wherever a step may leave it. Models with fewer
 * states than a window has are taken one by one, with tables that end with the last state. */
static void search_among(int least, int most)
{
    labial_model_t model;
    labial_search_t search;
    any_model(&model, 1);
    model.state_count = (uint8_t)Frama_C_interval(least, most);
    channels[0].emissions = emissions + LABIAL_STATES_MAX - most;
    FILL(search);
    labial_viterbi_step(&model, &channels[0], any_position(), LABIAL_BEGINS, &search);
    while (any_int) {
        labial_viterbi_step(&model, &channels[0], any_position(), any_unsigned, &search);
        labial_viterbi_span(&search, any_unsigned);
        labial_viterbi_state(&search, 0);
    }
}

int prove_viterbi(void)
{
    int count;
    for (count = 1; count < LABIAL_SEARCHED; count++)
        search_among(count, count);
    search_among(LABIAL_SEARCHED, LABIAL_STATES_MAX);
    return 0;
}

/* ---- Models ------------------------------------------------------------------------------------------------------ */

/* Any counts and values, pointers null or not. */

/* With one number of channels, or those that no model has: EVA, which sees a number and the tables of the channels apart,
 * sees then whose tables are there. */
static void check_with(labial_model_t *model, int least, int most)
{
    model->channel_count = (uint8_t)Frama_C_interval(least, most);
    model->pair_keys = model->contacts = 0;
    model->floors = 0;
    labial_model_check(model);
    model->floors = floors;
    labial_model_check(model);
    model->contacts = contacts;
    labial_model_check(model);
    model->pair_keys = pair_keys;
    labial_model_check(model);
}

int prove_model(void)
{
    labial_model_t model;
    FILL(phonemes);
    FILL(components);
    FILL(pair_keys);
    FILL(floors);
    FILL(contacts);
    FILL(emissions);
    FILL(states);
    FILL(transitions);
    FILL(channels);
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++) {
        channels[i].emissions = OR_NULL(const labial_emission_t *, emissions);
        channels[i].states = OR_NULL(const labial_state_t *, states);
        channels[i].transitions = OR_NULL(const labial_transition_t *, transitions);
        channels[i].initials = OR_NULL(const uint8_t *, initials);
    }
    FILL(model);
    model.phonemes = OR_NULL(const labial_phoneme_t *, phonemes);
    model.components = OR_NULL(const labial_component_t *, components);
    model.shapes = OR_NULL(const int8_t *, shapes);
    model.kernels = OR_NULL(const uint32_t *, kernels);
    model.pairs = OR_NULL(const int8_t *, shapes);
    model.protrusion = OR_NULL(const labial_protrusion_t *, &protrusion);
    model.channels = OR_NULL(const labial_channel_t *, channels);
    labial_model_check(0);
    /*@ loop unroll 14; */
    for (int i = 0; i <= LABIAL_CHANNELS; i++)
        check_with(&model, i, i);
    check_with(&model, LABIAL_CHANNELS + 1, 255);
    return 0;
}

/* ---- Shapes ------------------------------------------------------------------------------------------------------ */

/* Any model, phonemes, duration and neighbours; any shape, and any frame that units.c may take, with labels as far
 * as the kernels of a checked model reach and no farther. Phonemes with one to eight components are taken one by
 * one, as are one and two knots of pairs, and kernels of every stride and number of taps. */

static labial_model_t shaped;

static void select_among(int count, int knots)
{
    labial_spoken_t spoken;
    labial_selection_t selection = { 0 }; /* as labial_init() makes it */
    labial_shape_t shape[LABIAL_CHANNELS];
    FILL(shape); /* the workspace */
    selection.shape = shape;
    spoken.slot = any_uint8;
    spoken.phoneme = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    spoken.previous = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    spoken.next = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    spoken.ms = any_uint16;
    any_phonemes(count);
    shaped.pair_knots = (uint8_t)knots;
    labial_shape_select(&shaped, &spoken, &selection);
    labial_shape_select(&shaped, &spoken, &selection);
}

static void take(void)
{
    labial_taken_t taken;
    labial_shape_t shape[LABIAL_CHANNELS];
    uint8_t labels[2 * LABIAL_REACH + 1];
    int16_t target[LABIAL_CHANNELS];
    int i;
    FILL(target); /* the workspace, which a reset sets to zero: EVA cannot tell that a shaped's channels were written */
    for (i = 0; i < LABIAL_CHANNELS; i++)
        shape[i].knots[0] = any_position();
    for (i = 0; i < LABIAL_CHANNELS; i++)
        shape[i].knots[1] = any_position();
    for (i = 0; i < 2 * LABIAL_REACH + 1; i++)
        labels[i] = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    taken.labels = labels + LABIAL_REACH;
    taken.share = (uint16_t)Frama_C_interval(0, 16384);
    taken.slot = any_uint8;
    taken.is_first = (uint8_t)Frama_C_interval(0, 1);
    taken.is_open = (uint8_t)Frama_C_interval(0, 1);
    taken.rest = (uint8_t)Frama_C_interval(0, LABIAL_REST_FRAMES);
    taken.marks = any_uint8;
    labial_shape_target(&shaped, shape, &taken, target);
}

/* Kernels of every length and place with this stride: `room` taps at most to either side of the frame. */
static void aim(int stride, int room)
{
    int taps;
    shaped.kernel_stride = (uint8_t)stride;
    /*@ loop unroll 32; */
    for (taps = 1; taps <= LABIAL_KERNEL_TAPS_MAX && taps <= 2 * room + 1; taps++) {
        shaped.kernel_taps = (uint8_t)taps;
        shaped.kernel_behind =
            (uint8_t)Frama_C_interval(taps - 1 > room ? taps - 1 - room : 0, taps > room ? room : taps - 1);
        take();
    }
}

int prove_shape(void)
{
    int count, knots, stride;
    any_model(&shaped, 1);
    /*@ loop unroll 8; */
    for (count = 1; count <= LABIAL_PHONEME_COMPONENTS_MAX; count++)
        for (knots = 1; knots <= 2; knots++)
            select_among(count, knots);
    shaped.kernel_taps = shaped.kernel_behind = 0;
    take();
    shaped.kernel_taps = 1;
    take();
    aim(0, LABIAL_KERNEL_TAPS_MAX - 1);
    /*@ loop unroll 20; */
    for (stride = 1; stride <= LABIAL_REACH; stride++)
        aim(stride, LABIAL_REACH / stride);
    return 0;
}
