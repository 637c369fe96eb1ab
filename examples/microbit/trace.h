/*
 * trace.h - what the firmware tells whoever runs it under QEMU. A board without a debugger must not ask for text, so
 * without MICROBIT_TRACE these calls are empty, and the firmware waits for its button instead of ending.
 */
#ifndef EXAMPLE_TRACE_H
#define EXAMPLE_TRACE_H

#include "servos.h"

#if defined(MICROBIT_TRACE)

/* Prints a face that was shown: its number, its pulses, and what the pins made of them. */
void trace_face(const servos_face_t *shown);

/* The time that one call of the library took, microseconds. */
void trace_work(uint32_t microseconds);

/* Prints what was counted. */
void trace_end(void);

#else

static inline void trace_face(const servos_face_t *shown)
{
    (void)shown;
}

static inline void trace_work(uint32_t microseconds)
{
    (void)microseconds;
}

static inline void trace_end(void)
{
}

#endif

#endif
