/*
 * labial/config.h - the library's limits. Each may be set for the whole build; library and program must agree on them.
 */
#ifndef LABIAL_CONFIG_H
#define LABIAL_CONFIG_H

#include <stdint.h>

/* 1 builds the published method to the letter (docs/method.md): each unit is searched and solved as a whole when its
 * last frame has come, and cross-faded with the next. LABIAL_WINDOW, LABIAL_LAG and LABIAL_SEARCHED have no effect
 * then. */
#ifndef LABIAL_PAPER
#define LABIAL_PAPER 0
#endif

/* How many frames ahead of the delivered ones the trajectory's backward pass starts, 1 .. 48. Each frame makes the
 * motion smoother and costs a frame of delay and 8 bytes of workspace in each channel. With the bundled models 3 frames
 * leave an error of .2 % of a channel's range (RMS); the stiffer models of the published method need 16 frames or more.
 * Where the delay is longer than LABIAL_REACH, all frames of labial_visemes() are silence. */
#ifndef LABIAL_WINDOW
#define LABIAL_WINDOW 3
#endif

/* How many frames after a step the search decides its state, if the unit does not end earlier, 0 .. 40. Each frame
 * makes the path more probable and costs a frame of delay, 32 bytes of workspace and 11 in each channel; with the
 * bundled models the difference is not visible. With a lag as long as the longest unit, the states of each unit are the
 * most probable path through it (Viterbi) among the states that LABIAL_SEARCHED allows. */
#ifndef LABIAL_LAG
#define LABIAL_LAG 0
#endif

/* States of a channel that a step of the search considers, 2 .. 64: those around the state whose mean is nearest to the
 * target. With all states of a model, the search considers every path. Each costs a byte of workspace in each channel,
 * LABIAL_LAG bytes more with a lag, and its share of the search's time. */
#ifndef LABIAL_SEARCHED
#define LABIAL_SEARCHED 8
#endif

/* Phonemes that the queue has room for: how far ahead a program can push, LABIAL_REACH + 2 .. 255. Each costs 8 bytes
 * of the stream. Within these limits no sequence of pushes can stall the stream. */
#ifndef LABIAL_QUEUE
#define LABIAL_QUEUE 32
#endif

/* Distance of the farthest tap of a model's kernels from the frame, in frames to either side, 0 .. 60. Each frame
 * costs 2 bytes of the stream. A generated model that needs more does not compile, and a blob that needs more is
 * refused. */
#ifndef LABIAL_REACH
#define LABIAL_REACH 20
#endif

/* Models whose phonemes can be in a stream at the same time, 1 .. 255. Another model can replace a model when all
 * frames of its phonemes have been delivered. */
#ifndef LABIAL_MODELS
#define LABIAL_MODELS 2
#endif

/* Which calls on a stream take the lock that the program provides as labial_lock() and labial_unlock() (labial.h):
 * 0: none, no two calls overlap; 1: all but labial_tick(), which interrupts the others and which the lock holds off; 2:
 * all calls, from any tasks or threads. */
#ifndef LABIAL_LOCKS
#define LABIAL_LOCKS 0
#endif

/* Who multiplies the weights of hearing, which takes about half of its time. 0: the library, on Arm cores that have
 * DSP instructions with these. 1: the program, which defines labial_hear_sums() (labial/hear_model.h) for the vector
 * instructions of another core. */
#ifndef LABIAL_HEAR_SUMS
#define LABIAL_HEAR_SUMS 0
#endif

/* Units of a layer that a network of hearing may have, a multiple of four, 80 .. 252. Above 128 each four cost 16 bytes
 * of a stream of sound: hear_small and hear_large have 68 and 76 units, hear_host and hear_ahead 192. */
#ifndef LABIAL_HEAR_UNITS_MAX
#define LABIAL_HEAR_UNITS_MAX 128
#endif

/* The build fails for values out of range, sums without parentheses (which the macros would break apart), and unsigned
 * numbers. */
#define LABIAL_IS_NUMBER_(x, least, most) (x >= least && (x) <= most && 2 * x * 2 + 1 == 4 * (x) + 1 && -1 - (x) < 0)
#if !LABIAL_IS_NUMBER_(LABIAL_PAPER, 0, 1)
#error "LABIAL_PAPER must be a number from 0 to 1."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_WINDOW, 1, 48)
#error "LABIAL_WINDOW must be a number from 1 to 48."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_LAG, 0, 40)
#error "LABIAL_LAG must be a number from 0 to 40."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_SEARCHED, 2, 64)
#error "LABIAL_SEARCHED must be a number from 2 to 64."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_LOCKS, 0, 2)
#error "LABIAL_LOCKS must be a number from 0 to 2."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_HEAR_SUMS, 0, 1)
#error "LABIAL_HEAR_SUMS must be a number from 0 to 1."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_HEAR_UNITS_MAX, 80, 252)
#error "LABIAL_HEAR_UNITS_MAX must be a number from 80 to 252."
#endif
#if LABIAL_HEAR_UNITS_MAX % 4
#error "LABIAL_HEAR_UNITS_MAX must be a multiple of four."
#endif
#if LABIAL_WINDOW + LABIAL_LAG > 55
#error "LABIAL_WINDOW and LABIAL_LAG must not be more than 55 together."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_REACH, 0, 60)
#error "LABIAL_REACH must be a number from 0 to 60."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_QUEUE, 2, 255)
#error "LABIAL_QUEUE must be a number from 2 to 255."
#endif
#if LABIAL_QUEUE < LABIAL_REACH + 2
#error "LABIAL_QUEUE must be LABIAL_REACH + 2 or more, or a stream could wait for a phoneme that has no room."
#endif
#if !LABIAL_IS_NUMBER_(LABIAL_MODELS, 1, 255)
#error "LABIAL_MODELS must be a number from 1 to 255."
#endif

/* Ticks from accepting a frame to delivering it. */
#if LABIAL_PAPER
#define LABIAL_PIECE 40 /* most frames of a unit; a longer one is cut into pieces */
#define LABIAL_DELAY(stride) (LABIAL_PIECE - 1 + 0 * (stride))
#else
#define LABIAL_DELAY(stride) (LABIAL_WINDOW + LABIAL_LAG + (stride))
#endif

#endif
