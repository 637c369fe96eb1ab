/*
 * labial/visemes.h - which sound each frame shows, for what lips and jaw alone cannot tell: the tongue in "thin", the
 * teeth in "see", lips that are pressed, not only closed, in "mama".
 *
 *     static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
 *     {
 *         uint8_t shares[LABIAL_VISEMES];
 *         labial_visemes(&stream, &speech_en, labial_arpabet_visemes, shares);
 *         labial_rig_apply_visemes(&oculus, faps, shares, values);
 *     }
 *
 * The sounds are the 15 visemes of Oculus LipSync, which are the 14 of MPEG-4 (ISO/IEC 14496-2, table C.2) and silence
 * in another order. Shares are computed from the phonemes that a stream holds around the frame that it delivered last:
 * no stream grows or becomes slower by them, and the code is linked only when used.
 *
 * Each sound has a dominance over its neighbours, a strength with an onset before it and a release after it (Cohen and
 * Massaro, Modeling coarticulation in synthetic visual speech, 1993): with d the milliseconds from the frame to the
 * nearest frame of sound v,
 *
 *     D(v) = max(0, strength(v) - slope(v) d)      onset: the sound is still to come; release: it is over
 *     share(v) = D(v) / sum of all D
 *
 * So lips are pressed in p even if it lasts 40 ms, and a vowel gives way to its neighbours. /hh/ has no viseme of its
 * own: its neighbours share its time. While the face comes to rest, the shares pass to silence in step with it.
 */
#ifndef LABIAL_VISEMES_H
#define LABIAL_VISEMES_H

#include <stdint.h>

#include "labial/labial.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The visemes, in the order of Oculus LipSync. */
enum {
    LABIAL_VISEME_SIL, /* rest */
    LABIAL_VISEME_PP,  /* p b m */
    LABIAL_VISEME_FF,  /* f v */
    LABIAL_VISEME_TH,  /* thin, this */
    LABIAL_VISEME_DD,  /* t d */
    LABIAL_VISEME_KK,  /* k g, sing */
    LABIAL_VISEME_CH,  /* chin, joy, shoe */
    LABIAL_VISEME_SS,  /* s z */
    LABIAL_VISEME_NN,  /* n l */
    LABIAL_VISEME_RR,  /* red, bird */
    LABIAL_VISEME_AA,  /* car, cut, my */
    LABIAL_VISEME_E,   /* bed, day */
    LABIAL_VISEME_IH,  /* tip, see, yes */
    LABIAL_VISEME_OH,  /* toe, law */
    LABIAL_VISEME_OU,  /* too, book, we */
    LABIAL_VISEMES
};

/* A share of one. The shares of a frame add up to this, but for rounding. */
#define LABIAL_VISEME_ONE 128

/* In a table of visemes: a phoneme that its neighbours decide, such as /hh/. */
#define LABIAL_VISEME_NONE 255

/* Phonemes of the speech models that Labial trains, and the viseme of each: silence, then ARPABET by the alphabet. */
#define LABIAL_ARPABET_PHONEMES 40
extern const uint8_t labial_arpabet_visemes[LABIAL_ARPABET_PHONEMES];

/*
 * The shares of the frame that the stream delivered last, in its callback or until the next tick. `visemes` has the
 * viseme of each phoneme of `model`; numbers that are none, and frames of other models, such as laughter, count as
 * silence. The last frames before the model changes show what follows instead. In a build with LABIAL_LOCKS it takes
 * the lock; without, as all calls, it must not run while another context uses the stream.
 *
 * It needs LABIAL_REACH of at least LABIAL_DELAY(stride); with less, and in a build with LABIAL_PAPER, all frames are
 * silence.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (before labial_init()).
 */
int labial_visemes(const labial_t *stream, const labial_model_t *model, const uint8_t *visemes,
                   uint8_t shares[LABIAL_VISEMES]);

/* Lip classes of the models of hearing that Labial trains, and the viseme of each, for labial_hear_visemes(). */
#define LABIAL_HEARD_CLASSES 26
extern const uint8_t labial_heard_visemes[LABIAL_HEARD_CLASSES];

/* FAPs of the tongue: 43 shift_tongue_tip and 45 thrust_tongue_tip in 1/1024 of the mouth's width, 44 raise_tongue_tip
 * and 46 raise_tongue in 1/1024 of the distance from mouth to nose, 47 tongue_roll in 1/100,000 radian. */
#define LABIAL_TONGUE_FAPS 5

/*
 * The FAPs 43 to 47 of a frame from its shares: what each sound does with the tongue (docs/method.md gives the rules
 * and their source), weighted by the shares. Does nothing when a pointer is null.
 */
void labial_tongue(const uint8_t shares[LABIAL_VISEMES], int16_t tongue[LABIAL_TONGUE_FAPS]);

#ifdef __cplusplus
}
#endif

#endif
