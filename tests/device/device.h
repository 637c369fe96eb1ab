/*
 * device.h - what the files of the device tests share: the memory under test.
 */
#ifndef DEVICE_H
#define DEVICE_H

#include "board.h"
#include "messages.h"
#include "player.h"

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

#define ASSERT_RESULT(wanted, result) TEST_ASSERT_EQUAL_INT32(wanted, result)

/* Runs all device tests; returns 1 if one of them failed, else 0. */
int device_tests(void);

/* The tests of a file of this name, each run by RUN_TEST. */
void test_arithmetic(void);
void test_memory(void);

#endif
