/*
 * closure.h - finds the beginning of a stop in the sound. A synthesiser may report p, t and k at their burst; the lips
 * of a p are shut before it, and the sound is silent while they are.
 */
#ifndef LABIAL_EXAMPLE_CLOSURE_H
#define LABIAL_EXAMPLE_CLOSURE_H

#include <stddef.h>
#include <stdint.h>

/* Frames of 5 ms whose levels are stored. */
#define CLOSURE_FRAMES 128u

/* Private. */
typedef struct {
    unsigned rate;
    uint64_t samples;               /* so far */
    uint64_t sum;                   /* of the magnitudes in the frame that is not yet full */
    unsigned count;                 /* of its samples */
    uint16_t level[CLOSURE_FRAMES]; /* mean magnitude of frame k at k % CLOSURE_FRAMES */
} closure_t;

/* Prepares for sound of `samples_per_second`, 200 or more. */
void closure_init(closure_t *closure, unsigned samples_per_second);

/* Processes the next piece of the sound, 16 bits. */
void closure_sound(closure_t *closure, const short *samples, size_t count);

/*
 * Returns where the silence before a burst begins, milliseconds. The burst is `burst` milliseconds into the sound,
 * which was processed up to there; the phoneme before it begins at `before`. Frames are silent up to a sixteenth (-24
 * dB) of that phoneme's loudest frame, so that a voiced stop, whose voicing continues, begins where it is reported. At
 * most 100 ms are taken from the phoneme before, which keeps at least 20 ms. Returns `burst` without silence.
 */
uint64_t closure_begin(const closure_t *closure, uint64_t before, uint64_t burst);

/* Whether a label of the IPA is that of a stop or an affricate. */
int closure_is_stop(const char *label);

#endif
