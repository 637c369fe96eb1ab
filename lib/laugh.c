/*
 * laugh.c - laughs of a given length. export/labial/reference/laughs.py computes the same and writes the tables, which
 * keep every duration, period and train within its limits (tests/c/test_laugh.c).
 */
#include "labial/laugh.h"

#include <string.h>

#include "labial/labial.h"
#include "laugh_table.h"

/* Kinds of pulses, in the order of pulse_shares. */
enum { BREATH_FIRST, VOWEL_ALONE, CACKLE, NASAL, STOP_FIRST, KINDS };

#define VOWELS (sizeof vowels / sizeof vowels[0])
#define ONSETS (sizeof onsets / sizeof onsets[0])
#define CHANGE 38u /* of 256: how often a pulse is of another kind, or has another vowel, than the one before it */

/* Phonemes that get longer with intensity, by bits. */
#define VOICED                                                                                                         \
    (1u << LABIAL_LAUGH_A | 1u << LABIAL_LAUGH_E | 1u << LABIAL_LAUGH_O | 1u << LABIAL_LAUGH_IC |                      \
     1u << LABIAL_LAUGH_CACKLE | 1u << LABIAL_LAUGH_NASAL)

/* ---- Chance ---------------------------------------------------------------------------------------------------- */

/* A number from 0 to count - 1, `count` at most 65536 (Marsaglia's xorshift). */
static uint32_t draw(labial_laugh_t *laugh, uint32_t count)
{
    uint32_t x = laugh->random;
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    laugh->random = x;
    return ((x >> 16) * count) >> 16;
}

static int chance(labial_laugh_t *laugh, uint32_t share)
{
    return draw(laugh, 256u) < share;
}

static uint8_t choose(labial_laugh_t *laugh, const uint8_t *shares, const int16_t *tilts, unsigned count)
{
    uint32_t weights[KINDS];
    uint32_t sum = 0, place;
    unsigned i;
    for (i = 0; i < count; i++) {
        const int32_t tilt = 32768 + (int32_t)tilts[i] * ((int32_t)laugh->intensity - 128);
        weights[i] = (shares[i] * (uint32_t)tilt) >> 8;
        sum += weights[i];
    }
    place = draw(laugh, sum);
    for (i = 0; i + 1u < count && place >= weights[i]; i++)
        place -= weights[i];
    return (uint8_t)i;
}

/* A duration of `phoneme`, milliseconds, at least SHORTEST. Vowels get longer with intensity, silences shorter. */
static uint32_t duration(labial_laugh_t *laugh, unsigned phoneme)
{
    uint32_t value;
    if (phoneme == LABIAL_LAUGH_SILENCE)
        return ((160u + draw(laugh, 261u)) * (384u - laugh->intensity)) >> 8;
    value = ((uint32_t)medians[phoneme] * stretches[draw(laugh, 32u)]) >> 7;
    return (VOICED >> phoneme & 1u) ? (value * (218u + ((77u * laugh->intensity) >> 8))) >> 8 : value;
}

/* ---- The grammar ----------------------------------------------------------------------------------------------- */

/* Appends a phoneme. A pause has most: silence, click, inhalation, grunt, silence, rest. */
static void add(labial_laugh_t *laugh, unsigned phoneme, uint32_t milliseconds)
{
    laugh->phonemes[laugh->count] = (uint8_t)phoneme;
    laugh->durations[laugh->count] = (uint16_t)milliseconds;
    laugh->count++;
}

/* The same in the grade for `loudness`, 0 to 255 of the intensity; a dither alternates between two grades. */
static void add_graded(labial_laugh_t *laugh, unsigned phoneme, uint32_t milliseconds, uint32_t loudness)
{
    const unsigned soft = soft_grades[phoneme];
    uint32_t louder, grade;
    if (soft != 0u) {
        laugh->dither = (uint8_t)(laugh->dither + DITHER_STEP);
        louder = (laugh->intensity * (loudness + 1u)) >> 8;
        grade = louder < SOFT ? 0u : ((louder - SOFT) * GRADES) >> 8;
        grade = ((grade < 512u ? grade : 512u) + laugh->dither) >> 8;
        if (grade != 1u)
            phoneme = grade == 0u ? soft : soft + 1u;
    }
    add(laugh, phoneme, milliseconds);
}

static void begin_train(labial_laugh_t *laugh)
{
    /* The median is 2/3 to 4/3 of the corpus's, in 1/384; lengths are in 1/32. */
    const uint32_t median = TRAIN_MEDIAN * (256u + laugh->intensity);
    laugh->pulses = (uint8_t)((median * lengths[draw(laugh, 32u)] + 6144u) / 12288u);
    laugh->loudness = laugh->train_loudness;
    laugh->kind = choose(laugh, pulse_shares, pulse_tilts, KINDS);
    laugh->vowel = choose(laugh, vowel_shares, vowel_tilts, VOWELS);
}

static void pulse(labial_laugh_t *laugh, uint32_t room)
{
    uint32_t period, sound, remainder, stop;
    int32_t deviation;
    unsigned note;
    if (chance(laugh, CHANGE))
        laugh->kind = choose(laugh, pulse_shares, pulse_tilts, KINDS);
    if (chance(laugh, CHANGE))
        laugh->vowel = choose(laugh, vowel_shares, vowel_tilts, VOWELS);
    deviation = PERIOD_SPREAD * (int32_t)deviates[draw(laugh, 32u)];
    /* Rounded down: what is added is a whole number of 1/32 and keeps the shift from a negative number. */
    period = (uint32_t)(PERIOD - 512 + ((deviation + 512 * 32) >> 5));
    if (period > room)
        period = room;
    note = vowels[laugh->vowel];
    if (laugh->kind == CACKLE)
        note = LABIAL_LAUGH_CACKLE;
    else if (laugh->kind == NASAL)
        note = LABIAL_LAUGH_NASAL;
    sound = duration(laugh, note);
    if (sound > period - 40u)
        sound = period - 40u;
    remainder = period - sound;
    if (laugh->kind == BREATH_FIRST) {
        add_graded(laugh, LABIAL_LAUGH_FRICATIVE, remainder, laugh->loudness);
        add_graded(laugh, note, sound, laugh->loudness);
    } else if (laugh->kind == STOP_FIRST) {
        stop = duration(laugh, LABIAL_LAUGH_PLOSIVE);
        if (stop > remainder - 20u)
            stop = remainder - 20u;
        add(laugh, LABIAL_LAUGH_PLOSIVE, stop);
        add_graded(laugh, note, sound, laugh->loudness);
        add(laugh, LABIAL_LAUGH_SILENCE, remainder - stop);
    } else {
        add_graded(laugh, note, sound, laugh->loudness);
        add(laugh, LABIAL_LAUGH_SILENCE, remainder);
    }
    laugh->loudness = (uint8_t)((laugh->loudness * PULSE_DECAY) >> 8);
}

static void pause_between_trains(labial_laugh_t *laugh, uint32_t room)
{
    uint32_t sum = 0, breath;
    unsigned inhaled, i;
    if (chance(laugh, INHALED)) {
        add(laugh, LABIAL_LAUGH_SILENCE, duration(laugh, LABIAL_LAUGH_SILENCE));
        if (chance(laugh, CLICKED))
            add(laugh, LABIAL_LAUGH_CLICK, duration(laugh, LABIAL_LAUGH_CLICK));
        inhaled = chance(laugh, BY_NOSE) ? LABIAL_LAUGH_NE : LABIAL_LAUGH_FRICATIVE;
        add_graded(laugh, inhaled, duration(laugh, inhaled), (laugh->train_loudness * INHALED_LOUDNESS) >> 8);
    }
    if (chance(laugh, GRUNTED))
        add(laugh, LABIAL_LAUGH_GRUNT, duration(laugh, LABIAL_LAUGH_GRUNT));
    if (chance(laugh, SILENT))
        add(laugh, LABIAL_LAUGH_SILENCE, duration(laugh, LABIAL_LAUGH_SILENCE));
    if (chance(laugh, RESTED))
        add(laugh, LABIAL_LAUGH_SILENCE, 450u + draw(laugh, 451u));
    for (i = 0; i < laugh->count; i++)
        sum += laugh->durations[i];
    if (sum + PERIOD_SHORTEST > room) {
        breath = duration(laugh, LABIAL_LAUGH_NE);
        if (breath > room)
            breath = room;
        laugh->count = 0;
        add(laugh, LABIAL_LAUGH_NE, breath);
        if (breath + PERIOD > room) { /* no pulse fits after it: the laugh ends with air drawn in */
            laugh->tail = laugh->left - breath;
            return;
        }
    }
    laugh->train_loudness = (uint8_t)((laugh->train_loudness * TRAIN_DECAY) >> 8);
    if (laugh->train_loudness < SOFTEST) /* a laugh that is longer than a bout has several bouts */
        laugh->train_loudness = 255;
    begin_train(laugh);
}

static void onset(labial_laugh_t *laugh, uint32_t room)
{
    uint32_t place, milliseconds;
    unsigned i;
    begin_train(laugh);
    place = draw(laugh, 256u);
    for (i = 0; i < ONSETS && place >= onset_shares[i]; i++)
        place -= onset_shares[i];
    if (i == ONSETS)
        return;
    milliseconds = duration(laugh, onsets[i]);
    if (milliseconds + 3u * PERIOD_SHORTEST <= room)
        add(laugh, onsets[i], milliseconds);
}

/* Chooses the next phonemes; a pause may emit nothing. */
static void compose(labial_laugh_t *laugh)
{
    const uint32_t room = laugh->left > laugh->tail ? laugh->left - laugh->tail : 0u;
    laugh->first = 0;
    laugh->count = 0;
    if (room < SHORTEST) {
        add(laugh, LABIAL_LAUGH_SILENCE, laugh->left);
    } else if (room < PERIOD_SHORTEST) {
        add_graded(laugh, LABIAL_LAUGH_FRICATIVE, room, laugh->loudness);
    } else if (laugh->pulses == 0) {
        pause_between_trains(laugh, room);
    } else {
        laugh->pulses--;
        pulse(laugh, room);
    }
}

int labial_laugh_init(labial_laugh_t *laugh, uint32_t milliseconds, unsigned intensity, uint32_t seed)
{
    if (!laugh)
        return LABIAL_ERROR_NULL;
    if (milliseconds > LABIAL_DURATION_MAX)
        return LABIAL_ERROR_DURATION;
    memset(laugh, 0, sizeof *laugh);
    laugh->left = milliseconds;
    laugh->tail = milliseconds / 6u < 300u ? milliseconds / 6u : 300u; /* the mouth comes to rest */
    laugh->intensity = (uint16_t)(intensity < LABIAL_LAUGH_FULL ? intensity : LABIAL_LAUGH_FULL);
    laugh->random = seed * 2654435761u + 2654435769u;
    if (laugh->random == 0u)
        laugh->random = 1;
    laugh->dither = (uint8_t)(laugh->random >> 24);
    laugh->train_loudness = 255;
    onset(laugh, milliseconds - laugh->tail);
    return LABIAL_OK;
}

int labial_laugh_next(labial_laugh_t *laugh, unsigned *phoneme, uint32_t *milliseconds)
{
    uint32_t length;
    if (!laugh || !phoneme || !milliseconds)
        return LABIAL_ERROR_NULL;
    if (laugh->left == 0u)
        return LABIAL_DONE;
    while (laugh->first >= laugh->count)
        compose(laugh);
    length = laugh->durations[laugh->first];
    if (laugh->left < length + SHORTEST)
        length = laugh->left;
    *phoneme = laugh->phonemes[laugh->first];
    *milliseconds = length;
    laugh->left -= length;
    laugh->first++;
    return LABIAL_OK;
}
