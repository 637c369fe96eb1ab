/*
 * fuzz_timings.c - any text as phoneme timings, in every format: libFuzzer's bytes are the file.
 *
 * Beyond what AddressSanitizer sees: labels are short texts, times are within their limit and follow each other, laughs
 * have an intensity in range, an error has a message and a line and is the last that happens, and the text gives the same
 * timings whole as byte by byte. Labels are looked up in the names of the speech model.
 */
#include "fuzz.h"
#include "labial/labial.h"
#include "labial/laugh.h"
#include "labial/timings.h"
#include "speech_en.h"

static void check(const labial_timing_t *timing, uint64_t before, size_t size, size_t piece)
{
    size_t i;
    REQUIRE(timing->start <= timing->end && timing->end <= LABIAL_TIMINGS_TIME_MAX);
    REQUIRE(timing->start + LABIAL_TIMINGS_TOLERANCE >= before);
    REQUIRE(timing->laugh >= -1 && timing->laugh <= (int)LABIAL_LAUGH_FULL);
    REQUIRE(timing->xsampa <= 1 && timing->line >= 1 && timing->line <= size + 1);
    if (timing->has_apex)
        REQUIRE(timing->apex + LABIAL_TIMINGS_TOLERANCE >= timing->start &&
                timing->apex <= timing->end + LABIAL_TIMINGS_TOLERANCE);
    if (timing->word)
        REQUIRE(timing->word[0] != '\0' && strlen(timing->word) <= LABIAL_TIMINGS_FIELD_MAX);
    if (timing->label) {
        for (i = 0; timing->label[i]; i++)
            REQUIRE((unsigned char)timing->label[i] >= 0x20 && timing->label[i] != 0x7f);
        REQUIRE(i > 0 && i <= LABIAL_TIMINGS_LABEL_MAX);
        if (piece == 7) /* once */
            look_up(&speech_en_names, timing->label, i);
    }
}

/* Gives the text in pieces of so many bytes. Returns a sum over the timings and the error. */
static uint64_t parse(const uint8_t *data, size_t size, labial_timings_format_t format, const char *tier,
                      uint32_t number, size_t piece)
{
    labial_timings_t *timings = (labial_timings_t *)memory_of(sizeof *timings);
    labial_timing_t timing;
    uint64_t sum = 0, before = 0;
    size_t used;
    int result = LABIAL_STARVED, readings = 0;
    labial_timings_init(timings, format);
    REQUIRE(labial_timings_tier(timings, tier, number) == LABIAL_OK);
    while (result == LABIAL_STARVED) {
        REQUIRE(readings++ < 2);
        result = LABIAL_WAITING;
        for (size_t at = 0; result >= 0 && (at < size || result != LABIAL_DONE);) {
            if (at < size) {
                const size_t left = size - at < piece ? size - at : piece;
                result = labial_timings_next(timings, (const char *)data + at, left, &used, &timing);
                REQUIRE(used > 0 && used <= left && (result == LABIAL_OK || used == left || result < 0));
                at += used;
            } else if ((result = labial_timings_end(timings, &timing)) == LABIAL_STARVED) {
                break;
            }
            if (result == LABIAL_OK) {
                check(&timing, before, size, piece);
                before = timing.end > before ? timing.end : before;
                sum = sum * 31u + timing.end + (timing.label ? (unsigned char)timing.label[0] : 0u);
            }
        }
    }
    REQUIRE(result == LABIAL_DONE || result == LABIAL_ERROR_TIMINGS);
    REQUIRE((labial_timings_message(timings)[0] != '\0') == (result < 0));
    REQUIRE(memchr(timings->message, 0, sizeof timings->message) && !strpbrk(timings->message, "\r\n"));
    REQUIRE(timings->line >= 1 && timings->line <= size + 2);
    sum = sum * 31u + (result < 0 ? timings->line : 0u);
    if (result < 0)
        REQUIRE(labial_timings_next(timings, "0", 1, &used, &timing) == result &&
                labial_timings_end(timings, &timing) == result);
    free(timings);
    return sum;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    for (unsigned i = 0; labial_timings_format_name(i); i++) {
        const labial_timings_format_t format = (labial_timings_format_t)i;
        REQUIRE(parse(data, size, format, NULL, 0, 1) == parse(data, size, format, NULL, 0, size));
    }
    parse(data, size, LABIAL_TIMINGS_AUTO, "words", 0, 7);
    parse(data, size, LABIAL_TIMINGS_AUTO, NULL, 2, 7);
    return 0;
}
