/*
 * result.c - a description of each result (labial/result.h).
 */
#include "labial/result.h"

const char *labial_result_text(int result)
{
    switch (result) {
#define LABIAL_RESULT_TEXT(name, value, text)                                                                          \
    case value:                                                                                                        \
        return text;
        LABIAL_RESULTS(LABIAL_RESULT_TEXT)
#undef LABIAL_RESULT_TEXT
    default:
        return "unknown result";
    }
}
