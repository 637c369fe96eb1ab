/*
 * random_calls.c - runs tests/fuzz/fuzz_stream.c on bytes by chance, for builds that have no fuzzer: the same bytes on
 * every machine. What is wrong ends the program.
 */
#include "fixture.h"
#include "fuzz.h"

#define INPUTS 600
#define LONGEST 600 /* bytes */

int main(void)
{
    fixture_random_t random = { 1 };
    unsigned i;
    for (i = 0; i < INPUTS; i++) {
        const size_t size = 1u + fixture_below(&random, LONGEST);
        uint8_t *const bytes = (uint8_t *)malloc(size); /* so that reading beyond them is seen */
        size_t at;
        REQUIRE(bytes);
        for (at = 0; at < size; at++)
            bytes[at] = (uint8_t)fixture_random(&random);
        REQUIRE(LLVMFuzzerTestOneInput(bytes, size) == 0);
        free(bytes);
    }
    return 0;
}
