/*
 * trace.h - the firmware's output under QEMU. A board without a debugger must not print text; so without MICROBIT_TRACE
 * these calls are empty, and the firmware waits for its button instead of ending.
 */
#ifndef EXAMPLE_TRACE_H
#define EXAMPLE_TRACE_H

#include "servos.h"

#if defined(MICROBIT_TRACE)

/* Prints a shown face: its number, its pulses, and the pulses at the pins. */
void trace_face(const servos_face_t *shown);

/* The time that one call of the library took, microseconds. */
void trace_work(uint32_t microseconds);

/* Prints the counters. */
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
