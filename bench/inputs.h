/*
 * inputs.h - what is synthesised to measure: the phonemes of the demo's sentence, or two trains of laughter, repeated.
 */
#ifndef BENCH_INPUTS_H
#define BENCH_INPUTS_H

#include "laughter_synthetic.h"
#include "speech_en.h"

typedef struct {
    uint8_t phoneme;
    uint16_t ms;
} bench_phoneme_t;

typedef struct {
    const labial_model_t *model;
    const bench_phoneme_t *phonemes;
    unsigned count;
} bench_input_t;

/* `name` is SPEECH or LAUGHTER, or a macro that is; the other model is then not linked. */
#define BENCH_INPUT(name) BENCH_JOIN(name)
#define BENCH_JOIN(name) BENCH_##name
/* clang-format off */
#define BENCH_SPEECH { &speech_en, bench_sentence, sizeof bench_sentence / sizeof *bench_sentence }
#define BENCH_LAUGHTER { &laughter_synthetic, bench_laugh, sizeof bench_laugh / sizeof *bench_laugh }

#define S(label, ms) { SPEECH_EN_##label, ms }
#define L(label, ms) { LAUGHTER_SYNTHETIC_##label, ms }
/* clang-format on */

static const bench_phoneme_t bench_sentence[] = {
    S(SIL, 220), S(M, 71),   S(AY, 152), S(B, 90),   S(EY, 197), S(B, 85),   S(IY, 89),   S(M, 80), S(EY, 139),
    S(B, 84),    S(IY, 110), S(HH, 92),  S(AE, 106), S(P, 127),  S(IY, 192), S(SIL, 220), S(W, 53), S(EH, 70),
    S(R, 43),    S(W, 47),   S(ER, 66),  S(Y, 84),   S(UW, 115), S(F, 112),  S(AY, 155),  S(V, 45), S(Y, 63),
    S(IH, 85),   S(R, 73),   S(Z, 70),   S(AH, 60),  S(G, 122),  S(OW, 204), S(SIL, 220)
};

static const bench_phoneme_t bench_laugh[] = { L(FRICATIVE, 110), L(A, 104),      L(FRICATIVE, 112), L(A, 100),
                                               L(FRICATIVE, 114), L(A, 90),       L(FRICATIVE, 122), L(E, 84),
                                               L(FRICATIVE, 120), L(CACKLE, 48),  L(SILENCE, 180),   L(NE, 240),
                                               L(FRICATIVE, 120), L(E, 92),       L(FRICATIVE, 118), L(IC, 80),
                                               L(NASAL, 80),      L(SILENCE, 200) };

#undef S
#undef L

/* Keeps the queue full until `milliseconds` were pushed, then ends the stream. `*next` and `*pushed` start as 0. */
static inline void bench_feed(labial_t *stream, const bench_input_t *input, unsigned *next, uint32_t *pushed,
                              uint32_t milliseconds)
{
    while (*pushed < milliseconds && labial_room(stream) > 0) {
        const bench_phoneme_t *phoneme = &input->phonemes[*next];
        labial_push(stream, phoneme->phoneme, phoneme->ms);
        *pushed += phoneme->ms;
        *next = *next + 1u < input->count ? *next + 1u : 0u;
    }
    if (*pushed >= milliseconds)
        labial_end(stream);
}

/* The same from two inputs, BENCH_TURN phonemes of each by turns; their durations differ, so that the
 * model changes in every phase of the channels' turns. */
#define BENCH_TURN 5u

static inline void bench_feed_turns(labial_t *stream, const bench_input_t inputs[2], unsigned *next, uint32_t *pushed,
                                    uint32_t milliseconds)
{
    while (*pushed < milliseconds && labial_room(stream) > 0) {
        const unsigned turn = *next / BENCH_TURN, place = turn / 2u * BENCH_TURN + *next % BENCH_TURN;
        const bench_input_t *input = &inputs[turn % 2u];
        const bench_phoneme_t *phoneme = &input->phonemes[place % input->count];
        labial_use(stream, input->model);
        labial_push(stream, phoneme->phoneme, phoneme->ms);
        *pushed += phoneme->ms;
        ++*next;
    }
    if (*pushed >= milliseconds)
        labial_end(stream);
}

/* The callback: a sum over all channels, so that nothing is left out as unused and runs can be told to agree. */
static inline void bench_on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    uint32_t *sum = (uint32_t *)user;
    (void)frame;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        *sum = *sum * 31u + (uint32_t)(uint16_t)faps[k];
}

#endif
