/*
 * checksum.h - the CRC-32 of what a device test sees, and numbers drawn from a seed.
 */
#ifndef CHECKSUM_H
#define CHECKSUM_H

#include <stdint.h>

/* A CRC-32 before any byte; its complement is the sum. */
#define CHECKSUM_BEGIN 0xffffffffu

/* The CRC-32 after one more byte, the lowest of `byte`. */
static inline uint32_t checksum_add(uint32_t crc, uint32_t byte)
{
    unsigned bit;
    for (crc ^= byte & 255u, bit = 0; bit < 8; bit++)
        crc = crc >> 1 ^ (crc & 1u ? 0xedb88320u : 0u);
    return crc;
}

/* The next number of a seed, less than `below`. */
static inline uint32_t checksum_draw(uint32_t *seed, uint32_t below)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) % below;
}

#endif
