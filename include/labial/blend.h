/*
 * labial/blend.h - speaking while laughing: blends a frame of speech and a frame of laughter.
 *
 * Two streams run side by side, one with a speech and one with a laughter model of the same frame rate. Each keeps its
 * latest frame, and once per frame period the two are blended:
 *
 *     labial_tick(&talk);  // callback copies the frame to speech[]
 *     labial_tick(&laugh); // callback copies the frame to laugh[]
 *     labial_blend(&labial_blend_default, intensity, words, speech, laugh, faps);
 *
 * `intensity` is the amount of laughter, `words` how far it must give way to words. The program changes both in ramps
 * of 200 to 300 ms, since a jump in either is a jump in the motion. docs/laughing.md has complete programs.
 *
 * For each channel c, with s the speech's and l the laugh's value and everything else in 0 .. 1:
 *
 *     out[c] = s[c] + (l[c] - s[c]) * intensity * (1 - words * (1 - share[c] * free[c]))     rounded to the nearest
 *
 * With words = 1 a channel follows the laugh by its share, but lips that meet stay together: `free` is 0 where speech
 * needs the channel for a closure, 1 where it does not, and 3 x^2 - 2 x^3 in between. The speech frame itself shows the
 * closures, so that its phonemes are not needed:
 *
 *     opening = -(FAP 51 + FAP 52)   distance of the middles of the lips: small in p, b, m
 *     drop    = -FAP 52              how far the lower lip is lowered: small in f, v, where it touches the teeth
 *
 *     upper lip (FAPs 51, 55, 56)              x = (opening - closed) / (open - closed)
 *     lower lip (FAPs 52, 57, 58)              the same or, if less, x = (drop - touching) / (dropped - touching)
 *     jaw (FAP 3)                              the lower lip's where l > s, so that no laugh pulls lips apart that
 *                                              meet; free where l <= s
 *     protrusion (16, 17), corners (53, 54, 59, 60)      always free: one smiles with closed lips, too
 *
 * With words = 0 nothing is kept closed and the mouth laughs alone: in pauses of speech the lips are closed, too, and a
 * laugh should open them.
 *
 * Every value lies between the speech's and the laugh's, so that nothing overflows or leaves the range of FAPs. With
 * intensity = 0, and with share[c] * free[c] = 0 while words = 1, it is exactly the speech's; with intensity = 1 and
 * words = 0 exactly the laugh's. It goes towards the laugh as intensity grows and as words shrink.
 *
 * Integers only, no state, the same bits on every target, within 1 FAP unit of the equation for values within +-2,000.
 * Linked only when used.
 */
#ifndef LABIAL_BLEND_H
#define LABIAL_BLEND_H

#include <stdint.h>

#include "labial/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One, in shares, intensities and words: Q8. */
#define LABIAL_BLEND_FULL 256u

/* How a face laughs while it speaks. 34 bytes. Any values are safe; the comments say which make sense. */
typedef struct {
    /* Q8, 0 .. LABIAL_BLEND_FULL, more counts as that: how far the channel follows the laugh at full intensity while
     * words are spoken. */
    uint16_t shares[LABIAL_CHANNELS];
    int16_t closed;   /* FAP units of opening: up to here the lips are closed and stay so */
    int16_t open;     /* from here on they are free; where it is not above `closed` there is nothing in between */
    int16_t touching; /* FAP units of drop: up to here the lower lip touches the teeth and stays there */
    int16_t dropped;  /* from here on it is free; where it is not above `touching` there is nothing in between */
} labial_blend_t;

/*
 * A face that laughs with the corners of its mouth and speaks with its lips and jaw: corners .9, protrusion .6, jaw and
 * lips .35. Lips are closed up to 120 FAP units of opening, free from 240 on; the lower lip touches up to 150 units of
 * drop and is free from 270 on, as suits the bundled voice.
 */
extern const labial_blend_t labial_blend_default;

/*
 * Blends two frames of 13 FAPs, of which every int16 is allowed. `intensity` and `words` are Q8, 0 ..
 * LABIAL_BLEND_FULL, more counts as that. `out` may be `speech` or `laugh` itself, but not overlap them otherwise. All
 * memory is the caller's.
 *
 * Returns LABIAL_OK or, with nothing written, LABIAL_ERROR_NULL (labial/labial.h).
 */
int labial_blend(const labial_blend_t *blend, unsigned intensity, unsigned words, const int16_t speech[LABIAL_CHANNELS],
                 const int16_t laugh[LABIAL_CHANNELS], int16_t out[LABIAL_CHANNELS]);

#ifdef __cplusplus
}
#endif

#endif
