/*
 * test_result.c - the sentences for results, in step with the enumeration.
 */
#include "suite.h"

#include <limits.h>
#include <string.h>

#include "labial/result.h"

#define UNKNOWN "unknown result"

static const int codes[] = {
    LABIAL_OK,           LABIAL_WAITING,       LABIAL_STARVED,        LABIAL_DONE,          LABIAL_CANCELLED,
    LABIAL_NEW_SESSION,  LABIAL_ERROR_NULL,    LABIAL_ERROR_VERSION,  LABIAL_ERROR_MODEL,   LABIAL_ERROR_WORKSPACE,
    LABIAL_ERROR_STATE,  LABIAL_ERROR_PHONEME, LABIAL_ERROR_DURATION, LABIAL_ERROR_FULL,    LABIAL_ERROR_FRAME_RATE,
    LABIAL_ERROR_MODELS, LABIAL_ERROR_NAME,    LABIAL_ERROR_RIG,      LABIAL_ERROR_TIMINGS, LABIAL_ERROR_SAMPLE_RATE,
    LABIAL_ERROR_WORD,   LABIAL_ERROR_RANGE,   LABIAL_ERROR_PACKET
};

#define CODES (sizeof codes / sizeof codes[0])

/* Would catch a renumbering, which breaks programs linked against an older library. */
TEST(zero_is_success_and_errors_are_negative)
{
    assert_int_equal(LABIAL_OK, 0);
    for (unsigned i = 1; i < 6; i++)
        assert_int_equal(codes[i], (int)i);
    for (unsigned i = 6; i < CODES; i++)
        assert_int_equal(codes[i], 5 - (int)i);
    assert_int_equal(LABIAL_RESULT_LAST_, codes[CODES - 1]);
}

/* Would catch a text of the wrong row, and two codes with one text. */
TEST(every_code_has_its_own_text)
{
    for (unsigned i = 0; i < CODES; i++) {
        const char *text = labial_result_text(codes[i]);
        assert_non_null(text);
        assert_true(strlen(text) > 0);
        assert_string_not_equal(text, UNKNOWN);
        for (unsigned k = 0; k < i; k++)
            assert_string_not_equal(text, labial_result_text(codes[k]));
    }
    assert_string_equal(labial_result_text(LABIAL_OK), "success");
    assert_string_equal(labial_result_text(LABIAL_DONE), "the stream has ended and every frame was delivered");
    assert_string_equal(labial_result_text(LABIAL_ERROR_NAME), "no phoneme of this name is known");
}

TEST(other_numbers_are_unknown)
{
    static const int others[] = { 6, 7, 8, 255, -18, -19, 1000, -1000, INT_MAX, INT_MIN, INT_MIN + 1 };
    for (unsigned i = 0; i < sizeof others / sizeof others[0]; i++)
        assert_string_equal(labial_result_text(others[i]), UNKNOWN);
}

SUITE(NULL, NULL)
