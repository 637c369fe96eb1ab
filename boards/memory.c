/*
 * memory.c - the C library's functions that compilers and the library call, for boards without a C library. They copy
 * words where both sides are aligned, like the usual C libraries.
 */
#include <stdint.h>
#include <string.h>

#define BOTH_ALIGNED(a, b) ((((uintptr_t)(a) | (uintptr_t)(b)) & 3u) == 0)

/* Words that may hold objects of any type. */
typedef uint32_t __attribute__((may_alias)) word_t;

void *memcpy(void *restrict to, const void *restrict from, size_t size)
{
    uint8_t *out = (uint8_t *)to;
    const uint8_t *in = (const uint8_t *)from;
    if (BOTH_ALIGNED(to, from))
        for (; size >= 4; size -= 4, out += 4, in += 4)
            *(word_t *)(void *)out = *(const word_t *)(const void *)in;
    while (size-- > 0)
        *out++ = *in++;
    return to;
}

void *memmove(void *to, const void *from, size_t size)
{
    uint8_t *out = (uint8_t *)to;
    const uint8_t *in = (const uint8_t *)from;
    if ((uintptr_t)to < (uintptr_t)from)
        while (size-- > 0)
            *out++ = *in++;
    else
        while (size-- > 0)
            out[size] = in[size];
    return to;
}

void *memset(void *at, int value, size_t size)
{
    uint8_t *out = (uint8_t *)at;
    const uint32_t word = (uint8_t)value * 0x01010101u;
    if (BOTH_ALIGNED(at, 0))
        for (; size >= 4; size -= 4, out += 4)
            *(word_t *)(void *)out = word;
    while (size-- > 0)
        *out++ = (uint8_t)value;
    return at;
}

int memcmp(const void *a, const void *b, size_t size)
{
    const uint8_t *x = (const uint8_t *)a, *y = (const uint8_t *)b;
    for (; size > 0; size--, x++, y++)
        if (*x != *y)
            return *x - *y;
    return 0;
}

size_t strlen(const char *text)
{
    const char *end = text;
    while (*end)
        end++;
    return (size_t)(end - text);
}

int strcmp(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return (uint8_t)*a - (uint8_t)*b;
}
