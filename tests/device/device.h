/*
 * device.h - what the suites of the device tests share: the memory under test, and their entries.
 */
#ifndef DEVICE_H
#define DEVICE_H

#include "board.h" /* before cmocka.h, which then writes to the board */
#include "player.h"

#include <cmocka.h>

#define DEVICE_WORKSPACE CONFORMANCE_WORKSPACE

/* The only stream and workspace of the tests, the latter exactly as large as is demanded, each between canaries. */
#define DEVICE_CANARIES 4
typedef struct {
    uint32_t before[DEVICE_CANARIES];
    labial_t stream;
    uint32_t between[DEVICE_CANARIES];
    uint32_t workspace[DEVICE_WORKSPACE / 4];
    uint32_t after[DEVICE_CANARIES];
} device_memory_t;

extern device_memory_t device_memory;

/* Fills everything with a pattern; says whether the canaries are as they were left by that. */
void device_memory_fill(void);
int device_memory_is_whole(void);

/* The stream of vectors.c with that name; the test fails if there is none. */
const conformance_stream_t *device_stream(const char *name);

/* Fails the test and says of what, where something does not hold. */
void device_require(int holds, const char *what);

/* The suites, each in a file of its name. Return how many tests failed. */
int test_arithmetic(void);
int test_memory(void);
int test_ticks(void);

/* A test, and its entry in a suite: setup and teardown see to it that it stays within its memory. */
#define TEST(name) static void name(void **state __attribute__((unused)))
#define DEVICE_TEST(function) cmocka_unit_test_setup_teardown(function, device_setup, device_teardown)
int device_setup(void **state);
int device_teardown(void **state);

#endif
