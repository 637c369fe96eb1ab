/*
 * words.c: words of any letters, with tables of any numbers, as large as what points into them can tell.
 * words_characters.c: any bytes of a text of any size up to its largest here, at any place of it.
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
        letters[i].sound = any_uint8;
    }
    model.multiplier = any_uint32;
    model.phoneme_count = (uint8_t)Frama_C_interval(0, 3);
    labial_words_spell(&model, letters, (unsigned)Frama_C_interval(1, LABIAL_WORDS_LETTERS), &word);
    any_int = labial_words_label(OR_NULL(labial_words_model_t *, &model), any_unsigned)[0];
    return 0;
}

#define BYTES 64

int prove_words_characters(void)
{
    static unsigned char text[BYTES];
    labial_words_place_t here;
    FILL(text);
    FILL(here);
    here.text = text;
    here.size = (size_t)Frama_C_interval(0, BYTES);
    here.at = any_size;
    any_int = (int)labial_words_following(&here);
    labial_words_advance(&here);
    any_int = labial_words_is_capital(any_unsigned) + labial_words_is_latin(any_unsigned) +
              labial_words_is_decimal(any_unsigned) + labial_words_is_inside(any_unsigned);
    any_int = (int)labial_words_small_letter(any_unsigned);
    any_int = labial_words_is_blank(any_unsigned);
    any_int = (int)labial_words_accented(&here);
    return 0;
}
