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

static const line_t lines[] = {
    { SPEECH, SPEECH_EN_SIL, 220 },
    { SPEECH, SPEECH_EN_M, 71 },
    { SPEECH, SPEECH_EN_AY, 152 },
    { SPEECH, SPEECH_EN_B, 90 },
    { SPEECH, SPEECH_EN_EY, 197 },
    { SPEECH, SPEECH_EN_B, 85 },
    { SPEECH, SPEECH_EN_IY, 89 },
    { SPEECH, SPEECH_EN_M, 80 },
    { SPEECH, SPEECH_EN_EY, 139 },
    { SPEECH, SPEECH_EN_B, 84 },
    { SPEECH, SPEECH_EN_IY, 110 },
    { SPEECH, SPEECH_EN_HH, 92 },
    { SPEECH, SPEECH_EN_AE, 106 },
    { SPEECH, SPEECH_EN_P, 127 },
    { SPEECH, SPEECH_EN_IY, 192 },
    { SPEECH, SPEECH_EN_SIL, 220 },
    { SPEECH, SPEECH_EN_W, 53 },
    { SPEECH, SPEECH_EN_EH, 70 },
    { SPEECH, SPEECH_EN_R, 43 },
    { SPEECH, SPEECH_EN_W, 47 },
    { SPEECH, SPEECH_EN_ER, 66 },
    { SPEECH, SPEECH_EN_Y, 84 },
    { SPEECH, SPEECH_EN_UW, 115 },
    { SPEECH, SPEECH_EN_F, 112 },
    { SPEECH, SPEECH_EN_AY, 155 },
    { SPEECH, SPEECH_EN_V, 45 },
    { SPEECH, SPEECH_EN_Y, 63 },
    { SPEECH, SPEECH_EN_IH, 85 },
    { SPEECH, SPEECH_EN_R, 73 },
    { SPEECH, SPEECH_EN_Z, 70 },
    { SPEECH, SPEECH_EN_AH, 60 },
    { SPEECH, SPEECH_EN_G, 122 },
    { SPEECH, SPEECH_EN_OW, 204 },
    { SPEECH, SPEECH_EN_SIL, 220 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 110 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_A, 104 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 112 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_A, 100 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 114 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_A, 90 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 122 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_E, 84 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 120 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_CACKLE, 48 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_SILENCE, 56 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_NE, 240 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_SILENCE, 50 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_PLOSIVE, 40 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_IC, 80 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 118 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_A, 96 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 120 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_E, 92 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_FRICATIVE, 120 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_E, 80 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_NASAL, 80 },
    { LAUGHTER, LAUGHTER_SYNTHETIC_SILENCE, 364 },
};

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
