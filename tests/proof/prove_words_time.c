/*
 * Any texts, times and calls in any order, in streams of any offset; with stand-ins for words_text.c, of whose words
 * nothing is assumed but their number of phonemes.
 */
#include "labial/words.h"

#include "prove.h"
#include "words_parts.h"

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

void labial_words_advance(labial_words_place_t *here)
{
    //@ assert at_byte: here->at < here->size;
    here->code = any_unsigned;
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

int main(void)
{
    static labial_words_own_t own;
    static uint32_t ends[LABIAL_WORDS_CHARACTERS];
    static char text[8];
    size_t size = (size_t)Frama_C_interval(0, sizeof text);
    labial_words_t *any;
    unsigned phoneme;
    uint32_t lasts;
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
