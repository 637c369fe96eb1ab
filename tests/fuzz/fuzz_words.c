/*
 * fuzz_words.c - any bytes as words and times (labial/words.h). The first byte is the stream's offset; each word begins
 * with four bytes: its length, how long after the beginning of the word before it begins, how long it lasts, and whether
 * its end or the ends of its characters are told.
 */
#include "fuzz.h"

#include "labial/labial.h"
#include "labial/words.h"
#include "words_en.h"

/* Takes all phonemes; returns by how much the time went on. */
static uint64_t take_all(labial_words_t *words)
{
    unsigned phoneme;
    uint32_t milliseconds;
    uint64_t sum = 0;
    int result;
    while ((result = labial_words_next(words, &phoneme, &milliseconds)) == LABIAL_OK) {
        REQUIRE(phoneme < words_en.phoneme_count && milliseconds > 0 && milliseconds <= LABIAL_DURATION_MAX);
        sum += milliseconds;
    }
    REQUIRE(result == LABIAL_WAITING || result == LABIAL_DONE);
    return sum;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t sounds[] = { 15, 34, 255 };
    static const labial_words_entry_t entry = { "go", sounds, sizeof sounds };
    static const labial_words_own_t own = { &entry, 1 };
    labial_words_t words;
    labial_words_context_t context;
    unsigned before = 0;
    uint32_t start = 0;
    uint64_t sum = 0;
    const int32_t offset = size > 0 ? (int8_t)data[0] : 0;
    memset(&context, 0, sizeof context);
    REQUIRE(labial_words_init(&words, &words_en, &own, offset) == LABIAL_OK);
    data += size > 0;
    size -= size > 0;
    while (size >= 4) {
        const size_t length = data[0] < size - 4 ? data[0] : size - 4;
        const uint32_t lasts = data[2] * 8u, kind = data[3] % 3u;
        char *text = (char *)copy_of(data + 4, length);
        labial_word_t word;
        int result;
        start += data[1] * 8u;
        REQUIRE(labial_words_read_next(&words_en, &own, &context, text, length, &word) == LABIAL_OK);
        REQUIRE(context.dropped == 0 || context.dropped < before);
        before = word.count > 0 ? word.count : before;
        REQUIRE(word.count <= LABIAL_WORDS_PHONEMES && word.characters <= length);
        REQUIRE((word.kind == LABIAL_WORDS_READ) == (word.count > 0));
        if (kind == 2 && word.characters > 0) {
            uint32_t ends[LABIAL_WORDS_CHARACTERS];
            unsigned i;
            for (i = 0; i < word.characters; i++)
                ends[i] = start + lasts * (i + 1u) * (data[3] % 7u + i) / (word.characters * (word.characters + 6u));
            result = labial_words_push_characters(&words, text, length, start, ends, word.characters);
        } else {
            result = labial_words_push(&words, text, length, start, kind == 0 ? LABIAL_WORDS_NO_END : start + lasts);
        }
        REQUIRE(result == LABIAL_OK);
        free(text);
        sum += take_all(&words);
        REQUIRE((int64_t)sum <= (int64_t)start + (offset > 0 ? offset : 0));
        data += 4 + length;
        size -= 4 + length;
    }
    REQUIRE((offset & 1 ? labial_words_cancel(&words) : labial_words_end(&words)) == LABIAL_OK);
    REQUIRE(take_all(&words) == 0 || !(offset & 1));
    REQUIRE(labial_words_next(&words, &(unsigned){ 0 }, &(uint32_t){ 0 }) == LABIAL_DONE);
    REQUIRE(labial_words_latency(&words).milliseconds == 0 && labial_words_latency(&words).phonemes == 0);
    REQUIRE(labial_words_restart(&words) == LABIAL_OK);
    return 0;
}
