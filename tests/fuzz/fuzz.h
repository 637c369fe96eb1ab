/*
 * fuzz.h - what every fuzz target has: libFuzzer's entry, and the condition whose failure is a finding.
 */
#ifndef LABIAL_TEST_FUZZ_H
#define LABIAL_TEST_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            abort();                                                                                                   \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
