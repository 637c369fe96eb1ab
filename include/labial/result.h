/*
 * labial/result.h - what the calls of all modules return, and the longest cancel. It needs no other file.
 */
#ifndef LABIAL_RESULT_H
#define LABIAL_RESULT_H

#ifdef __cplusplus
extern "C" {
#endif

/* Zero is success, a positive value tells what state a call has led to, a negative one is an error. */
#define LABIAL_RESULTS(X)                                                                                              \
    X(LABIAL_OK, 0, "success")                                                                                         \
    X(LABIAL_WAITING, 1, "the first frame is on its way or waits for phonemes")                                        \
    X(LABIAL_STARVED, 2, "the next frame waits for more phonemes")                                                     \
    X(LABIAL_DONE, 3, "the stream has ended and every frame was delivered")                                            \
    X(LABIAL_CANCELLED, 4, "the packet cancels: drop the sound that was not played")                                   \
    X(LABIAL_NEW_SESSION, 5, "the packet begins another session, whose samples count from now on")                     \
    X(LABIAL_ERROR_NULL, -1, "a pointer that is needed is null")                                                       \
    X(LABIAL_ERROR_VERSION, -2, "the model is of another version: export its .npz again by labial export")             \
    X(LABIAL_ERROR_MODEL, -3, "the model's tables are out of range")                                                   \
    X(LABIAL_ERROR_WORKSPACE, -4, "the workspace is too small or not aligned to four bytes")                           \
    X(LABIAL_ERROR_STATE, -5, "the call is not allowed now: not initialised, or a push after the end")                 \
    X(LABIAL_ERROR_PHONEME, -6, "the model has no phoneme of this number")                                             \
    X(LABIAL_ERROR_DURATION, -7, "the duration exceeds LABIAL_DURATION_MAX")                                           \
    X(LABIAL_ERROR_FULL, -8, "the queue is full: take from it and push again")                                         \
    X(LABIAL_ERROR_FRAME_RATE, -9, "the model's frame rate or search stride is not the stream's")                      \
    X(LABIAL_ERROR_MODELS, -10, "phonemes of LABIAL_MODELS other models are still to be played")                       \
    X(LABIAL_ERROR_NAME, -11, "no phoneme of this name is known")                                                      \
    X(LABIAL_ERROR_RIG, -12, "the rig has no output, or a value in its table is out of range")                         \
    X(LABIAL_ERROR_TIMINGS, -13, "the timings are malformed; the parser's message says how")                           \
    X(LABIAL_ERROR_SAMPLE_RATE, -14, "sound of so many samples per second is not supported")                           \
    X(LABIAL_ERROR_WORD, -15, "a word or a character ends before it begins, or begins before an earlier one")          \
    X(LABIAL_ERROR_RANGE, -16, "a number is out of the range that the call allows")                                    \
    X(LABIAL_ERROR_PACKET, -17, "the packet is not of this format, or not for so many outputs")

typedef enum {
#define LABIAL_RESULT_VALUE(name, value, text) name = value,
    LABIAL_RESULTS(LABIAL_RESULT_VALUE)
#undef LABIAL_RESULT_VALUE
        LABIAL_RESULT_LAST_ = LABIAL_ERROR_PACKET
} labial_result_t;

/* A description of any result, "unknown result" for other numbers. Linked only when used. */
const char *labial_result_text(int result);

/* The longest way to rest of a cancel, in frames. In every module the milliseconds of a cancel are the time in which
 * the face comes to rest, rounded up to whole frames, one at least; what is longer than this counts as this. The time
 * counts from the latest cancel: call it once, not again and again while a button is down. */
#define LABIAL_CANCEL_MAX 1000u

#ifdef __cplusplus
}
#endif

#endif
