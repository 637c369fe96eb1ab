/*
 * prove.h - what the drivers share: values of which nothing is known.
 *
 * A driver calls the functions of one file of lib/ with everything that their header allows, and Frama-C's EVA reports
 * whatever might then be undefined: an access outside its object, an overflow, a shift by too much, a division by zero,
 * the use of what was never written. Drivers are analysed and never run.
 */
#ifndef PROVE_H
#define PROVE_H

#include <stddef.h>
#include <stdint.h>

#include "__fc_builtin.h"

/* Any value of its type. */
static volatile unsigned any_unsigned;
static volatile int any_int;
static volatile uint32_t any_uint32;
static volatile int32_t any_int32;
static volatile uint16_t any_uint16;
static volatile int16_t any_int16;
static volatile uint8_t any_uint8;
static volatile size_t any_size;

/* Fills an object with any bytes. */
#define FILL(object) Frama_C_make_unknown((char *)&(object), sizeof(object))

/* The pointer or null. */
#define OR_NULL(type, pointer) (any_int ? (type)(pointer) : (type)0)

#endif
