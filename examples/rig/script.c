/*
 * script.c - "My baby may be happy. Where were you five years ago?", as flite times it, and a laugh.
 */
#include "script.h"

#include "laughter_synthetic.h"
#include "speech_en.h"

#define SPEECH 0
#define LAUGHTER 1

#define WORKSPACE_SIZE LABIAL_LARGER(SPEECH_EN_WORKSPACE_SIZE, LAUGHTER_SYNTHETIC_WORKSPACE_SIZE)

typedef struct {
    uint8_t model;
    uint8_t phoneme;
    uint16_t milliseconds;
} line_t;

/* clang-format off */
#define S(label, ms) { SPEECH, SPEECH_EN_##label, ms }
#define L(label, ms) { LAUGHTER, LAUGHTER_SYNTHETIC_##label, ms }
static const line_t lines[] = {
    S(SIL, 220), S(M, 71), S(AY, 152), S(B, 90), S(EY, 197), S(B, 85), S(IY, 89), S(M, 80), S(EY, 139), S(B, 84),
    S(IY, 110), S(HH, 92), S(AE, 106), S(P, 127), S(IY, 192), S(SIL, 220), S(W, 53), S(EH, 70), S(R, 43), S(W, 47),
    S(ER, 66), S(Y, 84), S(UW, 115), S(F, 112), S(AY, 155), S(V, 45), S(Y, 63), S(IH, 85), S(R, 73), S(Z, 70),
    S(AH, 60), S(G, 122), S(OW, 204), S(SIL, 220),
    L(FRICATIVE, 110), L(A, 104), L(FRICATIVE, 112), L(A, 100), L(FRICATIVE, 114), L(A, 90), L(FRICATIVE, 122),
    L(E, 84), L(FRICATIVE, 120), L(CACKLE, 48), L(SILENCE, 56), L(NE, 240), L(SILENCE, 50), L(PLOSIVE, 40), L(IC, 80),
    L(FRICATIVE, 118), L(A, 96), L(FRICATIVE, 120), L(E, 92), L(FRICATIVE, 120), L(E, 80), L(NASAL, 80),
    L(SILENCE, 364),
};
/* clang-format on */

static const labial_model_t *const models[] = { &speech_en, &laughter_synthetic };

static uint32_t workspace[WORKSPACE_SIZE / 4];

int script_begin(script_t *script, labial_frame_fn on_frame, void *user)
{
    script->next = 0;
    return labial_init(&script->stream, models[lines[0].model], workspace, sizeof workspace, on_frame, user);
}

int script_tick(script_t *script)
{
    int result = LABIAL_OK;
    while (result >= 0 && script->next < sizeof lines / sizeof lines[0] && labial_room(&script->stream) > 0) {
        const line_t *line = &lines[script->next++];
        if (script->next > 1 && line->model != line[-1].model)
            result = labial_use(&script->stream, models[line->model]);
        if (result >= 0)
            result = labial_push(&script->stream, line->phoneme, line->milliseconds);
        if (result >= 0 && script->next == sizeof lines / sizeof lines[0])
            result = labial_end(&script->stream);
    }
    return result < 0 ? result : labial_tick(&script->stream);
}
