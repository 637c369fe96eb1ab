/*
 * labial/laugh.h - generates laughs of a given length, for programs that have no timings of laughter.
 *
 * The generator yields phonemes of laughter with their durations, one at a time, to be pushed onto a stream whose model
 * is one of laughter (labial_use()):
 *
 *     labial_laugh_t laugh;
 *     unsigned phoneme;
 *     uint32_t milliseconds;
 *     labial_laugh_init(&laugh, 1800, LABIAL_LAUGH_FULL / 2, seed);
 *     while (labial_laugh_next(&laugh, &phoneme, &milliseconds) == LABIAL_OK)
 *         labial_push(&stream, phoneme, milliseconds);        // while labial_room() > 0
 *
 * Its statistics are those of the synthetic laughter corpus: pulses 210 ms apart in trains of three, more or less, with
 * inhalations between the trains. The same length, intensity and seed give the same laugh on every machine; the
 * caller's structure is the only state.
 */
#ifndef LABIAL_LAUGH_H
#define LABIAL_LAUGH_H

#include <stdint.h>

#include "labial/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The highest intensity. At 0 a laugh is a hum behind nearly closed lips, at the highest the mouth is wide open, and in
 * between jaw, lips and corners change gradually: the generator yields soft, plain and loud grades of the phonemes, and
 * alternates between two grades for a loudness between them; the model has the opening of each grade. Pulses get softer
 * along a train and from train to train. Half the highest intensity has the corpus's rhythm; a higher one makes trains
 * longer, pauses shorter and vowels longer and more open, a lower one hums more pulses with closed lips. */
#define LABIAL_LAUGH_FULL 256u

/* The phonemes of every laughter model that the exporter writes, in the order of their numbers: twelve, then the soft
 * and the loud grade of six of them. A model that was trained on labels without grades has the plain phoneme's shapes
 * there. */
enum {
    LABIAL_LAUGH_SILENCE,
    LABIAL_LAUGH_NE, /* air through the nose, mostly drawn in */
    LABIAL_LAUGH_CLICK,
    LABIAL_LAUGH_NASAL,
    LABIAL_LAUGH_PLOSIVE,
    LABIAL_LAUGH_FRICATIVE,
    LABIAL_LAUGH_IC,
    LABIAL_LAUGH_E,
    LABIAL_LAUGH_O,
    LABIAL_LAUGH_GRUNT,
    LABIAL_LAUGH_CACKLE,
    LABIAL_LAUGH_A,
    LABIAL_LAUGH_FRICATIVE_SOFT,
    LABIAL_LAUGH_FRICATIVE_LOUD,
    LABIAL_LAUGH_IC_SOFT,
    LABIAL_LAUGH_IC_LOUD,
    LABIAL_LAUGH_E_SOFT,
    LABIAL_LAUGH_E_LOUD,
    LABIAL_LAUGH_O_SOFT,
    LABIAL_LAUGH_O_LOUD,
    LABIAL_LAUGH_CACKLE_SOFT,
    LABIAL_LAUGH_CACKLE_LOUD,
    LABIAL_LAUGH_A_SOFT,
    LABIAL_LAUGH_A_LOUD,
    LABIAL_LAUGH_PHONEMES
};

/* A laugh in progress; its members are private. It may be moved or copied between calls. */
typedef struct labial_laugh labial_laugh_t;

/*
 * Prepares a laugh of `milliseconds`, 0 to LABIAL_DURATION_MAX, and of `intensity`, 0 to LABIAL_LAUGH_FULL (more counts
 * as that). Each `seed` gives a different laugh. Below about half a second it is a single breath or pulse. A
 * laugh that is to be dropped is just prepared anew.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_DURATION.
 */
int labial_laugh_init(labial_laugh_t *laugh, uint32_t milliseconds, unsigned intensity, uint32_t seed);

/*
 * Yields the next phoneme and its duration, at least 20 ms unless the whole laugh is shorter; together the phonemes
 * last exactly as long as requested.
 *
 * Returns LABIAL_OK, LABIAL_DONE after the last one (nothing is written), or LABIAL_ERROR_NULL.
 */
int labial_laugh_next(labial_laugh_t *laugh, unsigned *phoneme, uint32_t *milliseconds);

/* ---- Private ----------------------------------------------------------------------------------------------------- */

struct labial_laugh {
    uint32_t left;         /* milliseconds to come */
    uint32_t tail;         /* of them, the silence at the end */
    uint32_t random;       /* state of the random numbers, never 0 */
    uint16_t intensity;    /* 0 .. LABIAL_LAUGH_FULL */
    uint16_t durations[6]; /* of the phonemes that are decided, milliseconds */
    uint8_t phonemes[6];
    uint8_t first, count;             /* of these, the next one and how many there are */
    uint8_t pulses;                   /* to come in the current train */
    uint8_t kind, vowel;              /* of these pulses */
    uint8_t train_loudness, loudness; /* of the current train's first and of its next pulse, 255 the intensity's own */
    uint8_t dither;                   /* between two grades, 1/256 */
};

#ifdef __cplusplus
}
#endif

#endif
