/* Any model, also one that labial_model_check() refuses, whose phonemes are there. */
#include "labial/labial.h"
#include "prove.h"

static labial_phoneme_t phonemes[255];

int main(void)
{
    labial_model_t model;
    FILL(phonemes);
    FILL(model);
    model.phonemes = phonemes;
    labial_model_cost(0);
    return (int)labial_model_cost(&model);
}
