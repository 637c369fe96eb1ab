/*
 * fuzz_timings.c - any text as phoneme timings, in every format: libFuzzer's bytes are the file.
 *
 * Beyond what AddressSanitizer sees: labels are short texts, durations are within their limit and add up to the time
 * that the parser has come to, laughs have an intensity in range, an error has a message and a line, and a sink that
 * stops the parser is the last that is called. Labels are looked up in the names of the speech model.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "labels.h"
#include "speech_en.h"
#include "timings.h"

#define STOPPED 7

typedef struct {
    uint64_t milliseconds;
    unsigned long phonemes, stop_at;
    const timings_t *timings;
} watch_t;

static int on_phoneme(void *user, const timings_phoneme_t *phoneme)
{
    watch_t *watch = (watch_t *)user;
    size_t i;
    REQUIRE(watch->phonemes != watch->stop_at);
    watch->phonemes++;
    REQUIRE(phoneme->milliseconds <= TIMINGS_DURATION_MAX);
    REQUIRE(phoneme->laugh >= -1 && phoneme->laugh <= TIMINGS_LAUGH_FULL);
    REQUIRE(phoneme->sampa == 0 || phoneme->sampa == 1);
    REQUIRE(watch->timings->line >= 1);
    watch->milliseconds += phoneme->milliseconds;
    if (phoneme->label) {
        REQUIRE(phoneme->laugh == -1);
        for (i = 0; phoneme->label[i]; i++)
            REQUIRE((unsigned char)phoneme->label[i] >= 0x20 && phoneme->label[i] != 0x7f);
        REQUIRE(i > 0 && i <= TIMINGS_LABEL_MAX);
        look_up(&speech_en_names, phoneme->label, i);
    }
    return watch->phonemes == watch->stop_at ? STOPPED : 0;
}

static void parse(const uint8_t *data, size_t size, timings_format_t format, const char *tier, unsigned long stop_at)
{
    timings_t *timings = (timings_t *)malloc(sizeof *timings);
    watch_t watch;
    int result = 0;
    size_t i;
    REQUIRE(timings);
    memset(&watch, 0, sizeof watch);
    watch.timings = timings;
    watch.stop_at = stop_at ? stop_at : (unsigned long)-1;
    timings_init(timings, format, tier, on_phoneme, &watch);
    for (i = 0; i < size && result == 0; i++)
        result = timings_put(timings, data[i]);
    if (result == 0)
        result = timings_end(timings);
    REQUIRE(result == 0 || result == TIMINGS_MALFORMED || (stop_at && result == STOPPED));
    REQUIRE(timings->line >= 1 && timings->line <= size + 1);
    if (result == TIMINGS_MALFORMED)
        REQUIRE(timings->message[0] != '\0' && memchr(timings->message, 0, sizeof timings->message) &&
                !strpbrk(timings->message, "\r\n"));
    REQUIRE(watch.milliseconds == (timings->end + 500u) / 1000u);
    REQUIRE(timings->end <= TIMINGS_TIME_MAX);
    timings_free(timings);
    free(timings);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const timings_format_t formats[] = { TIMINGS_AUTO, TIMINGS_FLITE, TIMINGS_LAB,   TIMINGS_HTK,
                                         TIMINGS_PHO,  TIMINGS_MARY,  TIMINGS_PHSEG, TIMINGS_TEXTGRID };
    unsigned i;
    for (i = 0; i < sizeof formats / sizeof formats[0]; i++)
        parse(data, size, formats[i], NULL, 0);
    parse(data, size, TIMINGS_AUTO, "words", 3);
    return 0;
}
