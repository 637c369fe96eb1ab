/* A laugh of any length, intensity and seed, followed for as long as it lasts. */
#include "labial/labial.h"
#include "labial/laugh.h"

#include "prove.h"

static void refusals(void)
{
    labial_laugh_t laugh;
    unsigned phoneme;
    uint32_t milliseconds;
    labial_laugh_init(0, any_uint32, any_unsigned, any_uint32);
    labial_laugh_next(0, &phoneme, &milliseconds);
    labial_laugh_next(&laugh, 0, &milliseconds);
    labial_laugh_next(&laugh, &phoneme, 0);
}

int main(void)
{
    labial_laugh_t laugh;
    unsigned phoneme;
    uint32_t milliseconds;
    refusals();
    if (labial_laugh_init(&laugh, any_uint32, any_unsigned, any_uint32) == LABIAL_OK)
        while (labial_laugh_next(&laugh, &phoneme, &milliseconds) == LABIAL_OK)
            ;
    return 0;
}
