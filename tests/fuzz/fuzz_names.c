/*
 * fuzz_names.c - any bytes as labels of phonemes, in the names of both bundled models: fuzz.h says what must hold. A
 * byte 255, which no UTF-8 has, ends a label.
 */
#include "fuzz.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    while (size > 0) {
        const uint8_t *end = (const uint8_t *)memchr(data, 0xff, size);
        const size_t length = end ? (size_t)(end - data) : size;
        look_up(&speech_en_names, (const char *)data, length);
        look_up(&laughter_synthetic_names, (const char *)data, length);
        data += length + (end != NULL);
        size -= length + (end != NULL);
    }
    return 0;
}
