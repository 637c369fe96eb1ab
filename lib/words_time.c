/*
 * words_time.c - words in time: what share of its word's time a phoneme gets, and the stream of words.
 * export/labial/words/times.py is the reference.
 */
#include "labial/words.h"

#include <string.h>

#include "fixed.h"
#include "labial/labial.h"
#include "words_parts.h"

#define VOWEL 1u
#define VOICELESS 2u
#define NONE 4u /* no phoneme */

/* A word of unknown end takes all of the time to the next one if that is at most this share of what it usually
 * lasts, in quarters. */
#define STRETCHED 6u

/* Unknown words: about how long each phoneme lasts, milliseconds. */
#define FILLER 150u

/* Characters are of equal length if the standard deviation is below 2/25 of the mean. */
#define EQUAL 25u
#define EQUAL_TO 2u

/* Factors in 1/256: of vowels - in words of one syllable, of three or more, in the last and the first syllable, before
 * a voiceless consonant, before a vowel, at the end of the word, in the last syllable before a pause - and of
 * consonants - the first, the last, after another, before another, behind the last vowel before a pause, between
 * vowels. */
#define FACTORS 8u
static const uint16_t vowel_factors[FACTORS] = { 269, 271, 259, 259, 259, 300, 259, 415 };
static const uint16_t consonant_factors[FACTORS] = { 302, 266, 218, 251, 410, 294, 256, 256 };

/* ---- Weights ---------------------------------------------------------------------------------------------------- */

static unsigned class_of(const labial_words_model_t *model, const labial_word_t *word, unsigned place)
{
    return model->classes[word->phonemes[place].phoneme];
}

uint32_t labial_words_weight(const labial_words_model_t *model, const labial_word_t *word, unsigned place,
                             unsigned pause)
{
    const unsigned own = class_of(model, word, place);
    unsigned first = place, end = place + 1u, before = NONE, after = NONE, vowel_count = 0, vowels_left = 0,
             vowels_right = 0;
    unsigned holds, i;
    const uint16_t *factor = consonant_factors;
    uint32_t weight = 64u * model->milliseconds[word->phonemes[place].phoneme];
    while (first > 0u && !word->phonemes[first].first)
        first--;
    while (end < word->count && !word->phonemes[end].first)
        end++;
    for (i = first; i < end; i++) {
        const unsigned is_vowel = class_of(model, word, i) == VOWEL;
        vowel_count += is_vowel;
        vowels_left += is_vowel && i < place;
        vowels_right += is_vowel && i > place;
    }
    if (place > first)
        before = class_of(model, word, place - 1u);
    if (place + 1u < end)
        after = class_of(model, word, place + 1u);
    pause = pause && end == word->count && vowels_right == 0u;
    if (own == VOWEL) {
        holds = (unsigned)(vowel_count == 1u) | (unsigned)(vowel_count >= 3u) << 1 |
                (unsigned)(vowels_right == 0u) << 2 | (unsigned)(vowels_left == 0u) << 3 |
                (unsigned)(after == VOICELESS) << 4 | (unsigned)(after == VOWEL) << 5 | (unsigned)(after == NONE) << 6 |
                pause << 7;
        factor = vowel_factors;
    } else {
        holds = (unsigned)(before == NONE) | (unsigned)(after == NONE) << 1 |
                (unsigned)(before != NONE && before != VOWEL) << 2 | (unsigned)(after != NONE && after != VOWEL) << 3 |
                pause << 4 | (unsigned)(before == VOWEL && after == VOWEL) << 5;
    }
    for (i = 0; i < FACTORS; i++)
        if (holds >> i & 1u)
            weight = (weight * factor[i]) >> 8;
    return weight;
}

/* The weights of all phonemes from `first` to before `end`. */
static uint32_t weigh_words(const labial_words_model_t *model, const labial_word_t *word, unsigned first, unsigned end,
                            unsigned pause)
{
    uint32_t sum = 0;
    for (; first < end; first++)
        sum += labial_words_weight(model, word, first, pause);
    return sum;
}

uint32_t labial_words_length(const labial_words_model_t *model, const labial_word_t *word)
{
    if (!model || !word)
        return 0;
    return (weigh_words(model, word, 0, word->count, 0) + 32u) / 64u;
}

/* value * part / whole, rounded; part <= whole; 0 of nothing. */
static uint32_t portion(uint32_t value, uint32_t part, uint32_t whole)
{
    return whole == 0u ? 0u : (uint32_t)(((uint64_t)value * part + whole / 2u) / whole);
}

/* ---- Characters ------------------------------------------------------------------------------------------------- */

/* Whether all characters are about equally long. */
static int are_equal(uint32_t start, const uint32_t *ends, unsigned count)
{
    const uint64_t sum = ends[count - 1u] - start;
    uint64_t squares = 0;
    unsigned i;
    for (i = 0; i < count; i++) {
        const uint64_t length = ends[i] - (i > 0u ? ends[i - 1u] : start);
        squares += length * length;
    }
    return EQUAL * EQUAL * (count * squares - sum * sum) < EQUAL_TO * EQUAL_TO * sum * sum;
}

/* Where the characters of each phoneme end: those of a character share its time, and characters without a phoneme
 * belong to the one before. */
static void reach_characters(const labial_words_model_t *model, struct labial_words_span *span, const uint32_t *ends)
{
    const labial_word_t *const word = &span->word;
    uint32_t begin = 0;
    unsigned first = 0, end, i;
    for (; first < word->count; first = end) {
        uint32_t until = span->end - span->start, whole, part = 0;
        for (end = first + 1u; end < word->count && word->phonemes[end].character == word->phonemes[first].character;)
            end++;
        if (end < word->count) {
            const unsigned character = word->phonemes[end].character;
            /* Behind that of the phoneme before. */
            /*@ assert character > 0; */
            LABIAL_CHECK(character > 0u);
            until = ends[character - 1u] - span->start;
        }
        whole = weigh_words(model, word, first, end, 0);
        for (i = first; i < end; i++) {
            uint32_t reach;
            part += labial_words_weight(model, word, i, 0);
            reach = begin + portion(until - begin, part, whole);
            span->reach[i] = (uint16_t)(reach < 0xffffu ? reach : 0xffffu);
        }
        begin = until;
    }
}

/* ---- The stream ------------------------------------------------------------------------------------------------- */

int labial_words_init(labial_words_t *stream, const labial_words_model_t *model, const labial_words_own_t *own,
                      int32_t offset)
{
    if (!stream)
        return LABIAL_ERROR_NULL;
    memset(stream, 0, sizeof *stream);
    if (!model)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_WORDS_FORMAT)
        return LABIAL_ERROR_VERSION;
    stream->model = model;
    stream->own = own;
    stream->offset = offset;
    return LABIAL_OK;
}

/* LABIAL_OK for a stream that was prepared, else the error that every call on it returns. */
static int words_status(const labial_words_t *stream)
{
    return !stream ? LABIAL_ERROR_NULL : stream->model ? LABIAL_OK : LABIAL_ERROR_STATE;
}

int labial_words_pronounce(labial_words_t *stream, const labial_words_own_t *own)
{
    const int result = words_status(stream);
    if (result == LABIAL_OK)
        stream->own = own;
    return result;
}

/* A time of the voice with the offset, from 0 to the latest one. */
static uint32_t shifted(const labial_words_t *stream, uint32_t time)
{
    const int64_t moved = (int64_t)time + stream->offset;
    return moved < 0 ? 0u : moved > 0xffffffff ? 0xffffffffu : (uint32_t)moved;
}

/* The last character of a text, as the rules see it; `size` becomes what is before it. */
static unsigned last_character(const char *text, size_t *size)
{
    labial_words_place_t here;
    size_t at = *size - 1u;
    unsigned code = (unsigned char)text[at];
    if (code >= 0x80u) {
        while (at > 0u && ((unsigned char)text[at] & 0xc0u) == 0x80u)
            at--;
        labial_words_place(&here, text, *size, at);
        code = here.code;
    }
    *size = at;
    return code;
}

/* Whether a text ends in punctuation behind which voices pause, of any script whose punctuation is known; quotes,
 * brackets and signs that are not read may follow it. */
static int ends_in_punctuation(const char *text, size_t size)
{
    while (size > 0u) {
        switch (last_character(text, &size)) {
        case '"':
        case '\'':
        case ')':
        case ']':
        case ' ':
        case NO_CHARACTER:
            break;
        case ',':
        case '.':
        case ';':
        case ':':
        case '?':
        case '!':
            return 1;
        default:
            return 0;
        }
    }
    return 0;
}

/* Begins with the word that waits, up to `limit`, where the next one begins. */
static void speak(labial_words_t *stream, uint32_t limit)
{
    const struct labial_words_span *const span = &stream->spans[stream->held];
    const labial_word_t *const word = &span->word;
    const uint32_t room = limit - span->start;
    uint32_t end = span->end;
    if (span->open) {
        const uint32_t usual = word->kind == LABIAL_WORDS_READ ? labial_words_length(stream->model, word) : 2u * FILLER;
        end = room <= usual / 4u * STRETCHED ? limit : span->start + usual;
    }
    if (end > limit || limit - end < (span->stops ? LABIAL_WORDS_COMMA : LABIAL_WORDS_PAUSE))
        end = limit;
    stream->holding = 0;
    stream->held ^= 1u;
    stream->speaking = 1;
    stream->paused = end < limit;
    stream->start = shifted(stream, span->start);
    if (stream->start < stream->time)
        stream->start = stream->time;
    stream->until = shifted(stream, end);
    if (stream->until < stream->start)
        stream->until = stream->start;
    stream->place = 0;
    stream->reached = 0;
    if (word->kind == LABIAL_WORDS_READ)
        stream->weight = weigh_words(stream->model, word, 0, word->count, stream->paused);
    else /* FILLER milliseconds each, more or less */
        stream->weight = 1u + (stream->until - stream->start) / (FILLER + FILLER / 2u);
}

/* Takes a word; with the ends of its characters unless `ends` is null. */
static int take(labial_words_t *stream, const char *text, size_t size, uint32_t start, uint32_t end,
                const uint32_t *ends, unsigned count)
{
    struct labial_words_span *span, *before;
    labial_words_context_t context;
    if (!stream || !text)
        return LABIAL_ERROR_NULL;
    if (!stream->model || stream->ended)
        return LABIAL_ERROR_STATE;
    if (end < start || start < stream->latest)
        return LABIAL_ERROR_WORD;
    if (end != LABIAL_WORDS_NO_END && end - start > LABIAL_DURATION_MAX)
        return LABIAL_ERROR_DURATION;
    if (stream->speaking)
        return LABIAL_ERROR_FULL;
    before = &stream->spans[stream->held];
    span = &stream->spans[stream->held ^ 1u];
    context = stream->context;
    (void)labial_words_read_next(stream->model, stream->own, &context, text, size,
                                 &span->word); /* arguments are valid */
    if (ends && span->word.characters != count)
        return LABIAL_ERROR_WORD;
    stream->context = context;
    stream->latest = start;
    span->start = start;
    if (stream->holding && context.dropped > 0u && context.dropped >= before->word.count) {
        span->start = before->start; /* nothing of the word before is left: its time is this one's */
        stream->holding = 0;
    } else if (stream->holding) {
        const unsigned left = (unsigned)before->word.count - context.dropped;
        /*@ assert left <= 96; */
        LABIAL_CHECK(left <= LABIAL_WORDS_PHONEMES);
        before->word.count = (uint8_t)left;
    }
    if (span->word.kind == LABIAL_WORDS_SILENT) {
        before->stops |= (uint8_t)ends_in_punctuation(text, size);
        if (stream->holding && before->open && start > before->start) {
            before->end = start;
            before->open = 0;
        }
        return LABIAL_OK;
    }
    span->end = end;
    span->open = end == LABIAL_WORDS_NO_END || end == start;
    span->spelt = 0;
    span->stops = (uint8_t)ends_in_punctuation(text, size);
    if (ends && !span->open && !are_equal(start, ends, count)) {
        span->spelt = 1;
        reach_characters(stream->model, span, ends);
    }
    if (stream->holding)
        speak(stream, start);
    else
        stream->held ^= 1u;
    stream->holding = 1;
    return LABIAL_OK;
}

int labial_words_push(labial_words_t *stream, const char *text, size_t size, uint32_t start, uint32_t end)
{
    return take(stream, text, size, start, end, NULL, 0);
}

int labial_words_push_characters(labial_words_t *stream, const char *text, size_t size, uint32_t start,
                                 const uint32_t *ends, unsigned count)
{
    unsigned i;
    if (!ends)
        return LABIAL_ERROR_NULL;
    if (count == 0u || count > LABIAL_WORDS_CHARACTERS || ends[count - 1u] == LABIAL_WORDS_NO_END)
        return LABIAL_ERROR_WORD;
    for (i = 0; i < count; i++)
        if (ends[i] < (i > 0u ? ends[i - 1u] : start))
            return LABIAL_ERROR_WORD;
    return take(stream, text, size, start, ends[count - 1u], ends, count);
}

int labial_words_end(labial_words_t *stream)
{
    const int result = words_status(stream);
    if (result == LABIAL_OK) {
        stream->ended = 1;
        memset(&stream->context, 0, sizeof stream->context);
    }
    return result;
}

int labial_words_cancel(labial_words_t *stream)
{
    const int result = words_status(stream);
    if (result == LABIAL_OK) {
        stream->speaking = stream->holding = 0;
        stream->latest = 0;
        stream->ended = 1;
        memset(&stream->context, 0, sizeof stream->context);
    }
    return result;
}

int labial_words_restart(labial_words_t *stream)
{
    const int result = words_status(stream);
    if (result != LABIAL_OK)
        return result;
    if (!stream->ended || stream->holding || (stream->speaking && stream->reached < stream->weight))
        return LABIAL_ERROR_STATE;
    stream->speaking = stream->ended = 0;
    return LABIAL_OK;
}

labial_latency_t labial_words_latency(const labial_words_t *stream)
{
    labial_latency_t latency = { 0, 0, 0, 0, 0 };
    uint32_t end;
    if (words_status(stream) != LABIAL_OK)
        return latency;
    end = stream->time;
    if (stream->speaking) {
        const labial_word_t *const word = &stream->spans[stream->held ^ 1u].word;
        end = stream->until;
        latency.phonemes =
            word->kind == LABIAL_WORDS_READ ? (unsigned)word->count - stream->place : stream->weight - stream->reached;
    }
    if (stream->holding) {
        const struct labial_words_span *const span = &stream->spans[stream->held];
        end = shifted(stream, span->open ? span->start : span->end);
        latency.phonemes += span->word.count;
    }
    latency.milliseconds = end > stream->time ? end - stream->time : 0u;
    return latency;
}

/* The next phoneme of the word being spoken, and when it ends, from the word's beginning on; moves `reached` behind it. */
static uint32_t boundary(const labial_words_t *stream, uint32_t *reached, unsigned *phoneme)
{
    const struct labial_words_span *const span = &stream->spans[stream->held ^ 1u];
    const uint32_t length = stream->until - stream->start;
    const unsigned place = stream->place;
    uint32_t end;
    if (span->word.kind != LABIAL_WORDS_READ) {
        *phoneme = stream->model->filler[stream->reached & 1u];
        *reached = stream->reached + 1u;
        return portion(length, *reached, stream->weight);
    }
    /* With the last phoneme `reached` came to the word's weight. */
    /*@ assert place < 96; */
    LABIAL_CHECK(place < span->word.count);
    *phoneme = span->word.phonemes[place].phoneme;
    *reached = stream->reached + labial_words_weight(stream->model, &span->word, place, stream->paused);
    end = portion(length, *reached, stream->weight);
    if (span->spelt && *reached < stream->weight) {
        const uint32_t reach = span->reach[place];
        end = (end + (reach < length ? reach : length)) / 2u;
    }
    return end;
}

int labial_words_next(labial_words_t *stream, unsigned *phoneme, uint32_t *milliseconds)
{
    uint32_t end, reached = 0;
    if (!stream || !phoneme || !milliseconds)
        return LABIAL_ERROR_NULL;
    if (!stream->model)
        return LABIAL_ERROR_STATE;
    do {
        if (stream->speaking && stream->reached == stream->weight)
            stream->speaking = 0;
        if (!stream->speaking && stream->holding && stream->ended)
            speak(stream, 0xffffffffu);
        if (!stream->speaking)
            return stream->ended ? LABIAL_DONE : LABIAL_WAITING;
        reached = stream->reached;
        *phoneme = 0;
        end = stream->start;
        if (stream->time >= stream->start)
            end += boundary(stream, &reached, phoneme);
        if (end - stream->time > LABIAL_DURATION_MAX) {
            end = stream->time + LABIAL_DURATION_MAX;
        } else if (stream->time >= stream->start) {
            stream->reached = reached;
            stream->place++;
        }
        *milliseconds = end - stream->time;
        stream->time = end;
    } while (*milliseconds == 0u);
    return LABIAL_OK;
}
