/* Any stream whose input is as units.c and channels.c keep it, which prove_units.c shows: no more frames in the queue than
 * are pending; any labels, and any shares for the tongue. */
#include "labial/visemes.h"

#include "prove.h"

static labial_t stream;
static labial_model_t model;
static uint8_t visemes[LABIAL_PHONEMES_MAX];

int main(void)
{
    uint8_t shares[LABIAL_VISEMES];
    int16_t tongue[LABIAL_TONGUE_FAPS];
    Frama_C_make_unknown((char *)&stream, sizeof stream);
    Frama_C_make_unknown((char *)&model, sizeof model);
    FILL(visemes);
    for (unsigned i = 0; i < LABIAL_MODELS; i++)
        stream.models[i] = OR_NULL(const labial_model_t *, &model);
    for (unsigned i = 0; i < sizeof stream.channels.slots; i++)
        stream.channels.slots[i] = (uint8_t)(any_uint8 % LABIAL_MODELS);
    model.frames_per_second = (uint16_t)(1u + any_uint16 % 250u);
    model.phoneme_count = (uint8_t)(1u + any_uint8 % LABIAL_PHONEMES_MAX);
    labial_visemes(OR_NULL(const labial_t *, &stream), OR_NULL(const labial_model_t *, &model),
                   OR_NULL(const uint8_t *, visemes), OR_NULL(uint8_t *, shares));
    FILL(shares);
    labial_tongue(OR_NULL(const uint8_t *, shares), OR_NULL(int16_t *, tongue));
    return 0;
}
