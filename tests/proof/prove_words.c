/*
 * prove_words.c - drivers of files of words: prove_NAME() is that of lib/NAME.c.
 */
#include "labial/words.h"

#include "prove.h"
#include "words_parts.h"

/* ---- Letters and characters -------------------------------------------------------------------------------------- */

/* words.c: words of any letters, with tables of any numbers, as large as what points into them can tell.
 * words_characters.c: any bytes of a text of any size up to its largest here, at any place of it. */

#define TREES 65536u /* what a root can tell */

static uint16_t roots[27], bases[27], buckets[257];
static uint8_t leaves[65536 + 256], labels[2 * 256], trees[TREES + 65536], patches[65536 + 64];
static const char phonemes[] = "SIL\0AA\0B";

int prove_words(void)
{
    static labial_words_model_t tables = { .roots = roots,
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
    tables.multiplier = any_uint32;
    tables.phoneme_count = (uint8_t)Frama_C_interval(0, 3);
    labial_words_spell(&tables, letters, (unsigned)Frama_C_interval(1, LABIAL_WORDS_LETTERS), &word);
    any_int = labial_words_label(OR_NULL(labial_words_model_t *, &tables), any_unsigned)[0];
    return 0;
}

#define BYTES 64

int prove_words_characters(void)
{
    static unsigned char text[BYTES];
    labial_words_place_t here;
    FILL(text);
    labial_words_place(&here, (const char *)text, (size_t)Frama_C_interval(0, BYTES), any_size);
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

/* ---- Words in time ----------------------------------------------------------------------------------------------- */

/* Any texts, times and calls in any order, in streams of any offset; with words_characters.c, which tells how texts
 * end, and stand-ins for words_text.c, of whose words nothing is assumed but their number of phonemes. */

#define PHONEMES 256 /* what a byte can tell */

static labial_words_t stream;
static uint8_t milliseconds[PHONEMES], classes[PHONEMES];
static labial_words_model_t model = { .milliseconds = milliseconds, .classes = classes };

static labial_word_t any_word;

int labial_words_read_next(const labial_words_model_t *any, const labial_words_own_t *own,
                           labial_words_context_t *context, const char *text, size_t size, labial_word_t *word)
{
    FILL(*context);
    *word = any_word;
    return LABIAL_OK;
}

/* Any state that calls leave behind: no word has more phonemes than there is room for. */
static void any_state(const labial_words_own_t *own)
{
    unsigned k;
    FILL(stream);
    stream.model = OR_NULL(labial_words_model_t *, &model);
    stream.own = OR_NULL(labial_words_own_t *, own);
    stream.held = (uint8_t)Frama_C_interval(0, 1);
    for (k = 0; k < 2; k++)
        stream.spans[k].word.count = (uint8_t)Frama_C_interval(0, LABIAL_WORDS_PHONEMES);
}

int prove_words_time(void)
{
    static labial_words_own_t own;
    static uint32_t ends[LABIAL_WORDS_CHARACTERS];
    static char text[8];
    size_t size = (size_t)Frama_C_interval(0, sizeof text);
    labial_words_t *any;
    unsigned phoneme;
    uint32_t lasts;
    any_int = prove_words_characters(); /* all of that file is called */
    FILL(milliseconds);
    FILL(classes);
    FILL(model.filler);
    model.format = any_uint16;
    FILL(any_word);
    any_word.count = (uint8_t)Frama_C_interval(0, LABIAL_WORDS_PHONEMES);
    labial_words_length(OR_NULL(labial_words_model_t *, &model), OR_NULL(labial_word_t *, &any_word));
    FILL(ends);
    FILL(text);
    any = OR_NULL(labial_words_t *, &stream);
    any_state(&own);
    switch (Frama_C_interval(0, 8)) {
    case 0:
        labial_words_init(any, OR_NULL(labial_words_model_t *, &model), OR_NULL(labial_words_own_t *, &own), any_int32);
        break;
    case 1:
        labial_words_pronounce(any, OR_NULL(labial_words_own_t *, &own));
        break;
    case 2:
        labial_words_push(any, OR_NULL(char *, text), size, any_uint32, any_uint32);
        break;
    case 3:
        labial_words_push_characters(any, OR_NULL(char *, text), size, any_uint32, OR_NULL(uint32_t *, ends),
                                     any_unsigned);
        break;
    case 4:
        labial_words_end(any);
        break;
    case 5:
        labial_words_cancel(any);
        break;
    case 6:
        labial_words_restart(any);
        break;
    case 7:
        labial_words_latency(any);
        break;
    default:
        labial_words_next(any, OR_NULL(unsigned *, &phoneme), OR_NULL(uint32_t *, &lasts));
    }
    return 0;
}
