/*
 * talk_phonemes.h - 30 phonemes, 3.1 s, of talk.lab, for the model speech_en. Written by labial bake 0.4.0; do not
 * edit.
 */
#ifndef LABIAL_PHONEMES_TALK_PHONEMES_H
#define LABIAL_PHONEMES_TALK_PHONEMES_H

#include "speech_en.h"

#if SPEECH_EN_PHONEMES != 40
#error "talk_phonemes was written for another speech_en: run labial bake again."
#endif

#define TALK_PHONEMES_PHONEMES 30u
#define TALK_PHONEMES_MILLISECONDS 3125ul

/* A phoneme of speech_en in the low byte, its milliseconds above it. */
static const uint32_t talk_phonemes[30] = {
    SPEECH_EN_SIL | 208ul << 8, SPEECH_EN_HH | 60ul << 8, SPEECH_EN_EH | 110ul << 8, SPEECH_EN_L | 110ul << 8,
    SPEECH_EN_OW | 190ul << 8, SPEECH_EN_SIL | 230ul << 8, SPEECH_EN_M | 70ul << 8, SPEECH_EN_AY | 190ul << 8,
    SPEECH_EN_N | 90ul << 8, SPEECH_EN_EY | 160ul << 8, SPEECH_EN_M | 70ul << 8, SPEECH_EN_IH | 70ul << 8,
    SPEECH_EN_Z | 80ul << 8, SPEECH_EN_B | 80ul << 8, SPEECH_EN_AA | 190ul << 8, SPEECH_EN_B | 82ul << 8,
    SPEECH_EN_SIL | 90ul << 8, SPEECH_EN_AE | 58ul << 8, SPEECH_EN_N | 40ul << 8, SPEECH_EN_D | 50ul << 8,
    SPEECH_EN_AY | 150ul << 8, SPEECH_EN_AE | 80ul << 8, SPEECH_EN_M | 50ul << 8, SPEECH_EN_AH | 50ul << 8,
    SPEECH_EN_P | 120ul << 8, SPEECH_EN_AH | 80ul << 8, SPEECH_EN_P | 80ul << 8, SPEECH_EN_IH | 70ul << 8,
    SPEECH_EN_T | 72ul << 8, SPEECH_EN_SIL | 145ul << 8
};

/*
 * Pushes as many phonemes as the stream has room for, from number *next on, which it moves on; 0 to begin with. Call it
 * before each labial_tick(). It ends the stream behind the last one. Returns LABIAL_OK, or what labial_push() and
 * labial_end() do not accept.
 */
static inline int talk_phonemes_feed(labial_t *stream, uint32_t *next)
{
    while (*next < TALK_PHONEMES_PHONEMES && labial_room(stream) > 0) {
        const int result = labial_push(stream, talk_phonemes[*next] & 255u, talk_phonemes[*next] >> 8);
        if (result < 0)
            return result;
        if (++*next == TALK_PHONEMES_PHONEMES)
            return labial_end(stream);
    }
    return LABIAL_OK;
}

#endif
