/*
 * Words of any letters, with tables of any numbers, as large as what points into them can tell.
 */
#include "prove.h"
#include "words_parts.h"

#define TREES 65536u /* what a root can tell */

static uint16_t roots[27], bases[27], buckets[257];
static uint8_t leaves[65536 + 256], labels[2 * 256], trees[TREES + 65536], patches[65536 + 64];
static const char phonemes[] = "SIL\0AA\0B";

int main(void)
{
    static labial_words_model_t model = { .roots = roots,
                                          .bases = bases,
                                          .leaves = leaves,
                                          .labels = labels,
                                          .trees = trees,
                                          .buckets = buckets,
                                          .patches = patches,
                                          .phonemes = phonemes };
    static labial_words_letter_t letters[LABIAL_WORDS_LETTERS];
    static labial_word_t word;
    unsigned i;
    FILL(roots);
    FILL(bases);
    FILL(buckets);
    FILL(leaves);
    FILL(labels);
    FILL(trees);
    FILL(patches);
    FILL(word);
    word.count = (uint8_t)Frama_C_interval(0, LABIAL_WORDS_PHONEMES);
    for (i = 0; i < LABIAL_WORDS_LETTERS; i++) {
        letters[i].letter = (uint8_t)Frama_C_interval(1, 27);
        letters[i].character = any_uint8;
    }
    model.multiplier = any_uint32;
    model.phoneme_count = (uint8_t)Frama_C_interval(0, 3);
    labial_words_spell(&model, letters, (unsigned)Frama_C_interval(1, LABIAL_WORDS_LETTERS), &word);
    any_int = labial_words_label(OR_NULL(labial_words_model_t *, &model), any_unsigned)[0];
    return 0;
}
