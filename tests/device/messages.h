/*
 * messages.h - Unity's comparisons of numbers with the expression that has the wrong value.
 */
#ifndef DEVICE_MESSAGES_H
#define DEVICE_MESSAGES_H

#include <unity.h>

#undef TEST_ASSERT_EQUAL_INT32
#undef TEST_ASSERT_EQUAL_UINT32
#undef TEST_ASSERT_EQUAL_HEX32
#define TEST_ASSERT_EQUAL_INT32(wanted, found) TEST_ASSERT_EQUAL_INT32_MESSAGE(wanted, found, #found)
#define TEST_ASSERT_EQUAL_UINT32(wanted, found) TEST_ASSERT_EQUAL_UINT32_MESSAGE(wanted, found, #found)
#define TEST_ASSERT_EQUAL_HEX32(wanted, found) TEST_ASSERT_EQUAL_HEX32_MESSAGE(wanted, found, #found)

#endif
