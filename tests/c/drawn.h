/*
 * drawn.h - what suites and device tests draw from a seed: numbers, and the sounds of hears.py, sample by sample; and the
 * CRC-32 of what a device test sees.
 */
#ifndef LABIAL_TEST_DRAWN_H
#define LABIAL_TEST_DRAWN_H

#include <stdint.h>

/* The next number of a seed, less than `below`. */
static inline uint32_t drawn_below(uint32_t *seed, uint32_t below)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) % below;
}

/* Sample `at` of the sound with this number, one after the other; `state` is 1 at first. */
static inline int16_t hear_sound(uint32_t number, uint32_t at, uint32_t *state)
{
    int32_t noise, value = 0;
    *state = *state * 1664525u + 1013904223u;
    noise = (int32_t)(*state >> 16) - 32768;
    switch (number) {
    case 1:
        value = 8520;
        break;
    case 2:
        value = at / 40u % 2u == 0u ? 32767 : -32768;
        break;
    case 3:
        value = noise >> (at / 2500u % 4u * 4u);
        break;
    case 4:
        value = 8000 + (noise >> 12);
        break;
    case 5:
        value = (int32_t)((((int64_t)(at * 420u % 65536u) - 32768) * (int32_t)(at * 77u % 16384u)) >> 15);
        value = ((value * (int32_t)(at / 3000u % 3u)) >> 1) + (noise >> 7);
        break;
    case 6:
        value = noise >> (at < 5000u ? 9u : 4u + at / 1500u % 3u);
        break;
    default:
        break;
    }
    return (int16_t)value;
}

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

#endif
