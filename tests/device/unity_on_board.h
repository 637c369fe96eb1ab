/*
 * unity_on_board.h - how the device tests use Unity: integers only, text through board.h, and nothing of a C library.
 * It is included before all else (-include). A framework's Unity has a configuration of its own, a file called
 * unity_config.h; this one must not be found in its place.
 */
#ifndef UNITY_ON_BOARD_H
#define UNITY_ON_BOARD_H

#include "board.h"

#define UNITY_OUTPUT_CHAR(character) board_put((char)(character))

/* Without setjmp() a test goes on after an assertion that failed; it still counts as a failure. */
#define UNITY_EXCLUDE_SETJMP_H
#define UNITY_EXCLUDE_MATH_H
#define UNITY_EXCLUDE_FLOAT
#define UNITY_EXCLUDE_DOUBLE

#if !__STDC_HOSTED__
#define UNITY_EXCLUDE_LIMITS_H
#define UNITY_INT_WIDTH 32
#define UNITY_LONG_WIDTH 32
#define UNITY_POINTER_WIDTH 32
#endif

#endif
