/*
 * words.c - a word's letters to phonemes: decision trees from the last letter to the first, and exceptions.
 * export/labial/words/tables.py does the same with the trees as they were trained.
 */
#include "labial/words.h"

#include "labial/labial.h"
#include "words_parts.h"

/* The label of a place outside the word. */
#define NO_LABEL 63u

/* Mark beside a label's second phoneme. */
#define VOWEL_LAST 0x80u

/* Sets of letters, a bit for each number. */
#define LETTER(letter) ((uint32_t)1 << ((letter) - 'a' + 1))
#define FRONT_VOWELS (LETTER('e') | LETTER('i') | LETTER('y'))
#define VOWEL_LETTERS (FRONT_VOWELS | LETTER('a') | LETTER('o') | LETTER('u'))
#define SONORANTS (LETTER('l') | LETTER('r') | LETTER('m') | LETTER('n') | LETTER('w'))
#define CONSONANTS (0x07fffffeu & ~VOWEL_LETTERS)

/* A letter and its neighbourhood. */
typedef struct {
    const uint8_t *sounds; /* the tables' labels */
    const labial_words_letter_t *letters;
    const uint8_t *labels; /* of the letters behind `place` */
    unsigned count, place;
    unsigned left, right; /* groups of vowels beside it */
} view_t;

static unsigned has_vowel(const view_t *view, unsigned place)
{
    return (unsigned)(VOWEL_LETTERS >> view->letters[place].letter) & 1u;
}

/* Questions 0 to 255: a letter up to four places away. */
static unsigned asks_letter(const view_t *view, unsigned question)
{
    static const uint32_t sets[] = { VOWEL_LETTERS, FRONT_VOWELS, SONORANTS, CONSONANTS };
    const unsigned distance = (question >> 5 & 3u) + 1u, what = question & 31u;
    const unsigned other = question < 128u ? view->place - distance : view->place + distance;
    const unsigned letter = other < view->count ? view->letters[other].letter : 0u; /* before the first one it wraps */
    return what < 28u ? letter == what : (unsigned)(sets[what - 28u] >> letter) & 1u;
}

/* Questions 256 to 383: the label of one of the next two letters. */
static unsigned asks_label(const view_t *view, unsigned question)
{
    const unsigned next = view->place + 1u + ((question >> 6) & 1u), what = question & 63u;
    const unsigned label = next < view->count ? view->labels[next] : NO_LABEL;
    if (what < 60u || what == NO_LABEL)
        return label == what;
    if (label == NO_LABEL)
        return what == 62u;
    if (what == 62u)
        return label == 0u;
    if (what == 61u)
        return (view->sounds[2u * label + 1u] & ~VOWEL_LAST) != 0u;
    return view->sounds[2u * label + 1u] >= VOWEL_LAST;
}

/* Questions to 399 (export/labial/words/trees.py). */
static unsigned answer(const view_t *view, unsigned question)
{
    unsigned groups = view->left;
    if (question < 256u)
        return asks_letter(view, question);
    if (question < 384u)
        return asks_label(view, question);
    if (question < 392u)
        groups = view->right;
    return (groups < 7u ? groups : 7u) <= (question & 7u);
}

/* The leaf of a letter's tree, from its root on. */
static unsigned leaf_of(const view_t *view, const uint8_t *node)
{
    for (;;) {
        const unsigned head = (unsigned)node[0] << 8 | node[1];
        const unsigned kind = (head >> 5) & 3u, five = head & 31u, yes = answer(view, head >> 7);
        node += 2;
        if (kind == 0u)
            return yes ? five : *node;
        if (kind == 3u) {
            const unsigned length = five << 8 | *node++;
            node += yes ? 0u : length;
        } else if (yes == (kind == 1u)) {
            return five;
        }
    }
}

/* The label of a letter with an accent, which its leaves may have; else `none`. An e behind an acute one is silent. */
static unsigned accented(const labial_words_model_t *model, const labial_words_letter_t *letters, unsigned count,
                         unsigned place, unsigned none)
{
    const unsigned letter = letters[place].letter - 1u;
    unsigned sound = letters[place].sound, part, i;
    if (sound == 0u)
        return letter == 'e' - 'a' && place > 0u && letters[place - 1u].sound == PHONEME_EY ? 0u : none;
    if (sound == (PHONEME_EH | ACCENT_LAST))
        sound = place + 1u >= count || letters[place + 1u].letter == 27u ? PHONEME_IY : PHONEME_EH;
    part = letter - letter / 26u; /* the apostrophe, which has no accents, is the last */
    for (i = model->bases[part]; i < model->bases[part + 1u]; i++) {
        const uint8_t *const label = model->labels + 2u * model->leaves[i];
        if (((label[0] ^ sound) | (label[1] & ~VOWEL_LAST)) == 0u)
            return model->leaves[i];
    }
    return none;
}

/* Changes labels where the word is an exception. */
static void patch(const labial_words_model_t *model, const labial_words_letter_t *letters, unsigned count,
                  uint8_t *labels)
{
    const uint8_t *entry, *end;
    uint32_t hash = 2166136261u;
    unsigned i;
    for (i = 0; i < count; i++)
        hash = (hash ^ letters[i].letter) * 16777619u;
    hash *= model->multiplier;
    entry = model->patches + model->buckets[hash >> 24];
    end = model->patches + model->buckets[(hash >> 24) + 1u];
    while (entry < end) {
        const unsigned is_word = ((unsigned)entry[0] << 8 | entry[1]) == ((hash >> 8) & 0xffffu);
        unsigned change;
        do {
            entry += 2;
            change = (unsigned)entry[0] << 8 | entry[1];
            if (is_word && (change & 31u) < count) /* another word may have the same hash */
                labels[change & 31u] = (uint8_t)((change >> 5) & 63u);
        } while (change < 0x8000u);
        entry += 2;
    }
}

void labial_words_append(labial_word_t *word, unsigned phoneme, unsigned character, unsigned first)
{
    labial_words_phoneme_t *added;
    if (word->count >= LABIAL_WORDS_PHONEMES)
        return;
    added = &word->phonemes[word->count++];
    added->phoneme = (uint8_t)phoneme;
    added->character = (uint8_t)character;
    added->first = (uint8_t)first;
}

void labial_words_spell(const labial_words_model_t *model, const labial_words_letter_t *letters, unsigned count,
                        labial_word_t *word)
{
    uint8_t labels[LABIAL_WORDS_LETTERS] = { 0 };
    view_t view = { model->labels, letters, labels, count, 0, 0, 0 };
    unsigned place, first = 1, is_accented = 0, k;
    for (place = 0; place < count; place++) { /* a group begins where the letter before is no vowel */
        view.left += has_vowel(&view, place) && (place == 0u || !has_vowel(&view, place - 1u));
        is_accented |= letters[place].sound;
    }
    for (place = count; place > 0u;) {
        const unsigned letter = letters[--place].letter - 1u;
        view.place = place;
        view.left -= has_vowel(&view, place) && (place == 0u || !has_vowel(&view, place - 1u));
        if (place + 1u < count && has_vowel(&view, place + 1u))
            view.right += place + 2u >= count || !has_vowel(&view, place + 2u);
        if (is_accented) {
            const unsigned label = accented(model, letters, count, place, NO_LABEL);
            labels[place] = (uint8_t)label;
            if (label != NO_LABEL)
                continue;
        }
        labels[place] = model->leaves[model->bases[letter] + leaf_of(&view, model->trees + model->roots[letter])];
    }
    if (!is_accented)
        patch(model, letters, count, labels);
    for (place = 0; place < count; place++)
        for (k = 0; k < 2u; k++) {
            const unsigned phoneme = model->labels[2u * labels[place] + k] & ~VOWEL_LAST;
            if (phoneme == 0u)
                continue;
            labial_words_append(word, phoneme, letters[place].character, first);
            first = 0;
        }
}

const char *labial_words_label(const labial_words_model_t *model, unsigned phoneme)
{
    const char *label;
    if (!model || phoneme >= model->phoneme_count)
        return "";
    for (label = model->phonemes; phoneme > 0u; label++)
        phoneme -= *label == '\0';
    return label;
}
